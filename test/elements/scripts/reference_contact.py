"""Contact over one step, written from the formulas of docs/notes/contact.md alone.

Forces, tangents and discrete gradients to test the library against: dense numpy, not optimised. A pose is (position
[m], rotation matrix to the world). Increments over a step are {displacement, tangent-scaled rotation}. Rows are {force
[N], moment [N m]} on body A, then on body B, in world axes, conjugate to these increments. `y` is a point of A in B's
frame. A local force acts on A, along B's axes. reference_contact_checks.py tests that work and momenta are exact and
that tangents are derivatives, reference_contact_laws.py what laws do over many steps.
"""

import numpy as np

from reference_beam import I3, cayley_tangent, exp, hat, log, tangent_scaled

SHORT = 1e-6  # relative to a shape's size: shorter motions get no correction along them


def mean(a, b):
    return 0.5 * (a + b)


# ---------------------------------------------------------------- discrete gradients: D . (y1 - y0) = change


def norm_gradient(y0, y1):
    """Return a discrete gradient of |y| and its derivative: (D, dD/dy1)."""
    size = np.linalg.norm(y0) + np.linalg.norm(y1)
    gradient = (y0 + y1) / size
    return gradient, (np.eye(len(y0)) - np.outer(gradient, y1 / np.linalg.norm(y1))) / size


def quotient(function, slope, z0, z1):
    """Return the difference quotient, or the slope in the middle if there is no difference."""
    return (function(z1) - function(z0)) / (z1 - z0) if abs(z1 - z0) > 1e-9 else slope(mean(z0, z1))


def sign_mean(p0, p1):
    """Return a discrete gradient of |p|, in [-1, 1]."""
    return (p0 + p1) / max(abs(p0) + abs(p1), 1e-300)


def solid_distance(q):
    """Return the signed distance of a solid that is bounded by q_i < 0 at right angles."""
    return np.linalg.norm(np.maximum(q, 0)) + min(max(q), 0)


def solid_gradient(q0, q1):
    """Return a discrete gradient of solid_distance with respect to q, by the discrete chain rule. Its length is at most
    1."""
    u0, u1 = np.maximum(q0, 0), np.maximum(q1, 0)
    size = np.linalg.norm(u0) + np.linalg.norm(u1)
    above = np.array([quotient(lambda z: max(z, 0), lambda z: float(z > 0), a, b) for a, b in zip(q0, q1)])
    outer = (u0 + u1) / size * above if size > 0 else np.zeros(len(q0))
    largest, m0, m1 = np.ones(1), q0[0], q1[0]
    for a, b in zip(q0[1:], q1[1:]):  # max(a, b) = (a + b + |a - b|) / 2
        first = 0.5 * (1 + sign_mean(m0 - a, m1 - b))
        largest, m0, m1 = np.append(first * largest, 1 - first), max(m0, a), max(m1, b)
    return outer + quotient(lambda z: min(z, 0), lambda z: float(z < 0), m0, m1) * largest


def box(y, half):
    return solid_distance(np.abs(y) - half)


def box_gradient(y0, y1, half):
    return solid_gradient(np.abs(y0) - half, np.abs(y1) - half) * np.array([sign_mean(a, b) for a, b in zip(y0, y1)])


def cylinder(y, sizes):
    """Return the signed distance. sizes: radius, half length."""
    return solid_distance(np.array([np.linalg.norm(y[:2]), abs(y[2])]) - sizes)


def cylinder_gradient(y0, y1, sizes):
    q0, q1 = (np.array([np.linalg.norm(y[:2]), abs(y[2])]) - sizes for y in (y0, y1))
    by_q = solid_gradient(q0, q1)
    return np.append(by_q[0] * norm_gradient(y0[:2], y1[:2])[0], by_q[1] * sign_mean(y0[2], y1[2]))


def beyond(z, half):
    return np.sign(z) * max(abs(z) - half, 0)


