"""Records of the slewing arm: a step of the reference, and its numbers."""

import os
import shutil
import tempfile

import numpy

BEFORE, AFTER = 0.1, 2.4  # the step of the reference; from the records [s]


class Step:
    """A step of the reference in a record: times [s], voltage [V], hub's angle [rad] and tip's deflection [m]."""

    def __init__(self, case, row):
        """row: of numbers.csv."""
        table = numpy.loadtxt(case.record(row["record"]), comments="%")
        change = numpy.flatnonzero(abs(numpy.diff(table[:, 5])) > 0.1)[int(row["step"]) - 1] + 1
        part = table[change - round(1e3 * BEFORE):change + round(1e3 * AFTER)]
        self.rig = "unit 6" if "Unit6" in row["record"] else "unit 7"
        self.name = "%s, step %d" % (self.rig, row["step"])
        self.times = 1e-3 * (part[:, 0] - part[0, 0])
        self.voltage, self.hub, self.tip = part[:, 6], part[:, 1], row["sign"] * part[:, 2]
        self.start = self.hub[:50].mean()


def metrics(times, hub, tip, start, end):
    """Time to 90 % of the step, extremum of the hub, and first and second extremum of the tip with their times."""
    after = times >= BEFORE
    t, part = times[after] - BEFORE, (hub[after] - start) / (end - start)
    sense = numpy.sign(end - start)
    first = numpy.argmin(numpy.where(t < 0.35, sense * tip[after], numpy.inf))
    second = numpy.argmax(numpy.where((t > 0.3) & (t < 0.8), sense * tip[after], -numpy.inf))
    return {"t90_s": t[numpy.argmax(part >= 0.9)], "hub_extremum_rad": start + (end - start) * part.max(),
            "tip1_m": tip[after][first], "t1_s": t[first], "tip2_m": tip[after][second], "t2_s": t[second]}


class Arm:
    """The scene of a case with columns of a step in its table, in a folder of its own."""

    def __init__(self, case, step, table, columns):
        """table: name of the file. columns: by their names, shape (rows,) each; the first is the time [s]."""
        self._folder = tempfile.TemporaryDirectory()
        self.path = shutil.copy(case.path("arm.urdf"), self._folder.name)
        self.step = step
        numpy.savetxt(os.path.join(self._folder.name, table), numpy.column_stack(list(columns.values())), "%.9g", ",",
                      header=",".join(columns), comments="")


def predict(run, numbers, estimate, step=1.0):
    """Numbers of curves, their uncertainties by an Estimate (see Estimate.predict), and the curves themselves.

    run: gives curves by the dictionary of the values. numbers: of curves, a list.
    """
    curves = []  # of the values themselves, then of their neighbours

    def model(x):
        curves.append(run(dict(zip(estimate.names, x))))
        return numbers(curves[-1])

    return (*estimate.predict(model, step), curves[0])
