"""Residuals of one geometrically exact beam element over one step, written from the formulas alone.

This is a second, independent implementation to test the library against: dense numpy, without tangents, not optimised.
The formulas are those of docs/notes/beam.md and of Munoz 2004. Positions [m] and vectors are in world axes unless they
are called material. Rotations are matrices from the section to the world. "Nodal" arrays have one row (or matrix) per
node. Residuals are {force [N], moment [N m]} of node 1, of node 2, ...; moments are conjugate to spatial spins.
"""

import dataclasses
import functools
import math

import numpy as np

I3 = np.eye(3)


# ---------------------------------------------------------------- rotations


def hat(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def vee(m):
    return 0.5 * np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])


def series(x, first):
    """Return sum_j (-x)^j / (2 j + first)!. x may be complex, for derivatives.

    For x = t^2 and first = 1, 2, 3 it is (sin t)/t, (1 - cos t)/t^2, (t - sin t)/t^3. It converges to round-off for
    t <= pi.
    """
    return sum((-x) ** j / math.factorial(2 * j + first) for j in range(20))


def exp(theta):
    """Return the rotation of a rotation vector."""
    x, h = theta @ theta, hat(theta)
    return I3 + series(x, 1) * h + series(x, 2) * h @ h


def tangent(theta):
    """Return T of a rotation vector: spin = T(theta) d(theta)."""
    x, h = theta @ theta, hat(theta)
    return I3 + series(x, 2) * h + series(x, 3) * h @ h


def tangent_scaled(rotation):
    """Return the tangent-scaled rotation vector, 2 tan(angle/2) axis, for angles below pi."""
    return 4 * vee(rotation) / (1 + np.trace(rotation))


def log(rotation):
    """Return the rotation vector, for angles below pi."""
    scaled = tangent_scaled(rotation)
    t = 0.25 * scaled @ scaled  # tan^2 of half the angle
    if abs(t) < 1e-3:
        return scaled * sum((-t) ** j / (2 * j + 1) for j in range(8))
    return scaled * np.arctan(np.sqrt(t)) / np.sqrt(t)


def cayley(scaled):
    """Return the rotation of a tangent-scaled vector."""
    h = hat(scaled)
    return I3 + (h + 0.5 * h @ h) / (1 + 0.25 * scaled @ scaled)


def cayley_tangent(scaled):
    """Return S of a tangent-scaled vector w: spin = S(w) dw."""
    return (I3 + 0.5 * hat(scaled)) / (1 + 0.25 * scaled @ scaled)


# ---------------------------------------------------------------- the element

# Parent coordinates of the nodes (Gauss-Lobatto points).
NODES = {
    2: [-1, 1],
    3: [-1, 0, 1],
    4: [-1, -np.sqrt(0.2), np.sqrt(0.2), 1],
    5: [-1, -np.sqrt(3 / 7), 0, np.sqrt(3 / 7), 1],
}


def lagrange(nodes, x):
    """Return values and derivatives of the Lagrange functions at x, from polynomials in monomial form."""
    values, derivatives = [], []
    for i, own in enumerate(NODES[nodes]):
        others = [c for k, c in enumerate(NODES[nodes]) if k != i]
        polynomial = np.poly1d(others, r=True) / np.prod([own - c for c in others])
        values.append(polynomial(x))
        derivatives.append(polynomial.deriv()(x))
    return np.array(values), np.array(derivatives)


@dataclasses.dataclass
class Point:
    """An integration point: shape functions, their derivatives with respect to arc length [1/m], and weight [m]."""

    shape: np.ndarray
    slope: np.ndarray
    weight: float


def points(count, positions):
    """Return Gauss-Legendre points on the undeformed line."""
    result = []
    for x, weight in zip(*np.polynomial.legendre.leggauss(count)):
        shape, derivative = lagrange(len(positions), x)
        length = np.linalg.norm(derivative @ positions)
        result.append(Point(shape, derivative / length, weight * length))
    return result


