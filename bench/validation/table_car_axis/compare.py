"""The car axis: places and velocities of its masses at t = 3."""

import time

from flexarm import Simulation
from flexarm.validation import Row

UNTIL, STEP = 3, 5e-4
PLACE, VELOCITY = 5e-9, 1e-4  # eight decimals; four decimals, since velocities are of second order


def compare(case):
    simulation = Simulation(case.scene("car_axis.urdf"), scheme="em4", step=STEP, tolerance=1e-12)
    start = time.process_time()
    rows = simulation.run(round(UNTIL / STEP), record=["probe/left/[xy]", "probe/right/[xy]"])
    note = "steps of %g, %.1g s of processor time" % (STEP, time.process_time() - start)
    published = case.table("numbers.csv")
    for row in published:
        point, axis = simulation.probe_names.index(row["point"]), "xy".index(row["axis"])
        name = "%s of the %s mass" % (row["axis"], row["point"])
        yield Row(name, row["place"], simulation.probe_poses[point, axis], PLACE, "-", "calculated", note)
        yield Row("velocity, " + name, row["velocity"], simulation.probe_velocities[point, axis], VELOCITY, "-",
                  "calculated", note)

    def draw(axes):
        for column, row in enumerate(published, 1):
            line, = axes.plot(rows[:, 0], rows[:, column], label="%s, %s" % (row["point"], row["axis"]))
            axes.plot(UNTIL, row["place"], "o", mfc="none", color=line.get_color())
        axes.set(xlabel="time", ylabel="place")
        axes.legend(fontsize="small")

    case.draw(draw)
