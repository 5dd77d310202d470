"""Tests that the formulas of contact are exact: work, momenta, tangents. The formulas are in reference_contact.py."""

import numpy as np
import pytest

from reference_beam import I3, cayley, cayley_tangent, exp, hat, log, tangent_scaled
import reference_contact as contact
from reference_contact import (arm_rows, closest, curves_gradient, curves_rows, curves_tangent, edges_gap, local, mean,
                               point_rows, point_tangent, pose_gradient, pose_rows, pose_tangent, relative_turn,
                               rolling_slip, shell_force)


class Body:
    """A rigid body in steps of the energy-momentum rule. The spin is material."""

    def __init__(self, mass, inertia, pose, velocity, spin):
        self.mass, self.inertia, self.pose, self.velocity, self.spin = mass, np.diag(inertia), pose, velocity, spin

    def end(self, pose, h):
        """Return velocity and material spin at the end of a step."""
        turn = tangent_scaled(pose[1] @ self.pose[1].T)
        return 2 * (pose[0] - self.pose[0]) / h - self.velocity, 2 * self.pose[1].T @ turn / h - self.spin

    def balance(self, pose, h):
        """Return the rates of the momenta, and their derivatives by {displacement, spin}."""
        velocity, spin = self.end(pose, h)
        turn = tangent_scaled(pose[1] @ self.pose[1].T)
        rows = np.concatenate([self.mass * (velocity - self.velocity),
                               pose[1] @ self.inertia @ spin - self.pose[1] @ self.inertia @ self.spin]) / h
        slope = np.zeros((6, 6))
        slope[:3, :3] = 2 * self.mass / h**2 * I3
        slope[3:, 3:] = -hat(pose[1] @ self.inertia @ spin) / h + 2 / h**2 * (
            pose[1] @ self.inertia @ self.pose[1].T @ np.linalg.inv(cayley_tangent(turn)))
        return rows, slope

    def totals(self):
        """Return energy, momentum, angular momentum."""
        kinetic = 0.5 * self.mass * self.velocity @ self.velocity + 0.5 * self.spin @ self.inertia @ self.spin
        momentum = self.mass * self.velocity
        return kinetic, momentum, np.cross(self.pose[0], momentum) + self.pose[1] @ self.inertia @ self.spin


class Contact:
    """Contact of a point of one body with a function of another body, or of the world (None), with its memory."""

    def __init__(self, first, second, arm, force, law):
        self.first, self.second, self.arm, self.force = first, second, arm, force
        self.law = dict(dict(omega=1.0, d=0.0, speed=0.0, memory=np.zeros(3), mu=0.0, kt=1.0), **law)

    def poses(self, poses):
        return poses[self.first], (np.zeros(3), I3) if self.second is None else poses[self.second]


def step(bodies, contacts, h, gravity=np.zeros(3)):
    """Make one step of all bodies by Newton's method. Return the dissipation, iterations, and halved updates."""
    count, halved = len(bodies), 0
    begin = [b.pose for b in bodies]
    end = [(b.pose[0] + h * b.velocity, cayley(h * b.pose[1] @ b.spin) @ b.pose[1]) for b in bodies]

    def residual(end):
        rows, slope, results = np.zeros(6 * count), np.zeros((6 * count, 6 * count)), []
        for k, body in enumerate(bodies):
            part = slice(6 * k, 6 * k + 6)
            rows[part], slope[part, part] = body.balance(end[k], h)
            rows[6 * k : 6 * k + 3] -= body.mass * gravity
        for c in contacts:
            pair0, pair1 = c.poses(begin), c.poses(end)
            results.append(c.force(local(*pair0, c.arm), local(*pair1, c.arm), c.law))
            if not (results[-1][0].any() or results[-1][1].any()):
                continue
            add, tangent = point_rows(pair0, pair1, c.arm, results[-1][0]), point_tangent(pair0, pair1, c.arm,
                                                                                      *results[-1][:2])
            parts = [c.first] + ([] if c.second is None else [c.second])
            index = np.concatenate([np.arange(6 * k, 6 * k + 6) for k in parts])
            rows[index] -= add[: len(index)]
            slope[np.ix_(index, index)] -= tangent[: len(index), : len(index)]
        return rows, slope, results

    here = residual(end)
    for iteration in range(60):
        update = -np.linalg.solve(here[1], here[0]).reshape(count, 6)
        # A line search, because contacts may alternate between touching and not touching
        for part in 0.5 ** np.arange(8):
            trial = [(p[0] + part * u[:3], exp(part * u[3:]) @ p[1]) for p, u in zip(end, update)]
            there = residual(trial)
            if np.linalg.norm(there[0]) < np.linalg.norm(here[0]) or abs(update).max() < 1e-9:
                break
            halved += 1
        end, here = trial, there
        if abs(update).max() < 1e-13:
            break
    for body, pose in zip(bodies, end):
        body.velocity, body.spin = body.end(pose, h)
        body.pose = pose
    for c, result in zip(contacts, here[2]):
        c.law["memory"] = result[2]
    return sum(r[3] for r in here[2]), iteration + 1, halved


