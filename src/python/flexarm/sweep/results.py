"""The file of results: a row for each run, appended when it is there, and in their order at the end."""

import csv
import fcntl
import io
import os

from .input import InputError

FORMAT = "# flexarm sweep 1"


def line_of(fields):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(fields)
    return text.getvalue().encode(errors="backslashreplace")


def is_failure(line):
    """The last column says why; it is empty where nothing failed."""
    return not line.endswith(b",\n")


class Results:
    """Opens or begins the file of a plan's results; `rows`: the lines that are there, by the number of the run.

    What a killed program has left of a last line is cut off. Raises InputError where the file is of another plan or
    scene, is no such file, or is being written by somebody else.
    """

    def __init__(self, path, plan, repeat_failed=False):
        self.path = os.path.realpath(path)  # of a link: where it leads
        self._plan = plan
        self._header = b"%s, scene %s, plan %s\n" % (
            FORMAT.encode(), plan.scene_hash.encode(), plan.plan_hash.encode()) + line_of(plan.columns)
        try:
            self._file = open(os.open(self.path, os.O_RDWR | os.O_CREAT, 0o666), "r+b", buffering=0)
        except OSError as error:
            raise InputError("cannot write '%s': %s" % (path, error.strerror)) from None
        self._lock(self.path)
        content = self._file.readall()
        if self._header.startswith(content):  # nothing, or what is left of a header
            content = self._header
        elif not content.startswith(self._header):
            raise self._stranger(content)
        self.rows = self._rows_of(content[len(self._header):content.rfind(b"\n") + 1])
        if repeat_failed:
            self.rows = {number: line for number, line in self.rows.items() if not is_failure(line)}
        kept = self._header + b"".join(self.rows.values())
        if content != kept or self._file.tell() != len(kept):
            self._replace(kept)

    def _lock(self, is_open_at=None):
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError("'%s' is being written by another sweep" % self.path) from None
        except OSError:
            pass  # a file system without locks
        if is_open_at and not os.path.samestat(os.fstat(self._file.fileno()), os.stat(is_open_at)):
            raise InputError("'%s' is being written by another sweep" % self.path)  # which has just replaced it

    def _stranger(self, content):
        first = content.split(b"\n", 1)[0].decode(errors="replace")
        if not first.startswith(FORMAT):
            return InputError("'%s' is no file of results of a sweep; it is left as it is" % self.path)
        what = "scene" if "scene %s," % self._plan.scene_hash not in first else "plan"
        return InputError("'%s' has results of another %s (%s; now: scene %s, plan %s); name another file by --output, "
                          "or remove it" % (self.path, what, first[len(FORMAT) + 2:], self._plan.scene_hash,
                                            self._plan.plan_hash))

    def _rows_of(self, text):
        rows = {}
        for count, line in enumerate(text.splitlines(keepends=True), 3):
            fields = next(csv.reader([line.decode(errors="replace")]), [])
            number = int(fields[0]) if fields and fields[0].isdecimal() else 0
            if len(fields) != len(self._plan.columns) or not 1 <= number <= len(self._plan.design.rows):
                raise InputError("%s:%d: expected the %d columns of a run, got '%s'"
                                 % (self.path, count, len(self._plan.columns), line.decode(errors="replace").strip()))
            rows[number] = line
        return rows

    def missing(self):
        """Numbers of the runs that have no row."""
        return [number for number in range(1, len(self._plan.design.rows) + 1) if number not in self.rows]

    def failures(self):
        return sum(map(is_failure, self.rows.values()))

    def add(self, number, outcome):
        line = line_of([number, *map(repr, self._plan.design.rows[number - 1]), *map(repr, outcome.measures),
                        outcome.failure])
        self.rows[number] = line
        self._write(line)

    def _write(self, data):
        while data:
            data = data[self._file.write(data):]

    def _replace(self, content):
        """Puts another file in its place, whole; it is locked before anybody can find it."""
        unfinished = self.path + ".unfinished"
        old, self._file = self._file, open(unfinished, "w+b", buffering=0)
        self._lock()
        self._write(content)
        os.fsync(self._file.fileno())
        os.replace(unfinished, self.path)
        old.close()

    def finish(self):
        """Rows in the order of runs, when all of them are there."""
        if list(self.rows) != sorted(self.rows):
            self.rows = dict(sorted(self.rows.items()))
            self._replace(self._header + b"".join(self.rows.values()))
        os.fsync(self._file.fileno())

    def close(self):
        self._file.close()
