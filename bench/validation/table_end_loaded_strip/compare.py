"""The cantilevers of Sze, Liu and Lo."""

import math
import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

# One in the last digit, since the elements are not the same; the last digit.
DIGITS = {"force": 0.001, "moment": 0.00051}
CONVERGED, SIXTEEN = {"elements": 10, "order": 3}, {"elements": 16, "order": 1}


def tips(case, rows, mesh, length, **load):
    """Shortening and drop for each row, shape (rows, 2), and processor time [s]."""
    found, seconds = [], 0
    for row in rows:
        loads = {name: value * row["fraction"] for name, value in load.items()}
        simulation = Simulation(case.scene("strip.urdf", {"length": length, "force": 0, **loads, **mesh}))
        start = time.process_time()
        simulation.solve_static()
        seconds += time.process_time() - start
        found.append([length - simulation.probe_poses[0, 0], simulation.probe_poses[0, 2]])
    return numpy.array(found), seconds


def compare(case):
    force, moment = case.table("force.csv"), case.table("moment.csv")
    coarse, _ = tips(case, force, SIXTEEN, 10, force=4)
    fine, _ = tips(case, force, CONVERGED, 10, force=4)
    rolled, seconds = tips(case, moment, CONVERGED, 12, moment=50 * math.pi / 3)
    for name, rows, found, kind, note in (
            ("force", force, coarse, "calculated", "on the mesh of the source, sixteen linear elements"),
            ("moment", moment, rolled, "closed form", "all twenty equilibria: %.1g s of processor time" % seconds)):
        for row, values, converged in zip(rows, found, fine if name == "force" else found):
            if round(100 * row["fraction"]) % 25 == 0:
                for key, value, other in zip(("shortening", "drop"), values, converged):
                    yield Row("%s %g: %s" % (name, row["fraction"], key), row[key], value, DIGITS[name], "-", kind,
                              note + ("; converged: %.4f" % other if name == "force" else ""))
        published = numpy.array([[row["shortening"], row["drop"]] for row in rows])
        yield Row("%s: largest of all forty differences" % name, 0, abs(found - published).max(), DIGITS[name], "-",
                  kind, note)

    def draw(axes):
        for plot, rows, found, what in ((axes[0], force, fine, "force/4"),
                                        (axes[1], moment, rolled, "moment/(50$\\pi$/3)")):
            fractions = [row["fraction"] for row in rows]
            for column, key in enumerate(("shortening", "drop")):
                line, = plot.plot(fractions, found[:, column], label=key)
                plot.plot(fractions, [row[key] for row in rows], "o", mfc="none", ms=4, color=line.get_color())
            plot.set(xlabel=what)
            plot.legend(fontsize="small")

    case.draw(draw, columns=2)
