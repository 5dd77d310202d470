"""A drive with friction (EMPS): the force that holds a constant velocity."""

import numpy

from flexarm import Simulation
from flexarm.validation import Row

OFFSET = -3.1648  # of the motor's force, of the authors [N]
SCATTER = 3.0  # of neighbouring bins of the record [N]


def force(case, velocity, acceleration=0.0):
    """The drive's force while the axis moves so [N]."""
    simulation = Simulation(case.scene("axis.urdf", {"velocity": velocity, "acceleration": acceleration}))
    rows = simulation.run(50, record=["joint/axis/effort"])
    return rows[-1, 1]


def compare(case):
    rows = case.table("numbers.csv")
    values = {parameter.name: parameter.value for parameter in case.scene("axis.urdf").parameters}
    expected = values["mass"] * 0.8 + values["viscous"] * 0.04 + values["dry"]
    yield Row("force at 0.04 m/s and 0.8 m/s^2", expected, force(case, 0.0, 0.8), 1e-9 * expected, "N", "closed form",
              "round-off")
    found = [force(case, row["velocity"]) + OFFSET for row in rows]
    for row, value in zip(rows, found):
        yield Row("force at %.3f m/s" % row["velocity"], row["force"], value, SCATTER, "N",
                  note="scatter of neighbouring bins", group="force")
    case.draw(lambda axes: draw(case, axes, rows))


def draw(case, axes, rows):
    axes.plot([row["velocity"] for row in rows], [row["force"] for row in rows], "o", mfc="none", color="#D55E00",
              label="measured")
    for side in (-1, 1):
        velocities = side * numpy.linspace(0.005, 0.13, 6)
        axes.plot(velocities, [force(case, velocity) + OFFSET for velocity in velocities], color="black",
                  label="flexarm, authors' parameters" if side > 0 else None)
    axes.set(xlabel="velocity [m/s]", ylabel="force [N]")
    axes.legend()
