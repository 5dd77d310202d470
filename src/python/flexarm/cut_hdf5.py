"""Reads what an HDF5 file without its end still has: `cut_hdf5.py FILE RESULT`, see read().

HDF5 may crash on such a file, or never end, so a process of its own reads it.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import typing

import numpy

LONGEST, BYTES_PER_SECOND = 10, 5e6  # after so many seconds, and the time for the file's size, HDF5 will not end
# What h5py raises for a part of a file that is not there.
LOST: typing.Tuple[typing.Type[Exception], ...] = KeyError, OSError, RuntimeError


def whole_size(error: OSError) -> typing.Optional[int]:
    """The size that a file once had, from the error of opening it; None: it is not one without its end."""
    found = re.search(r"truncated file.* stored_eo[af] = (\d+)", str(error))
    return int(found.group(1)) if found else None


def read(path: str, size: int) -> typing.Optional[typing.Dict[str, numpy.ndarray]]:
    """Reads the rows that all columns have which have rows; None: there are none.

    Returns the arrays `names`, `units`, `rows`, `origin` (the attributes scene and scene_options).
    """
    with tempfile.TemporaryDirectory(prefix="flexarm_") as folder:
        copy, result = os.path.join(folder, "copy.h5"), os.path.join(folder, "result.npz")
        shutil.copyfile(path, copy)
        os.truncate(copy, size)  # HDF5 opens no file that is too short
        try:
            subprocess.run([sys.executable, __file__, copy, result], check=False, stderr=subprocess.DEVNULL,
                           timeout=LONGEST + size / BYTES_PER_SECOND)
        except subprocess.TimeoutExpired:
            return None
        if not os.path.exists(result):
            return None
        with numpy.load(result) as arrays:
            return dict(arrays)


def data_sets(group: typing.Any) -> typing.Iterator[typing.Any]:
    """The data sets within a group, at any depth, that can be found."""
    try:
        names = list(group)
    except LOST:
        return
    for name in names:
        try:
            entry = group[name]
        except LOST:
            continue
        if hasattr(entry, "keys"):
            yield from data_sets(entry)
        elif entry.ndim == 1 and entry.chunks and entry.dtype.kind in "fiu":
            yield entry


def first_values(data_set: typing.Any) -> numpy.ndarray:
    """The values of a data set up to the first chunk that is lost."""
    parts = [numpy.empty(0)]
    size, = data_set.chunks
    for begin in range(0, len(data_set), size):
        try:
            parts.append(data_set[begin:begin + size].astype(float))
        except LOST:
            break
    return numpy.concatenate(parts)


def text_of(attributes: typing.Any, name: str, default: str = "") -> str:
    try:
        return str(attributes.get(name, default))
    except LOST:
        return default


def main(path: str, result: str) -> None:
    import h5py  # type: ignore

    with h5py.File(path, "r") as file:
        found = [(data_set, first_values(data_set)) for data_set in data_sets(file)]
        columns = [(text_of(data_set.attrs, "name", data_set.name.strip("/")), text_of(data_set.attrs, "unit"), values)
                   for data_set, values in found if len(values)]
        origin = [text_of(file.attrs, name) for name in ("scene", "scene_options")]
    if not columns:
        return
    names, units, values = zip(*columns)
    count = min(map(len, values))
    numpy.savez(result, names=names, units=units, rows=numpy.transpose([column[:count] for column in values]),
                origin=origin)


if __name__ == "__main__":
    main(*sys.argv[1:])
