"""A steel strip that a robot moves: frequencies flat, up and down, and the force on the flange after the move."""

import math
import os
import shutil
import sys
import tempfile

import numpy

from flexarm import Simulation, read_scene
from flexarm.validation import Row
from flexarm.validation.fits import fit_run

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from robot import Log  # noqa: E402

PITCH = {"flat": 0.0, "up": -math.pi / 2, "down": math.pi / 2}
# The authors give Young's modulus as 190 to 205 GPa, 4 % of the frequency at the most; 0.02 mm of 1 mm are 2 %.
NOMINAL = 0.04
# Within a record the frequency changes by 0.04 Hz while the robot's joints, which give a little, come to rest.
WANDER = 0.02  # Hz
# Force by the torque of a joint: repeats have a standard deviation of 4 %, twice that counts; friction shows as
# scatter of 0.05 Nm at levers of 0.4 m.
FORCE, FRICTION = 0.08, 0.15  # relative; N
EARLY, LATE = (2.0, 3.5), (7.0, 10.0)  # windows of the records [s]
FITTED = "flat", 15  # the log from which numbers are identified
SETTLED = 0.3  # after the robot has come to rest [s]


class Strip:
    """A scene with the motion of a log, in a folder of its own."""

    def __init__(self, case, log, pitch):
        self._folder = tempfile.TemporaryDirectory()
        self.path = shutil.copy(case.path("strip.urdf"), self._folder.name)
        log.write_motion(os.path.join(self._folder.name, "flange.csv"))
        self.pitch = pitch

    def run(self, until, **values):
        """Times [s] and force on the flange [N]."""
        simulation = Simulation(read_scene(self.path, {"pitch": self.pitch, **values}))
        rows = simulation.run(round(until / simulation.step_size), record=["sensor/root/fz"])
        return rows[:, 0], rows[:, 1]


def sine(times, values, window):
    """Frequency [Hz] and amplitude of the sine, beside a straight line, that fits the values in a window best."""
    from scipy.optimize import minimize_scalar
    inside = (times >= window[0]) & (times <= window[1])
    t, y = times[inside] - window[0], values[inside]

    def solve(frequency):
        angle = 2 * numpy.pi * frequency * t
        basis = numpy.column_stack([numpy.cos(angle), numpy.sin(angle), numpy.ones_like(t), t])
        solution, rest, _, _ = numpy.linalg.lstsq(basis, y, rcond=None)
        return rest[0], math.hypot(*solution[:2])

    frequency = minimize_scalar(lambda f: solve(f)[0], bounds=(2.4, 3.5), method="bounded", options={"xatol": 1e-5}).x
    return frequency, solve(frequency)[1]


def frequency_at_rest(case, pitch, **values):
    simulation = Simulation(case.scene("strip.urdf", {"pitch": pitch, "ratio": 0, **values}))
    simulation.solve_static()
    return simulation.natural_modes(1)[0].frequency


def identify(case, strip, log):
    """Young's modulus, damping ratio and drag coefficient, from the first log."""
    still = strip.run(0.002)[1][0]  # the strip's weight
    used = (log.times > log.rest + SETTLED)
    force = numpy.where(used, log.force - log.force[used].mean() + still, numpy.nan)[::10]
    estimate = fit_run(strip.path, {"young": 190e9, "ratio": 0.005, "drag": 5.0}, log.times[::10],
                       {"sensor/root/fz": force}, {"pitch": strip.pitch}, step=0.002)
    for name, unit, factor, value, error in zip(("Young's modulus", "damping ratio", "drag coefficient"),
                                                ("GPa", "", ""), (1e-9, 1, 1), estimate.values,
                                                estimate.standard_errors):
        case.identify(name, factor * value, unit, "the %s log with %g cm" % FITTED, factor * error)
    return estimate


def predict(case, strip, log, estimate):
    """Late frequency, early and late amplitude, and their uncertainties; times and force of the run."""
    curves = []  # of the values themselves, then of their neighbours

    def numbers(x):
        values = dict(zip(estimate.names, x))
        curves.append(strip.run(log.times[-1], **values))
        return [frequency_at_rest(case, strip.pitch, young=values["young"]),
                *(sine(*curves[-1], window)[1] for window in (EARLY, LATE))]

    return (*estimate.predict(numbers), *curves[0])


def compare(case):
    table = case.table("numbers.csv")
    for row in table:
        name = "%s, %g cm" % (row["orientation"], row["move_cm"])
        yield Row(name + ": frequency, Young's modulus as published", row["frequency_hz"],
                  frequency_at_rest(case, PITCH[row["orientation"]]), NOMINAL * row["frequency_hz"], "Hz",
                  note="4 %: Young's modulus, 0.02 mm of thickness", group="frequency")
    curves = {}
    estimate = None
    for row in table:
        name, pitch = "%s, %g cm" % (row["orientation"], row["move_cm"]), PITCH[row["orientation"]]
        log = Log(case.record(row["log"]), int(row["joint"]))
        strip = Strip(case, log, pitch)
        is_first = (row["orientation"], row["move_cm"]) == FITTED
        estimate = identify(case, strip, log) if is_first else estimate
        found, parts, times, force = predict(case, strip, log, estimate)
        curves[name] = log, times, force
        late = sine(log.times, log.force, LATE)
        yield Row(name + ": frequency from %g s on" % LATE[0], late[0], found[0], WANDER, "Hz",
                  note="own: robot's joints give", is_fitted=is_first, group="frequency", propagated=parts[0])
        for i, window, amplitude in ((1, EARLY, sine(log.times, log.force, EARLY)[1]), (2, LATE, late[1])):
            yield Row(name + ": force amplitude, %g to %g s" % window, amplitude, found[i],
                      math.hypot(FORCE * amplitude, FRICTION), "N", note="own: repeats, friction of the joint",
                      is_fitted=is_first, group="force amplitude", propagated=parts[i])
    case.draw(lambda axes: draw(axes, curves), columns=3, rows=3, width=4, height=2.5)


def draw(axes, curves):
    for each, (name, (log, times, force)) in zip(axes, curves.items()):
        seen = log.times > log.rest
        late = log.times > LATE[0]
        each.plot(log.times[seen], log.force[seen] - log.force[late].mean(), linewidth=0.7, color="#D55E00",
                  label="measured")
        each.plot(times, force - force[times > LATE[0]].mean(), linewidth=0.8, color="black", label="flexarm")
        each.set(title=name, xlim=(0, 5), ylim=(-7, 7), xlabel="time [s]", ylabel="force [N]")
    axes[0].legend()
