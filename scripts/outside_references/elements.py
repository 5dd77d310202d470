"""Forces on the coordinates of a mechanism, by the laws of docs/scene_format.md, docs/theory/joints.md,
docs/notes/stops.md and docs/notes/drives.md, in continuous time.

Each element has switches, functions that change sign where its law is not smooth. During an interval between two
corners, the element keeps the signs of its switches at the start, so that its law is smooth also beyond the end.
"""

import math

import time_functions
from mechanism import Refused, number, numbers

CREEP = 1e-3  # transition velocity of the smooth law of friction [rad/s or m/s]


class Element:
    """An element. `extras`: number of own states. `held`: signs of its switches in the present interval, 1 or -1."""

    extras = 0
    functions = ()
    held = ()

    def start(self, _q, _v):
        return []

    def switches(self, _s):
        return []

    def act(self, s, efforts, rates):
        """Adds to `efforts` on the coordinates, and writes the `rates` of the own states, which are s.own(self)."""

    def longest_step(self):
        """The longest step in which no zero of a switch is overlooked [s]."""
        return math.inf

    def settle(self, s):
        """Chooses the signs at the start."""
        self.held = [1 if value > 0 else -1 for value in self.switches(s)]

    def flip(self, which, _s):
        """Passes the zero of a switch."""
        self.held = list(self.held)
        self.held[which] *= -1

    def sample(self, s):
        """Takes a sample, at the element's own sampling times."""


class Passive(Element):
    """Damping, smooth friction and spring of a coordinate."""

    def __init__(self, j, damping, friction, spring):
        self.j, self.damping, self.friction, self.spring = j, damping, friction, spring

    def act(self, s, efforts, rates):
        q, v = s.q[self.j], s.v[self.j]
        efforts[self.j] -= self.damping * v + self.friction * math.tanh(v / CREEP)
        if self.spring:
            efforts[self.j] -= self.spring[0] * (q - self.spring[1])


def restitution_of(ratio):
    """The restitution of a linear oscillator with this damping ratio: starts at x = 0, v = 1, and ends at zero force.

    With frequency 1, x = exp(-z t) sin(w t)/w. The force x + 2 z v is 0 first at tan(w t) = 2 z w / (2 z^2 - 1). For
    z > 1, hyperbolic functions replace the circular ones."""
    w = max(math.sqrt(abs(1 - ratio ** 2)), 1e-6)
    if ratio < 1:
        t = math.atan2(2 * ratio * w, 2 * ratio ** 2 - 1) / w
        return -math.exp(-ratio * t) * (math.cos(w * t) - ratio * math.sin(w * t) / w)
    t = math.atanh(2 * ratio * w / (2 * ratio ** 2 - 1)) / w
    return -math.exp(-ratio * t) * (math.cosh(w * t) - ratio * math.sinh(w * t) / w)


class Stop(Element):
    """Both stops of a coordinate (notes/stops.md 2). The switches are penetration and force of each stop."""

    def __init__(self, j, lower, upper, restitution, inertia, contact_time, start):
        self.j, self.bounds = j, ((1, upper), (-1, lower))
        depth = 0.1 * (upper - lower)
        if not depth > 0:
            raise Refused("a range of nothing")
        self.depth = max(depth, 4 * (lower - start), 4 * (start - upper))
        frequency = math.pi / contact_time
        self.stiffness = inertia * frequency ** 2
        low, high = 0.0, 10.0
        for _ in range(60):
            ratio = 0.5 * (low + high)
            low, high = (ratio, high) if restitution_of(ratio) > restitution else (low, ratio)
        self.damping = 2 * ratio * inertia * frequency

    def _state(self, s, side):
        sign, bound = self.bounds[side]
        p = sign * (s.q[self.j] - bound)
        r = min(max(p, 0.0) / self.depth, 0.99999)
        room = 1 - r * r
        return p, p / room ** 2 if p > 0 else 0.0, (1 + 3 * r * r) / room ** 3, sign * s.v[self.j]

    def switches(self, s):
        found = []
        for side in (0, 1):
            p, x, _, rate = self._state(s, side)
            found += [p, self.stiffness * x + self.damping * rate]
        return found

    def act(self, s, efforts, rates):
        for side in (0, 1):
            if self.held[2 * side] > 0 and self.held[2 * side + 1] > 0:
                _, x, slope, rate = self._state(s, side)
                efforts[self.j] -= self.bounds[side][0] * slope * (self.stiffness * x + self.damping * rate)


