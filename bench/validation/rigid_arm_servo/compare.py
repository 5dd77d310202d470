"""A rigid arm under a sampled controller: steps of the hub's angle with eight sets of gains."""

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_run

FITTED = "rigidarm_K1_9", 1  # the step from which numbers are identified
# The two steps of a record, there and back, differ by 0.03 rad (one by 0.05) in the size of the last angle, where
# friction holds the arm, and by up to 34 ms in time.
ANGLE, TIME = 0.03, 0.034  # rad; s
DELAYS = 0.02, 0.025, 0.03, 0.035, 0.04, 0.045, 0.05  # that are tried [s]
HUB = "joint/hub/position"


def respond(case, row, values, until=1.6):
    """Times [s] and angles [rad] after the change of the reference."""
    simulation = Simulation(case.scene("arm.urdf", {**known(row), **values}))
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
    """Inertia, friction and delay, from one step; the delay is in whole milliseconds, so that several are tried."""
    times, angles = recorded(case, row, 0.8)
    tries = []
    for delay in DELAYS:
        values, errors = fit_run(case.path("arm.urdf"), {"inertia": 0.0035, "dry": 0.05}, times[::5],
                                 {HUB: angles[::5]}, {**known(row), "delay": delay})
        values["delay"] = delay
        found = numpy.interp(times, *respond(case, row, values, 0.8))
        tries.append((((found - angles) ** 2).sum(), values, errors))
    _, values, errors = min(tries, key=lambda each: each[0])
    name = "%s, step %d" % FITTED
    case.identify("inertia (published: 0.0035)", values["inertia"], "kg m^2", name, errors["inertia"])
    case.identify("dry friction", values["dry"], "N m", name, errors["dry"])
    case.identify("delay of the loop", 1e3 * values["delay"], "ms", name)
    return values


def compare(case):
    rows = case.table("numbers.csv")
    values = identify(case, next(row for row in rows if (row["record"], row["step"]) == FITTED))
    for row in rows:
        name = "%s, step %d: " % (row["record"][9:], row["step"])
        is_fitted = (row["record"], row["step"]) == FITTED
        extremum, half, end = metrics(*respond(case, row, values), row)
        yield Row(name + "largest angle", row["extremum_rad"], extremum, ANGLE, "rad",
                  note="steps of a record differ by this", is_fitted=is_fitted, group="largest angle")
        yield Row(name + "time to half", row["half_s"], half, TIME, "s", note="steps of a record differ by this",
                  is_fitted=is_fitted, group="time")
        yield Row(name + "angle after 1.6 s", row["end_rad"], end, ANGLE, "rad", note="friction holds the arm",
                  is_fitted=is_fitted, group="last angle")
    case.draw(lambda axes: draw(case, axes, rows, values), columns=4, rows=2, width=3.2, height=2.5)


def draw(case, axes, rows, values):
    for each, row in zip(axes, rows[::2]):
        times, angles = respond(case, row, values)
        each.plot(*recorded(case, row), color="#D55E00", label="measured")
        each.plot(times, angles, color="black", linewidth=0.9, label="flexarm")
        each.axhline(row["goal_rad"], color="gray", linewidth=0.5)
        each.set(title=row["record"][9:], xlabel="time [s]", ylabel="angle [rad]", xlim=(0, 0.8))
    axes[0].legend(fontsize=8)
