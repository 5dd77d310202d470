"""Simulates an experiment: computes what would have been measured for given values of the unknowns."""

import math
import typing

import numpy
from scipy.interpolate import CubicSpline

from .. import Simulation, read_scene
from ..errors import SceneError
from .inputs import InputError

# Times this near to the end of a step (in steps) count as its end, since stamps are rounded.
ROUNDED = 1e-5
MOST_STEPS = 10**7
# Least step per longest step. To end steps at the measurements with smaller ones costs more than a spline between rows.
SHORTEST = 0.25


def choose_step(times, longest):
    """The largest step, at most `longest` [s], of which all `times` are multiples; None: there is none large enough."""
    spacings = numpy.diff(numpy.unique(numpy.append(0.0, times)))
    if not len(spacings):
        return None
    spacing = spacings.min()
    # If the times are a grid, the last time gives its spacing most accurately.
    spacing = times.max() / max(round(times.max() / spacing), 1)
    if spacing < SHORTEST * longest or abs(times / spacing - numpy.round(times / spacing)).max() > ROUNDED:
        return None
    step = spacing / math.ceil(spacing / longest * (1 - ROUNDED))
    return longest if abs(step / longest - 1) < ROUNDED else step


class Sampling:
    """Evaluates columns at any times, from rows of a simulation (one at the start and one after each step).

    If all times are ends of steps, values are taken from these rows. Else they are taken from a cubic spline through
    the rows, with an error of the fourth order in the step.
    """

    def __init__(self, times, step):
        """times: a list of arrays, one for each column [s]."""
        self.steps = max(math.ceil(max(column.max() for column in times) / step - ROUNDED), 1)
        self._times, self._step = times, step
        at = [numpy.round(column / step).astype(int) for column in times]
        self.is_exact = all(abs(column / step - rows).max() <= ROUNDED for column, rows in zip(times, at))
        self.every = int(numpy.gcd.reduce(numpy.concatenate([*at, [self.steps]]))) if self.is_exact else 1
        self._rows = [rows // self.every for rows in at]
        if not self.is_exact:
            self.steps = max(self.steps, 3)  # required by the spline

    def look(self, rows):
        """Values of the columns of `rows` at their times, column after column, shape (values,)."""
        if self.is_exact:
            return numpy.concatenate([rows[at, i] for i, at in enumerate(self._rows)])
        grid = self._step * numpy.arange(self.steps + 1)
        spline = CubicSpline(grid, rows)
        return numpy.concatenate([spline(times)[:, i] for i, times in enumerate(self._times)])


class Setting(typing.NamedTuple):
    """How the scene is simulated. With fixed steps and tolerance, results are smooth functions of the unknowns."""

    scene: str  # path
    values: typing.Dict[str, float]  # of known parameters, which replace the file's
    step: float  # [s]
    tolerance: float


class Experiment:
    """unknowns: of a plan. initial: known coordinates at the start, by JOINT/position and JOINT/velocity.
    measurements: a list of Measurement. efforts: histories by names of joints. setting: a Setting.

    steps, step: of each simulation. is_exact: values are taken at ends of steps. units: of the columns.
    measured: shape (values,): all columns, one after the other, in the order of simulate().
    parts: slices of `measured`, one for each column.
    """

    def __init__(self, unknowns, initial, measurements, efforts, setting):
        self.unknowns, self.measurements = unknowns, measurements
        self.measured = numpy.concatenate([measurement.values for measurement in measurements])
        ends = numpy.cumsum([0] + [len(measurement.values) for measurement in measurements])
        self.parts = [slice(begin, end) for begin, end in zip(ends, ends[1:])]
        self.step = setting.step
        self._setting, self._initial = setting, initial
        times = [measurement.times for measurement in measurements]
        longest = max(column.max() for column in times)
        if longest / setting.step > MOST_STEPS:
            raise InputError("the measurements last until %g s of simulated time, more than %d steps of %g s: 'begin' "
                             "of the plan must be the measured time at which the scene starts"
                             % (longest, MOST_STEPS, setting.step))
        self._sampling = Sampling(times, setting.step)
        self.steps, self.is_exact = self._sampling.steps, self._sampling.is_exact
        simulation = self._simulation([unknown.start for unknown in unknowns])
        self._record = [measurement.column.name for measurement in measurements]
        self._order, self.units = self._columns(simulation)
        self._joints, self._efforts = self._commands(simulation, efforts)

    def _columns(self, simulation):
        """The indices of the columns in a row of results, and their units."""
        for measurement in self.measurements:
            column = measurement.column
            try:
                names = [name for name, _ in simulation.columns([column.name])]
            except ValueError as error:
                raise column.entry.error(str(error)) from None
            if names[1:] != [column.name]:
                raise column.entry.error("expected the name of one column, got those of %s" % ", ".join(names[1:]))
        columns = simulation.columns(self._record)
        names = [name for name, _ in columns]
        order = [names.index(name) for name in self._record]
        return order, [columns[i][1] for i in order]

    def _commands(self, simulation, efforts):
        """Joints, and their efforts in each step, shape (steps, joints); None: efforts are those of the scene."""
        if not efforts:
            return None, None
        for joint in efforts:
            if joint not in simulation.effort_joints:
                raise InputError("efforts are given for '%s': expected joints that take efforts, of %s"
                                 % (joint, ", ".join(simulation.effort_joints)))
        edges = self.step * numpy.arange(self.steps + 1)
        return list(efforts), numpy.column_stack([history.means(edges) for history in efforts.values()])

    def _simulation(self, values):
        setting = self._setting
        given = {unknown.name: float(value) for unknown, value in zip(self.unknowns, values) if not unknown.of_start}
        scene = read_scene(setting.scene, parameters={**setting.values, **given})
        simulation = Simulation(scene, step=setting.step, tolerance=setting.tolerance)
        start = dict(self._initial)
        start.update((unknown.name, value) for unknown, value in zip(self.unknowns, values) if unknown.of_start)
        if start:
            split = {"position": {}, "velocity": {}}
            for name, value in start.items():
                joint, _, suffix = name.rpartition("/")
                split[suffix][joint] = value
            try:
                simulation.set_joint_state(split["position"], split["velocity"])
            except ValueError as error:
                raise InputError("initial: %s" % error) from None
        return simulation

    def simulate(self, values):
        """What would be measured with these values of the unknowns, shape (values,).

        values: shape (unknowns,). May be called by several threads at once.
        Raises flexarm.SceneError, flexarm.StepError or InputError if scene, motion or start are impossible with these.
        """
        simulation = self._simulation(values)
        first = simulation.row(self._record)
        rows = simulation.run(self.steps, self._efforts, self._joints, record=self._record, every=self._sampling.every)
        return self._sampling.look(numpy.vstack([first, rows])[:, self._order])

    def derivatives(self, values):
        """Derivatives of simulate() with respect to the unknowns, shape (values, unknowns), from one run.

        None if a run has no such derivatives: if coordinates of the start are given, at events, or with some schemes
        (docs/notes/sensitivities.md). Raises as simulate() does.
        """
        if self._initial or any(unknown.of_start for unknown in self.unknowns):
            return None
        simulation = self._simulation(values)
        try:
            run = simulation.sensitivities([unknown.name for unknown in self.unknowns])
        except (ValueError, SceneError):
            return None
        first = run.row(self._record)
        rows = run.run(self.steps, self._efforts, self._joints, record=self._record, every=self._sampling.every)
        if run.lost or any(event.doubt for event in run.events):
            return None
        rows = numpy.concatenate([first[None], rows])[:, self._order]
        return numpy.column_stack([self._sampling.look(rows[:, :, i]) for i in range(rows.shape[2])])
