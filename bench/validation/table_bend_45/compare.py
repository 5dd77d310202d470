"""The 45 degree bend of Bathe and Bolourchi, beside seven published results."""

import re
import time

import numpy

from flexarm import Simulation, read_scene_text
from flexarm.validation import Row

NAMES = {"bathe": "Bathe and Bolourchi 1979", "simo": "Simo and Vu-Quoc 1986",
         "two_node": "Ibrahimbegovic 1995, two nodes", "three_node": "Ibrahimbegovic 1995, three nodes",
         "exudyn": "Exudyn, 32 elements"}
SHEAR = 5e6
# Kynema's line goes through these three points of the arc.
POINTS = numpy.array([[0, 0], [38.2683, 7.61205], [70.7107, 29.2893]])
KYNEMA = {"ga": 41.6667e5, "gj": 8.333e5, "ei": 8.333e5}


def parabola(pieces):
    """The parabola y(x) through the three points as a <centerline> of short arcs, and its last point."""
    polynomial = numpy.polyfit(*POINTS.T, 2)
    x = numpy.linspace(0, POINTS[-1, 0], pieces + 1)
    line = numpy.column_stack([x, numpy.polyval(polynomial, x) - polynomial[-1]])
    turns = numpy.diff(numpy.arctan(numpy.polyval(numpy.polyder(polynomial), x)))
    arcs = []
    for start, end, turn in zip(line, line[1:], turns):
        across = numpy.array([start[1] - end[1], end[0] - start[0]])
        centre = (start + end) / 2 + across / (2 * numpy.tan(turn / 2))
        arcs.append('<arc to="%.17g %.17g 0" center="%.17g %.17g 0"/>' % (*end, *centre))
    return "<centerline>%s</centerline>" % "".join(arcs), line[-1]


def equilibrium(scene):
    """Place of the tip, and processor time [s]."""
    simulation = Simulation(scene)
    start = time.process_time()
    simulation.solve_static()
    return simulation.probe_poses[0, :3], time.process_time() - start


def compare(case):
    for row in case.table("numbers.csv"):
        tip, seconds = equilibrium(case.scene("bend.urdf", {"load": row["load"], "gj": row["torsion"] * SHEAR}))
        for axis, value in zip("xyz", tip):
            yield Row("%s, %g: %s" % (NAMES[row["source"]], row["load"], axis), row[axis], value, row["uncertainty"],
                      "in", "calculated", "J = %.3f side^4, %.1g s of processor time" % (row["torsion"], seconds))

    centreline, end = parabola(80)
    with open(case.path("bend.urdf"), encoding="utf-8") as file:
        text = re.sub("<centerline>.*</centerline>", centreline, file.read())
    text = re.sub('at="[^"]*"', 'at="%.17g %.17g 0"' % tuple(end), text)
    tip, seconds = equilibrium(read_scene_text(text, "parabola", {**KYNEMA, "elements": 80}))
    circle, _ = equilibrium(case.scene("bend.urdf", KYNEMA))
    for row, value, other in zip(case.table("kynema.csv"), tip - [*end, 0],
                                 circle - [100 * numpy.sin(numpy.pi / 4), 100 - 100 * numpy.cos(numpy.pi / 4), 0]):
        yield Row("Kynema, converged: %s" % row["axis"], row["displacement"], value, 1e-6, "in", "calculated",
                  "on the parabola through Kynema's three points; on the circle %.6f; %.1g s" % (other, seconds))

    def draw(axes):
        def polar(load):
            return equilibrium(case.scene("bend.urdf", {"load": load}))[0]

        loads = numpy.linspace(0, 600, 25)
        change = numpy.array([equilibrium(case.scene("bend.urdf", {"load": load, "gj": 0.141 * SHEAR}))[0] - polar(load)
                              for load in loads])
        axes.axhline(0, color="0.7", lw=0.8)
        for axis, marker in enumerate("os^"):
            line, = axes.plot(loads, change[:, axis], label="%s, J = 0.141" % "xyz"[axis])
            for row in case.table("numbers.csv"):
                axes.plot(row["load"], row["xyz"[axis]] - polar(row["load"])[axis], marker, mfc="none", ms=5,
                          color=line.get_color())
        axes.set(xlabel="force at the tip [lb]", ylabel="tip, less that with J = 1/6 [in]")
        axes.legend(fontsize="small")

    case.draw(draw)
