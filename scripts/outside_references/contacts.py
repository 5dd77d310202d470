"""Contact without friction of balls and boxes with grounds and balls, by docs/notes/contact.md 2, in continuous time.

The speed of approach v of a hit is the largest rate of penetration so far. While the rate rises, v is the rate itself;
from its peak on, v is constant until the contact opens, or approaches again after it has receded.
"""

import math

from scipy.optimize import brentq

from elements import Element
from mechanism import Refused, number, numbers

DEPTH = 0.1  # relative to the smaller half width of both sides
CONTACT_TIME = 0.01  # that a hit lasts, if the scene says nothing else [s]
SLOW = 1e-3  # rates below this part of half of the frequency times the penetration are those of a contact at rest


def damping_of(restitution):
    """The damping d of Hunt and Crossley's law: (1 + d)/(1 - e d) = exp(d (1 + e))."""
    e = restitution
    if e == 1:
        return 0.0
    return brentq(lambda d: d * (1 + e) - math.log1p(d) + math.log1p(-e * d), 1e-6, (1 - 1e-15) / e, xtol=1e-16)


class Ground:
    mass = size = math.inf

    def __init__(self, element, plane):
        normal = numbers(element.get("normal", "0 0 1"))
        length = math.sqrt(float(normal @ normal))
        self.normal, height = plane.split(normal / length)
        self.offset = number(element, "offset", 0.0)
        if abs(height) > 1e-12:
            raise Refused("a ground that is not normal to the plane")


class Body:
    """A link with one ball or one box as its shape. `points`: (place, radius, how many are at this place in space)."""

    def __init__(self, element, link, plane):
        shapes = element.findall("collision")
        if len(shapes) != 1 or (shapes[0].find("origin") is not None
                                and any(numbers(shapes[0].find("origin").get("rpy", "0 0 0")))):
            raise Refused(f"the shapes of '{link.name}'")
        origin = shapes[0].find("origin")
        middle, height = plane.split(numbers(origin.get("xyz", "0 0 0"))) if origin is not None else (0j, 0.0)
        geometry = shapes[0].find("geometry")
        sphere, box = geometry.find("sphere"), geometry.find("box")
        if (sphere is None and box is None) or height != 0:
            raise Refused(f"the shape of '{link.name}'")
        self.link, self.mass = link.name, link.mass
        if sphere is not None:
            self.size, self.at_a_time = float(sphere.get("radius")), 1
            self.points = [(middle, self.size, 1)]
        else:
            half = 0.5 * numbers(box.get("size"))
            flat, _ = plane.split(half)
            self.size, self.at_a_time = float(min(half)), 4
            self.points = [(middle + complex(x * flat.real, y * flat.imag), 0.0, 2) for x in (-1, 1) for y in (-1, 1)]


