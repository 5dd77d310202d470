#!/usr/bin/python3
"""Residuals of one random element step per scheme, by the reference implementation beside this file.

Usage: reference_steps.py > ../reference_steps.csv      writes the table that reference_steps_test.cpp reads
       reference_steps.py --check TABLE                 computes it again; exit status 1 if the file differs

Each line of the table is "nodes,key,values...": all inputs of the step and the residual {f_i, phi_i} of every scheme.
Quaternions are w, x, y, z.
"""

import sys

import numpy as np

from reference_beam import (Element, Step, beta1, energy_momentum, exp, material_spin, momentum, newmark, static, std,
                            NODES)

STEP = 0.3
DAMPING = 0.05
ALPHA = -0.1
# Round-off of some hundred operations on different machines. The multiplier's numerator loses three digits of the
# stresses by cancellation.
TOLERANCE = 1e-12


def quaternion(rotation):
    angle_vector = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                             rotation[1, 0] - rotation[0, 1]])
    w = 0.5 * np.sqrt(max(0.0, 1 + np.trace(rotation)))
    return np.concatenate([[w], angle_vector / (4 * w)])


def positive_definite(rng, size):
    root = rng.uniform(-1, 1, (size, size))
    return root @ root.T + np.eye(size)


def case(nodes):
    """Return ordered (key, values) of an element with this number of nodes."""
    rng = np.random.default_rng(nodes)

    def vectors(size, count=nodes):
        return size * rng.uniform(-1, 1, (count, 3))

    x = 0.75 * (1 + np.array(NODES[nodes]))
    r_undeformed = np.array([[s, 0.3 * s * s, -0.2 * s] for s in x])
    R_undeformed = np.array([exp(np.array([0.4 * s, 0.1, 0.5 * s])) for s in x])
    stiffness, inertia, mass = positive_definite(rng, 6), positive_definite(rng, 3), 1.3
    r0 = r_undeformed + vectors(0.1)
    R0 = np.array([R @ exp(w) for R, w in zip(R_undeformed, vectors(0.3))])
    r1 = r0 + vectors(0.3)
    R1 = np.array([exp(w) @ R for R, w in zip(R0, vectors(0.3))])
    velocity, spin, acceleration = vectors(1), vectors(1), vectors(1)
    element = Element(r_undeformed, R_undeformed, stiffness, mass, inertia)
    step = Step(STEP, r0, R0, r1, R1, velocity, acceleration,
                node_spin=np.array([R.T @ w for R, w in zip(R0, spin)]),
                point_spin=np.array([material_spin(p, R0, spin) for p in element.mass_points]),
                point_spin_rate=vectors(1))

    rows = {"step": STEP, "damping": DAMPING, "alpha": ALPHA, "section_mass": mass, "stiffness": stiffness,
            "inertia": inertia}
    for key, r, R in (("undeformed", r_undeformed, R_undeformed), ("begin", r0, R0), ("end", r1, R1)):
        rows[key + "_position"] = r
        rows[key + "_orientation"] = [quaternion(a) for a in R]
    rows.update({
        "velocity": velocity,
        "acceleration": acceleration,
        "node_angular_velocity": step.node_spin,
        "point_angular_velocity": step.point_spin,
        "point_angular_acceleration": step.point_spin_rate,
        "static": static(element, r1, R1),
        "newmark": newmark(element, step),
        "m1": momentum(element, step),
        "m2": momentum(element, step, is_backward=True),
        "std": std(element, step),
        "beta1": beta1(element, step, with_moments=False),
        "beta1_repaired": beta1(element, step, with_moments=True),
        "hht2": newmark(element, step, ALPHA),
        "em0": energy_momentum(element, step, False),
        "em0_damped": energy_momentum(element, step, False, DAMPING),
        "em": energy_momentum(element, step, True),
        "em_damped": energy_momentum(element, step, True, DAMPING),
    })
    return [((str(nodes), key), np.ravel(values)) for key, values in rows.items()]


def table():
    return [row for nodes in NODES for row in case(nodes)]


def write():
    print("# Residuals of one element over one random step, by test/elements/scripts/reference_steps.py with numpy "
          + np.__version__ + ".")
    print("# nodes,key,values: SI units, row by row; quaternions w x y z; angular quantities of nodes and points "
          "material.")
    for key, values in table():
        print(",".join([*key] + [repr(float(v)) for v in values]))


def check(path):
    """Return the differences between the table in the file and the table that is computed again."""
    with open(path, encoding="utf-8") as file:
        lines = [line.split(",") for line in file if not line.startswith("#")]
    found = {(nodes, key): np.array(values, dtype=float) for nodes, key, *values in lines}
    computed = dict(table())
    if found.keys() != computed.keys() or len(lines) != len(found):
        return ["the keys differ: " + str(sorted(found.keys() ^ computed.keys()))]
    differences = []
    for (nodes, key), values in computed.items():
        in_file = found[nodes, key]
        if in_file.shape != values.shape:
            differences.append("%s nodes, %s: %d numbers, expected %d" % (nodes, key, in_file.size, values.size))
        elif np.max(np.abs(in_file - values)) > TOLERANCE * np.max(np.abs(values)):
            k = np.argmax(np.abs(in_file - values))
            differences.append("%s nodes, %s, number %d: %r, expected %r" % (nodes, key, k + 1, in_file[k], values[k]))
    return differences


if __name__ == "__main__":
    if len(sys.argv) == 1:
        write()
    elif len(sys.argv) == 3 and sys.argv[1] == "--check":
        differences = check(sys.argv[2])
        print("\n".join(differences) if differences else sys.argv[2] + " is what the reference computes")
        sys.exit(1 if differences else 0)
    else:
        sys.exit(__doc__)
