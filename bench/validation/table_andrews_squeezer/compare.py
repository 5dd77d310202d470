"""Andrews' squeezing mechanism: angles and rates after 0.03 s."""

import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

UNTIL = 0.03  # s
ANGLE, RATE = 5e-8, 0.01  # seven decimals [rad]; five digits of the crank's rate [rad/s]


def run(case, step, record=None):
    """Simulation at the end, its rows, and its processor time [s]."""
    simulation = Simulation(case.scene("squeezer.urdf"), scheme="em4", step=step, tolerance=1e-13)
    start = time.process_time()
    rows = simulation.run(round(UNTIL / step), record=record)
    return simulation, rows, time.process_time() - start


def compare(case):
    published = case.table("numbers.csv")
    for what, unit, step, uncertainty in (("angle", "rad", 2e-5, ANGLE), ("rate", "rad/s", 5e-6, RATE)):
        simulation, _, seconds = run(case, step)
        found = simulation.positions if what == "angle" else simulation.velocities
        for row in published:
            joint = row["joint"]
            key = "angle_rad" if what == "angle" else "rate_rad_s"
            yield Row("%s %s" % (what, joint), row[key], found[simulation.joint_names.index(joint)], uncertainty, unit,
                      "calculated", "steps of %g s, %.1g s of processor time" % (step, seconds))

    def draw(axes):
        names = [row["joint"] for row in published]
        _, rows, _ = run(case, 2e-5, ["joint/%s/position" % name for name in names])
        for column, row in enumerate(published, 1):
            if row["joint"] not in ("beta", "theta"):
                line, = axes[0].plot(1e3 * rows[:, 0], rows[:, column], label=row["joint"])
                axes[0].plot(1e3 * UNTIL, row["angle_rad"], "o", mfc="none", color=line.get_color())
        axes[0].set(xlabel="time [ms]", ylabel="angle [rad]")
        axes[0].legend(fontsize="small", ncol=2)
        cost, errors = [], []
        for step in (2e-4, 1e-4, 5e-5, 2e-5):
            simulation, _, seconds = run(case, step)
            angles = [simulation.positions[simulation.joint_names.index(name)] for name in names]
            cost.append(seconds)
            errors.append(max(abs(numpy.array(angles) - [row["angle_rad"] for row in published])))
        axes[1].loglog(cost, errors, "o-")
        axes[1].set(xlabel="processor time [s]", ylabel="largest error of an angle [rad]")

    case.draw(draw, columns=2)