def total(bodies):
    return [sum(t) for t in zip(*(b.totals() for b in bodies))]


@pytest.mark.parametrize("h, stiffness, damping, mu, steps", [
    (0.02, 2e3, 0.0, 0.0, 950), (0.02, 1e6, 0.0, 0.0, 950),  # the second contact lasts a sixth of a step
    (0.02, 2e3, 0.373, 0.3, 300)])
def test_bodies_keep_energy_and_momenta(h, stiffness, damping, mu, steps):
    """Two free bodies in flight, where points of the first are in a spherical shell of the second."""
    rng = np.random.default_rng(3)
    bodies = [Body(1.0, [0.02, 0.03, 0.04], (np.zeros(3), I3), np.array([1.0, 0.3, -0.2]), rng.normal(size=3) * 3),
              Body(2.0, [0.5, 0.6, 0.8], (np.array([0.1, 0, 0]), exp(rng.normal(size=3))), np.zeros(3),
                   rng.normal(size=3))]
    radius, law = 0.35, dict(h=h, k=stiffness, omega=np.sqrt(stiffness), d=damping, mu=mu, kt=stiffness)
    contacts = [Contact(0, 1, 0.2 * np.array(a), lambda y0, y1, law: shell_force(y0, y1, radius, law), law)
                for a in [(1, 0, 0), (-0.5, 0.8, 0), (-0.5, -0.8, 0.3), (0, 0, -0.7)]]

    def depths():
        return np.array([np.linalg.norm(local(*c.poses([b.pose for b in bodies]), c.arm)) - radius for c in contacts])

    start, lost, least, hits, errors = total(bodies), 0.0, 0.0, 0, np.zeros(3)
    p0 = depths()
    for _ in range(steps):
        step_lost = step(bodies, contacts, h)[0]
        p1 = depths()
        for c, a, b in zip(contacts, p0, p1):
            c.law["speed"] = max((b - a) / h, c.law["speed"] if b > 0 else 0)
        hits += np.sum((p0 <= 0) & (p1 > 0))
        p0 = p1
        lost, least = lost + step_lost, min(least, step_lost)
        now = total(bodies)
        now[0] += lost + sum(0.5 * stiffness * (max(p, 0) ** 2 + c.law["memory"] @ c.law["memory"])
                             for c, p in zip(contacts, p1))
        errors = np.maximum(errors, [np.abs(a - b).max() for a, b in zip(now, start)])
    assert hits > (10 if damping > 0 else 100) and least > -1e-12
    assert errors[0] < 1e-11 * start[0] and errors.max() < 1e-10
    assert lost > 0.5 * start[0] if damping > 0 else abs(lost) < 1e-11


def motions(begin, end):
    return np.concatenate([np.concatenate([e[0] - b[0], tangent_scaled(e[1] @ b[1].T)]) for b, e in zip(begin, end)])


def moment(begin, end, rows):
    """Return total force and moment about the origin."""
    arms = [mean(b[0], e[0]) for b, e in zip(begin, end)]
    return np.concatenate([rows[:3] + rows[6:9], np.cross(arms[0], rows[:3]) + rows[3:6] + np.cross(
        arms[1], rows[6:9]) + rows[9:]])


