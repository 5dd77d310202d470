"""A silicone cantilever that is let go: static drop, period, decay, largest drop."""

import numpy

from flexarm import Simulation
from flexarm.validation import MissingRecord, Row
from flexarm.validation.fits import fit_numbers

FITTED = "load52_a"  # the run from which numbers are identified
MARKERS = 0.007  # height of the mean of the markers above the beam's axis [m]
# The two runs with each weight differ by up to 3 % (static), 6.5 % (largest drop) and 1.3 % (period, of samples at
# 100 Hz). Held by hand, the level start differs by 0.5 mm from run to run. The weight's shape is not known: its centre
# is at the edge or up to 10 mm above, which is 2 % of the period.
STATIC, LARGEST, PERIOD, LEVEL = 0.03, 0.065, 0.025, 0.5  # three relative ones; [mm]
DECAY = 0.006  # of the damping ratio: spread over the runs and over halves of a run


def static_drop(case, young, load):
    """Drop of the markers in equilibrium [mm]."""
    simulation = Simulation(case.scene("cantilever.urdf", {"young": young, "load": load}))
    simulation.solve_static()
    return 1e3 * (MARKERS - simulation.probe_poses[0, 2])


def release(case, young, retardation, load, until=2.0):
    """Times [s] and drop of the markers [mm] after the release from the level."""
    simulation = Simulation(case.scene("cantilever.urdf", {"young": young, "load": load, "retardation": retardation}))
    rows = simulation.run(round(until / simulation.step_size), record=["probe/middle/z"])
    return rows[:, 0], 1e3 * (MARKERS - rows[:, 1])


def extrema(times, drop):
    """Times and values of the local extrema of a decaying oscillation, refined by parabolas."""
    inner = numpy.flatnonzero((drop[1:-1] - drop[:-2]) * (drop[2:] - drop[1:-1]) <= 0) + 1
    before, at, after = drop[inner - 1], drop[inner], drop[inner + 1]
    bend = before - 2 * at + after
    shift = 0.5 * (before - after) / bend
    return times[inner] + shift * (times[1] - times[0]), at - 0.125 * (before - after) ** 2 / bend


def motion(case, young, retardation, load):
    """Largest drop [mm], period [s] of the first cycles, and damping ratio of eight half cycles."""
    times, drop = release(case, young, retardation, load)
    at, values = extrema(times, drop)
    return drop.max(), (at[6] - at[0]) / 3, damping_ratio(abs(values[:8] - static_drop(case, young, load)))


def damping_ratio(half_cycles):
    """Of the decay of amplitudes from half cycle to half cycle."""
    slope = numpy.polyfit(numpy.arange(len(half_cycles)), numpy.log(half_cycles), 1)[0]
    return -slope / numpy.pi


def compare(case):
    runs = case.table("numbers.csv")
    for run in runs:
        run["damping"] = damping_ratio([float(text) for text in run["half_cycles_mm"].split()])
    young, fast, retardation = identify(case, next(run for run in runs if run["run"] == FITTED))
    for run in runs:
        is_fitted = run["run"] == FITTED
        yield Row(run["run"] + ": static drop", run["static_mm"], static_drop(case, young, run["load_kg"]),
                  numpy.hypot(STATIC * run["static_mm"], LEVEL), "mm", note="repeats, level by hand",
                  is_fitted=is_fitted, group="static drop")
        largest, period, ratio = motion(case, fast, retardation, run["load_kg"])
        yield Row(run["run"] + ": period", run["period_s"], period, PERIOD * run["period_s"], "s",
                  note="repeats, samples at 100 Hz, shape of the weight", is_fitted=is_fitted, group="period")
        yield Row(run["run"] + ": damping ratio", run["damping"], ratio, DECAY, "1", note="spread",
                  is_fitted=is_fitted, group="damping")
        yield Row(run["run"] + ": largest drop", run["largest_mm"], largest,
                  numpy.hypot(LARGEST * run["largest_mm"], LEVEL), "mm", note="repeats, level by hand",
                  group="largest drop")
    case.draw(lambda axes: draw(case, axes, runs, fast, retardation), columns=3, width=3.6)


def identify(case, run):
    """Modulus of the static drop, and modulus and retardation of the motion; tells them."""
    (young,), (error,) = fit_numbers(lambda x: [static_drop(case, x[0], run["load_kg"])], [270e3], [run["static_mm"]],
                                     [STATIC * run["static_mm"]])
    case.identify("Young's modulus at rest", young / 1e3, "kPa", "the static drop of " + run["run"], error / 1e3)
    (fast, retardation), errors = fit_numbers(
        lambda x: motion(case, x[0], x[1], run["load_kg"])[1:], [300e3, 0.004], [run["period_s"], run["damping"]],
        [PERIOD * run["period_s"], DECAY])
    case.identify("Young's modulus in motion", fast / 1e3, "kPa", "the period of " + run["run"], errors[0] / 1e3)
    case.identify("retardation time", 1e3 * retardation, "ms", "the decay of " + run["run"], 1e3 * errors[1])
    return young, fast, retardation


def draw(case, axes, runs, fast, retardation):
    for each, load in zip(axes, sorted({run["load_kg"] for run in runs})):
        for run in (run for run in runs if run["load_kg"] == load):
            try:
                path = case.record("silicone_cantilever_%s.csv" % run["run"])
            except MissingRecord:
                continue
            record = numpy.genfromtxt(path, delimiter=",", skip_header=2)
            first, height = int(run["release"]) - 1, record[:, [1, 4, 7]].mean(axis=1)
            each.plot(record[first:first + 150, 0] - record[first, 0], height[:30].mean() - height[first:first + 150],
                      ".", markersize=3, label="measured, " + run["run"][-1])
        times, drop = release(case, fast, retardation, load, 1.5)
        each.plot(times, drop, color="black", linewidth=1, label="flexarm")
        for run in runs:
            if run["load_kg"] == load:
                each.axhline(run["static_mm"], color="gray", linewidth=0.5)
        each.set(title="%g g" % (1e3 * load), xlabel="time [s]", ylabel="drop of the tip [mm]")
        each.invert_yaxis()
        each.legend(fontsize=7)
