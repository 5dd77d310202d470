"""Functions of time by docs/scene_format.md, with their first and second derivatives and their corners.

Written from the documentation rather than from flexarm's sources, so that references do not share its errors.
"""

import math
import re

import numpy as np


class Jet:
    """A number with its first and second time derivative."""

    __slots__ = ("x", "d", "dd")

    def __init__(self, x, d=0.0, dd=0.0):
        self.x, self.d, self.dd = x, d, dd

    def through(self, x, slope, curve):
        """f(self), given value, first and second derivative of f."""
        return Jet(x, slope * self.d, slope * self.dd + curve * self.d * self.d)

    def __add__(self, other):
        return Jet(self.x + other.x, self.d + other.d, self.dd + other.dd)

    def __sub__(self, other):
        return Jet(self.x - other.x, self.d - other.d, self.dd - other.dd)

    def __neg__(self):
        return Jet(-self.x, -self.d, -self.dd)

    def __mul__(self, other):
        return Jet(self.x * other.x, self.d * other.x + self.x * other.d,
                   self.dd * other.x + 2 * self.d * other.d + self.x * other.dd)

    def __truediv__(self, other):
        return self * other.through(1 / other.x, -1 / other.x ** 2, 2 / other.x ** 3)

    def __pow__(self, other):
        if other.d == 0 and other.dd == 0:
            n = other.x
            return self.through(self.x ** n, n * self.x ** (n - 1) if n else 0.0,
                                n * (n - 1) * self.x ** (n - 2) if n not in (0, 1) else 0.0)
        return _FUNCTIONS["exp"](other * _FUNCTIONS["ln"](self))


_FUNCTIONS = {
    "sin": lambda u: u.through(math.sin(u.x), math.cos(u.x), -math.sin(u.x)),
    "cos": lambda u: u.through(math.cos(u.x), -math.sin(u.x), -math.cos(u.x)),
    "exp": lambda u: u.through(math.exp(u.x), math.exp(u.x), math.exp(u.x)),
    "ln": lambda u: u.through(math.log(u.x), 1 / u.x, -1 / u.x ** 2),
    "sqrt": lambda u: u.through(math.sqrt(u.x), 0.5 / math.sqrt(u.x), -0.25 * u.x ** -1.5),
    "tanh": lambda u: u.through(math.tanh(u.x), 1 - math.tanh(u.x) ** 2,
                                -2 * math.tanh(u.x) * (1 - math.tanh(u.x) ** 2)),
    "abs": lambda u: u if u.x >= 0 else -u,
    "sign": lambda u: Jet(float(u.x > 0) - float(u.x < 0)),
    "rint": lambda u: Jet(float(round(u.x))),
}
_MANY = {"min": min, "max": max}
_TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)"
                    r"|(<=|>=|==|!=|&&|\|\||[-+*/^()<>?:,]))")


