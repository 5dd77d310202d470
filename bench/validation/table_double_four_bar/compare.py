"""The double four-bar linkage after ten seconds."""

import time

import numpy
from scipy.integrate import solve_ivp

from flexarm import Simulation
from flexarm.validation import Row

UNTIL = 10.0  # s


def independent():
    """x and y of B0 [m]: all three rods are parallel, which leaves the equation of a pendulum for their angle."""
    angle = solve_ivp(lambda _, y: [y[1], -3.5 * 9.81 * numpy.cos(y[0]) / 3], (0, UNTIL), [numpy.pi / 2, -1],
                      method="DOP853", rtol=1e-13, atol=1e-13).y[0, -1]
    return numpy.array([numpy.cos(angle), numpy.sin(angle)])


def run(case, scheme, step, record=None, tolerance=1e-9):
    """Simulation at the end, its rows, and its processor time [s]."""
    simulation = Simulation(case.scene("double_four_bar.urdf"), scheme=scheme, step=step, tolerance=tolerance)
    start = time.process_time()
    rows = simulation.run(round(UNTIL / step), record=record)
    return simulation, rows, time.process_time() - start


def compare(case):
    *_, coarse, fine = case.table("numbers.csv")
    exact = independent()
    simulation, _, seconds = run(case, "em4", 5e-3)
    note = "em4, steps of 0.005 s, %.1g s of processor time" % seconds
    for axis, (key, value) in enumerate(zip(("x_m", "y_m"), simulation.probe_poses[0])):
        yield Row("%s of B0" % key[0], fine[key], value, abs(fine[key] - coarse[key]), "m", "calculated", note)
        yield Row("%s of B0, beside scipy" % key[0], exact[axis], value, 1e-8, "m", "calculated",
                  "DOP853 of scipy for the parallel rods, tolerances of 1e-13")
    simulation, rows, seconds = run(case, "em", 5e-3, ["probe/b0/[xy]", "energy/total"])
    yield Row("largest change of the energy", 0, abs(rows[:, 3] - rows[0, 3]).max(), 1e-6, "J", "closed form",
              "em, steps of 0.005 s, %.1g s of processor time" % seconds)

    def draw(axes):
        axes.plot(rows[:, 0], rows[:, 1], label="x of B0")
        axes.plot(rows[:, 0], rows[:, 2], label="y of B0")
        axes.plot([UNTIL] * 2, [fine["x_m"], fine["y_m"]], "o", mfc="none", color="k", label="Exudyn")
        axes.set(xlabel="time [s]", ylabel="[m]")
        axes.legend(fontsize="small")

    case.draw(draw)
