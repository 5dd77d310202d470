"""The motion of a scene: integrates intervals between corners with scipy's DOP853, and locates corners in time.

Judged times are ends of intervals, so that results contain no interpolation.
"""

import math

import numpy as np
from scipy.linalg import null_space
from scipy.optimize import brentq

try:
    from scipy.integrate import DOP853 as RungeKutta
except ImportError:  # before scipy 1.4: of order 5 instead of 8, so with more steps
    from scipy.integrate import RK45 as RungeKutta

import time_functions
from contacts import CONTACT_TIME, contacts
from elements import Coulomb, Load, Motor, Passive, PointSpring, Stop
from mechanism import Mechanism, Refused, number, numbers

TOLERANCE = 1e-12
PARTS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)  # of a step: places where the signs of switches are checked
SAME = 1e-13  # relative to the time: distance from the ends of an interval at which functions of time are evaluated


class Snapshot:
    """What elements see: time, coordinates, rates, and their own states."""

    def __init__(self, motion, t, y):
        self.t, self.piece, self.slices, self.motion = t, motion.piece, motion.slices, motion
        self.middle = 0.5 * (motion.piece[0] + motion.piece[1])
        begin, end = motion.piece
        gap = SAME * max(1.0, end)
        self.clamped = min(max(t, begin + gap), end - gap) if end - begin > 2 * gap else self.middle
        self.y = y.tolist() if isinstance(y, np.ndarray) else y
        self.q, self.v, self.bias = motion.unpack(self.clamped, self.y)
        self.frames = None

    def own(self, element):
        return self.y[self.slices[element]]

    def jet(self, function):
        return function(self.clamped)

    def value(self, function):
        return function(self.clamped).x


