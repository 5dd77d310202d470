"""Values that simulations take and give."""

import dataclasses
import typing

import numpy

if typing.TYPE_CHECKING:
    from ._flexarm import Scene


class Energies(typing.NamedTuple):
    """Of a state [J]; the potential one is that of gravity, total the sum of the first three."""

    kinetic: float
    strain: float
    potential: float
    total: float
    work: float  # done from outside since the start
    dissipated: float  # since the start


class Contact(typing.NamedTuple):
    """A point at which one body touches another one, as Simulation.contacts has them."""

    first: str  # links or grounds, as a <contact> names both, else in the scene's order
    second: str
    position: numpy.ndarray  # shape (3,), in the world [m]
    normal: numpy.ndarray  # shape (3,), unit, from the second to the first
    force: numpy.ndarray  # shape (3,), on the first, friction included, world axes [N]
    penetration: float  # how deep they are in each other [m]


class Parameter(typing.NamedTuple):
    """A number that the expressions of a scene name."""

    name: str
    value: float  # that the scene was read with
    min: typing.Optional[float]  # what it may be set to; None: anything
    max: typing.Optional[float]


class Mode(typing.NamedTuple):
    """A motion Re(shape exp((rate + 2 pi i frequency) t)) of small amplitude about a configuration."""

    frequency: float  # [Hz]; 0: no oscillation
    rate: float  # [1/s]; > 0: grows
    damping_ratio: float  # of critical damping
    node_motion: numpy.ndarray  # complex, shape (nodes, 6): displacement, spin, world axes; largest component 1
    joint_motion: numpy.ndarray  # complex, shape (joints,) [m, rad], in the same units


class AccurateRun(typing.NamedTuple):
    """What run_to_accuracy() has come to."""

    estimate: float  # of the error, relative to `scale`
    scale: float  # of errors [m]
    scheme: str  # of the last try
    tries: int
    steps: int  # of all tries
    steps_per_interval: int  # of the last one
    interval: float  # [s]
    rows: typing.Optional[numpy.ndarray]  # shape (intervals + 1, columns); None: nothing was recorded


class Tuning(typing.NamedTuple):
    """What tune() has found."""

    scene: "Scene"  # with these settings
    mesh: str  # of its beams, in the scene's order: elements x order
    scheme: str
    step: float  # [s]
    tolerance: float  # of Newton's method
    error: float  # against a finer run, relative to `scale`
    scale: float  # how far points move [m]
    load: float  # time of the processor for a simulated second [-]
    runs: int  # that the search has made


@dataclasses.dataclass
class Wrench:
    """What Simulation.apply_wrenches() applies to a link, or a spring and a damper that pull on it."""

    link: typing.Union[str, int]
    force: typing.Sequence[float] = (0, 0, 0)  # [N]
    moment: typing.Sequence[float] = (0, 0, 0)  # about the point [N m]
    at: typing.Sequence[float] = (0, 0, 0)  # the point, in the undeformed link's frame [m]
    follows: bool = False  # axes are those of the link's material there, and turn with it; else the world's
    target: typing.Sequence[float] = (0, 0, 0)  # place in the world to which the spring pulls the point [m]
    stiffness: float = 0  # of the spring [N/m]
    damping: float = 0  # of the damper beside it [N s/m]
