"""What `flexarm show` does with results."""

import argparse
import json
import os
import sys
import warnings

import flexarm

from .pages import encode, page_of
from .results import Run, read_columns

DONE, BAD_INPUT = 0, 2  # exit status, as of flexarm's other commands


def parser():
    words = argparse.ArgumentParser(prog="flexarm show")
    words.add_argument("runs", nargs="+")
    words.add_argument("--scene", help="of all runs; without it each run names its own")
    words.add_argument("--output")
    words.add_argument("--rate", type=float)
    words.add_argument("--at", type=float)
    words.add_argument("--open", action="store_true")
    add_scene_options(words)
    return words


def add_scene_options(words):
    words.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    words.add_argument("--xacro-args", default="")
    words.add_argument("--start", default="")
    words.add_argument("--massless", default="")


def read_scene(path, *options):
    """Reads a scene. options: parsed words; the later ones replace the parameters of those before."""
    parameters = {name: float(value) for one in options for name, value in (text.split("=") for text in one.set)}
    return flexarm.read_scene(
        path, parameters, xacro_args=" ".join(one.xacro_args for one in options).strip(),
        clamp_start=any("clamp" in one.start for one in options),
        equilibrium_start=any("equilibrium" in one.start for one in options),
        lock_massless=any(one.massless for one in options))


class Scenes:
    """The scenes of runs, each read once."""

    def __init__(self, arguments):
        self.arguments, self.read = arguments, {}
        self.given = read_scene(arguments.scene, arguments) if arguments.scene else None

    def of(self, path, origin):
        if self.given:
            return self.given
        if origin is None:
            raise flexarm.ResultsError("%s: %s name its scene; name it: flexarm show SCENE --runs %s" % (
                path, "a CSV file does not" if path.endswith(".csv") else "does not", path))
        if not os.path.exists(origin.scene):
            raise flexarm.ResultsError("%s: its scene '%s' is not there any more; name it: flexarm show SCENE --runs %s"
                                       % (path, origin.scene, path))
        key = (origin.scene, *origin.options)
        if key not in self.read:
            words = argparse.ArgumentParser(prog=path)
            add_scene_options(words)
            self.read[key] = read_scene(origin.scene, words.parse_args(origin.options), self.arguments)
        return self.read[key]


def page_with(arguments):
    scenes = Scenes(arguments)
    losses = {path: [] for path in arguments.runs}
    tables = [(path, read_columns(path, losses=losses[path])) for path in arguments.runs]
    origins = [table.origin for _, table in tables if table.origin]
    encoded = []
    for path, table in tables:
        run = Run(table.names, table.units, table.rows, path)
        if not len(run.rows):
            raise flexarm.ResultsError("%s: there are no rows" % path)
        scene = scenes.of(path, table.origin or (origins[0] if origins else None))
        encoded.append(encode(run, scene, arguments.rate, losses[path]))
    notes = [note for picture, _ in encoded for note in json.loads(picture)["notes"]]
    for note in dict.fromkeys(notes):
        print("flexarm: warning: %s" % note, file=sys.stderr)
    return page_of(encoded, at=arguments.at)


def main(words):
    arguments = parser().parse_args(words)
    warnings.showwarning = lambda message, *_: print(message, file=sys.stderr)
    try:
        page = page_with(arguments)
        if not arguments.open:
            page.save(arguments.output)
        elif not page.open(arguments.output):
            print("flexarm: no browser can be started: open %s yourself" % arguments.output, file=sys.stderr)
        print("%s shows it in a browser" % arguments.output)
    except (flexarm.ResultsError, flexarm.SceneError, OSError, ValueError) as error:
        print("flexarm: %s" % error, file=sys.stderr)
        return BAD_INPUT
    return DONE