class Contact(Element):
    """One point of a body against a ground or a ball. `mode`: open, rising (v is the rate), held (v is constant, and
    approaches), receding, resting (v is so small that the law does not depend on it)."""

    def __init__(self, mechanism, element, body, other, point, contact_time):
        self.mechanism, self.body, self.other = mechanism, body, other
        self.at, self.radius, self.count = point
        mass = 1 / (1 / body.mass + 1 / other.mass)
        usual = mass * (math.pi / number(element, "contact_time", contact_time)) ** 2 / body.at_a_time
        self.stiffness = number(element, "stiffness", usual)
        self.frequency = math.sqrt(self.stiffness * body.at_a_time / mass)
        self.depth = DEPTH * min(body.size, other.size)
        self.damping = damping_of(number(element, "restitution", 1.0))
        self.mode, self.speed, self.is_bound, self.pushes, self.held = "open", 0.0, False, True, [1] * 5

    # ---- kinematics

    def _frames(self, s):
        return s.frames or self.mechanism.place(s.q, s.v)

    def _gap(self, s):
        """The gap, its derivatives with respect to the coordinates, and the part of its acceleration without theirs."""
        frames = self._frames(s)
        place, slopes, bias = self.mechanism.point(frames[self.body.link], self.at)
        if isinstance(self.other, Ground):
            n = self.other.normal.conjugate()
            return ((n * place).real - self.other.offset - self.radius, [(n * j).real for j in slopes],
                    (n * bias).real)
        to, other_slopes, other_bias = self.mechanism.point(frames[self.other.link], self.other.points[0][0])
        way, moves = place - to, [a - b for a, b in zip(slopes, other_slopes)]
        length = abs(way)
        n = way.conjugate() / length
        velocity = sum(j * v for j, v in zip(moves, s.v))
        across = (n * velocity).imag
        return (length - self.radius - self.other.size, [(n * j).real for j in moves],
                (n * (bias - other_bias)).real + across ** 2 / length)

    def _state(self, s):
        """Penetration, its rate, and the derivatives of the gap."""
        gap, slopes, _ = self._gap(s)
        return -gap, -sum(j * v for j, v in zip(slopes, s.v)), slopes

    def _acceleration(self, s):
        """The second derivative of the penetration."""
        _, slopes, bias = self._gap(s)
        n = len(s.v)
        rates = s.motion.solve(s)[0]
        return -bias - sum(j * a for j, a in zip(slopes, rates[n:2 * n]))

    # ---- the law

    def _hardened(self, p):
        r = min(max(p, 0.0) / self.depth, 0.999999)
        room = 1 - r * r
        return p / room ** 2 if p > 0 else 0.0, (1 + 3 * r * r) / room ** 3

    def _approach(self, rate):
        return max(rate, 0.0) if self.mode == "rising" else self.speed

    def _factor(self, x, rate):
        if self.damping == 0:
            return 1.0
        speed = 0.5 * self.frequency * x if self.is_bound else self._approach(rate)
        return 1 + self.damping * rate / speed if speed > 0 else 1.0

    def act(self, s, efforts, rates):
        if self.mode == "open" or not self.pushes:
            return
        p, rate, slopes = self._state(s)
        x, slope = self._hardened(p)
        push = self.count * self.stiffness * slope * x * self._factor(x, rate)
        for i, j in enumerate(slopes):
            efforts[i] += push * j

    # ---- switches, > 0 until the mode ends

    def switches(self, s):
        p, rate, _ = self._state(s)
        if self.mode == "open":
            return [-p, 1.0, 1.0, 1.0, 1.0]
        x, _ = self._hardened(p)
        slow = 0.5 * self.frequency * x - self._approach(rate)
        found = [p, 1.0, 1.0, (slow if self.is_bound else -slow) if self.damping else 1.0, 1.0]
        if self.mode == "resting":
            found[1] = SLOW * 0.5 * self.frequency * x - abs(rate)
        elif self.mode == "rising":
            found[1] = self._acceleration(s)
        elif self.mode == "held":
            found[1:3] = rate, self.speed - rate
        else:
            factor = self._factor(x, rate)
            found[1], found[4] = -rate, factor if self.pushes else -factor
        return found

    def settle(self, s):
        p, rate, _ = self._state(s)
        self.held, self.pushes = [1] * 5, True
        if p > 0:
            raise Refused("bodies that overlap at the start")
        self.mode = "open"

    def longest_step(self):
        return math.inf if self.mode == "open" else 0.3 / self.frequency

    def flip(self, which, s):
        self._pass(which, s)
        p, rate, _ = self._state(s)
        slow = SLOW * 0.5 * self.frequency * self._hardened(p)[0]
        if self.mode in ("held", "receding", "rising") and self.is_bound and self.pushes:
            if abs(rate) < 0.5 * slow and self._approach(rate) < 0.5 * slow:
                self.mode = "resting"

    def _pass(self, which, s):
        _, rate, _ = self._state(s)
        if which == 3:
            self.is_bound = not self.is_bound
        elif which == 4:
            self.pushes = not self.pushes
        elif which == 0 and self.mode != "open":
            self.mode = "open"
        elif (self.mode == "held" and which == 1) or (self.mode == "resting" and rate < 0):
            self.mode = "receding"
        elif self.mode == "rising":
            self.mode, self.speed = "held", rate
        else:  # a touch, or an approach that has become faster, or that has begun anew
            self._rise(s, rate)

    def _rise(self, s, rate):
        p, _, _ = self._state(s)
        self.mode, self.pushes = "rising", True
        self.is_bound = 0.5 * self.frequency * self._hardened(p)[0] > rate
        if self._acceleration(s) <= 0:
            self.mode, self.speed = "held", rate


def contacts(mechanism, contact_time):
    """All contacts of a scene."""
    root, found = mechanism.root, []
    sides = {e.get("name"): Ground(e, mechanism.plane) for e in root.findall("ground")}
    for element in root.findall("contact"):
        if number(element, "friction", 0.0) != 0 or element.get("restitution") is None:
            raise Refused("a <contact> with friction, or without a restitution")
        for name in (element.get("first"), element.get("second")):
            if name not in sides:
                link = root.find(f"link[@name='{name}']")
                sides[name] = Body(link, mechanism.links[name], mechanism.plane)
        body, other = (sides[element.get(key)] for key in ("first", "second"))
        if isinstance(other, Body) and (other.at_a_time > 1 or body.at_a_time > 1):
            raise Refused("boxes that touch other bodies")
        found += [Contact(mechanism, element, body, other, point, contact_time) for point in body.points]
    return found
