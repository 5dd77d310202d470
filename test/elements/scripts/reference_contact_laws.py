"""Tests of the laws of contact over many steps: restitution, friction, orders of convergence, beams. The formulas are
in reference_contact.py, the numbers those of docs/notes/contact.md."""

import numpy as np
import pytest

from reference_beam import I3, exp
from reference_contact import arm_rows, friction_force, mean, normal_force, plane_force, rolling_slip
from reference_contact_checks import Body, Contact, step, total


def damping_of(restitution):
    """Return d for a restitution e: (1 + d) / (1 - e d) = exp(d (1 + e)), by bisection in (0, 1/e)."""
    low, high = 1e-9, (1 - 1e-15) / restitution
    for _ in range(200):
        d = 0.5 * (low + high)
        if d * (1 + restitution) - np.log1p(d) + np.log1p(-restitution * d) > 0:
            low = d
        else:
            high = d
    return low


def solved(rate_of_change, low, high):
    """Return the zero of an increasing function."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if rate_of_change(middle) > 0 else (middle, high)
        if high - low <= 1e-16 * abs(middle):
            break
    return 0.5 * (low + high)


class Ball:
    """A mass over a half-space: penetration p, rate v. The stiffness belongs to mass 1 and omega; mass is the true
    mass."""

    def __init__(self, restitution, omega=1.0, gravity=0.0, depth=np.inf, mass=1.0):
        self.d = damping_of(restitution) if restitution < 1 else 0.0
        self.omega, self.gravity, self.depth, self.mass = omega, gravity, depth, mass
        self.p, self.v, self.speed, self.receding = 0.0, 0.0, 0.0, False

    def memory(self):
        if self.v <= 0:
            return self.speed
        return self.v if self.receding or self.p <= 0 else max(self.speed, self.v)

    def trial(self, h):
        """Return the end of a step, and whether the step is short enough."""
        speed, k = self.memory(), self.omega**2

        def balance(change):
            force = normal_force(self.p, self.p + change, h, k, self.omega, self.d, speed, self.depth)[0]
            return self.mass * (2 * (change - self.v * h) / h**2 - self.gravity) + force

        high = min(self.v * h + 0.5 * self.gravity * h * h, self.depth * (1 - 1e-12) - self.p)
        low = high - abs(self.p) - abs(self.v) * h - 1e-12
        while balance(low) > 0:
            low -= high - low
        change = solved(balance, low, high)
        p, v = self.p + change, 2 * change / h - self.v
        x0, x1 = (max(q, 0) / (1 - (max(q, 0) / self.depth) ** 2) ** 2 for q in (self.p, p))
        angle = self.omega * h * (x1 - x0 if x1 != x0 else 0) / change if change else 0
        angle = max(angle, self.omega * h) if np.isinf(self.depth) else angle
        part = np.hypot(self.omega * (x1 - x0), v - self.v)
        whole = max(np.hypot(self.omega * x0, self.v), np.hypot(self.omega * x1, v))
        return p, v, speed, (x0 == x1 == 0) or angle <= np.pi / 9 or part <= 0.25 * whole

    def run(self, h, until, most=22):
        """Return the ratio of speeds at each hit, and numbers of steps and halvings, and the largest penetration."""
        level = place = steps = halvings = 0
        time, ratios, deepest, approach = 0.0, [], 0.0, None
        while time < until:
            part = h * 0.5**level
            p, v, speed, fine = self.trial(part)
            if not fine and level < most:
                level, place, halvings = level + 1, 2 * place, halvings + 1
                continue
            if self.p <= 0 < p:
                approach = self.v
            if self.p > 0 >= p and approach:
                ratios.append(-v / approach)
            if self.v:
                self.receding = self.v < 0
            self.p, self.v, self.speed = p, v, speed if p > 0 else 0.0
            deepest, time, steps, place = max(deepest, p), time + part, steps + 1, place + 1
            while level and place % 2 == 0:
                level, place = level - 1, place // 2
        return ratios, steps, halvings, deepest


def test_slopes():
    rng = np.random.default_rng(0)
    for _ in range(2000):
        p0, p1, speed, d = rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(0, 1), rng.uniform(0, 3)
        law = (0.3, 7.0, 2.0, d, speed, rng.choice([0.7, np.inf]))
        number = (normal_force(p0, p1 + 1e-6, *law)[0] - normal_force(p0, p1 - 1e-6, *law)[0]) / 2e-6
        force, slope = normal_force(p0, p1, *law)
        if abs(p1) > 1e-5:
            assert abs(slope - number) < 1e-8 * (abs(slope) + 100)
        assert force >= 0


def test_no_step_gains_energy():
    rng = np.random.default_rng(6)
    for _ in range(10000):
        p0, p1, depth = rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.choice([0.7, np.inf])
        force = normal_force(p0, p1, 0.1, 7.0, 2.0, rng.uniform(0, 9), rng.uniform(0, 1), depth)[0]
        stored = [3.5 * (max(p, 0) / (1 - (max(p, 0) / depth) ** 2) ** 2) ** 2 for p in (p0, p1)]
        normal, memory, slip = rng.normal(size=(3, 3))
        normal /= np.linalg.norm(normal)
        new = friction_force(memory, slip, normal, force, 0.5, 2.0)[0]
        stored.append(new @ new - memory @ memory)
        assert force * (p1 - p0) - stored[1] + stored[0] > -1e-12 and 2 * new @ slip - stored[2] > -1e-12


def ratios_of_first_hits(ball, way, h, until, most=22):
    """Return the least and the largest restitution for eight places of the touch within a step, the deepest
    penetration, and means of steps and of halvings. way: that of a step before the hit."""
    results = []
    for place in (np.arange(8) + 0.5) / 8:
        flying = ball()
        flying.p = -place * way
        results.append(flying.run(h, until, most))
    first = [r[0][0] for r in results]
    return min(first), max(first), max(r[3] for r in results), *(np.mean([r[k] for r in results]) for k in (1, 2))


@pytest.mark.parametrize("theta, stated", [(0.05, [0.1, 0.3, 0.5001, 0.8001]),
                                           (np.pi / 10, [0.1, 0.3018, 0.5034, 0.8025]),
                                           (1.0, [0.1070, 0.3021, 0.5022, 0.8016]),
                                           (3.0, [0.1014, 0.3017, 0.5023, 0.8009]),
                                           (10.0, [0.1006, 0.3018, 0.5034, 0.8025])])
def test_restitution(theta, stated):
    for e, largest in zip((0.1, 0.3, 0.5, 0.8), stated):
        def ball():
            out = Ball(e)
            out.v = 1.0
            return out

        least, most = ratios_of_first_hits(ball, theta, theta, max(14 if e < 0.2 else 8, 3 * theta))[:2]
        assert most == pytest.approx(largest, abs=6e-5)
        assert e - 1e-4 < least <= most


@pytest.mark.parametrize("mass, stated", [(1 / 16, 0.5002), (1 / 4, 0.5001), (4.0, 0.5), (16.0, 0.5159)])
def test_restitution_of_another_mass_than_is_assumed(mass, stated):
    ball = Ball(0.5, mass=mass)
    ball.v = 1.0
    assert ball.run(0.02, 15 * max(1, mass**0.5))[0][0] == pytest.approx(stated, abs=6e-5)


@pytest.mark.parametrize("speed, deepest, steps, halvings", [(1.0, 3.85e-4, 17, 13), (100.0, 4.88e-4, 26, 22)])
def test_a_wall_of_a_millimetre(speed, deepest, steps, halvings):
    def ball():
        out = Ball(0.5, np.pi / 0.01, depth=0.5e-3)
        out.v = speed
        return out

    least, most, depth, *counts = ratios_of_first_hits(ball, speed * 1e-3, 1e-3, 4e-3, 40)
    assert 0.501 < least <= most < 0.503
    assert depth == pytest.approx(deepest, abs=6e-7)
    assert counts == pytest.approx([steps, halvings], abs=0.6)


@pytest.mark.parametrize("e, omega, stated, left", [(0.5, 100.0, [0.493, 0.4785, 0.4545, 0.3959], 1e-8),
                                                    (0.5, 1000.0, [0.5024, 0.5013, 0.499, 0.4949], 1e-17),
                                                    (0.8, 1000.0, [0.8018] * 4, 1e-17)])
def test_bounces_come_to_an_end(e, omega, stated, left):
    """Hits follow each other ever faster; left: speed [m/s] 0.3 s after the closed form's end."""
    ball = Ball(e, omega, 1.0)
    ball.v = 1.0
    ratios = ball.run(np.pi / 10 / omega, 2 * e / (1 - e) - 0.05)[0]
    assert ratios[:4] == pytest.approx(stated, abs=6e-5 if e < 0.8 else 1e-3)
    ball.run(np.pi / 10 / omega, 0.35)
    assert abs(ball.v) < left
    assert ball.p * omega**2 == pytest.approx(1, abs=1e-6)


