"""The composite beam of BeamDyn: in equilibrium, and after its load began to act."""

import time

from flexarm import Simulation
from flexarm.validation import Row

TOLERANCE = 0.2  # of the transient, see transient.csv


def transient(case, scheme, step):
    """Times [s] and displacements of the tip in z [in] at each step."""
    simulation = Simulation(case.scene("composite_beam.urdf"), scheme=scheme, step=step)
    start = time.process_time()
    rows = simulation.run(round(1 / step), record=["probe/tip/z"])
    return rows, time.process_time() - start


def compare(case):
    simulation = Simulation(case.scene("composite_beam.urdf", {"elements": 20}))
    start = time.process_time()
    simulation.solve_static()
    seconds = time.process_time() - start
    for row, place, free in zip(case.table("numbers.csv"), simulation.probe_poses[0], (10, 0, 0)):
        yield Row("equilibrium, %s" % row["axis"], row["displacement_in"], place - free, 1e-9, "in", "calculated",
                  "%.1g s of processor time" % seconds)
    published = case.table("transient.csv")
    step = 1e-3
    rows, seconds = transient(case, "em4", step)
    for row in published:
        yield Row("transient, %g s, z" % row["time_s"], row["z_in"], rows[round(row["time_s"] / step) - 1, 1],
                  TOLERANCE * row["z_in"], "in", "calculated",
                  "the source's own tolerance of 20 %%; em4, %.1g s of processor time" % seconds)

    def draw(axes):
        axes.plot(rows[:, 0], rows[:, 1], label="em4, steps of 1 ms")
        for scheme in ("em", "hht3"):
            coarse, _ = transient(case, scheme, 5e-3)
            axes.plot(coarse[:, 0], coarse[:, 1], lw=0.8, label=scheme + ", steps of 5 ms")
        axes.plot([row["time_s"] for row in published], [row["z_in"] for row in published], "ko", mfc="none",
                  label="BeamDyn, steps of 5 ms")
        axes.set(xlabel="time [s]", ylabel="z of the tip [in]", ylim=(0, 3.2))
        axes.legend(fontsize="small", ncol=2)

    case.draw(draw)