def capsule(y, half):
    """Return the distance from a segment of this half length."""
    return np.linalg.norm([y[0], y[1], beyond(y[2], half)])


def capsule_gradient(y0, y1, half):
    ends = [np.array([y[0], y[1], beyond(y[2], half)]) for y in (y0, y1)]
    slope = quotient(lambda z: beyond(z, half), lambda z: float(abs(z) > half), y0[2], y1[2])
    return norm_gradient(*ends)[0] * np.array([1, 1, slope])


def gonzalez(gradient, change, step, length):
    """Correct a gradient in the middle such that gradient . step = change. step: {displacement, rotation}; length: size
    of arms [m]."""
    along = np.r_[1, 1, 1, np.full(3, length**2)] * step
    square = step @ along
    return gradient + ((change - gradient @ step) / square * along if square > (SHORT * length) ** 2 else 0)


# ---------------------------------------------------------------- laws


def energy_quotient(p0, p1, stiffness, depth=np.inf):
    """Return (force (V1 - V0) / (p1 - p0), its derivative with respect to p1, mean of x), with V = k x(p)^2 / 2 and x
    of stops.md 2."""

    def x_and_slope(p):
        s2 = (p / depth) ** 2
        return (p / (1 - s2) ** 2, (1 + 3 * s2) / (1 - s2) ** 3) if p > 0 else (0.0, 0.0)

    (x0, slope0), (x1, slope1) = x_and_slope(p0), x_and_slope(p1)
    if p0 > 0 and p1 > 0:
        s0, s1 = p0 / depth, p1 / depth
        a, b = 1 - s0 * s0, 1 - s1 * s1
        rho = ((a + b) * (1 + s0 * s1) - a * b) / (a * b) ** 2
    else:
        rho = (x1 - x0) / (p1 - p0) if p1 != p0 else 0
    force = stiffness * rho * mean(x0, x1)
    if abs(p1 - p0) <= 1e-6 * (abs(p0) + abs(p1)):
        return force, 0.5 * stiffness * slope0 * slope1, mean(x0, x1)  # V''/2 without the term x x''
    return force, (stiffness * slope1 * x1 - force) / (p1 - p0), mean(x0, x1)


def normal_force(p0, p1, h, stiffness, omega=1.0, damping=0.0, speed=0.0, depth=np.inf):
    """Return the mean force over a step and its derivative with respect to p1. speed: speed of the approach (memory);
    damping: d(e)."""
    force, slope, x = energy_quotient(p0, p1, stiffness, depth)
    if damping == 0 or h == 0 or force == 0:
        return force, slope
    bound = 0.5 * omega * x
    alpha = damping / max(speed, bound)
    factor = 1 + alpha * (p1 - p0) / h
    if factor <= 0:
        return 0.0, 0.0
    by_alpha = 0.0
    if bound > speed:
        s2 = (p1 / depth) ** 2
        by_alpha = -alpha / x * (0.5 * (1 + 3 * s2) / (1 - s2) ** 3 if p1 > 0 else 0)
    return force * factor, slope * factor + force * (alpha + by_alpha * (p1 - p0)) / h


def grip_factor(share):
    """Return V''(p) / k at p = share of the depth, by which the tangential stiffness hardens."""
    s2 = share**2
    return (1 + 18 * s2 + 21 * s2**2) / (1 - s2) ** 6


def friction_force(memory, slip, normal, force, limit, stiffness):
    """Return (new memory, its derivatives with respect to slip, unit normal and normal force). The force on B is
    stiffness * memory. With a tangential stiffness of stiffness * root**2: root * slip and force / root in place of
    slip and force, and the force on B is root times as large."""
    whole = memory + slip
    projector = I3 - np.outer(normal, normal)
    trial = projector @ whole
    by_normal = -(normal @ whole) * I3 - np.outer(normal, whole)
    size, most = np.linalg.norm(trial), limit * force / stiffness
    if size <= most:
        return trial, projector, by_normal, np.zeros(3)
    along = trial / max(size, 1e-300)
    turn = most / max(size, 1e-300) * (I3 - np.outer(along, along))
    return most * along, turn @ projector, turn @ by_normal, limit / stiffness * along


