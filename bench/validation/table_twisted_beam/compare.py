"""The twisted beam of BeamDyn."""

import time

from flexarm import Simulation
from flexarm.validation import Row

SOLID = 0.01  # see numbers.csv


def compare(case):
    simulation = Simulation(case.scene("twisted_beam.urdf", {"elements": 30}))
    start = time.process_time()
    simulation.solve_static()
    note = "%.1g s of processor time" % (time.process_time() - start)
    rows = case.table("numbers.csv")
    for row, place, free in zip(rows, simulation.probe_poses[0], (10, 0, 0)):
        yield Row("%s, beam" % row["axis"], row["beam_m"], place - free, 1e-8, "m", "calculated", note)
        yield Row("%s, solid" % row["axis"], row["solid_m"], place - free, SOLID * abs(row["solid_m"]), "m",
                  "calculated", "1 %: beam and solid in the source")

    def draw(axes):
        counts, errors = [2, 4, 8, 16], []
        for count in counts:
            coarse = Simulation(case.scene("twisted_beam.urdf", {"elements": count}))
            coarse.solve_static()
            errors.append(max(abs(place - free - row["beam_m"])
                              for row, place, free in zip(rows, coarse.probe_poses[0], (10, 0, 0))))
        axes.loglog(counts, errors, "o-", label="order 3")
        line = [errors[0] * (count / counts[0]) ** -6.0 for count in counts]
        axes.loglog(counts, line, "0.6", ls="--", label="slope -6")
        axes.set(xlabel="elements", ylabel="largest difference from BeamDyn [m]")
        axes.legend(fontsize="small")

    case.draw(draw)