class PointSpring(Element):
    """A spring along the line between two points, with a parallel damper."""

    def __init__(self, mechanism, element, q):
        self.mechanism = mechanism
        self.ends = [(element.get(end), *mechanism.plane.split(numbers(element.get(end + "_at", "0 0 0"))))
                     for end in ("from", "to")]
        self.stiffness, self.damping = number(element, "stiffness"), number(element, "damping", 0.0)
        self.rest = number(element, "rest_length", self._line(mechanism.place(q, [0.0] * mechanism.n))[0])

    def _line(self, frames):
        """The length, and its derivatives with respect to the coordinates."""
        (a, at_a, height_a), (b, at_b, height_b) = self.ends
        ra, ja, _ = self.mechanism.point(frames[a], at_a)
        rb, jb, _ = self.mechanism.point(frames[b], at_b)
        way, rise = rb - ra, frames[b][2] + height_b - frames[a][2] - height_a
        length = math.hypot(abs(way), rise)
        return length, [((way.conjugate() * (y - x)).real + rise * (h - g)) / length
                        for x, y, g, h in zip(ja, jb, frames[a][5], frames[b][5])]

    def act(self, s, efforts, rates):
        length, slopes = self._line(s.frames)
        rate = sum(slope * v for slope, v in zip(slopes, s.v))
        pull = self.stiffness * (length - self.rest) + self.damping * rate
        for i, slope in enumerate(slopes):
            efforts[i] -= slope * pull


class Load(Element):
    """A force and a moment on a link."""

    def __init__(self, mechanism, element):
        self.mechanism, self.link = mechanism, element.get("link")
        (self.at, _), (self.force, self.rise), (_, self.moment) = (
            mechanism.plane.split(numbers(element.get(key, "0 0 0"))) for key in ("at", "force", "moment"))
        self.is_follower = element.get("frame", "world") == "follower"
        self.functions = [time_functions.read(element.get("history", "1"))]

    def act(self, s, efforts, rates):
        frame = s.frames[self.link]
        _, jacobian, _ = self.mechanism.point(frame, self.at)
        force = (self.force * frame[1] if self.is_follower else self.force).conjugate()
        factor = s.value(self.functions[0])
        for i, j in enumerate(jacobian):
            efforts[i] += factor * ((force * j).real + self.moment * frame[4][i] + self.rise * frame[5][i])