def by_end(rows, end, h=1e-6):
    """Return the derivative of rows(end) by {displacement, spin} of both bodies, by differences."""

    def at(k, sign):
        d = np.zeros(12)
        d[k] = sign * h
        return rows(tuple((p[0] + u[:3], exp(u[3:]) @ p[1]) for p, u in zip(end, d.reshape(2, 6))))

    return np.column_stack([(at(k, 1) - at(k, -1)) / (2 * h) for k in range(12)])


def test_maps():
    rng = np.random.default_rng(1)
    for size in (1e-3, 0.1, 1.0):
        begin = tuple((rng.normal(size=3), exp(rng.normal(size=3))) for _ in range(2))
        end = tuple((p[0] + size * rng.normal(size=3), cayley(size * rng.normal(size=3)) @ p[1]) for p in begin)
        arm, force = rng.normal(size=(2, 3))
        y0 = local(*begin, arm)
        rows = point_rows(begin, end, arm, force)
        work = rows @ motions(begin, end) - force @ (local(*end, arm) - y0)
        law = dict(h=1.0, k=100.0, omega=3.0, d=0.7, speed=2.0, memory=0.01 * rng.normal(size=3), mu=0.3, kt=50.0)

        radius = 0.9 * max(np.linalg.norm(local(*poses, arm)) for poses in (begin, end))

        def shell_rows(e):
            return point_rows(begin, e, arm, shell_force(y0, local(*e, arm), radius, law)[0])

        local_force, slope = shell_force(y0, local(*end, arm), radius, law)[:2]
        tangent = point_tangent(begin, end, arm, local_force, slope)
        assert abs(work) < 1e-15 and abs(moment(begin, end, rows)).max() < 1e-15
        assert abs(tangent - by_end(shell_rows, end)).max() < 1e-8 * abs(tangent).max()
        arm_a, f = rng.normal(size=3), mean(begin[1][1], end[1][1]) @ force
        work = arm_rows(begin, end, arm_a, f) @ motions(begin, end) - force @ rolling_slip(begin, end, arm_a)
        assert abs(work) < 1e-15

        def relative(poses):
            return local(*poses, np.zeros(3)), poses[1][1].T @ poses[0][1]

        def gradient(e):
            return pose_gradient(relative(begin), relative(e), relative_turn(begin, e)[0], edges_gap, 0.5)

        pose_force = pose_rows(begin, end, gradient(end))
        change = edges_gap(*relative(end))[0] - edges_gap(*relative(begin))[0]
        numeric = np.zeros((6, 6))
        fixed = gradient(end)
        for k in range(6):  # action by {y1, spin of Q1}: moves A alone, in B's axes
            d = np.zeros(6)
            d[k] = 1e-6
            ends = []
            for sign in (1, -1):
                turn = exp(sign * end[1][1] @ d[3:])
                ends.append(gradient(((end[0][0] + sign * end[1][1] @ d[:3], turn @ end[0][1]), end[1])))
            numeric[:, k] = (ends[0] - ends[1]) / 2e-6
        tangent = pose_tangent(begin, end, fixed, numeric)
        error = abs(tangent - by_end(lambda e: pose_rows(begin, e, gradient(e)), end)).max() / abs(tangent).max()
        assert abs(pose_force @ motions(begin, end) - change) < 1e-15
        assert abs(moment(begin, end, pose_force)).max() < 1e-15
        assert error < (1e-6 if size < 0.1 else 1e-8)


@pytest.mark.parametrize("name, sizes", [("box", np.array([1, 0.5, 0.3])), ("cylinder", np.array([1, 0.5])),
                                         ("capsule", 0.8)])
def test_gradients_of_shapes(name, sizes):
    rng, distance, gradient = np.random.default_rng(2), getattr(contact, name), getattr(contact, name + "_gradient")
    for _ in range(10000):
        y0 = rng.normal(size=3)
        y1 = y0 + rng.normal(size=3) * 10 ** rng.uniform(-3, 0)
        d = gradient(y0, y1, sizes)
        assert abs(d @ (y1 - y0) - distance(y1, sizes) + distance(y0, sizes)) < 1e-14
        assert np.linalg.norm(d) < 1 + 1e-14


