"""A drive with friction (EMPS): the force that holds a constant velocity."""

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.uncertainty import coverage_factor

OFFSET = -3.1648  # of the motor's force, of the authors [N]


def force(case, velocity, acceleration=0.0):
    """The drive's force while the axis moves so [N]."""
    simulation = Simulation(case.scene("axis.urdf", {"velocity": velocity, "acceleration": acceleration}))
    rows = simulation.run(50, record=["joint/axis/effort"])
    return rows[-1, 1]


def scatter(curves):
    """Expanded uncertainty of a bin, from how bins scatter about a smooth curve, by their second differences [N].

    These have 6 times the variance of independent bins (von Neumann's method, with differences of second order).
    """
    bends = numpy.concatenate([numpy.diff(curve, 2) for curve in curves])
    return coverage_factor(len(bends)) * numpy.sqrt(numpy.mean(bends ** 2) / 6)


def compare(case):
    rows = case.table("numbers.csv")
    values = {parameter.name: parameter.value for parameter in case.scene("axis.urdf").parameters}
    expected = values["mass"] * 0.8 + values["viscous"] * 0.04 + values["dry"]
    yield Row("force at 0.04 m/s and 0.8 m/s^2", expected, force(case, 0.0, 0.8), 1e-9 * expected, "N", "closed form",
              "round-off")
    found = [force(case, row["velocity"]) + OFFSET for row in rows]
    own = scatter([[row["force"] for row in rows if row["velocity"] * side > 0] for side in (-1, 1)])
    for row, value in zip(rows, found):
        yield Row("force at %.3f m/s" % row["velocity"], row["force"], value, own, "N",
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
