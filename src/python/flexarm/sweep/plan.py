"""Reads a plan of many runs: their parameters, their duration, and what is measured."""

import dataclasses
import hashlib
import importlib.util
import os
import re
import typing

import flexarm

from .commands import read_commands
from .designs import Design, read_design
from .input import InputError, read_yaml
from .measures import Measure, read_measure


@dataclasses.dataclass(frozen=True)
class History:
    """Which columns of each run are saved, and in which format."""

    format: str  # "hdf5" or "csv"
    columns: tuple  # names


@dataclasses.dataclass(frozen=True)
class Job:
    """What all runs have in common; is sent to the processes that make runs."""

    scene: str  # path
    until: float  # [s]
    every: int  # steps between rows
    pulses: tuple  # of commands.Pulse
    measures: typing.Tuple[Measure, ...]
    history: typing.Optional[History]


@dataclasses.dataclass(frozen=True)
class Plan:
    job: Job
    design: Design
    scene_hash: str  # of the scene's file, and of the tables to which it refers
    plan_hash: str  # of everything that the plan says

    @property
    def columns(self):
        """Columns of the results."""
        return ["run", *self.design.names, *(measure.name for measure in self.job.measures), "failure"]


def read_scene(path):
    """The simulation of a scene, with the parameters' values in the file."""
    try:
        return flexarm.Simulation(flexarm.read_scene(path))
    except flexarm.SceneError as error:
        raise InputError(str(error)) from None


def scene_hash(path, scene):
    """A hash of the scene's file and of its identity, which includes the tables to which it refers."""
    with open(path, "rb") as file:
        return digest(file.read() + scene.identity.encode())


def digest(data):
    return hashlib.sha256(data).hexdigest()[:16]


def read_measures(entry, design, until, columns, parameters):
    measures = []
    for name, measure in entry.items("a mapping of measures"):
        if not re.fullmatch(r"[A-Za-z_]\w*", name):
            raise measure.error("expected a name of letters, digits and _, got '%s'" % name)
        if name in ("run", "failure", *design.names):
            raise measure.error("expected another name: results have a column '%s' already" % name)
        measures.append(read_measure(name, measure, until, columns, parameters))
    return tuple(measures)


def format_of(entry):
    """The format of histories; an error if a package that it needs is missing."""
    if entry.choice(["hdf5", "csv"]) == "hdf5" and importlib.util.find_spec("h5py") is None:
        raise entry.error("HDF5 needs Debian's python3-h5py, which is not installed")
    return entry.text()


def read_history(entry, simulation):
    """Reads `history: hdf5`, or `history: {format: hdf5, columns: [pattern, ...]}`."""
    if not entry.is_mapping():
        return History(format_of(entry), tuple(name for name, _ in simulation.columns()))
    fields = entry.fields(["format"], ["columns"])
    patterns = fields["columns"].entries("a list of patterns of columns") if "columns" in fields else []
    for pattern in patterns:
        try:
            simulation.columns([pattern.text()])
        except ValueError as error:
            raise pattern.error(str(error)) from None
    columns = simulation.columns([pattern.text() for pattern in patterns])
    return History(format_of(fields["format"]), tuple(name for name, _ in columns))


def read_plan(scene_path, path):
    """Reads a plan. Raises InputError."""
    simulation = read_scene(scene_path)
    scene = simulation.scene
    parameters = {parameter.name: parameter for parameter in scene.parameters}
    columns = [name for name, _ in simulation.columns()]
    fields = read_yaml(path).fields(["design", "until"], ["every", "commands", "measures", "history"])
    if not parameters:
        raise InputError("%s: expected a scene with a <parameter> to which the plan gives values" % scene_path)
    design = read_design(fields["design"], parameters)
    until = fields["until"].positive()
    every = fields["every"].count() if "every" in fields else 1
    pulses = read_commands(fields["commands"], simulation.effort_joints, until) if "commands" in fields else ()
    measures = read_measures(fields["measures"], design, until, columns, parameters) if "measures" in fields else ()
    history = read_history(fields["history"], simulation) if "history" in fields else None
    if not measures and not history:
        raise InputError("%s: expected 'measures' or 'history' in it" % path)
    job = Job(os.path.abspath(scene_path), until, every, pulses, measures, history)
    said = (design, until, every, pulses, measures, history)
    return Plan(job, design, scene_hash(scene_path, scene), digest(repr(said).encode()))
