"""One comparison: a folder with scenes, published numbers and a script `compare.py`."""

import csv
import importlib.util
import os
import sys

from .. import read_scene
from .rows import Identified

SCRIPT, TEXT = "compare.py", "README.md"


class MissingRecord(Exception):
    """A recorded file is in none of the folders of data. Its text is the file's name."""


class Case:
    """What `compare(case)` gets: the files of its folder, recorded files, and a place for its picture.

    name: that of the folder
    identified: list of Identified, what `identify()` was called with
    has_picture: whether `draw()` has written one
    """

    def __init__(self, folder, data=(), output=None):
        """folder: of the case. data: folders with recorded files. output: folder for the picture; None: no picture."""
        self.folder = os.path.abspath(folder)
        self.name = os.path.basename(self.folder)
        self.identified = []
        self.has_picture = False
        self._data, self._output = list(data), output

    def path(self, name):
        """Path of a file of the case's folder."""
        return os.path.join(self.folder, name)

    def record(self, name):
        """Path of a recorded file, which is not part of the repository. Raises MissingRecord if it is not there."""
        for folder in self._data:
            path = os.path.join(folder, name)
            if os.path.isfile(path):
                return path
        raise MissingRecord(name)

    def table(self, name):
        """Rows of a CSV file as dictionaries: numbers as float, empty fields as None, other fields as text.

        name: a file of the case's folder, or a path. Lines that begin with # are left out.
        """
        with open(self.path(name), encoding="utf-8", newline="") as file:
            lines = [line for line in file if line.strip() and not line.startswith("#")]
        rows = list(csv.DictReader(lines))
        for number, row in enumerate(rows, 1):
            if None in row or None in row.values():
                raise ValueError("%s: row %d: expected as many fields as names, got another number" % (name, number))
        return [{key: _value(text) for key, text in row.items()} for row in rows]

    def scene(self, name, parameters=None, **options):
        """The scene of a file of the folder, with other values of its parameters; options: those of read_scene()."""
        return read_scene(self.path(name), parameters or {}, **options)

    def identify(self, name, value, unit, source, standard_error=float("nan"), birge=1.0):
        """Tells of a number that was identified, and from what; see Identified."""
        self.identified.append(Identified(name, value, unit, source, standard_error, birge))

    def draw(self, function, columns=1, rows=1, width=4.5, height=3.4):
        """Writes the picture: function(axes) draws into matplotlib's axes, one, or `rows * columns` of them.

        width, height: of one of them [inches]. Does nothing if matplotlib is missing or no picture is wanted.
        """
        if self._output is None:
            return
        from ..plotting import figures  # matplotlib is needed only for pictures
        from ..errors import ResultsError
        try:
            pyplot = figures.import_pyplot()
        except ResultsError as error:
            print("flexarm bench validation: no picture: %s" % error, file=sys.stderr)
            return
        with pyplot.rc_context(figures.SETTINGS):
            figure, axes = pyplot.subplots(rows, columns, figsize=(width * columns, height * rows))
            function(axes.ravel() if rows * columns > 1 else axes)
            figure.tight_layout()
            figure.savefig(os.path.join(self._output, self.name + ".png"), dpi=figures.DOTS)
            pyplot.close(figure)
        self.has_picture = True

    def text(self):
        """Title and paragraphs of the folder's README.md."""
        with open(self.path(TEXT), encoding="utf-8") as file:
            heading, _, rest = file.read().partition("\n")
        return heading.lstrip("# "), rest.strip()

    def compare(self):
        """The rows of the folder's compare.py, one after the other as they are computed."""
        spec = importlib.util.spec_from_file_location("flexarm_validation_" + self.name, self.path(SCRIPT))
        module = importlib.util.module_from_spec(spec)
        sys.path.insert(0, self.folder)  # for modules beside it
        try:
            spec.loader.exec_module(module)
        finally:
            sys.path.remove(self.folder)
        return module.compare(self)


def find_cases(folder):
    """Names of the subfolders that are cases, in alphabetical order."""
    return sorted(entry.name for entry in os.scandir(folder) if os.path.isfile(os.path.join(entry.path, SCRIPT)))


def _value(text):
    if not text.strip():
        return None
    try:
        return float(text)
    except ValueError:
        return text