class Motor(Element):
    """The effort of a coordinate with servo and drive, cut off at the smallest limit."""

    def __init__(self, j, effort, servo, drive, limit, q0):
        self.j, self.servo, self.drive = j, servo, drive
        self.functions = [time_functions.read(effort)] if effort is not None else []
        self.effort = self.functions[0] if self.functions else None
        self.is_elastic = drive is not None and drive.get("stiffness") is not None
        self.inertia = 0.0
        self.limit = min([limit or math.inf, number(servo, "effort_limit", math.inf),
                          number(drive, "effort_limit", math.inf)])
        self.no_load = number(drive, "velocity_limit", math.inf)
        if drive is not None:
            self._read_drive()
        self.period = 0.0
        self.integral_at = 2 if self.is_elastic else 0
        self.has_integral = False
        if servo is not None:
            self._read_servo(q0)
        self.extras = (2 if self.is_elastic else 0) + (1 if self.has_integral else 0)

    def _read_drive(self):
        if any(self.drive.get(key) for key in ("axis", "efficiency", "damping_ratio")):
            raise Refused("efficiency, axis or damping ratio of a drive")
        self.inertia = number(self.drive, "gear", 1.0) ** 2 * number(self.drive, "rotor_inertia", 0.0)
        self.stiffness, self.damping = number(self.drive, "stiffness", 0.0), number(self.drive, "damping", 0.0)
        self.half_play = 0.5 * number(self.drive, "backlash", 0.0)
        self.friction = number(self.drive, "friction", 0.0)

    def _read_servo(self, q0):
        servo = self.servo
        if servo.find("gains") is not None:
            raise Refused("a servo that is switched")
        self.mode = servo.get("mode", "position")
        self.kp, self.kd, self.ki = (number(servo, key, 0.0) for key in ("kp", "kd", "ki"))
        self.tracking = number(servo, "anti_windup", 0.0)
        self.measures_link = servo.get("side", "motor") == "link"
        self.set_point = time_functions.read(servo.get("set_point", str(q0 if self.mode == "position" else 0.0)))
        self.feedforward = time_functions.read(servo.get("feedforward", "0"))
        self.functions = self.functions + [self.set_point, self.feedforward]
        self.period, self.delay = number(servo, "sample_time", 0.0), number(servo, "delay", 0.0)
        self.has_integral = self.period == 0 and self.ki > 0
        self.outputs = []  # (time from which it acts, value) of each sample
        self.last, self.sum, self.last_set = q0, 0.0, None

    def start(self, q, v):
        return ([q[self.j], v[self.j]] if self.is_elastic else []) + ([0.0] if self.has_integral else [])

    def _measured(self, s):
        if self.is_elastic and not (self.servo is not None and self.measures_link):
            return s.own(self)[0], s.own(self)[1]
        return s.q[self.j], s.v[self.j]

    def _rate(self, s):
        return s.own(self)[1] if self.is_elastic else s.v[self.j]

    def _raw(self, s):
        raw = s.value(self.effort) if self.effort is not None else 0.0
        if self.servo is None:
            return raw, 0.0
        if self.period > 0:
            due = [value for begin, value in self.outputs if begin <= s.middle]
            return raw + (due[-1] if due else 0.0), 0.0
        y, rate = self._measured(s)
        jet = s.jet(self.set_point)
        raw += s.value(self.feedforward)
        error = jet.x - (rate if self.mode == "velocity" else y)
        if self.mode == "effort":
            return raw + jet.x, 0.0
        raw += self.kp * error
        if self.mode == "position":
            raw += self.kd * (jet.d - rate)
        if self.has_integral:
            raw += self.ki * s.own(self)[self.integral_at]
        return raw, error

    def sample(self, s):
        y, _ = self._measured(s)
        set_point = s.jet(self.set_point).x
        rate = (y - self.last) / self.period
        set_rate = 0.0 if self.last_set is None else (set_point - self.last_set) / self.period
        error = set_point - (rate if self.mode == "velocity" else y)
        self.sum += self.period * error
        raw = s.value(self.feedforward) + self.kp * error + self.ki * self.sum
        if self.mode == "position":
            raw += self.kd * (set_rate - rate)
        limit = number(self.servo, "effort_limit", math.inf)
        cut = min(max(raw, -limit), limit)
        if self.tracking > 0 and self.ki > 0:
            self.sum += self.period * (cut - raw) / (self.ki * self.tracking)
        self.outputs = self.outputs[-8:] + [(s.t + self.delay, cut)]
        self.last, self.last_set = y, set_point

    def _bounds(self, s):
        """Lowest and highest effort. The held signs say on which part of the torque-speed line the motor is."""
        if math.isinf(self.no_load):
            return -self.limit, self.limit
        rate = self._rate(s)
        beyond, forward = self.held[-3:-1], self.held[-1] > 0
        low, high = -self.limit, self.limit
        if forward:
            high = 0.0 if beyond[0] > 0 else self.limit * (1 - rate / self.no_load)
        else:
            low = 0.0 if beyond[1] > 0 else -self.limit * (1 + rate / self.no_load)
        return low, high

    def switches(self, s):
        found = []
        if self.is_elastic and self.half_play > 0:
            twist = s.own(self)[0] - s.q[self.j]
            found += [twist - self.half_play, -twist - self.half_play]
        if math.isinf(self.limit):
            return found
        if math.isinf(self.no_load):
            raw, _ = self._raw(s)
            return found + [raw - self.limit, -raw - self.limit]
        rate, raw = self._rate(s), self._raw(s)[0]
        if len(self.held) < 5:
            self.held = [-1] * (len(found) + 4) + [1 if rate > 0 else -1]
        low, high = self._bounds(s)
        return found + [raw - high, low - raw, rate - self.no_load, -rate - self.no_load, rate]

    def act(self, s, efforts, rates):
        raw, error = self._raw(s)
        motor = raw
        if not math.isinf(self.limit):
            first = 2 if self.is_elastic and self.half_play > 0 else 0
            low, high = self._bounds(s)
            motor = high if self.held[first] > 0 else low if self.held[first + 1] > 0 else raw
        if self.has_integral:
            rates[self.integral_at] = error + ((motor - raw) / (self.ki * self.tracking) if self.tracking > 0 else 0.0)
        if not self.is_elastic:
            efforts[self.j] += motor
            return
        theta, rate = s.own(self)[:2]
        twist, twist_rate = theta - s.q[self.j], rate - s.v[self.j]
        if self.half_play > 0:
            side = 1 if self.held[0] > 0 else -1 if self.held[1] > 0 else 0
            twist, twist_rate = twist - side * self.half_play, twist_rate * abs(side)
            twist *= abs(side)
        gear = self.stiffness * twist + self.damping * twist_rate
        efforts[self.j] += gear
        rates[0] = rate
        rates[1] = (motor - gear - self.friction * math.tanh(rate / CREEP)) / self.inertia


class Coulomb:
    """Dry friction that sticks. `state`: 0 while it sticks, else the sign of the sliding velocity."""

    def __init__(self, j, capacity):
        self.j, self.capacity, self.state = j, capacity, 0
