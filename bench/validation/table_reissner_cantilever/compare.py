"""The cantilever under a force across its tip, beside closed solutions."""

import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

ELASTICA = 1e8  # GA L^2/EI which is as good as infinite: it changes the ninth decimal
NAMES = {"batista": "Batista 2016", "mattiasson": "Mattiasson 1981"}


def tip(case, load, shear):
    """Shortening and drop, and processor time [s]."""
    simulation = Simulation(case.scene("cantilever.urdf", {"load": load, "ga": shear}))
    start = time.process_time()
    simulation.solve_static()
    place = simulation.probe_poses[0]
    return 1 - place[0], place[1], time.process_time() - start


def compare(case):
    rows = case.table("numbers.csv")
    for row in rows:
        shear = row["shear"] or ELASTICA
        shortening, drop, seconds = tip(case, row["load"], shear)
        what = "%s, P = %g%s: " % (NAMES[row["source"]], row["load"], ", GA = %g" % shear if row["shear"] else "")
        for key, value in (("shortening", shortening), ("drop", drop)):
            yield Row(what + key, row[key], value, row["uncertainty"], "L", "closed form",
                      "the last digit; %.1g s of processor time" % seconds)

    def draw(axes):
        loads = numpy.linspace(0, 10, 41)
        curves = numpy.array([tip(case, load, ELASTICA)[:2] for load in loads])
        for column, key in enumerate(("shortening", "drop")):
            line, = axes[0].plot(loads, curves[:, column], label=key)
            some = [row for row in rows if not row["shear"]]
            axes[0].plot([row["load"] for row in some], [row[key] for row in some], "o", mfc="none",
                         color=line.get_color())
        axes[0].set(xlabel="P L$^2$/EI", ylabel="lengths")
        axes[0].legend(fontsize="small")
        shears = numpy.logspace(-0.4, 2, 30)
        curves = numpy.array([tip(case, 1, shear)[:2] for shear in shears])
        for column, key in enumerate(("shortening", "drop")):
            line, = axes[1].semilogx(shears, curves[:, column])
            some = [row for row in rows if row["shear"]]
            axes[1].plot([row["shear"] for row in some], [row[key] for row in some], "o", mfc="none",
                         color=line.get_color())
        axes[1].set(xlabel="GA L$^2$/EI, at P L$^2$/EI = 1")

    case.draw(draw, columns=2)
