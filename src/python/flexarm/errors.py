"""Exceptions and warnings of the package."""

import typing

import numpy


class SceneWarning(UserWarning):
    """Something about a scene, its start or its equilibrium is doubtful."""


class SceneError(ValueError):
    """A scene cannot be used. The text has one line for each error, with file and line."""


class StepError(RuntimeError):
    """A step has failed, or no equilibrium was found. The simulation is at its last good state and can still be used.

    The text says what failed, where and when, what was tried, and what usually helps.
    time: of the last good state [s].
    reason: a few words.
    rows: what run() has recorded until then, shape (rows, columns); None if it records nothing.
    """

    def __init__(self, text: str, time: float, reason: str, rows: typing.Optional[numpy.ndarray] = None) -> None:
        super().__init__(text, time, reason, rows)
        self.time, self.reason, self.rows = time, reason, rows

    def __str__(self) -> str:
        return str(self.args[0])


class AccuracyError(RuntimeError):
    """run_to_accuracy() or tune() has not reached its goal.

    After run_to_accuracy(), the simulation is at the end of the last try.
    estimate: of the error of the last try, relative; NaN: unknown.
    rows: what run_to_accuracy() has recorded, shape (intervals + 1, columns); None if it records nothing.
    """

    def __init__(self, text: str, estimate: float, rows: typing.Optional[numpy.ndarray] = None) -> None:
        super().__init__(text, estimate, rows)
        self.estimate, self.rows = estimate, rows

    def __str__(self) -> str:
        return str(self.args[0])


class ResultsError(ValueError):
    """A file of results cannot be read, or its columns not be drawn. The text says what was expected."""