def test_gradient_of_a_disc():
    rng = np.random.default_rng(2)
    for _ in range(1000):
        begin = (rng.normal(size=3), exp(rng.normal(size=3)))
        psi, disc = rng.normal(size=3), (np.array([0, 0, 1.0]), 0.7, np.array([1.0, 0, 0]))
        end = (rng.normal(size=3), cayley(psi) @ begin[1])
        work = contact.rim_gradient(begin, end, *disc) @ np.concatenate([end[0] - begin[0], psi])
        assert abs(work - contact.rim_gap(*end, *disc) + contact.rim_gap(*begin, *disc)) < 1e-14


def quadratic(s):
    """Return weights of three nodes at -1, 0, 1 and their derivatives."""
    return (np.array([0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)]), np.array([s - 0.5, -2 * s, s + 0.5]),
            np.array([1.0, -2, 1]))


def curves_case(size, turn):
    """Return the nodes of two curves before and after a common rotation and a relative motion, and the rotations of
    their nodes."""
    a0, b0 = np.array([[-1, 0, 0], [0, 0.1, 0.05], [1, 0, 0]]), np.array([[0, -1, 0.3], [0.1, 0, 0.25], [0, 1, 0.35]])
    rng = np.random.default_rng(7)
    whole = cayley(turn * np.array([0.3, 0.5, -0.4]))
    end = [(n + size * rng.normal(size=(3, 3))) @ whole.T + 0.3 * turn for n in (a0, b0)]
    return [a0, b0], end, [np.array([tangent_scaled(whole @ exp(size * rng.normal(size=3))) for _ in a0]) for _ in "ab"]


def nearest(nodes):
    """Return parameters, distance, and its derivative by {displacement, spin} of all nodes."""
    s = closest(quadratic, quadratic, *nodes)
    weights = [quadratic(x)[0] for x in s]
    d = weights[0] @ nodes[0] - weights[1] @ nodes[1]
    gap = np.linalg.norm(d)
    return np.array(s), gap, np.concatenate([np.concatenate([w * d / gap, np.zeros(3)]) for w in np.r_[
        weights[0], -weights[1]]])