def turn_grip(memory, turn, normal, force, spinning, rolling, stiffness):
    """Return the resistance to spinning (along the normal) and rolling (across the normal), as friction_force does.

    spinning, rolling: coefficients [m]."""
    across = friction_force(memory, turn, normal, force, rolling, stiffness)
    whole, most = memory + turn, spinning * force / stiffness
    size = normal @ whole
    if abs(size) <= most:
        along = (size * normal, np.outer(normal, normal), size * I3 + np.outer(normal, whole), np.zeros(3))
    else:
        sign = np.sign(size)
        along = (sign * most * normal, np.zeros((3, 3)), sign * most * I3, sign * spinning / stiffness * normal)
    return tuple(a + b for a, b in zip(along, across))


# ---------------------------------------------------------------- (a) a point of A against a function in B's frame


def local(pose_a, pose_b, arm):
    return pose_b[1].T @ (pose_a[0] + pose_a[1] @ arm - pose_b[0])


def arm_rows(begin, end, arm_a, force, couple=np.zeros(3)):
    """Return the rows of a force on A at a mean arm and of a couple, in world axes. The opposite acts on B through the
    same point."""
    (a0, b0), (a1, b1) = begin, end
    arm_b = mean(a0[0], a1[0]) + arm_a - mean(b0[0], b1[0])
    return np.concatenate([force, np.cross(arm_a, force) + couple, -force, -np.cross(arm_b, force) - couple])


def point_rows(begin, end, arm, force):
    """Return the rows of a local force on A's point."""
    (a0, b0), (a1, b1) = begin, end
    return arm_rows(begin, end, mean(a0[1], a1[1]) @ arm, mean(b0[1], b1[1]) @ force)


def local_slopes(end, arm):
    """Return derivatives with respect to {displacement, spin} of A and B: of A's point minus B's origin, and of y, both
    at the end."""
    (r_a, axes_a), (r_b, axes_b) = end
    arm_a = axes_a @ arm
    d_point = np.hstack([I3, -hat(arm_a), -I3, np.zeros((3, 3))])
    d_y = d_point.copy()
    d_y[:, 9:] += hat(r_a + arm_a - r_b)
    return d_point, axes_b.T @ d_y


def point_tangent(begin, end, arm, force, slope):
    """Return the derivative of point_rows with respect to {displacement, spin} of A and B at the end. slope: derivative
    of the local force by y1."""
    (a0, b0), (a1, b1) = begin, end
    axes = mean(b0[1], b1[1])
    f, arm_a = axes @ force, mean(a0[1], a1[1]) @ arm
    arm_b = mean(a0[0], a1[0]) + arm_a - mean(b0[0], b1[0])
    d_point, d_y = local_slopes(end, arm)
    d_f = axes @ slope @ d_y
    d_f[:, 9:] -= 0.5 * hat(b1[1] @ force)
    d_arm = np.zeros((3, 12))
    d_arm[:, 3:6] = -hat(a1[1] @ arm)
    return np.vstack([d_f, hat(arm_a) @ d_f - 0.5 * hat(f) @ d_arm, -d_f, -hat(arm_b) @ d_f + 0.5 * hat(f) @ d_point])


