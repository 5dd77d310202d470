"""Expressions of result columns and parameters, evaluated for all rows at once. Other functions are not allowed."""

import ast
import functools
import operator
import re

import numpy

FUNCTIONS = {
    "abs": numpy.abs, "sign": numpy.sign, "sqrt": numpy.sqrt, "hypot": numpy.hypot,
    "exp": numpy.exp, "ln": numpy.log, "log": numpy.log, "log2": numpy.log2, "log10": numpy.log10,
    "sin": numpy.sin, "cos": numpy.cos, "tan": numpy.tan,
    "asin": numpy.arcsin, "acos": numpy.arccos, "atan": numpy.arctan, "atan2": numpy.arctan2,
    "sinh": numpy.sinh, "cosh": numpy.cosh, "tanh": numpy.tanh,
    "floor": numpy.floor, "ceil": numpy.ceil, "min": numpy.minimum, "max": numpy.maximum,
}
ARGUMENTS = {"hypot": 2, "atan2": 2, "min": 2, "max": 2}  # number of arguments, if it is not 1
CONSTANTS = {"pi": numpy.pi}
OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: numpy.divide, ast.Pow: numpy.power,
    ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Not: numpy.logical_not,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.And: numpy.logical_and, ast.Or: numpy.logical_or,
}
DEEPEST = 100  # greatest depth of nested operations


class ExpressionError(ValueError):
    """An expression cannot be used; the text says why."""


class Expression:
    """An expression with names of `columns` (joint/elbow/position) and `parameters`, numbers, operators and functions.

    The longest name that fits is taken as the column: `probe/tip/x/2` is half of `probe/tip/x`.
    Raises ExpressionError. used: names of the columns in the expression.
    """

    def __init__(self, text, columns, parameters):
        self.text = text
        prefix = "c_"  # of the names that replace columns, chosen so that the text has no such name
        while prefix in text:
            prefix = "_" + prefix
        names = {}

        def stand_in(match):
            return " %s " % names.setdefault(match.group(), prefix + str(len(names)))

        known = "|".join(re.escape(name) for name in sorted(columns, key=len, reverse=True))
        plain = re.sub(r"(?<!\w)(?:%s)(?!\w)" % known, stand_in, text).replace("^", "**")
        self._names = {name: column for column, name in names.items()}
        self.used = tuple(names)
        try:
            self._tree = ast.parse(plain.strip(), mode="eval").body
        except (SyntaxError, ValueError, MemoryError, RecursionError):
            raise ExpressionError("expected an expression of columns, got '%s'" % text) from None
        self._check(self._tree, parameters)

    def __repr__(self):
        return "Expression(%r)" % self.text

    def _check(self, node, parameters, depth=0):
        if depth > DEEPEST:
            raise ExpressionError("expected at most %d nested operations in '%s'" % (DEEPEST, self.text))
        for part in self._parts(node, parameters):
            self._check(part, parameters, depth + 1)

    def _parts(self, node, parameters):
        """The operands of an operation; raises ExpressionError if the operation is not allowed."""
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            return []
        if isinstance(node, ast.Name):
            if node.id not in self._names and node.id not in parameters and node.id not in CONSTANTS:
                raise ExpressionError("'%s' is neither a column nor a parameter" % self._whole_name(node.id))
            return []
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            return self._arguments(node.func.id, node.args)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return [node.left, node.right]
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
            return [node.operand]
        if isinstance(node, ast.BoolOp):
            return node.values
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in OPERATORS:
            return [node.left, node.comparators[0]]
        if isinstance(node, ast.IfExp):
            return [node.test, node.body, node.orelse]
        raise ExpressionError("expected numbers, columns, parameters, + - * / ^, comparisons, and the functions [%s] "
                              "in '%s'" % (", ".join(FUNCTIONS), self.text))

    def _whole_name(self, part):
        """The whole name as in the text: joint/elbwo/position rather than `joint`, for error messages."""
        match = re.search(r"(?<!\w)%s(?:/\w+)*" % re.escape(part), self.text)
        return match.group() if match else part

    def _arguments(self, function, arguments):
        if function not in FUNCTIONS:
            raise ExpressionError("'%s' is not one of the functions [%s]" % (function, ", ".join(FUNCTIONS)))
        expected = ARGUMENTS.get(function, 1)
        if len(arguments) != expected:
            raise ExpressionError("%s(): expected %d argument%s, got %d"
                                  % (function, expected, "s"[:expected - 1], len(arguments)))
        return arguments

    def evaluate(self, columns, parameters):
        """The values, an array. `columns`: arrays of the same length by name; `parameters`: numbers by name."""
        values = {**CONSTANTS, **parameters, **{name: columns[column] for name, column in self._names.items()}}
        with numpy.errstate(all="ignore"):
            result = self._value(self._tree, values)
        length = len(next(iter(columns.values())))
        return numpy.broadcast_to(numpy.asarray(result, dtype=float), (length,))

    def _value(self, node, values):
        def of(part):
            return numpy.asarray(self._value(part, values), dtype=float)

        if isinstance(node, ast.Constant):
            return float(node.value)
        if isinstance(node, ast.Name):
            return values[node.id]
        if isinstance(node, ast.Call):
            return FUNCTIONS[node.func.id](*map(of, node.args))
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](of(node.left), of(node.right))
        if isinstance(node, ast.UnaryOp):
            return OPERATORS[type(node.op)](of(node.operand))
        if isinstance(node, ast.BoolOp):
            return functools.reduce(OPERATORS[type(node.op)], map(of, node.values))
        if isinstance(node, ast.Compare):
            return OPERATORS[type(node.ops[0])](of(node.left), of(node.comparators[0]))
        return numpy.where(of(node.test), of(node.body), of(node.orelse))
