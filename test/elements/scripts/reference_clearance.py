"""Reference for joints with play, written from section 11 of docs/notes/contact.md alone, as tests for pytest.

They compute the numbers again that test/reference/clearance_test.cpp compares with: of a pendulum, and of the
slider-crank of Flores and Ambrosio (Computers & Structures 82 (2004) 1359), which is integrated with scipy from event
to event of the law.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from reference_beam import I3
from reference_contact import gonzalez, shell_force
from reference_contact_checks import Body, Contact, step, total
from reference_contact_laws import damping_of
from stated_numbers import stated_numbers

STATED_IN = "reference/clearance_test.cpp"

# ---------------------------------------------------------------- holes


def ball_gap(y, radius):
    """Return the gap to the inside of a spherical hole, and its gradient."""
    size = np.linalg.norm(y)
    return radius - size, -y / size


def cylinder_gap(y, radius):
    value, gradient = ball_gap(y[:2], radius)
    return value, np.append(gradient, 0)


def test_work_in_holes_is_exact():
    rng = np.random.default_rng(2)
    for _ in range(2000):
        y0, y1 = rng.uniform(-1, 1, size=(2, 3))
        for gap in (ball_gap, cylinder_gap):
            g0, g1 = gap(y0, 0.8)[0], gap(y1, 0.8)[0]
            way = np.append(y1 - y0, np.zeros(3))
            gradient = gonzalez(np.append(gap(0.5 * (y0 + y1), 0.8)[1], np.zeros(3)), g1 - g0, way, 1.0)[:3]
            assert abs(gradient @ (y1 - y0) - (g1 - g0)) < 1e-14
            # The gap of a hole is concave, so it cannot be deeper between the ends of a chord.
            inside = min(gap(y0 + s * (y1 - y0), 0.8)[0] for s in np.linspace(0, 1, 21))
            assert inside >= min(g0, g1) - 1e-12


def test_hits_in_a_socket_keep_energy():
    """A free body has a point in a socket of the world: 100 elastic hits."""
    law = dict(h=2e-3, k=1e5)
    arm = np.array([0.1, 0.05, -0.02])
    body = Body(1.0, [2e-3, 3e-3, 4e-3], (-arm, I3), np.array([0.5, 0.2, -0.1]), np.array([1.0, -2, 0.5]))
    contacts = [Contact(0, None, arm, lambda y0, y1, law: shell_force(y0, y1, 0.01, law), law)]
    begin, hits, inside = total([body])[0], 0, False
    while hits < 100:
        step([body], contacts, law["h"])
        deep = np.linalg.norm(body.pose[0] + body.pose[1] @ arm) - 0.01
        hits += deep > 0 and not inside
        inside = deep > 0
        stored = 0.5 * law["k"] * max(deep, 0) ** 2
        assert abs(total([body])[0] + stored - begin) < 1e-12 * begin


# ---------------------------------------------------------------- limit


def pendulum(play, stiffness, until, start=0.5):
    """Return the angle of a pendulum on a pin with play at time `until`. It starts from rest, pressed as without play;
    play 0 is without play."""
    mass, inertia, arm, g = 1.0, 0.02, 0.5, 9.81
    whole = inertia + mass * arm**2

    def fixed(t, y):
        return [y[1], -mass * g * arm * np.sin(y[0]) / whole]

    if play == 0:
        return solve_ivp(fixed, (0, until), [start, 0], method="DOP853", rtol=1e-12, atol=1e-14).y[0, -1]

    def loose(t, y):
        x, angle = y[:2], y[2]
        out = np.array([-np.sin(angle), np.cos(angle)])  # from the centre of mass to the pin
        pin = x + arm * out
        size = np.linalg.norm(pin)
        force = -stiffness * max(size - play, 0) * pin / max(size, 1e-300)
        moment = arm * (out[0] * force[1] - out[1] * force[0])
        return [*y[3:], force[0] / mass, force[1] / mass - g, moment / inertia]

    rate = fixed(0, [start, 0])[1]
    tangent = np.array([np.cos(start), np.sin(start)])  # direction of the centre's motion
    force = mass * (arm * rate * tangent + np.array([0, g]))
    pin = -force / np.linalg.norm(force) * (play + np.linalg.norm(force) / stiffness)
    centre = pin - arm * np.array([-np.sin(start), np.cos(start)])
    return solve_ivp(loose, (0, until), [*centre, start, 0, 0, 0], method="DOP853", rtol=1e-10, atol=1e-13).y[2, -1]


def test_the_limit_is_the_joint_without_play():
    exact = pendulum(0, 0, 1.3)
    plays, errors = (4e-3, 2e-3, 1e-3), []
    stated, with_play = np.split(np.array(stated_numbers(STATED_IN, "const double without = ", 4)), [1])
    assert exact == pytest.approx(stated[0], abs=1e-9)
    for play, expected in zip(plays, with_play):
        angle = pendulum(play, 1e7, 1.3)
        assert angle == pytest.approx(expected, abs=1e-9)
        errors.append(abs(angle - exact))
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(1, abs=0.01)


# ---------------------------------------------------------------- slider-crank


class Crank:
    """A crank at 5000 rpm with rod and slider, and play between rod and slider. y: angle of the rod, position of the
    slider, and their rates."""

    CRANK, ROD, ROD_MASS, ROD_INERTIA, SLIDER = 0.05, 0.12, 0.21, 2.5e-4, 0.14  # m, kg, kg m^2
    SPEED, PLAY, RESTITUTION = 5000 * 2 * np.pi / 60, 0.5e-3, 0.9
    STIFFNESS = 3e8  # N/m: force over depth at 8 kN of the authors' law by Hertz (6.6e10 N/m^1.5)

    def __init__(self):
        self.damping = damping_of(self.RESTITUTION)
        self.frequency = np.sqrt(self.STIFFNESS * (1 / self.ROD_MASS + 1 / self.SLIDER))
        self.inertia = self.ROD_INERTIA + self.ROD_MASS * self.ROD**2 / 4
        self.start = np.array([0, self.CRANK + self.ROD, -self.CRANK * self.SPEED / self.ROD, 0])

    def pin(self, t, y):
        """Return position and rate of the rod's end relative to the slider's bearing, tangent of the rod, and
        acceleration of the crank's pin."""
        along = np.array([np.cos(self.SPEED * t), np.sin(self.SPEED * t)])
        rod = np.array([np.cos(y[0]), np.sin(y[0])])
        tangent = np.array([-rod[1], rod[0]])
        place = self.CRANK * along + self.ROD * rod - np.array([y[1], 0])
        rate = self.CRANK * self.SPEED * np.array([-along[1], along[0]]) + self.ROD * y[2] * tangent
        return place, rate - np.array([y[3], 0]), tangent, -self.SPEED**2 * self.CRANK * along

    def depth(self, t, y):
        return np.linalg.norm(self.pin(t, y)[0]) - self.PLAY

    def rate(self, t, y):
        place, rate = self.pin(t, y)[:2]
        return place @ rate / max(np.linalg.norm(place), 1e-300)

    def force(self, t, y, speed):
        """Return the contact force. speed: speed of the approach; None: no contact."""
        depth = self.depth(t, y)
        if speed is None or depth <= 0:
            return 0.0
        alpha = self.damping / max(speed, 0.5 * self.frequency * depth, 1e-300)
        return self.STIFFNESS * depth * max(1 + alpha * self.rate(t, y), 0)

    def rates(self, t, y, speed):
        place, _, tangent, acceleration = self.pin(t, y)
        force = self.force(t, y, speed) * place / max(np.linalg.norm(place), 1e-300)  # force on the slider
        turn = -0.5 * self.ROD_MASS * self.ROD * acceleration @ tangent - self.ROD * force @ tangent
        return [y[2], y[3], turn / self.inertia, force[0] / self.SLIDER]

    def growth(self, t, y):
        """Return the second derivative of the depth, for an approach that speeds up."""
        h, slope = 1e-10, np.array(self.rates(t, y, self.rate(t, y)))
        return (self.rate(t + h, y + h * slope) - self.rate(t - h, y - h * slope)) / (2 * h)

    def run(self, until, tolerance=1e-11):
        """Return the pieces of the motion, and times and speeds of hits. The speed of an approach is its largest
        speed."""
        def event(function, direction):
            def of(t, y):
                return function(t, y)

            of.terminal, of.direction = True, direction
            return of

        touch, release = event(self.depth, 1), event(self.depth, -1)
        turns, returns, peak = event(self.rate, -1), event(self.rate, 1), event(self.growth, -1)
        t, y, phase, speed, pieces, hits = 0.0, self.start, "free", None, [], []
        while t < until:
            if phase == "free":
                events, rates = [touch], lambda t, y: self.rates(t, y, None)
            elif phase == "faster":
                events, rates = [release, peak], lambda t, y: self.rates(t, y, max(self.rate(t, y), 0))
            else:
                events = [release, turns if phase == "in" else returns]
                rates = lambda t, y, speed=speed: self.rates(t, y, speed)  # noqa: E731
            piece = solve_ivp(rates, (t, until), y, method="DOP853", rtol=tolerance, atol=1e-3 * tolerance,
                              events=events, dense_output=True, max_step=5e-6)
            pieces.append((piece.t[-1], piece.sol))
            t, y = piece.t[-1], piece.y[:, -1]
            if piece.status == 0:
                break
            if phase == "free":
                speed = self.rate(t, y)
                hits.append((t, speed))
                phase = "faster" if self.growth(t, y) > 0 else "in"
            elif len(piece.t_events[0]) > 0:
                phase = "free"
            elif phase == "faster":
                speed, phase = self.rate(t, y), "in"
            else:
                phase = "out" if phase == "in" else "faster"
        return pieces, hits


def test_crank():
    pieces, hits = Crank().run(3e-3, 1e-12)
    assert len(hits) == 8
    stated = stated_numbers(STATED_IN, "const double expected[][3] = ", 18)
    for t, rod, slider in np.reshape(stated, (6, 3)):
        found = next(sol for end, sol in pieces if end >= t - 1e-12)(t)
        assert found[:2] == pytest.approx([rod, slider], abs=1e-9)
