"""The file of results: a row is appended for each run when it ends; at the end all rows are sorted."""

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
    """Whether a row's last column, the reason of a failure, is not empty."""
    return not line.endswith(b",\n")


class Results:
    """Opens or creates the file of a plan's results. `rows`: existing lines, by the number of the run.

    If a killed program has left an incomplete last line, that line is removed. Raises InputError if the file belongs to
    another plan or scene, has another format, or is being written by another process.
    """

    def __init__(self, path, plan, repeat_failed=False):
        self.path = os.path.realpath(path)  # follows symbolic links
        self._plan = plan
        self._header = b"%s, scene %s, plan %s\n" % (
            FORMAT.encode(), plan.scene_hash.encode(), plan.plan_hash.encode()) + line_of(plan.columns)
        try:
            self._file = open(os.open(self.path, os.O_RDWR | os.O_CREAT, 0o666), "r+b", buffering=0)
        except OSError as error:
            raise InputError("cannot write '%s': %s" % (path, error.strerror)) from None
        self._lock(self.path)
        content = self._file.readall()
        if self._header.startswith(content):  # empty, or an incomplete header
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
            raise InputError("'%s' is being written by another sweep" % self.path)  # was just replaced

    def _stranger(self, content):
        first = content.split(b"\n", 1)[0].decode(errors="replace")
        if not first.startswith(FORMAT):
            return InputError("'%s' is not a file of results of a sweep; it was not changed" % self.path)
        what = "scene" if "scene %s," % self._plan.scene_hash not in first else "plan"
        return InputError("'%s' has results of another %s (%s; now: scene %s, plan %s); name another file by --output, "
                          "or remove it" % (self.path, what, first[len(FORMAT) + 2:], self._plan.scene_hash,
                                            self._plan.plan_hash))

    def _rows_of(self, text):
        rows = {}
        for count, line in enumerate(text.splitlines(keepends=True), 3):
            try:
                fields = next(csv.reader([line.decode(errors="replace")]), [])
            except csv.Error:
                fields = []
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
        """Replaces the file by one with this content, as a whole. The new file is locked before it gets its name."""
        unfinished = self.path + ".unfinished"
        old, self._file = self._file, open(unfinished, "w+b", buffering=0)
        self._lock()
        self._write(content)
        os.fsync(self._file.fileno())
        os.replace(unfinished, self.path)
        old.close()

    def finish(self):
        """Sorts the rows by run; to be called when all rows are there."""
        if list(self.rows) != sorted(self.rows):
            self.rows = dict(sorted(self.rows.items()))
            self._replace(self._header + b"".join(self.rows.values()))
        os.fsync(self._file.fileno())

    def close(self):
        self._file.close()
