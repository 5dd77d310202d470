"""The thick cantilever of Nachbagauer and others, bent a little and strongly."""

import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row

ERROR = 0.01  # of the error that they give


def tip(case, load, elements=10):
    """Shortening and drop [m], and processor time [s]."""
    simulation = Simulation(case.scene("cantilever.urdf", {"load": load, "elements": elements}))
    start = time.process_time()
    simulation.solve_static()
    return 2 - simulation.probe_poses[0, 0], simulation.probe_poses[0, 1], time.process_time() - start


def compare(case):
    rows = case.table("numbers.csv")
    for row in rows:
        shortening, drop, seconds = tip(case, row["load_n"])
        what = "%g kN: " % (row["load_n"] / 1000)
        yield Row(what + "drop", row["drop_m"] + row["drop_error_m"], drop, ERROR * row["drop_error_m"], "m",
                  "calculated", "1 %% of their own error, which is added; %.1g s of processor time" % seconds)
        change = row["shortening_m"] - row["shortening_coarse_m"]
        yield Row(what + "shortening", row["shortening_m"] + change / 3, shortening, change / 20, "m", "calculated",
                  "extrapolated from their two finest meshes")

    def draw(axes):
        row = rows[-1]
        exact = row["drop_m"] + row["drop_error_m"]
        counts = numpy.array([1, 2, 3, 4, 6])
        errors = [abs(tip(case, row["load_n"], count)[1] - exact) for count in counts]
        axes.loglog(counts, errors, "o-", label="flexarm, order 3")
        # The errors that the paper gives for 1, 2, 4 and 1024 of its elements.
        axes.loglog([1, 2, 4, 1024], [0.168310, 0.053697, 0.014633, 2.280e-7], "s--", mfc="none", label="the paper")
        axes.set(xlabel="elements", ylabel="error of the drop [m]")
        axes.legend(fontsize="small")

    case.draw(draw)
