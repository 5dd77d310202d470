"""The load at which the deep arch of DaDeppo and Schmidt snaps through."""

import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

NAMES = {"dadeppo": ("DaDeppo and Schmidt 1975", "closed form"), "three_node": ("Ibrahimbegovic 1995", "calculated")}


def equilibrium(case, load):
    """Place of the crown, and the fourth power of the lowest frequency."""
    simulation = Simulation(case.scene("arch.urdf", {"load": load}))
    simulation.solve_static(stable=False)
    return simulation.probe_poses[0, :2], simulation.natural_modes(1)[0].frequency ** 4


def limit_load(case):
    """At a limit point the square of the lowest frequency vanishes as a root of the load, its fourth power as a line.

    Each load is four fifths of the way from the one before to where the line of the last two ends.
    """
    loads = [880.0, 890.0]
    powers = [equilibrium(case, load)[1] for load in loads]
    for _ in range(6):
        end = loads[-1] + powers[-1] * (loads[-1] - loads[-2]) / (powers[-2] - powers[-1])
        loads.append(loads[-1] + 0.8 * (end - loads[-1]))
        powers.append(equilibrium(case, loads[-1])[1])
    return end


def compare(case):
    start = time.process_time()
    limit = limit_load(case)
    seconds = time.process_time() - start
    for row in case.table("numbers.csv"):
        name, kind = NAMES[row["source"]]
        yield Row("load at which it snaps, %s" % name, row["load"], limit, row["uncertainty"], "-", kind,
                  "the last digit; %.1g s of processor time for eight equilibria with modes" % seconds)

    def draw(axes):
        loads = numpy.r_[numpy.linspace(0, 880, 23), numpy.linspace(885, limit - 0.02, 25)]
        places = numpy.array([equilibrium(case, load)[0] for load in loads])
        axes.plot(-places[:, 0], loads, label="to the side")
        axes.plot(100 - places[:, 1], loads, label="down")
        axes.axhline(897, color="0.5", ls="--", label="DaDeppo and Schmidt")
        axes.set(xlabel="way of the crown", ylabel="load")
        axes.legend(fontsize="small")

    case.draw(draw)
