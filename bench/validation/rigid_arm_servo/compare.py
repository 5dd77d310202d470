"""A rigid arm under a sampled controller: steps of the hub's angle with eight sets of gains."""

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_run
from flexarm.validation.uncertainty import from_trials

FITTED = "rigidarm_K1_9", "rigidarm_k1k3_9"  # the records from whose steps numbers are identified
# Of a reading: digits of the table, and the time between rows of the record. How steps differ is in the scatter of what
# is identified from each of them.
ANGLE, TIME = 0.001, 0.001  # rad; s
NAMES = "inertia", "dry", "delay"
DELAYS = 0.02, 0.025, 0.03, 0.035, 0.04, 0.045, 0.05  # that are tried [s]
HUB = "joint/hub/position"


def respond(case, row, values, until=1.6):
    """Times [s] and angles [rad] after the change of the reference."""
    simulation = Simulation(case.scene("arm.urdf", {**known(row), **dict(zip(NAMES, values))}))
    rows = simulation.run(round(until / simulation.step_size), record=[HUB])
    return rows.T


def metrics(times, angles, row):
    """Largest angle in the direction of the step [rad], time to half of the way to it [s], and last angle [rad]."""
    sense = numpy.sign(row["goal_rad"] - row["start_rad"])
    extremum = sense * numpy.max(sense * angles)
    half = times[numpy.argmax(sense * (angles - (row["start_rad"] + extremum) / 2) > 0)]
    return extremum, half, angles[-1]


def recorded(case, row, until=1.6):
    """Times [s] and measured angles [rad] from the change of the reference on."""
    table = numpy.loadtxt(case.record(row["record"]), comments="%")
    change = numpy.flatnonzero(abs(numpy.diff(table[:, 5])) > 0.1)[int(row["step"]) - 1] + 1
    part = table[change:change + round(1e3 * until)]
    return 1e-3 * (part[:, 0] - part[0, 0]), part[:, 1]


def known(row):
    return {"position_gain": row["K1_V_per_rad"], "rate_gain": row["K3_Vs_per_rad"], "start": row["start_rad"],
            "goal": row["goal_rad"]}


def identify(case, row):
    """Inertia, friction and delay of one step; the delay is in whole milliseconds, so that several are tried."""
    times, angles = recorded(case, row, 0.8)
    tries = []
    for delay in DELAYS:
        estimate = fit_run(case.path("arm.urdf"), {"inertia": 0.0035, "dry": 0.05}, times[::5], {HUB: angles[::5]},
                           {**known(row), "delay": delay})
        values = [*estimate.values, delay]
        found = numpy.interp(times, *respond(case, row, values, 0.8))
        tries.append((((found - angles) ** 2).sum(), values))
    return min(tries)[1]


def compare(case):
    rows = case.table("numbers.csv")
    trials = [identify(case, row) for row in rows if row["record"] in FITTED]
    estimate = from_trials(trials)
    for label, factor, unit, value, error, values in zip(
            ("inertia (published: 0.0035)", "dry friction", "delay of the loop"), (1, 1, 1e3),
            ("kg m^2", "N m", "ms"), estimate.values, estimate.standard_errors, zip(*trials)):
        each = ", ".join("%.4g" % (factor * one) for one in values)
        case.identify(label, factor * value, unit, "the steps of K1_9 and k1k3_9: %s; for one more step" % each,
                      factor * error)
    for row in rows:
        found, parts = estimate.predict(lambda x: metrics(*respond(case, row, x), row))
        for label, key, value, own, unit, part, group in zip(
                ("largest angle", "time to half", "angle after 1.6 s"), ("extremum_rad", "half_s", "end_rad"), found,
                (ANGLE, TIME, ANGLE), ("rad", "s", "rad"), parts, ("largest angle", "time", "last angle")):
            yield Row("%s, step %d: %s" % (row["record"][9:], row["step"], label), row[key], value, own, unit,
                      note="own: reading", is_fitted=row["record"] in FITTED, group=group, propagated=part)
    case.draw(lambda axes: draw(case, axes, rows, estimate.values), columns=4, rows=2, width=3.2, height=2.5)


def draw(case, axes, rows, values):
    for each, row in zip(axes, rows[::2]):
        times, angles = respond(case, row, values)
        each.plot(*recorded(case, row), color="#D55E00", label="measured")
        each.plot(times, angles, color="black", linewidth=0.9, label="flexarm")
        each.axhline(row["goal_rad"], color="gray", linewidth=0.5)
        each.set(title=row["record"][9:], xlabel="time [s]", ylabel="angle [rad]", xlim=(0, 0.8))
    axes[0].legend(fontsize=8)
