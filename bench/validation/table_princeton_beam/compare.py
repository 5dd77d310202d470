"""The beam of the Princeton experiment, beside beam and solid elements of ANSYS."""

import time

import numpy

from flexarm import Simulation
from flexarm.validation import Row


def tip(case, row, **parameters):
    """Displacement along the higher side and across it [m], and processor time [s]."""
    loads = {"load": row["load_n"], "angle": row["angle_deg"]}
    simulation = Simulation(case.scene("princeton_beam.urdf", {**loads, **parameters}))
    start = time.process_time()
    simulation.solve_static()
    return -simulation.probe_poses[0, 1], simulation.probe_poses[0, 2], time.process_time() - start


def compare(case):
    rows = case.table("numbers.csv")
    # What the source's three calculations differ by at most.
    apart = {(other, axis): max(abs(row["beam_%s_m" % axis] - row["%s_%s_m" % (other, axis)]) for row in rows)
             for other in ("exudyn", "solid") for axis in "yz"}
    for row in rows:
        *place, seconds = tip(case, row)
        for axis, value in zip("yz", place):
            for which, other in (("beam", "exudyn"), ("solid", "solid")):
                published = row["%s_%s_m" % (which, axis)]
                if published:
                    what = "%.5g N at %g deg: %s, %s" % (row["load_n"], row["angle_deg"], axis, which)
                    yield Row(what, 1e3 * published, 1e3 * value, 1e3 * apart[other, axis], "mm", "calculated",
                              "difference of the calculations in the source; %.1g s" % seconds)

    def draw(axes):
        for load, colour in ((8.896, "#0072B2"), (13.345, "#D55E00")):
            some = [row for row in rows if row["load_n"] == load]
            angles = numpy.linspace(0, 90, 31)
            curves = numpy.array([tip(case, {"load_n": load, "angle_deg": angle})[:2] for angle in angles])
            for column, axis in enumerate("yz"):
                axes[0].plot(angles, 1e3 * curves[:, column], "-" if axis == "z" else "--", color=colour,
                             label="%s, %.4g N" % (axis, load))
                axes[0].plot([row["angle_deg"] for row in some], [1e3 * row["beam_%s_m" % axis] for row in some], "o",
                             mfc="none", color=colour)
        axes[0].set(xlabel="angle of the load [deg]", ylabel="displacement of the tip [mm]")
        axes[0].legend(fontsize="small")
        factors = numpy.linspace(0.98, 1.06, 9)
        worst = [max(max(abs(place - row["beam_%s_m" % axis]) for axis, place in
                         zip("yz", tip(case, row, torsion=factor * 0.2789805))) for row in rows) for factor in factors]
        axes[1].plot(factors, 1e3 * numpy.array(worst), "o-")
        axes[1].set(xlabel="torsion constant over Saint-Venant's", ylabel="largest difference from ANSYS's beams [mm]",
                    ylim=(0, None))

    case.draw(draw, columns=2)