def box(size, pose, mass=1.0):
    squares = np.square(size)
    inertia = mass / 12 * (squares.sum() - squares)
    return Body(mass, inertia, pose, np.zeros(3), np.zeros(3))


def corners(size, below=False):
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1] if below else [-1, 1])).reshape(3, -1).T
    return 0.5 * np.array(size) * signs


def on_plane(first, second, arm, height, law):
    normal = np.array([0.0, 0, 1])
    shift = height * normal
    return Contact(first, second, arm, lambda y0, y1, law: plane_force(y0 - shift, y1 - shift, normal, law), dict(law))


@pytest.mark.parametrize("turn, stated", [((0, 0, 0), 0.5034), ((0.5, 0.4, 0), 0.5117)])
def test_restitution_of_a_box_that_falls_flat_or_on_a_corner(turn, stated):
    size, h, rotation = (0.2, 0.2, 0.1), 1e-4, exp(np.array(turn))
    k = (np.pi / (10 * h)) ** 2 / 4
    law = dict(h=h, k=k, omega=np.pi / (10 * h), d=damping_of(0.5))
    lowest = min((rotation @ a)[2] for a in corners(size))
    body = box(size, (np.array([0, 0, -lowest + 2.5 * h]), rotation))
    body.velocity = np.array([0, 0, -1.0])
    contacts = [on_plane(0, None, a, 0.0, law) for a in corners(size)]
    touched, apart = False, 0
    while apart < 2:
        before = np.array([-(body.pose[0] + body.pose[1] @ c.arm)[2] for c in contacts])
        step([body], contacts, h)
        after = np.array([-(body.pose[0] + body.pose[1] @ c.arm)[2] for c in contacts])
        rates = (after - before) / h
        for c, p, rate in zip(contacts, after, rates):
            c.law["speed"] = max(rate, c.law["speed"] if p > 0 else 0)
        touched = touched or after.max() > 0
        apart += touched and after.max() < 0
    assert -rates[np.argmax(after)] == pytest.approx(stated, abs=6e-5)


