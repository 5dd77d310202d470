"""What can go wrong: exceptions and warnings."""

import typing

import numpy


class SceneWarning(UserWarning):
    """Something about a scene, its start or its equilibrium is doubtful."""


class SceneError(ValueError):
    """A scene cannot be used; the text says what is wrong with it, one line for each finding, with file and line."""


class StepError(RuntimeError):
    """A step has failed, or there is no equilibrium; the simulation is at its last good state and can be used on.

    The text says what failed, where, when, what was tried, and what usually helps.
    time: of the last good state [s].
    reason: in a few words.
    rows: what run() had recorded until then, shape (rows, columns); None if it records nothing.
    """

    def __init__(self, text: str, time: float, reason: str, rows: typing.Optional[numpy.ndarray] = None) -> None:
        super().__init__(text, time, reason, rows)
        self.time, self.reason, self.rows = time, reason, rows

    def __str__(self) -> str:
        return str(self.args[0])


class AccuracyError(RuntimeError):
    """run_to_accuracy() has given up, the simulation being at the end of its last try; or tune() has.

    estimate: of the error of that, relative; NaN: unknown.
    rows: that run_to_accuracy() has recorded, shape (intervals + 1, columns); None if it records nothing.
    """

    def __init__(self, text: str, estimate: float, rows: typing.Optional[numpy.ndarray] = None) -> None:
        super().__init__(text, estimate, rows)
        self.estimate, self.rows = estimate, rows

    def __str__(self) -> str:
        return str(self.args[0])