def interpolated(point, rotations):
    """Return rotation and material curvature by the strain-invariant local interpolation (beam.md 2.3)."""
    nodes = len(rotations)
    first, second = rotations[(nodes - 1) // 2], rotations[nodes // 2]
    reference = first @ exp(0.5 * log(first.T @ second))
    local = np.array([log(reference.T @ rotation) for rotation in rotations])
    theta = point.shape @ local
    return reference @ exp(theta), tangent(theta).T @ (point.slope @ local)


def material_spin(point, rotations, spins):
    """Return the material angular velocity of the interpolated section for nodal spins, by a complex step."""
    h = 1e-40
    moved = np.array([exp(1j * h * spin) @ rotation for rotation, spin in zip(rotations, spins)])
    return vee(interpolated(point, rotations)[0].T @ interpolated(point, moved)[0].imag / h)


class Element:
    """A beam element: stiffness about the mass centroid, mass [kg/m], material rotary inertia [kg m]."""

    def __init__(self, positions, rotations, stiffness, mass, inertia):
        self.stiffness, self.mass, self.inertia = stiffness, mass, inertia
        self.nodes = len(positions)
        self.stiffness_points = points(self.nodes - 1, positions)
        self.mass_points = points(self.nodes, positions)
        self.references = [self._measures(p, positions, interpolated(p, rotations)) for p in self.stiffness_points]

    @staticmethod
    def _measures(point, positions, section):
        rotation, curvature = section
        return np.concatenate([rotation.T @ (point.slope @ positions), curvature])

    def strain(self, k, positions, section):
        """Return {Gamma, K} at stiffness point k, from the section's rotation and curvature there."""
        return self._measures(self.stiffness_points[k], positions, section) - self.references[k]

    def node_lengths(self):
        """Return the nodes' shares of the length, int I^i ds [m]."""
        return sum(p.weight * p.shape for p in self.mass_points)


@dataclasses.dataclass
class Step:
    """A step of the length `step` [s] from (r0, R0) to (r1, R1), and the motion at its beginning.

    Angular quantities of nodes and mass points are material.
    """

    step: float
    r0: np.ndarray
    R0: np.ndarray
    r1: np.ndarray
    R1: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    node_spin: np.ndarray
    point_spin: np.ndarray
    point_spin_rate: np.ndarray

    @functools.cached_property
    def increments(self):
        """Return the tangent-scaled rotation increments of the nodes."""
        return np.array([tangent_scaled(b @ a.T) for a, b in zip(self.R0, self.R1)])


def force_rows(point, n, m, tangent_vector):
    """Return the contribution of the stress resultants n, m (world) at a point to the residual."""
    moments = np.outer(point.slope, m) - np.outer(point.shape, np.cross(tangent_vector, n))
    return point.weight * np.hstack([np.outer(point.slope, n), moments])


def inertia_rows(point, force, moment):
    """Return the contribution of inertia per length at a point to the residual."""
    return point.weight * np.hstack([np.outer(point.shape, force), np.outer(point.shape, moment)])


# ---------------------------------------------------------------- one configuration: statics and Newmark's family


def static(element, r, R):
    """Return the internal forces of a configuration (beam.md 2.2)."""
    rows = np.zeros((element.nodes, 6))
    for k, point in enumerate(element.stiffness_points):
        section = interpolated(point, R)
        stress = element.stiffness @ element.strain(k, r, section)
        rows += force_rows(point, section[0] @ stress[:3], section[0] @ stress[3:], point.slope @ r)
    return rows


def newmark(element, step, alpha=0.0):
    """Return the residual of Newmark's rule. With alpha, forces conjugate to spins are interpolated (HHT2; Munoz 2004,
    eq. 4.11)."""
    h, gamma, beta = step.step, 0.5 - alpha, 0.25 * (1 - alpha) ** 2
    rows = (1 + alpha) * static(element, step.r1, step.R1) - alpha * static(element, step.r0, step.R0)

    def accelerated(increment, v, a):
        return (increment - h * v - (0.5 - beta) * h * h * a) / (beta * h * h)

    acceleration = accelerated(step.r1 - step.r0, step.velocity, step.acceleration)
    for point, W, A in zip(element.mass_points, step.point_spin, step.point_spin_rate):
        begin, end = interpolated(point, step.R0)[0], interpolated(point, step.R1)[0]
        A1 = accelerated(log(begin.T @ end), W, A)
        W1 = W + h * ((1 - gamma) * A + gamma * A1)
        moment = end @ (np.cross(W1, element.inertia @ W1) + element.inertia @ A1)
        rows += inertia_rows(point, element.mass * (point.shape @ acceleration), moment)
    return rows


# ---------------------------------------------------------------- momentum-conserving schemes (Munoz 2004, ch. 6)


def momentum_rates(element, step, is_backward=False):
    """Return the rates of momentum at the mass points, and the change of kinetic energy over the step [J]."""
    rows, energy = np.zeros((element.nodes, 6)), 0.0
    for point, W in zip(element.mass_points, step.point_spin):
        begin, end = interpolated(point, step.R0)[0], interpolated(point, step.R1)[0]
        v = point.shape @ step.velocity
        rate = point.shape @ (step.r1 - step.r0) / step.step
        v1 = rate if is_backward else 2 * rate - v
        W1 = 2 * log(begin.T @ end) / step.step - W
        J = element.inertia
        moment = (end @ J @ W1 - begin @ J @ W) / step.step
        rows += inertia_rows(point, element.mass * (v1 - v) / step.step, moment)
        energy += 0.5 * point.weight * (element.mass * (v1 @ v1 - v @ v) + W1 @ J @ W1 - W @ J @ W)
    return rows, energy


def algorithmic_rows(element, step, k, stress, is_backward=False):
    """Return the rows of a stress over a step at stiffness point k. Forces have the mean rotation, moments T(omega)
    Lambda_0 (eq. 6.13)."""
    point = element.stiffness_points[k]
    begin, end = interpolated(point, step.R0)[0], interpolated(point, step.R1)[0]
    line0, line1 = point.slope @ step.r0, point.slope @ step.r1
    line = line0 if is_backward else 0.5 * (line0 + line1)
    moment = tangent(begin @ log(begin.T @ end)) @ begin @ stress[3:]
    return force_rows(point, 0.5 * (begin + end) @ stress[:3], moment, line)


def strains(element, step, k):
    """Return the strains at stiffness point k at the beginning and at the end."""
    point = element.stiffness_points[k]
    return (element.strain(k, step.r0, interpolated(point, step.R0)),
            element.strain(k, step.r1, interpolated(point, step.R1)))


def momentum(element, step, is_backward=False):
    """Return the residual of M1, or of M2 if is_backward."""
    rows, _ = momentum_rates(element, step, is_backward)
    for k in range(element.nodes - 1):
        before, after = strains(element, step, k)
        rows += algorithmic_rows(element, step, k, 0.5 * element.stiffness @ (before + after), is_backward)
    return rows


def beta1(element, step, with_moments):
    """Return M1 plus a multiple of the rows of Delta N (repaired: and Delta M) that closes the element's energy (eq.
    6.22)."""
    rows, kinetic = momentum_rates(element, step)
    correction, strain_energy = np.zeros((element.nodes, 6)), 0.0
    for k, point in enumerate(element.stiffness_points):
        before, after = strains(element, step, k)
        change = element.stiffness @ (after - before)
        rows += algorithmic_rows(element, step, k, 0.5 * element.stiffness @ (before + after))
        strain_energy += 0.5 * point.weight * (after + before) @ change
        if not with_moments:
            change[3:] = 0
        correction += algorithmic_rows(element, step, k, change)
    increments = np.hstack([step.r1 - step.r0, step.increments])
    missing = kinetic + strain_energy - np.sum(increments * rows)
    return rows + missing / np.sum(increments * correction) * correction


def std(element, step):
    """Return the residual of Simo, Tarnow and Doblare, which interpolates tangent-scaled increments (sec. 6.2). The
    rotation at the beginning is the local interpolation."""
    rows, w_nodes, h, J = np.zeros((element.nodes, 6)), step.increments, step.step, element.inertia
    for point, W in zip(element.mass_points, step.point_spin):
        begin = interpolated(point, step.R0)[0]
        w = point.shape @ w_nodes
        v = point.shape @ step.velocity
        v1 = 2 * point.shape @ (step.r1 - step.r0) / h - v
        W1 = 2 * begin.T @ w / h - W
        rows += inertia_rows(point, element.mass * (v1 - v) / h, (cayley(w) @ begin @ J @ W1 - begin @ J @ W) / h)
    for k, point in enumerate(element.stiffness_points):
        begin, curvature = interpolated(point, step.R0)
        w, slope = point.shape @ w_nodes, point.slope @ w_nodes
        end = cayley(w) @ begin
        after = element.strain(k, step.r1, (end, curvature + begin.T @ cayley_tangent(w).T @ slope))
        stress = 0.5 * element.stiffness @ (element.strain(k, step.r0, (begin, curvature)) + after)
        line = 0.5 * point.slope @ (step.r0 + step.r1)
        moment = cayley_tangent(w) @ begin @ stress[3:]
        rows += force_rows(point, 0.5 * (begin + end) @ stress[:3], moment, line)
    return rows


# ---------------------------------------------------------------- energy-momentum scheme (beam.md 3.1)


@dataclasses.dataclass
class EnergyMomentumPoint:
    """A stiffness point of the energy-momentum scheme over a step."""

    point: Point
    mean: np.ndarray  # rotation, mean of both ends
    line: np.ndarray  # r', mean of both ends
    conjugate: np.ndarray  # s, to which the residual is conjugate: the discrete {Delta Gamma, Delta K}
    stress: np.ndarray  # C times the mean strain
    change: np.ndarray  # change of the strain


def energy_momentum_point(element, step, k):
    point = element.stiffness_points[k]
    begin, end = interpolated(point, step.R0)[0], interpolated(point, step.R1)[0]
    before, after = strains(element, step, k)
    mean, line = 0.5 * (begin + end), 0.5 * point.slope @ (step.r0 + step.r1)
    stretch = point.slope @ (step.r1 - step.r0) + np.cross(line, point.shape @ step.increments)
    conjugate = np.concatenate([mean.T @ stretch, mean.T @ (point.slope @ step.increments)])
    return EnergyMomentumPoint(point, mean, line, conjugate, 0.5 * element.stiffness @ (before + after), after - before)


def energy_momentum(element, step, with_multiplier, damping=0.0):
    """Return the residual of em (with the multiplier) or em0. Rotary inertia is lumped at the nodes; `damping` [s] is
    stiffness-proportional."""
    h, J = step.step, element.inertia
    at_points = [energy_momentum_point(element, step, k) for k in range(element.nodes - 1)]
    rows = np.zeros((element.nodes, 6))
    for p in at_points:
        stress = p.stress + damping / h * element.stiffness @ p.conjugate
        rows += force_rows(p.point, p.mean @ stress[:3], p.mean @ stress[3:], p.line)
    if with_multiplier:
        missing = sum(p.point.weight * p.stress @ (p.change - p.conjugate) for p in at_points)
        relative = step.increments - np.mean(step.increments, axis=0)
        rows[:, 3:] += missing / np.sum(relative**2) * relative
    velocity_change = 2 * ((step.r1 - step.r0) / h - step.velocity)
    for point in element.mass_points:
        rows += inertia_rows(point, element.mass * (point.shape @ velocity_change) / h, np.zeros(3))
    for i, length in enumerate(element.node_lengths()):
        W = step.node_spin[i]
        W1 = 2 * step.R0[i].T @ step.increments[i] / h - W
        rows[i, 3:] += length / h * (step.R1[i] @ J @ W1 - step.R0[i] @ J @ W)
    return rows