def shell_force(y0, y1, radius, law):
    """Return local force, its derivative by y1, memory and dissipation for a point inside a spherical shell of B with
    friction. The penetration is p = |y| - radius. law: h, k, omega, d, speed, memory, mu, kt."""
    gradient, d_gradient = norm_gradient(y0, y1)
    p0, p1 = np.linalg.norm(y0) - radius, np.linalg.norm(y1) - radius
    force, slope = normal_force(p0, p1, law["h"], law["k"], law["omega"], law["d"], law["speed"])
    by_y = slope * y1 / np.linalg.norm(y1)
    size = np.linalg.norm(gradient)
    normal, kt = gradient / size, law["kt"]
    memory, by_slip, by_normal, by_force = friction_force(law["memory"], y1 - y0, normal, force, law["mu"], kt)
    d_normal = (I3 - np.outer(normal, normal)) @ d_gradient / size
    d_memory = by_slip + by_normal @ d_normal + np.outer(by_force, by_y)
    lost = force * (p1 - p0) - 0.5 * law["k"] * (max(p1, 0) ** 2 - max(p0, 0) ** 2)
    lost += kt * (memory @ (y1 - y0) - 0.5 * (memory @ memory - law["memory"] @ law["memory"]))
    return (-force * gradient - kt * memory, -np.outer(gradient, by_y) - force * d_gradient - kt * d_memory, memory,
            lost)


def rolling_slip(begin, end, arm_a):
    """Return the slip of A's surface over B's at a mean arm (world axes), in the mean of B's axes. It is conjugate to
    arm_rows."""
    (a0, b0), (a1, b1) = begin, end
    turn = tangent_scaled(a1[1] @ a0[1].T) - tangent_scaled(b1[1] @ b0[1].T)
    origin = local(a1, b1, np.zeros(3)) - local(a0, b0, np.zeros(3))
    return origin + mean(b0[1], b1[1]).T @ np.cross(turn, arm_a)


# ---------------------------------------------------------------- (b) a function of the relative pose


def relative_turn(begin, end):
    """Return psi, where Q1 = cay(psi) Q0 with Q = Lambda_B^T Lambda_A, and N with psi = N (omega_A - omega_B)."""
    (a0, b0), (a1, b1) = begin, end
    wa, wb = tangent_scaled(a1[1] @ a0[1].T), tangent_scaled(b1[1] @ b0[1].T)
    n = b0[1].T @ (I3 - 0.5 * hat(wb)) / (1 + 0.25 * wa @ wb)
    return n @ (wa - wb), n


def pose_gradient(begin_relative, end_relative, psi, function, length):
    """Return the discrete gradient by {change of y, psi} of function(y, Q) -> (value, gradient by y and by a spin of
    Q). length: size of arms [m]."""
    (y0, q0), (y1, q1) = begin_relative, end_relative
    half = exp(0.5 * log(q1 @ q0.T)) @ q0
    change = function(y1, q1)[0] - function(y0, q0)[0]
    return gonzalez(function(mean(y0, y1), half)[1], change, np.concatenate([y1 - y0, psi]), length)


def pose_rows(begin, end, action):
    """Return the rows of {local force through A's origin, local couple conjugate to psi}."""
    n = relative_turn(begin, end)[1]
    return arm_rows(begin, end, np.zeros(3), mean(begin[1][1], end[1][1]) @ action[:3], n.T @ action[3:])


def pose_tangent(begin, end, action, slope):
    """Return the derivative of pose_rows. slope: derivative of the action by {y1, spin of Q1}, both in B's frame."""
    (a0, b0), (a1, b1) = begin, end
    wa, wb = tangent_scaled(a1[1] @ a0[1].T), tangent_scaled(b1[1] @ b0[1].T)
    n = relative_turn(begin, end)[1]
    d_relative = np.vstack([local_slopes(end, np.zeros(3))[1],
                            np.hstack([np.zeros((3, 3)), b1[1].T, np.zeros((3, 3)), -b1[1].T])])
    d_action = slope @ d_relative
    result = point_tangent(begin, end, np.zeros(3), action[:3], slope[:3, :3])
    turned = mean(b0[1], b1[1]) @ slope[:3, 3:] @ d_relative[3:]
    arm_b = mean(a0[0], a1[0]) - mean(b0[0], b1[0])
    result += np.vstack([turned, np.zeros((3, 12)), -turned, -hat(arm_b) @ turned])
    divisor = 1 + 0.25 * wa @ wb
    inverse_a, inverse_b = np.linalg.inv(cayley_tangent(wa)), np.linalg.inv(cayley_tangent(wb))
    couple = n.T @ action[3:]
    d_couple = n.T @ d_action[3:]
    d_couple[:, 3:6] -= 0.25 / divisor * np.outer(couple, wb @ inverse_a)
    d_couple[:, 9:] -= 0.25 / divisor * np.outer(couple, wa @ inverse_b)
    d_couple[:, 9:] -= 0.5 / divisor * hat(b0[1] @ action[3:]) @ inverse_b
    result[3:6] += d_couple
    result[9:] -= d_couple
    return result