@pytest.mark.parametrize("angle", [0.4, 0.46, 0.5, 0.7])  # atan 0.5 = 0.4636
def test_block_on_an_incline(angle):
    h, g, mu, size, steps = 1e-3, 9.81, 0.5, (0.2, 0.1, 0.1), 500
    k = 0.25 * (np.pi / (10 * h)) ** 2
    law = dict(h=h, k=k, omega=np.pi / (10 * h), d=1.0, speed=0.01, mu=mu, kt=k)
    body = box(size, (np.array([0, 0, 0.05 - g * np.cos(angle) / 4 / k]), I3))
    contacts = [on_plane(0, None, a, 0.0, law) for a in corners(size, True)]
    gravity = g * np.array([np.sin(angle), 0, -np.cos(angle)])
    for _ in range(1000):
        step([body], contacts, h, gravity)
    x, v = body.pose[0][0], body.velocity[0]
    for _ in range(steps):
        step([body], contacts, h, gravity)
    coulomb = max(0, g * (np.sin(angle) - mu * np.cos(angle)))
    assert (body.velocity[0] - v) / (steps * h) == pytest.approx(coulomb, abs=1e-9)
    if coulomb == 0:
        assert abs(body.pose[0][0] - x) < 1e-16


def test_rolling():
    """A solid sphere rolls down an incline from rest."""
    h, g, mu, radius, angle = 1e-3, 9.81, 0.5, 0.1, 0.5
    k = (np.pi / (10 * h)) ** 2
    body = Body(1.0, [0.4 * radius**2] * 3, (np.array([0, 0, radius - g * np.cos(angle) / k]), I3), np.zeros(3),
                np.zeros(3))
    world, normal, memory = (np.zeros(3), I3), np.array([0.0, 0, 1]), np.zeros(3)
    gravity = g * np.array([np.sin(angle), 0, -np.cos(angle)])
    for _ in range(300):
        begin = body.pose

        def residual(d):
            end = (begin[0] + d[:3], exp(d[3:]) @ begin[1])
            force = normal_force(radius - begin[0][2], radius - end[0][2], h, k)[0]
            arm = -radius * normal
            slip = rolling_slip((begin, world), (end, world), arm)
            new = friction_force(memory, slip, normal, force, mu, k)[0]
            rows = body.balance(end, h)[0] - arm_rows((begin, world), (end, world), arm, force * normal - k * new)[:6]
            rows[:3] -= gravity
            return rows, end, new

        d = np.concatenate([h * body.velocity, h * body.pose[1] @ body.spin])
        for _ in range(4):
            here = residual(d)[0]
            slope = np.column_stack([(residual(d + 1e-7 * u)[0] - here) / 1e-7 for u in np.eye(6)])
            d = d - np.linalg.solve(slope, here)
        _, end, memory = residual(d)
        body.velocity, body.spin = body.end(end, h)
        body.pose = end
    spin = body.pose[1] @ body.spin
    assert body.velocity[0] / 0.3 == pytest.approx(5 / 7 * g * np.sin(angle), rel=1e-5)
    assert body.velocity[0] - radius * spin[1] == pytest.approx(0, abs=1e-5)


