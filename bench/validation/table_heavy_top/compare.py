"""The heavy top after two seconds, beside a published run and an independent computation."""

import time

import numpy
from scipy.integrate import solve_ivp

from flexarm import Simulation
from flexarm.validation import Row

UNTIL = 2.0  # s
MASS, CENTRE, GRAVITY = 15, numpy.array([0.0, 1, 0]), numpy.array([0, 0, -9.81])
INERTIA = numpy.array([15.234375, 0.46875, 15.234375])  # about the foot [kg m^2]
START = [0, 150, -4.61538]  # rad/s
UNCERTAINTY = 2.05e-6  # m; see numbers.csv


def rotation(quaternion):
    w, x, y, z = quaternion / numpy.linalg.norm(quaternion)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def rates(_, state):
    """Euler's equations about the foot in the top's frame; the state is quaternion w x y z and angular velocity."""
    (w, *vector), spin = state[:4], state[4:]
    vector = numpy.array(vector)
    torque = numpy.cross(CENTRE, rotation(state[:4]).T @ (MASS * GRAVITY))
    return numpy.r_[-0.5 * vector @ spin, 0.5 * (w * spin + numpy.cross(vector, spin)),
                    (torque - numpy.cross(spin, INERTIA * spin)) / INERTIA]


def independent():
    """Displacement [m] and quaternion w x y z, by DOP853 of scipy."""
    state = solve_ivp(rates, (0, UNTIL), [1, 0, 0, 0, *START], method="DOP853", rtol=1e-13, atol=1e-13).y[:4, -1]
    return numpy.r_[rotation(state) @ CENTRE - CENTRE, state / numpy.linalg.norm(state)]


def run(case, scheme, step):
    """Displacement [m] and quaternion w x y z, and processor time [s]."""
    simulation = Simulation(case.scene("heavy_top.urdf"), scheme=scheme, step=step, tolerance=1e-12)
    start = time.process_time()
    simulation.run(round(UNTIL / step))
    seconds = time.process_time() - start
    pose = simulation.probe_poses[0]
    return numpy.r_[pose[:3] - CENTRE, pose[6], pose[3:6]], seconds


def compare(case):
    exact = independent()
    published = case.table("numbers.csv")
    found, seconds = run(case, "dop853", 2e-3)
    note = "dop853, steps of 0.002 s, %.1g s of processor time" % seconds
    for row, value in zip(published, found):
        yield Row(row["quantity"], row["value"], value * numpy.sign(found[3] * published[3]["value"] if
                  row["quantity"].startswith("q") else 1), UNCERTAINTY, "m" if len(row["quantity"]) == 1 else "-",
                  "calculated", note)
    for axis, ours, theirs in zip("xyz", found, exact):
        yield Row("%s, beside scipy" % axis, theirs, ours, 1e-9, "m", "calculated",
                  "DOP853 of scipy, own equations, tolerances of 1e-13")
    found, seconds = run(case, "em4", 2e-4)
    for axis, ours, theirs in zip("xyz", found, exact):
        yield Row("%s, em4, beside scipy" % axis, theirs, ours, 1e-8, "m", "calculated",
                  "steps of 0.0002 s, %.1g s of processor time" % seconds)

    def draw(axes):
        for scheme, steps in (("em", (4e-4, 2e-4, 1e-4, 5e-5)), ("em4", (2e-3, 1e-3, 5e-4, 2e-4)),
                              ("dop853", (4e-3, 2e-3, 1e-3))):
            runs = [run(case, scheme, step) for step in steps]
            errors = [numpy.linalg.norm(place[:3] - exact[:3]) for place, _ in runs]
            axes.loglog([seconds for _, seconds in runs], errors, "o-", label=scheme)
        axes.axhline(numpy.linalg.norm([row["value"] for row in published[:3]] - exact[:3]), color="0.5", ls="--",
                     label="the published number")
        axes.set(xlabel="processor time [s]", ylabel="error after 2 s [m]")
        axes.legend(fontsize="small")

    case.draw(draw)
