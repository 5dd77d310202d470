"""Writes the columns of one run to a file, in the formats of `flexarm simulate --output`."""

import os
import threading

import numpy

HDF5_LOCK = threading.Lock()  # the HDF5 library is not thread-safe, and Dask's workers may have several threads


def write_history(path, history, columns, units, simulation, number, parameters):
    """Writes a complete file; if that fails, an existing file stays as it was.

    history: of the plan. columns: arrays by name, of which `history` selects some. units: by name.
    """
    kept = {name: columns[name] for name in history.columns}
    unfinished = "%s.%d.unfinished" % (path, os.getpid())
    try:
        if history.format == "csv":
            write_csv(unfinished, kept)
        else:
            attributes = {"robot": simulation.scene.name, "scheme": simulation.scheme, "step": simulation.step_size,
                          "run": number, **{"parameter/" + name: value for name, value in parameters.items()}}
            with HDF5_LOCK:
                write_hdf5(unfinished, kept, units, attributes)
        os.replace(unfinished, path)
    finally:
        if os.path.exists(unfinished):
            os.remove(unfinished)


def write_csv(path, columns):
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in numpy.transpose(list(columns.values())).tolist():
            file.write(",".join(map(repr, row)) + "\n")


def write_hdf5(path, columns, units, attributes):
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs.update(attributes)
        for name, values in columns.items():
            # Settings as in the command line's writer, but the whole run is one chunk.
            data = file.create_dataset(name, data=values, chunks=values.shape, compression="gzip", track_times=False,
                                       compression_opts=1, shuffle=True)
            data.attrs["name"], data.attrs["unit"] = name, units[name]