class Expression:
    """An expression in t. `__call__(t)` returns a Jet. `switches`: functions of t whose zeros are the corners."""

    def __init__(self, text):
        self.text, self.switches, self._tokens, position = text, [], [], 0
        text = text.strip()
        while position < len(text):
            match = _TOKEN.match(text, position)
            if not match:
                raise ValueError(f"expression '{text}': cannot read '{text[position:]}'")
            self._tokens.append(match.group(match.lastindex))
            position = match.end()
        self._tokens.append("")
        self._evaluate = self._choice()
        if self._tokens != [""]:
            raise ValueError(f"expression '{text}': left over: {' '.join(self._tokens)}")
        self.switches = [(lambda switch: lambda t: switch(Jet(t, 1.0)))(switch) for switch in self.switches]

    def __call__(self, t):
        return self._evaluate(Jet(t, 1.0))

    def _take(self, *wanted):
        if self._tokens[0] in wanted:
            return self._tokens.pop(0)
        return None

    def _need(self, token):
        if not self._take(token):
            raise ValueError(f"expression '{self.text}': expected '{token}', got '{self._tokens[0]}'")

    def _choice(self):
        condition = self._or()
        if not self._take("?"):
            return condition
        yes = self._choice()
        self._need(":")
        no = self._choice()
        return lambda t: yes(t) if condition(t).x != 0 else no(t)

    def _or(self):
        left = self._and()
        while self._take("||"):
            left = (lambda a, b: lambda t: Jet(float(a(t).x != 0 or b(t).x != 0)))(left, self._and())
        return left

    def _and(self):
        left = self._comparison()
        while self._take("&&"):
            left = (lambda a, b: lambda t: Jet(float(a(t).x != 0 and b(t).x != 0)))(left, self._comparison())
        return left

    def _comparison(self):
        left = self._sum()
        sign = self._take("<", ">", "<=", ">=")
        if not sign:
            return left
        right = self._sum()
        self.switches.append(lambda t: (left(t) - right(t)).x)
        if sign[0] == "<":
            return lambda t: Jet(float(left(t).x < right(t).x))
        return lambda t: Jet(float(left(t).x > right(t).x))

    def _sum(self):
        left = self._product()
        while self._tokens[0] in ("+", "-"):
            if self._tokens.pop(0) == "+":
                left = (lambda a, b: lambda t: a(t) + b(t))(left, self._product())
            else:
                left = (lambda a, b: lambda t: a(t) - b(t))(left, self._product())
        return left

    def _product(self):
        left = self._signed()
        while self._tokens[0] in ("*", "/"):
            if self._tokens.pop(0) == "*":
                left = (lambda a, b: lambda t: a(t) * b(t))(left, self._signed())
            else:
                left = (lambda a, b: lambda t: a(t) / b(t))(left, self._signed())
        return left

    def _signed(self):
        if self._take("-"):
            return (lambda a: lambda t: -a(t))(self._signed())
        self._take("+")
        base = self._value()
        if not self._take("^"):
            return base
        return (lambda a, b: lambda t: a(t) ** b(t))(base, self._signed())

    def _value(self):
        token = self._tokens.pop(0)
        if token == "(":
            inner = self._choice()
            self._need(")")
            return inner
        if token == "t":
            return lambda t: t
        if token in ("_pi", "_e"):
            constant = Jet(math.pi if token == "_pi" else math.e)
            return lambda t: constant
        if token in _FUNCTIONS or token in _MANY:
            return self._call(token)
        constant = Jet(float(token))
        return lambda t: constant

    def _call(self, name):
        self._need("(")
        arguments = [self._choice()]
        while self._take(","):
            arguments.append(self._choice())
        self._need(")")
        if name in _MANY:
            for i, a in enumerate(arguments):
                for b in arguments[:i]:
                    self.switches.append((lambda a, b: lambda t: (a(t) - b(t)).x)(a, b))
            return lambda t: _MANY[name]((a(t) for a in arguments), key=lambda jet: jet.x)
        inner = arguments[0]
        if name in ("abs", "sign"):
            self.switches.append(lambda t: inner(t).x)
        if name == "rint":  # jumps at half-integers
            self.switches.append(lambda t: math.cos(math.pi * inner(t).x))
        return lambda t: _FUNCTIONS[name](inner(t))


class Table:
    """TIME:VALUE (linear) or TIME:VALUE:RATE (cubic); constant outside."""

    def __init__(self, text):
        rows = [[float(number) for number in row.split(":")] for row in text.split()]
        self.times = [row[0] for row in rows]
        self.rows, self.switches = rows, []

    def __call__(self, t):
        rows = self.rows
        if t <= rows[0][0] or t >= rows[-1][0]:
            return Jet((rows[0] if t <= rows[0][0] else rows[-1])[1])
        i = max(k for k, row in enumerate(rows) if row[0] <= t)
        (t0, a, *ra), (t1, b, *rb) = rows[i], rows[i + 1]
        h = t1 - t0
        s = (t - t0) / h
        if not ra:
            return Jet(a + s * (b - a), (b - a) / h)
        c2, c3 = 3 * (b - a) - h * (2 * ra[0] + rb[0]), 2 * (a - b) + h * (ra[0] + rb[0])
        return Jet(a + s * (h * ra[0] + s * (c2 + s * c3)), ra[0] + s * (2 * c2 + 3 * c3 * s) / h,
                   (2 * c2 + 6 * c3 * s) / h ** 2)


def read(text):
    """Reads a number, a table or an expression; columns of files are refused."""
    text = text.strip()
    if "#" in text:
        raise ValueError(f"'{text}': columns of files are not read here")
    if re.match(r"^[-+.\deE]+:", text):
        return Table(text)
    return Expression(text)


def corners(function, until, samples=20000):
    """Times inside (0, until) at which a function is not smooth: points of tables, and zeros of its switches."""
    found = [t for t in getattr(function, "times", []) if 0 < t < until]
    grid = np.linspace(0, until, samples + 1)
    for switch in function.switches:
        values = np.array([switch(t) for t in grid])
        found += [t for t in grid[1:-1][values[1:-1] == 0]]
        for i in np.nonzero(values[:-1] * values[1:] < 0)[0]:
            low, high, below = grid[i], grid[i + 1], values[i] < 0
            while True:
                middle = 0.5 * (low + high)
                if not low < middle < high:
                    break
                if (switch(middle) < 0) == below:
                    low = middle
                else:
                    high = middle
            found.append(high)
    return sorted(set(found))
