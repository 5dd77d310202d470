"""Efforts that are commanded in all runs: constant ones, or pulses as in config/demo_commands.yaml."""

import dataclasses
import os

import numpy

from .input import read_yaml


@dataclasses.dataclass(frozen=True)
class Pulse:
    """A constant effort on one joint for some time."""

    joint: str
    begin: float  # [s]
    end: float  # [s]
    effort: float  # [N m or N]


def joint_of(name, joints, error):
    if name not in joints:
        raise error("expected a joint that takes efforts, one of [%s], got '%s'" % (", ".join(joints), name))
    return name


def read_pulses(entry, joints):
    fields = entry.fields(["time", "names", "efforts", "duration"], ["repeat", "every"])
    names = [joint_of(name.text(), joints, name.error) for name in fields["names"].entries("a list of joints")]
    efforts = [effort.number() for effort in fields["efforts"].entries("a list of efforts")]
    if len(names) != len(efforts) or not names:
        raise entry.error("expected one effort for each name, got %d for %d" % (len(efforts), len(names)))
    begin, duration = fields["time"].number(), fields["duration"].non_negative()
    repeat = fields["repeat"].count(0) if "repeat" in fields else 1
    every = fields["every"].non_negative() if "every" in fields else 0.0
    return [Pulse(name, begin + k * every, begin + k * every + duration, effort)
            for name, effort in zip(names, efforts) for k in range(repeat)]


def read_commands(entry, joints, until):
    """Reads `commands: {joint: effort}`, or the name of a file relative to the plan's folder. Returns a tuple of Pulse.

    joints: those that take efforts. until: when constant efforts end [s].
    """
    if entry.is_mapping():
        return tuple(Pulse(joint_of(name, joints, effort.error), 0.0, until, effort.number())
                     for name, effort in entry.items())
    name = entry.text("a mapping of joints, or the name of a file")
    file = read_yaml(os.path.join(os.path.dirname(entry.file), name))
    commands = file.fields(["commands"], ["period"])["commands"]
    return tuple(pulse for command in commands.entries("a list of commands") for pulse in read_pulses(command, joints))


def effort_rows(pulses, steps, step):
    """Returns the names of the joints, and their efforts in each step, shape (steps, joints).

    The effort of a step is the mean of the pulses over the step, so that the impulse is exact for any step.
    """
    joints = list(dict.fromkeys(pulse.joint for pulse in pulses))
    efforts = numpy.zeros((steps, len(joints)))
    begin = step * numpy.arange(steps)
    for pulse in pulses:
        part = (numpy.minimum(begin + step, pulse.end) - numpy.maximum(begin, pulse.begin)) / step
        # But for round-off, a pulse that begins and ends with steps fills each step completely or not at all.
        part = numpy.where(part < 1e-6, 0, numpy.where(part > 1 - 1e-6, 1, part))
        efforts[:, joints.index(pulse.joint)] += pulse.effort * part
    return joints, efforts