@pytest.mark.parametrize("turn", [0.0, 1.5])
def test_curves(turn):
    for size, of_tangent in ((0.3, 1e-9), (1e-2, 3e-8), (1e-4, 3e-4)):  # round-off of differences over the motion
        begin, end, turns = curves_case(size, turn)
        (s0, g0, _), (s1, g1, slope) = nearest(begin), nearest(end)
        weights = [quadratic(s)[0] for s in mean(s0, s1)]

        def rows(nodes, turns):
            action = curves_gradient(*weights, begin, nodes, turns, nearest(nodes)[1] - g0, 0.1)
            return curves_rows(*weights, begin, nodes, action), action

        here, action = rows(end, turns)
        work, moments = g0 - g1, np.zeros(3)
        for n0, n1, turn_rows, r in zip(begin, end, turns, here):
            work += np.sum(r[:, :3] * (n1 - n0)) + np.sum(r[:, 3:] * turn_rows)
            moments += np.sum(np.cross(mean(n0, n1), r[:, :3]) + r[:, 3:], axis=0)
        numeric = np.zeros((36, 36))
        for k in range(36):
            sides = []
            for sign in (1e-6, -1e-6):
                d = np.zeros((2, 3, 6))
                d[k // 18, k // 6 % 3, k % 6] = sign
                moved = [[tangent_scaled(exp(u[3:]) @ cayley(w)) for u, w in zip(*pair)] for pair in zip(d, turns)]
                sides.append(np.concatenate([r.ravel() for r in rows([n + u[:, :3] for n, u in zip(end, d)],
                                                                     [np.array(m) for m in moved])[0]]))
            numeric[:, k] = (sides[0] - sides[1]) / 2e-6
        tangent = curves_tangent(*weights, begin, end, turns, g1 - g0, slope, 0.1)
        d0, d1 = (weights[0] @ n[0] - weights[1] @ n[1] for n in (begin, end))
        bare = (d0 + d1) / (np.linalg.norm(d0) + np.linalg.norm(d1))
        assert abs(work) < 1e-15 and abs(moments).max() < 1e-15
        assert np.linalg.norm(action[:3] - bare) < 6 * size**2  # vanishes at rest, whatever the finite rotation
        assert abs(tangent - numeric).max() < of_tangent * abs(tangent).max()


def test_friction_of_curves():
    """The memory in world axes is rotated by half of B's rotation before and after."""
    rng = np.random.default_rng(0)
    for _ in range(300):
        begin, end, turns = curves_case(10 ** rng.uniform(-4, -0.5), rng.uniform(0, 1.5))
        (s0, g0, _), (s1, g1, _) = nearest(begin), nearest(end)
        weights = [quadratic(s)[0] for s in mean(s0, s1)]
        d0, d1 = (weights[0] @ n[0] - weights[1] @ n[1] for n in (begin, end))
        turn_a, turn_b = weights[0] @ turns[0], weights[1] @ turns[1]
        half, tension = exp(0.5 * log(cayley(turn_b))), rng.uniform(0, 3)
        normal = (d0 + d1) / np.linalg.norm(d0 + d1)
        arm_a = -0.05 * normal
        arm_b = mean(d0, d1) + arm_a
        slip = d1 - d0 + np.cross(turn_a, arm_a) - np.cross(turn_b, arm_b)
        memory = rng.normal(size=3) * 10 ** rng.uniform(-4, 0)
        new = contact.friction_force(half @ memory, slip, normal, tension, 0.4, 7.0)[0]
        rows = curves_rows(*weights, begin, end,
                           tension * curves_gradient(*weights, begin, end, turns, g1 - g0, 0.1))
        work, moment_sum = 0.0, np.zeros(3)
        for r, n0, n1, w, arm, turn, sign in zip(rows, begin, end, weights, (arm_a, arm_b), turns, (-7, 7)):
            r += np.outer(w, np.concatenate([sign * new, np.cross(arm, sign * new)]))
            work += np.sum(r[:, :3] * (n1 - n0)) + np.sum(r[:, 3:] * turn)
            moment_sum += np.sum(np.cross(mean(n0, n1), r[:, :3]) + r[:, 3:], axis=0)
        assert tension * (g1 - g0) - work - 3.5 * (new @ new - memory @ memory) > -1e-12
        assert abs(moment_sum).max() < 1e-14


def test_hardened_grip():
    """The factor is that of the normal stiffness, and no energy is gained, however it changes from step to step."""
    rng = np.random.default_rng(6)
    for share in rng.uniform(0.05, 0.9, size=50):
        h = 1e-4 * (1 - share)
        energy = [0.5 * (s / (1 - s**2) ** 2) ** 2 for s in (share - h, share, share + h)]
        curvature = (energy[0] - 2 * energy[1] + energy[2]) / h**2
        assert abs(contact.grip_factor(share) / curvature - 1) < 1e-5  # h^2 times the fourth derivative
    memory, normal, stiffness, friction = np.zeros(3), np.array([0.0, 0.0, 1.0]), 3.0, 0.4
    for _ in range(5000):
        slip, force, root = 0.3 * rng.normal(size=3), rng.uniform(0, 4), rng.uniform(1, 5)
        after = contact.friction_force(memory, root * slip, normal, force / root, friction, stiffness)[0]
        pull = stiffness * root * after
        assert np.linalg.norm(pull) <= friction * force * (1 + 1e-14)
        assert pull @ slip - 0.5 * stiffness * (after @ after - memory @ memory) > -1e-14
        memory = after


@pytest.mark.parametrize("restitution, damping", [(0.5, 1.4328), (0.8, 0.37315)])
@pytest.mark.parametrize("across, along", [(3, 10), (30, 100), (0.3, 2)])
def test_sliding_hits_have_coulombs_impulse(restitution, damping, across, along):
    """A ball of 1 kg, radius 20 mm and the inertia of a solid sphere, against a floor with a depth of 2 mm."""
    stiffness, friction, depth, lever = (np.pi / 0.01) ** 2, 0.3, 2e-3, 3.5  # lever: 1 + m r^2 / J
    p, rate, slip, memory, impulse, pulled = 0.0, across, along, 0.0, 0.0, 0.0
    while p >= 0:
        s2 = (p / depth) ** 2
        stiffest = np.sqrt(stiffness * contact.grip_factor(p / depth))
        h = min(1e-6, 1e-3 * (depth - p) / across, 0.01 / stiffest)
        force = stiffness * p * (1 + 3 * s2) / (1 - s2) ** 5 * max(0, 1 + damping * rate / across)
        root = np.sqrt(contact.grip_factor(p / depth))
        memory = min(memory + root * slip * h, friction * force / (stiffness * root))
        pull = stiffness * root * memory
        rate, slip = rate - force * h, slip - lever * pull * h
        p, impulse, pulled = p + rate * h, impulse + force * h, pulled + pull * h
    assert abs(-rate / across - restitution) < 0.01
    assert abs(pulled / (friction * impulse) - 1) < 0.01


def test_resistance_to_spinning_and_rolling():
    """Derivatives, and that no energy is gained for any memory."""
    rng = np.random.default_rng(4)
    for case in range(2000):
        memory, turn, normal = rng.normal(size=(3, 3))
        normal, force = normal / np.linalg.norm(normal), rng.uniform(0.1, 2)
        law = rng.uniform(0.1, 2, size=2) * 10.0 ** rng.integers(-2, 2), 3.0
        after, *slopes = contact.turn_grip(memory, turn, normal, force, *law[0], law[1])
        assert law[1] * (after @ turn - 0.5 * (after @ after - memory @ memory)) > -1e-12
        if case > 200:
            continue
        h, columns = 1e-6, []
        for k in range(7):  # by turn, normal, force
            d = h * np.eye(7)[k]
            columns.append(sum(sign * contact.turn_grip(memory, turn + sign * d[:3], normal + sign * d[3:6],
                                                        force + sign * d[6], *law[0], law[1])[0] for sign in (1, -1)))
        error = np.column_stack(columns) / (2 * h) - np.column_stack([*slopes[:2], slopes[2]])
        assert abs(error).max() < 1e-8


def let_out(restitution_damping, gravity, h=1e-3, inside=0.05):
    """Release a mass that starts inside of a floor. Return its largest speed over inside omega / 100, its largest
    deviation from inside e^(-omega t / 100) after a tenth of a second, and the error of its energy account."""
    omega = np.pi / (10 * h)
    stiffness, start, memory = omega**2, inside, 0.0
    z, v, account, fastest, behind = -inside, 0.0, 0.0, 0.0, 0.0

    def stored(z, start):
        return 0.5 * stiffness * max(-z - start, 0) ** 2

    begin = gravity * z
    for k in range(5000):
        left, rate = start * np.exp(-omega * h / 100), start * omega / 100 - v
        speed = max(memory, rate) if -z - start > 0 else max(rate, 0)
        z1 = z + h * v
        for _ in range(50):
            force, slope = contact.normal_force(-z - start, -z1 - left, h, stiffness, omega, restitution_damping, speed)
            change = -(2 * (z1 - z - h * v) / h**2 + gravity - force) / (2 / h**2 + slope)
            z1 += change
            if abs(change) < 1e-17:
                break
        account -= force * (start - left)  # work of the decaying offset
        account += force * (z + start - z1 - left) - stored(z1, left) + stored(z, start)  # dissipation of the damper
        v = 2 * (z1 - z) / h - v
        z, start, memory = z1, left, speed if -z1 - left > 0 else 0.0
        fastest = max(fastest, v)
        if k * h > 0.1:
            behind = max(behind, abs(-z - start))
    error = 0.5 * v * v + gravity * z + stored(z, start) + account - begin
    return fastest / (inside * omega / 100), behind, error


@pytest.mark.parametrize("restitution, damping", [(1, 0.0), (0.5, 1.4328), (0.3, 3.0871)])
def test_letting_out(restitution, damping):
    """The first push is a hit with the speed p omega / 100. Then the weight makes the mass lag by g / omega^2."""
    for gravity in (0.0, 9.81):
        fastest, behind, error = let_out(damping, gravity)
        assert fastest < 1 + restitution and abs(error) < 1e-12
        if gravity > 0 and damping > 0:
            assert behind < 1.001 * gravity / (100 * np.pi) ** 2