def edges_gap(y, q, edge_a=(np.array([0.3, 0.2, 0.1]), np.array([1.0, 0, 0])),
              edge_b=(np.array([0.1, -0.2, 0.4]), np.array([0.0, 1, 0]))):
    """Return the distance of two lines along their common normal: (value, gradient by y and spin of Q)."""
    (p, s), (o, t) = edge_a, edge_b
    along, arm = q @ s, q @ p
    cross = np.cross(along, t)
    size = np.linalg.norm(cross)
    normal, d = cross / size, y + arm - o
    by_cross = (d - normal * (normal @ d)) / size
    return normal @ d, np.concatenate([normal, np.cross(arm, normal) + np.cross(along, np.cross(t, by_cross))])


def rim_gap(y, q, normal, radius, axis):
    """Return the height of a disc's lowest point over the plane normal . y = 0 of B."""
    return normal @ y - radius * np.linalg.norm(np.cross(normal, q @ axis))


def rim_gradient(begin_relative, end_relative, normal, radius, axis):
    """Return the discrete gradient of rim_gap by {change of y, psi}. It is exact without a correction."""
    a0, a1 = (q @ axis for _, q in (begin_relative, end_relative))
    size = sum(np.linalg.norm(np.cross(normal, a)) for a in (a0, a1))
    return np.concatenate([normal, radius * normal @ (a0 + a1) / size * np.cross(mean(a0, a1), normal)])


# ---------------------------------------------------------------- (c) closest points of two curves


def closest(curve_a, curve_b, nodes_a, nodes_b, s=0.0, t=0.0):
    """Return the parameters of the nearest points, by Newton's method. curve(s): weights of the nodes and two
    derivatives."""
    for _ in range(60):
        a, b = [w @ nodes_a for w in curve_a(s)], [w @ nodes_b for w in curve_b(t)]
        d = a[0] - b[0]
        residual = np.array([d @ a[1], -d @ b[1]])
        matrix = np.array([[a[1] @ a[1] + d @ a[2], -a[1] @ b[1]], [-a[1] @ b[1], b[1] @ b[1] - d @ b[2]]])
        step = np.linalg.solve(matrix, residual)
        s, t = s - step[0], t - step[1]
        if abs(step).max() < 1e-15:
            break
    return s, t


def curves_gradient(weights_a, weights_b, begin, end, turns, change, length):
    """Return (local force, couple), in world axes, whose work per unit of tension is the change of the distance.

    weights: at the middle parameters; begin, end: (nodes of A, nodes of B); turns: rotations of the nodes of A and of
    B.
    """
    d0, d1 = (weights_a @ nodes[0] - weights_b @ nodes[1] for nodes in (begin, end))
    turn_a, turn_b = weights_a @ turns[0], weights_b @ turns[1]
    gradient = np.concatenate([(d0 + d1) / (np.linalg.norm(d0) + np.linalg.norm(d1)), np.zeros(3)])
    step = np.concatenate([d1 - d0 - np.cross(turn_b, mean(d0, d1)), turn_a - turn_b])
    return gonzalez(gradient, change, step, length)