@pytest.mark.parametrize("name, h, iterations, most", [("box", 1e-3, 2.8, 4), ("box", 5e-3, 3.7, 6),
                                                       ("stack", 1e-3, 3.0, 4), ("stack", 5e-3, 3.6, 8)])
def test_boxes_come_to_rest(name, h, iterations, most):
    size = (0.2, 0.2, 0.1)
    k = 0.25 * (np.pi / 0.01) ** 2
    law = dict(h=h, k=k, omega=np.pi / 0.01, d=1.43, speed=0.3, mu=0.5, kt=k)
    if name == "box":
        bodies = [box(size, (np.array([0, 0, 0.2]), exp(np.random.default_rng(5).normal(size=3))))]
        contacts = [on_plane(0, None, a, 0.0, law) for a in corners(size)]
    else:
        bodies = [box(size, (np.array([0.01 * n, 0, 0.052 + 0.102 * n]), I3)) for n in range(3)]
        contacts = [on_plane(n, n - 1 if n else None, a, 0.05 if n else 0.0, law)
                    for n in range(3) for a in corners(size, True)]
    counts = []
    for _ in range(int(0.6 / h)):
        lost, count, _ = step(bodies, contacts, h, np.array([0, 0, -9.81]))
        counts.append(count)
        assert lost > -1e-12
    assert np.mean(counts) == pytest.approx(iterations, abs=0.06) and max(counts) <= most
    assert total(bodies)[0] < 1e-3  # kinetic energy, of 2 J and more


def test_stiff_sticking_rings_down():
    for theta, stated in ((np.pi / 10, 0.976), (1.0, 0.82), (4.0, 1 / 3), (10.0, 0.92), (100.0, 0.9992)):
        a = 1 / (1 + 0.5 * theta**2)
        matrix = np.array([[a, a], [-(theta**2) * a, 1 - theta**2 * a]])
        assert max(abs(np.linalg.eigvals(matrix))) == pytest.approx(stated, abs=5e-3 if theta < 100 else 5e-5)


def order_of(run, steps):
    values = [run(n) for n in steps]
    differences = [np.linalg.norm(b - a) for a, b in zip(values, values[1:])]
    return [round(float(np.log2(a / b)), 2) for a, b in zip(differences, differences[1:])]


def pressed(n):
    """Return the state of a damped ball that stays in contact, at time 3."""
    ball = Ball(0.5, 1.0, 1.0)
    ball.p, ball.v = 1.3, 0.0
    for _ in range(n):
        ball.p, ball.v, ball.speed, _ = ball.trial(3 / n)
    return np.array([ball.p, ball.v])


def bounced(n, place):
    """Return the error of an elastic ball after a bounce, against the closed form. place: position of the start within
    a step."""
    omega, until = 30.0, 1.8
    ball, h = Ball(1.0, omega, 1.0), until / n
    ball.p = start = -0.5 - place * h
    for _ in range(n):
        ball.p, ball.v, _, _ = ball.trial(h)
    fall = np.sqrt(-2 * start)
    contact = 2 / omega * (np.pi - np.arctan2(np.sqrt(-2 * start) * omega, 1.0))
    time = until - fall - contact
    return abs(ball.v - (time - fall))


