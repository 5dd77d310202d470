"""Pages that play runs in a browser."""

import html
import os
import pathlib
import typing
import webbrowser

from . import _flexarm
from .results import Run

Scene = typing.Union[_flexarm.Scene, str, "os.PathLike[str]"]
Shown = typing.Union[_flexarm.Recording, _flexarm.Simulation, Run]


class Page:
    """An HTML page that plays runs, as one text without references to other files.

    As the last value of a cell of a notebook it is shown there.
    """

    def __init__(self, text: str, height: int = 640) -> None:
        self.text, self.height = text, height

    def save(self, path: typing.Union[str, "os.PathLike[str]"]) -> None:
        """Writes the page to a file. Raises OSError."""
        pathlib.Path(path).write_text(self.text, encoding="utf-8")

    def open(self, path: typing.Union[str, "os.PathLike[str]"]) -> bool:
        """Writes the page to a file and opens it in a browser. Returns whether there is one."""
        self.save(path)
        return webbrowser.open(pathlib.Path(path).resolve().as_uri())

    def _repr_html_(self) -> str:
        return '<iframe srcdoc="%s" style="width: 100%%; height: %dpx; border: 0" allowfullscreen></iframe>' % (
            html.escape(self.text), self.height)


def show(*runs: Shown, scene: typing.Optional[Scene] = None, rate: float = 60.0, height: int = 640,
         at: typing.Optional[float] = None) -> Page:
    """A page that plays runs side by side.

    runs: each is a Recording; or a Simulation, whose present state is shown; or a Run (results of `scene`).
    scene: of the runs that are a Run, as read_scene() gives it, or the path of its file.
    rate: instants of a Run that are shown per second [1/s], at most.
    height: in a notebook [pixels].
    at: time that the page shows first [s]; by default that of the largest strain.
    Raises ValueError if a Run needs a scene and there is none.
    """
    encoded = []
    for run in runs:
        if isinstance(run, Run):
            if scene is None:
                raise ValueError("scene: expected the scene of the run '%s', got None" % run.name)
            encoded.append(encode(run, scene, rate))
        elif isinstance(run, _flexarm.Simulation):
            recording = _flexarm.Recording(run)
            recording.keep()
            encoded.append(recording._encode())
        else:
            encoded.append(run._encode())
    return page_of(encoded, height, at)


def encode(run: Run, scene: Scene, rate: float, notes: typing.Sequence[str] = ()) -> typing.Tuple[str, bytes]:
    """A run as page_of() takes it. notes: for the user."""
    columns = list(zip(run.names, run.units))
    return _flexarm._encode_rows(_flexarm.Simulation(scene), columns, run.rows, run.name, rate, list(notes))


def page_of(encoded: typing.Sequence[typing.Tuple[str, bytes]], height: int = 640,
            at: typing.Optional[float] = None) -> Page:
    return Page(_flexarm._page(list(encoded), at), height)