class Motion:
    def __init__(self, text, until):
        self.mechanism = m = Mechanism(text)
        self.until, self.step = until, 1e-3
        self.contact_time = number(m.simulation, "contact_time", CONTACT_TIME)
        integrator = m.simulation.find("integrator")
        if integrator is not None:
            self.step = number(integrator, "step", self.step)
        self._read_constraints()
        self._read_start()
        self.piece = (0.0, 1e-6)
        self._read_elements()
        self._find_corners()

    # ---- reading

    def _read_constraints(self):
        """Sets up q = T z + c(t), with the free coordinates z, for prescribed motions and for mimics."""
        m = self.mechanism
        self.motions = m.function_entries("motion", "position")
        followers = {m.index[j.name]: j.element.find("mimic") for j in m.moving if j.element.find("mimic") is not None}
        self.free = [i for i in range(m.n) if i not in self.motions and i not in followers]
        self.T, self.offset = np.zeros((m.n, len(self.free))), np.zeros(m.n)
        self.carried = np.zeros((m.n, m.n))  # maps prescribed motions to the coordinates, including followers
        for k, i in enumerate(self.free):
            self.T[i, k] = 1
        for i in self.motions:
            self.carried[i, i] = 1
        for i, mimic in followers.items():
            leader, ratio = m.index[mimic.get("joint")], number(mimic, "multiplier", 1.0)
            if leader in followers:
                raise Refused("a follower of a follower")
            self.T[i], self.carried[i] = ratio * self.T[leader], ratio * self.carried[leader]
            self.offset[i] = number(mimic, "offset", 0.0)
        self.followers = followers
        self.is_plain = not self.motions and not followers
        self.columns = self.T.tolist()

    def _read_start(self):
        m, q, v = self.mechanism, np.zeros(self.mechanism.n), np.zeros(self.mechanism.n)
        for entry in m.entries("initial"):
            if entry.get("link") is not None:
                self._read_velocity(entry, v)
                continue
            if entry.get("joint") is None:
                raise Refused("<initial> without a joint")
            q[m.index[entry.get("joint")]] = number(entry, "position", 0.0)
            v[m.index[entry.get("joint")]] = number(entry, "velocity", 0.0)
        self.q0, self.v0 = q, v
        if m.loops and np.any(v):
            raise Refused("initial rates in loops")
        c, _, _ = self.prescribed(0.0)
        self.q0 = self.T @ q[self.free] + c
        if any(gap > 1e-12 for gap in m.gaps(self.q0)):
            raise Refused(f"a loop that is open at the start: {m.gaps(self.q0)}")

    def _read_velocity(self, entry, v):
        """The velocity of a link that floats."""
        m = self.mechanism
        last = next((j for j in m.moving if j.child == entry.get("link") and j.name.endswith("/turn")), None)
        if last is None:
            raise Refused("the velocity of a link that does not float")
        name = last.name[:-len("turn")]
        linear, angular = (numbers(entry.get(key, "0 0 0")) for key in ("linear", "angular"))
        v[m.index[name + "x"]], v[m.index[name + "y"]], v[m.index[last.name]] = linear[0], linear[1], angular[2]
        if linear[2] or angular[0] or angular[1]:
            raise Refused("a velocity out of the plane")

    def _read_elements(self):
        m, self.elements, self.frictions, self.armature = self.mechanism, [], [], np.zeros(self.mechanism.n)
        by_joint = {tag: {m.index[e.get("joint")]: e for e in m.root.findall(tag) if e.get("joint") in m.index}
                    for tag in ("spring", "drive", "servo")}
        efforts = {m.index[e.get("joint")]: e.get("history") for e in m.entries("effort")}
        _, mass, _, rows, _ = m.equations(self.q0, [0.0] * m.n)
        for j, joint in enumerate(m.moving):
            drive = by_joint["drive"].get(j)
            limit = joint.element.find("limit")
            motor = None
            if j in efforts or j in by_joint["servo"] or drive is not None:
                motor = Motor(j, efforts.get(j), by_joint["servo"].get(j), drive, number(limit, "effort"), self.q0[j])
                self.elements.append(motor)
            rigid = motor.inertia if motor is not None and not motor.is_elastic else 0.0
            self.armature[j] = rigid
            if j not in self.motions and j not in self.followers:
                inertia = self._loop_inertia(j, mass, rows) if rows else mass[j][j] + rigid
                self._read_passive(j, joint, by_joint["spring"].get(j), motor, inertia)
        q = self.q0
        self.elements += [PointSpring(m, e, q) for e in m.point_springs] + [Load(m, e) for e in m.entries("load")]
        self.elements += contacts(m, self.contact_time)
        self.slices, at = {}, 2 * len(self.free)
        for element in self.elements:
            self.slices[element] = slice(at, at + element.extras)
            at += element.extras
        self.y0 = np.concatenate([self.q0[self.free], self.v0[self.free]]
                                 + [np.array(e.start(self.q0, self.v0), dtype=float) for e in self.elements])

    def _loop_inertia(self, j, mass, rows):
        """The inertia of all that moves with a coordinate of a loop with one freedom, at the start."""
        way = null_space(np.array(rows).reshape(-1, self.mechanism.n))
        if way.shape[1] != 1:
            return math.nan  # no stop may need it
        way = way[:, 0] / way[j, 0]
        return way @ (np.array(mass) + np.diag(self.armature)) @ way

    def _read_passive(self, j, joint, spring, motor, inertia):
        dynamics, law, limit = (joint.element.find(tag) for tag in ("dynamics", "friction", "limit"))
        friction = number(dynamics, "friction", 0.0)
        is_coulomb = law is not None and law.get("law", "smooth") == "coulomb"
        if motor is not None and motor.drive is not None:
            if motor.is_elastic and is_coulomb and motor.friction > 0:
                raise Refused("a rotor that sticks behind an elastic gear")
            friction += 0.0 if motor.is_elastic else motor.friction
        friction += self._pressed(joint, law)
        if spring is not None:
            spring = (number(spring, "stiffness"), number(spring, "rest", 0.0))
        self.elements.append(Passive(j, number(dynamics, "damping", 0.0), 0.0 if is_coulomb else friction, spring))
        if is_coulomb and friction > 0:
            self.frictions.append(Coulomb(j, friction))
        if limit is not None and joint.type in ("revolute", "prismatic", "floating"):
            lower, upper = number(limit, "lower", 0.0), number(limit, "upper", 0.0)
            if upper - lower < 1e8:
                if math.isnan(inertia):
                    raise Refused("a stop in loops with several freedoms")
                time = number(limit, "contact_time", self.contact_time)
                if limit.get("stiffness") is not None:
                    time = math.pi * math.sqrt(inertia / number(limit, "stiffness"))
                self.elements.append(Stop(j, lower, upper, number(limit, "restitution", 0.3), inertia, time,
                                          self.q0[j]))

    def _pressed(self, joint, law):
        """Friction due to the normal force on a slide. If no joint hangs on it, this force is a part of the weight."""
        coefficient = number(law, "coefficient", 0.0)
        if coefficient == 0:
            return 0.0
        m = self.mechanism
        if joint.kind != "slide" or m.n > 1 or joint.parent != m.base or m.gravity_height:
            raise Refused("a friction coefficient on anything but one slide")
        weight = sum(link.mass for link in m.links.values()) * m.gravity
        return coefficient * abs((weight.conjugate() * 1j * joint.direction).real)

    def _find_corners(self):
        functions = [f for e in self.elements for f in e.functions] + list(self.motions.values())
        self.corners = sorted({t for f in functions for t in time_functions.corners(f, self.until)})
        self.samples = {}  # by time: indices of elements
        for element in self.elements:
            if isinstance(element, Motor) and element.period > 0:
                which = self.elements.index(element)
                for k in range(int(math.ceil(self.until / element.period - 1e-9))):
                    self.samples.setdefault(k * element.period, []).append(which)
                    if element.delay > 0:
                        self.samples.setdefault(k * element.period + element.delay, [])

    # ---- equations

    def prescribed(self, t):
        jets = {i: function(t) for i, function in self.motions.items()}
        parts = [np.array([getattr(jets[i], key) if i in jets else 0.0 for i in range(self.mechanism.n)])
                 for key in ("x", "d", "dd")]
        c, d, dd = (self.carried @ part for part in parts)
        return c + self.offset, d, dd

    def unpack(self, t, y):
        n = len(self.free)
        if self.is_plain:
            return y[:n], y[n:2 * n], None
        c, d, dd = self.prescribed(t) if self.motions else (self.offset, 0.0, np.zeros(self.mechanism.n))
        return (self.T @ y[:n] + c).tolist(), (self.T @ y[n:2 * n] + d).tolist(), dd

    def solve(self, s):
        """The rates of the state, and the friction efforts of the coordinates that stick."""
        m, n = self.mechanism, len(self.free)
        s.frames, mass, force, rows, right = m.equations(s.q, s.v)
        rates = [0.0] * len(s.y)
        for element in self.elements:
            own = [0.0] * element.extras
            element.act(s, force, own)
            rates[self.slices[element]] = own
        sticking = []
        for friction in self.frictions:
            if friction.state:
                force[friction.j] -= friction.state * friction.capacity
            else:
                sticking.append(friction)
        if self.is_plain:
            for i in range(n):
                mass[i][i] += self.armature[i]
        else:
            mass, force, rows, right = self._reduced(mass, force, rows, right, s.bias)
        for friction in sticking:
            rows.append(self.columns[friction.j])
            right.append(0.0)
        if n == 1 and not rows:
            solution = [force[0] / mass[0][0]]
        else:
            k = len(rows)
            matrix = [row + [other[i] for other in rows] for i, row in enumerate(mass)]
            matrix += [row + [0.0] * k for row in rows]
            solution = np.linalg.solve(matrix, force + right).tolist()
        rates[:n], rates[n:2 * n] = s.y[n:2 * n], solution[:n]
        held = solution[len(solution) - len(sticking):]
        return rates, {f: -h for f, h in zip(sticking, held)}

    def _reduced(self, mass, force, rows, right, bias):
        """The same equations in the free coordinates, for prescribed motions and mimics."""
        mass = np.array(mass) + np.diag(self.armature)
        rows = np.array(rows).reshape(-1, self.mechanism.n)
        return ((self.T.T @ mass @ self.T).tolist(), (self.T.T @ (force - mass @ bias)).tolist(),
                (rows @ self.T).tolist(), (right - rows @ bias).tolist())

    def derivative(self, t, y):
        return self.solve(Snapshot(self, t, y))[0]

    # ---- switches

    def switch_values(self, t, y):
        """Values of all switches, each times its sign in this interval: they are above 0 until the interval ends."""
        s, found = Snapshot(self, t, y), []
        for element in self.elements:
            found += [sign * value for sign, value in zip(element.held, element.switches(s))]
        if self.frictions:
            held = self.solve(s)[1] if any(f.state == 0 for f in self.frictions) else {}
            found += [f.state * s.v[f.j] if f.state else f.capacity - abs(held[f]) for f in self.frictions]
        return np.array(found)

    def settle_signs(self, t, y):
        for element in self.elements:
            element.settle(Snapshot(self, t, y))
        for friction in self.frictions:
            rate = Snapshot(self, t, y).v[friction.j]
            friction.state = int(np.sign(rate))
        for friction in self.frictions:
            self._stick_or_slip(friction, t, y)

    def _stick_or_slip(self, friction, t, y):
        """Decides about a coordinate at rest. If it accelerates in one direction in spite of friction, it slides, else
        it sticks. (At a dead point of a loop no effort could hold it, but none is required.)"""
        if Snapshot(self, t, y).v[friction.j] != 0:
            return
        row = len(self.free) + self.free.index(friction.j)
        for friction.state in (1, -1):
            if friction.state * self.solve(Snapshot(self, t, y))[0][row] > 0:
                return
        friction.state = 0

    def pass_switch(self, which, t, y):
        """Passes the zero of a switch. Returns the state after it."""
        for element in self.elements:
            count = len(element.held)
            if which < count:
                element.flip(which, Snapshot(self, t, y))
                return y
            which -= count
        friction = self.frictions[which]
        if friction.state:
            y = y.copy()
            y[len(self.free) + self.free.index(friction.j)] = 0.0
            self._stick_or_slip(friction, t, y)
        else:
            held = self.solve(Snapshot(self, t, y))[1][friction]
            friction.state = -int(np.sign(held))
        return y

    def blow(self, t, y, before, after):
        """The state after a jump in the velocities of prescribed motions."""
        jump = np.array(after) - before
        if not np.any(np.abs(jump) > 1e-14):
            return y
        m, n = self.mechanism, len(self.free)
        _, mass, _, rows, _ = m.equations(*self.unpack(t, y)[:2])
        mass = mass + np.diag(self.armature)
        rows = np.array(rows).reshape(-1, m.n)
        left, value = rows @ self.T, -rows @ jump
        matrix = np.block([[self.T.T @ mass @ self.T, left.T], [left, np.zeros((len(left), len(left)))]])
        y = y.copy()
        y[n:2 * n] += np.linalg.solve(matrix, np.concatenate([-self.T.T @ mass @ jump, value]))[:n]
        for friction in self.frictions:
            friction.state = int(np.sign(y[n + self.free.index(friction.j)]))
        return y

    # ---- integration

    def _solver(self, t, y, end, tolerance, step):
        longest = min([element.longest_step() for element in self.elements], default=math.inf)
        first = min(step, end - t, longest) if step else None
        return RungeKutta(self.derivative, t, y, end, rtol=tolerance, atol=tolerance, first_step=first,
                          max_step=longest)

    def _exactly(self, t, y, end, tolerance):
        if end <= t:
            return y
        solver = self._solver(t, y, end, tolerance, end - t)
        while solver.status == "running":
            solver.step()
        return solver.y

    def _advance(self, t, y, end, tolerance):
        """Integrates to the end, or to the first zero of a switch. Returns (time, state, index of the switch)."""
        solver = self._solver(t, y, end, tolerance, self.length)
        has_switches = any(e.held for e in self.elements) or bool(self.frictions)
        while solver.status == "running":
            begin, y_begin = solver.t, solver.y.copy()
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"{RungeKutta.__name__} at {solver.t}: {message}")
            self.length = solver.h_abs
            if not has_switches:
                continue
            dense, low = solver.dense_output(), begin
            for part in PARTS:
                high = begin + part * (solver.t - begin) if part < 1 else solver.t
                values = self.switch_values(high, dense(high))
                if np.any(values < 0):
                    return self._locate(begin, y_begin, low, high, dense, np.nonzero(values < 0)[0], tolerance)
                low = high
        return solver.t, solver.y, None

    def _locate(self, begin, y_begin, low, high, dense, candidates, tolerance):
        first = (math.inf, None)
        for k in candidates:
            def value(t, k=k):
                return self.switch_values(t, dense(t))[k]
            at = low if value(low) <= 0 else brentq(value, low, high, xtol=1e-15, rtol=1e-15)
            if at < first[0]:
                first = (at, k)
        at, k = first
        # The interpolation has a lower order than the step. So Newton's method follows, with integrations to the end.
        for _ in range(3):
            y = self._exactly(begin, y_begin, at, tolerance)
            value = self.switch_values(at, y)[k]
            gap = 1e-7 * (high - begin) + 1e-12
            slope = (self.switch_values(min(at + gap, high), dense(min(at + gap, high)))[k]
                     - self.switch_values(max(at - gap, begin), dense(max(at - gap, begin)))[k]) / (
                         min(at + gap, high) - max(at - gap, begin))
            if slope == 0 or not abs(value / slope) < 1e-3 * (high - begin):
                break
            new = min(max(at - value / slope, begin), high)
            if abs(new - at) < 1e-15 * max(1.0, at):
                break
            at = new
        return at, self._exactly(begin, y_begin, at, tolerance), k

    def run(self, times, tolerance=TOLERANCE, shift=None):
        """Positions of the judged points (times, points, 3) [m]. `shift`: spacing of additional ends of intervals."""
        self._read_elements()
        ends = {t for t in list(times) + self.corners + list(self.samples) if 0 < t <= self.until}
        if shift:
            ends |= set(np.arange(shift, self.until, shift))
        ends = sorted(ends)
        ends = [b for a, b in zip([0.0] + ends, ends) if b - a > 1e-12]  # merges ends that differ by round-off
        t, y, self.length, self.events = 0.0, self.y0.copy(), None, 0
        self.piece = (0.0, ends[0])
        found, wanted = {0.0: self.mechanism.positions(self.unpack(0.0, y)[0])}, list(times)[1:]
        self._at_corner(t, y)
        self.settle_signs(t, y)
        for i, end in enumerate(ends):
            y = self._piece(t, y, end, tolerance)
            t = end
            while wanted and wanted[0] < t + 2e-12:
                found[wanted[0]] = self.mechanism.positions(self.unpack(t, y)[0])
                wanted.pop(0)
            if i + 1 < len(ends):
                before = Snapshot(self, t, y).v
                self.piece = (t, ends[i + 1])
                after = Snapshot(self, t, y).v
                y = self.blow(t, y, before, after)
                self._at_corner(t, y)
        return np.array([found[time] for time in times])

    def _at_corner(self, t, y):
        for time, which in self.samples.items():
            if abs(time - t) < 2e-12:
                for k in which:
                    self.elements[k].sample(Snapshot(self, time, y))

    def _piece(self, t, y, end, tolerance):
        near = 0
        while end - t > 1e-14 * max(1.0, end):
            new, y, which = self._advance(t, y, end, tolerance)
            if which is not None:
                y = self.pass_switch(which, new, y)
                self.events += 1
                near = near + 1 if new - t < 1e-12 else 0
                if near > 20 or self.events > 20000:
                    raise RuntimeError(f"corners without end at {new}")
                if self.length:
                    self.length = None if near == 0 else self.length
            t = new
        return y