def slid(n, velocity=(0.0, 2.0), stiffness=1e3, until=0.7, loaded=True):
    """Return the state of a mass on a spring that slides over a plane, with unit normal force and mu = 0.3."""
    x, v, h = np.array([1.0, 0, 0]), np.array([*velocity, 0]), until / n
    memory = 0.3 / stiffness * v / np.linalg.norm(v) if loaded else np.zeros(3)
    for _ in range(n):
        change = h * v
        for _ in range(30):
            new, by_slip, _, _ = friction_force(memory, change, np.array([0.0, 0, 1]), 1.0, 0.3, stiffness)
            balance = 2 * (change - h * v) / h**2 + x + 0.5 * change + stiffness * new
            change = change - np.linalg.solve((2 / h**2 + 0.5) * I3 + stiffness * by_slip, balance)
        x, v, memory = x + change, 2 * change / h - v, new
    return np.concatenate([x, v])


@pytest.mark.parametrize("run, steps, stated, within", [
    (pressed, [40, 80, 160, 320, 640], 2, 0.1),
    (slid, [400, 800, 1600, 3200, 6400], 1.9, 0.15),
    (lambda n: slid(n, (-0.1, 0.0)), [400, 800, 1600, 3200, 6400], 2, 0.02),
    (lambda n: slid(n, (-0.1, 0.0), loaded=False), [400, 800, 1600, 3200, 6400], 1, 0.2),
    (lambda n: slid(n, (-1e-3, 0.0), 3e1, 0.05, False), [50, 100, 200, 400, 800], 1, 0.1)],
    ids=["stays pressed", "slides along a curve", "slides along a line", "begins to slide", "sticks"])
def test_orders(run, steps, stated, within):
    assert order_of(run, steps) == pytest.approx([stated] * (len(steps) - 2), abs=within)


def test_error_of_a_bounce():
    """Of second order, whatever the place of the touch within a step."""
    worst = np.array([max(bounced(n, place) for place in np.linspace(0, 1, 11)[:-1]) for n in (100, 200, 400)])
    assert worst[-1] < 3e-4
    assert np.log2(worst[:-1] / worst[1:]) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("angle", [np.pi / 2, 0.3, 0.05])
@pytest.mark.parametrize("spacing, within", [(1.0, 0.065), (0.5, 0.0075), (0.25, 0.0045)])
def test_stations_of_tubes(angle, spacing, within):
    """The energy of two straight crossing tubes of R = 2 radii has a closed form. spacing: of the stations, in halves
    of the contact's length."""
    radii, p = 0.02, 2e-4
    half = np.sqrt(2 * radii * p) / np.sin(angle)
    exact = 8 / 15 * p * p * half
    for shift in np.linspace(0, 1, 21):
        s = (np.arange(-12, 13) + shift) * spacing * half
        distance = np.sqrt((radii - p) ** 2 + (s * np.sin(angle)) ** 2)
        energy = np.sum(0.5 * np.maximum(radii - distance, 0) ** 2) * spacing * half
        assert energy == pytest.approx(exact, rel=within)


def test_quadrature_of_an_energy_that_ends_inside_of_an_element():
    """A parabola of penetration, with Gauss points in elements whose ends are not the parabola's."""
    errors = []
    for count in (4, 8, 16, 32, 64, 128):
        worst = 0.0
        for shift in np.linspace(0, 1, 40):
            edges = -1.5 + 3.0 / count * (np.arange(count + 1) - shift)
            x, w = np.polynomial.legendre.leggauss(2)
            s = (mean(edges[1:], edges[:-1])[:, None] + 0.5 * np.diff(edges)[:, None] * x).ravel()
            weights = (0.5 * np.diff(edges)[:, None] * w).ravel()
            worst = max(worst, abs(np.sum(weights * 0.5 * np.maximum(1 - s * s, 0) ** 2) - 8 / 15))
        errors.append(worst)
    assert np.log2(np.array(errors[:-1]) / errors[1:])[1:] == pytest.approx(3, abs=0.2)  # of 40 places of the ends