def curves_rows(weights_a, weights_b, begin, end, action):
    """Return {force, moment} on each node of A and of B. The force on A acts through its middle point, with a
    couple."""
    arm = mean(*(weights_a @ nodes[0] - weights_b @ nodes[1] for nodes in (begin, end)))
    on_a = np.concatenate([action[:3], action[3:]])
    on_b = -np.concatenate([action[:3], np.cross(arm, action[:3]) + action[3:]])
    return np.outer(weights_a, on_a), np.outer(weights_b, on_b)


def curves_tangent(weights_a, weights_b, begin, end, turns, change, slope, length):
    """Return the derivative of curves_rows(curves_gradient()) at tension 1, by {displacement, spin} of all nodes at the
    end.

    slope: derivative of the change by the same; the weights are predicted, and constant here. Rows and columns: nodes
    of A,
    then of B.
    """
    d0, d1 = (weights_a @ nodes[0] - weights_b @ nodes[1] for nodes in (begin, end))
    d, size, along1 = mean(d0, d1), np.linalg.norm(d0) + np.linalg.norm(d1), d1 / np.linalg.norm(d1)
    turn_a, turn_b = weights_a @ turns[0], weights_b @ turns[1]
    count_a, columns = len(weights_a), 6 * (len(weights_a) + len(weights_b))
    d_d1, d_turn_a, d_turn_b = np.zeros((3, columns)), np.zeros((3, columns)), np.zeros((3, columns))
    for k, (weight, turn) in enumerate(zip(np.r_[weights_a, -weights_b], np.vstack(turns))):
        d_d1[:, 6 * k : 6 * k + 3] = weight * I3
        spin = d_turn_a if k < count_a else d_turn_b
        spin[:, 6 * k + 3 : 6 * k + 6] = weight * np.linalg.inv(cayley_tangent(turn))
    d_turn_b *= -1
    normal = (d0 + d1) / size
    metric = np.r_[1, 1, 1, np.full(3, length**2)]
    step = np.concatenate([d1 - d0 - np.cross(turn_b, d), turn_a - turn_b])
    d_step = np.vstack([d_d1 + hat(d) @ d_turn_b - 0.5 * hat(turn_b) @ d_d1, d_turn_a - d_turn_b])
    along = metric * step
    square = step @ along
    missing = change - (np.linalg.norm(d1) - np.linalg.norm(d0))
    d_action = np.outer(along, (slope - along1 @ d_d1) / square - 2 * missing / square**2 * (along @ d_step))
    d_action += missing / square * metric[:, None] * d_step
    d_action[:3] += (d_d1 - np.outer(normal, along1 @ d_d1)) / size
    force = normal + missing / square * along[:3]
    d_b = np.vstack([d_action[:3], hat(d) @ d_action[:3] - 0.5 * hat(force) @ d_d1 + d_action[3:]])
    return np.vstack([np.kron(weights_a[:, None], d_action), -np.kron(weights_b[:, None], d_b)])


def plane_force(y0, y1, normal, law):
    """Return the same as shell_force, for a point of A over the half-space normal . y < 0 of B."""
    p0, p1, kt = -normal @ y0, -normal @ y1, law["kt"]
    force, slope = normal_force(p0, p1, law["h"], law["k"], law["omega"], law["d"], law["speed"])
    memory, by_slip, _, by_force = friction_force(law["memory"], y1 - y0, normal, force, law["mu"], kt)
    by_y = -slope * normal
    lost = force * (p1 - p0) - 0.5 * law["k"] * (max(p1, 0) ** 2 - max(p0, 0) ** 2)
    lost += kt * (memory @ (y1 - y0) - 0.5 * (memory @ memory - law["memory"] @ law["memory"]))
    by_y1 = np.outer(normal, by_y) - kt * (by_slip + np.outer(by_force, by_y))
    return force * normal - kt * memory, by_y1, memory, lost
