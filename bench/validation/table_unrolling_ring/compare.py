"""A ring that is unrolled by a moment at its end."""

import math
import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

EI, LENGTH = 100, 10
CUT = 0.001  # three decimals, cut


def unrolled(case, moment):
    """Simulation of the ring in equilibrium under the moment, and processor time [s]."""
    simulation = Simulation(case.scene("ring.urdf", {"moment": moment}))
    start = time.process_time()
    simulation.solve_static()
    return simulation, time.process_time() - start


def exact(moment):
    """The arc of a circle whose curvature is that of the ring less M/EI."""
    curvature = 2 * math.pi / LENGTH - moment / EI
    if abs(curvature) < 1e-12:
        return LENGTH, 0.0
    return math.sin(curvature * LENGTH) / curvature, (1 - math.cos(curvature * LENGTH)) / curvature


def compare(case):
    for row in case.table("numbers.csv"):
        moment = row["moment"] * math.pi
        simulation, seconds = unrolled(case, moment)
        for name, value, closed in zip(("along", "across"), simulation.probe_poses[0], exact(moment)):
            what = "M = %g pi: %s" % (row["moment"], name)
            yield Row(what, row[name], value, CUT, "-", "closed form", "%.1g s of processor time" % seconds)
            yield Row(what + ", all digits", closed, value, 1e-5, "-", "closed form", "an arc of a circle")

    def draw(axes):
        for moment in numpy.linspace(0, 20 * math.pi, 6):
            simulation, _ = unrolled(case, moment)
            line = numpy.vstack([simulation.beam_points(link)["pose"][:, :3] for link in simulation.flexible_links])
            axes.plot(line[:, 0], line[:, 1], label="%.0f $\\pi$" % (moment / math.pi))
        axes.set_aspect("equal")
        axes.legend(fontsize="small", ncol=2)

    case.draw(draw)
