#!/usr/bin/env python3
"""Writes residuals of one random element step per scheme, computed by an independent numpy implementation.

Usage: prototype_steps.py PROTOTYPE_FOLDER > ../prototype_steps.csv

PROTOTYPE_FOLDER holds the research prototype's beam.py and rotations.py (dense numpy, formulas of Munoz 2004 and of the
energy-momentum scheme written out separately from the library). Each line of the output is "nodes,key,values...": all
inputs of the step and the residual {f_i, phi_i} of every scheme. Quaternions are w, x, y, z.
"""
import sys

import numpy as np

sys.path.insert(0, sys.argv[1])
import beam as prototype  # noqa: E402
from beam import Beam  # noqa: E402
from rotations import exp  # noqa: E402

STEP = 0.3
DAMPING = 0.05
ALPHA = -0.1


# Parent coordinates of the nodes: Gauss-Lobatto points (the prototype has equally spaced nodes of its own).
NODES = {2: [-1, 1], 3: [-1, 0, 1], 4: [-1, -np.sqrt(0.2), np.sqrt(0.2), 1],
         5: [-1, -np.sqrt(3 / 7), 0, np.sqrt(3 / 7), 1]}


def lagrange(nodes, x):
    """Values and derivatives of the Lagrange functions, from polynomials in monomial form."""
    values, derivatives = [], []
    for i, own in enumerate(NODES[nodes]):
        others = [c for k, c in enumerate(NODES[nodes]) if k != i]
        polynomial = np.poly1d(others, r=True) / np.prod([own - c for c in others])
        values.append(polynomial(x))
        derivatives.append(polynomial.deriv()(x))
    return np.array(values), np.array(derivatives)


prototype.lagrange = lagrange


def quaternion(rotation):
    angle_vector = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                             rotation[1, 0] - rotation[0, 1]])
    w = 0.5 * np.sqrt(max(0.0, 1 + np.trace(rotation)))
    return np.concatenate([[w], angle_vector / (4 * w)])


def spd(rng, n):
    root = rng.uniform(-1, 1, (n, n))
    return root @ root.T + np.eye(n)


def write(nodes, key, values):
    print(",".join([str(nodes), key] + [repr(float(v)) for v in np.ravel(values)]))


def residual(beam, scheme, begin, end, options):
    return beam.residual(scheme, *begin, *end, STEP, False, options)[0]


def case(nodes):
    rng = np.random.default_rng(nodes)
    vectors = lambda size: [size * rng.uniform(-1, 1, 3) for _ in range(nodes)]
    x = 0.75 * (1 + np.array(NODES[nodes]))
    r_undeformed = [np.array([s, 0.3 * s * s, -0.2 * s]) for s in x]
    R_undeformed = [exp(np.array([0.4 * s, 0.1, 0.5 * s])) for s in x]
    stiffness, inertia, mass = spd(rng, 6), spd(rng, 3), 1.3
    r0 = [a + b for a, b in zip(r_undeformed, vectors(0.1))]
    R0 = [R @ exp(w) for R, w in zip(R_undeformed, vectors(0.3))]
    r1 = [a + b for a, b in zip(r0, vectors(0.3))]
    R1 = [exp(w) @ R for R, w in zip(R0, vectors(0.3))]
    velocity, spin, acceleration = vectors(1), vectors(1), vectors(1)

    beam = Beam(range(nodes), r_undeformed, R_undeformed, stiffness, mass, inertia)
    beam.init_velocity(r0, R0, velocity, spin)
    for point, history in zip(beam.mg, beam.h):
        history.a = sum(point.I[i] * acceleration[i] for i in range(nodes))
        history.A = rng.uniform(-1, 1, 3)

    write(nodes, "step", [STEP])
    write(nodes, "damping", [DAMPING])
    write(nodes, "alpha", [ALPHA])
    write(nodes, "section_mass", [mass])
    write(nodes, "stiffness", stiffness)
    write(nodes, "inertia", inertia)
    for key, r, R in (("undeformed", r_undeformed, R_undeformed), ("begin", r0, R0), ("end", r1, R1)):
        write(nodes, key + "_position", r)
        write(nodes, key + "_orientation", [quaternion(a) for a in R])
    write(nodes, "velocity", velocity)
    write(nodes, "acceleration", acceleration)
    write(nodes, "node_angular_velocity", [R.T @ w for R, w in zip(R0, spin)])
    write(nodes, "point_angular_velocity", [h.W for h in beam.h])
    write(nodes, "point_angular_acceleration", [h.A for h in beam.h])

    begin, end = (r0, R0), (r1, R1)
    write(nodes, "static", beam.static(*end, False)[0])
    write(nodes, "newmark", residual(beam, "newmark", begin, end, {}))
    write(nodes, "m1", residual(beam, "m1", begin, end, {}))
    write(nodes, "m2", residual(beam, "m2", begin, end, {}))
    write(nodes, "std", residual(beam, "std", begin, end, {}))
    write(nodes, "beta1", residual(beam, "beta1", begin, end, {"scaled": True, "betafull": False}))
    write(nodes, "beta1_repaired", residual(beam, "beta1", begin, end, {"scaled": True, "betafull": True}))
    write(nodes, "hht2", residual(beam, "newmark", begin, end, {"alpha": ALPHA}))
    write(nodes, "em0", residual(beam, "em", begin, end, {"noproj": True}))
    write(nodes, "em0_damped", residual(beam, "em", begin, end, {"noproj": True, "kv": DAMPING}))
    write(nodes, "em", residual(beam, "em", begin, end, {"pool": "element"}))
    write(nodes, "em_damped", residual(beam, "em", begin, end, {"pool": "element", "kv": DAMPING}))


print("# Residuals of one element over one random step. Provenance: test/elements/scripts/prototype_steps.py with the "
      "numpy prototype, numpy " + np.__version__ + ".")
print("# nodes,key,values: SI units, row by row; quaternions w x y z; angular quantities of nodes and points material.")
for count in (2, 3, 4, 5):
    case(count)
