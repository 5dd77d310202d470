"""Values that simulations take and return."""

import dataclasses
import typing

import numpy

if typing.TYPE_CHECKING:
    from ._flexarm import Scene


class Energies(typing.NamedTuple):
    """Energies of a state [J]. `potential` is the energy of gravity; `total` is the sum of the first three."""

    kinetic: float
    strain: float
    potential: float
    total: float
    work: float  # by external forces since the start
    dissipated: float  # since the start


class Contact(typing.NamedTuple):
    """A point at which two bodies touch; see Simulation.contacts."""

    first: str  # link or ground; order as in the scene's <contact> if it names both, else as in the scene
    second: str
    position: numpy.ndarray  # shape (3,), in the world [m]
    normal: numpy.ndarray  # shape (3,), unit vector, from the second to the first body
    force: numpy.ndarray  # shape (3,), on the first body, including friction, world axes [N]
    penetration: float  # depth by which the bodies penetrate each other [m]


class Parameter(typing.NamedTuple):
    """A named number of a scene, which its expressions can use."""

    name: str
    value: float  # with which the scene was read
    min: typing.Optional[float]  # limits of the value; None: no limit
    max: typing.Optional[float]


class Mode(typing.NamedTuple):
    """A mode of small amplitude: the motion Re(shape exp((rate + 2 pi i frequency) t)) about a configuration."""

    frequency: float  # [Hz]; 0: no oscillation
    rate: float  # [1/s]; > 0: the motion grows
    damping_ratio: float  # as a fraction of critical damping
    node_motion: numpy.ndarray  # complex, shape (nodes, 6): displacement, rotation, world axes; largest component 1
    joint_motion: numpy.ndarray  # complex, shape (joints,) [m, rad], normalised like node_motion


class AccurateRun(typing.NamedTuple):
    """The result of run_to_accuracy()."""

    estimate: float  # of the error, relative to `scale`
    scale: float  # length by which errors are divided [m]
    scheme: str  # of the last try
    tries: int
    steps: int  # of all tries
    steps_per_interval: int  # of the last try
    interval: float  # [s]
    rows: typing.Optional[numpy.ndarray]  # shape (intervals + 1, columns); None: nothing was recorded


class Tuning(typing.NamedTuple):
    """The result of tune()."""

    scene: "Scene"  # the scene with the settings that were found
    mesh: str  # elements x order of each beam, in the scene's order
    scheme: str
    step: float  # [s]
    tolerance: float  # of Newton's method
    error: float  # compared with a finer run, relative to `scale`
    scale: float  # largest displacement of points [m]
    load: float  # processor time per simulated time [-]
    runs: int  # number of runs that the search has made


@dataclasses.dataclass
class Wrench:
    """A force and a moment on a link, or a spring and a damper that pull it; for Simulation.apply_wrenches()."""

    link: typing.Union[str, int]
    force: typing.Sequence[float] = (0, 0, 0)  # [N]
    moment: typing.Sequence[float] = (0, 0, 0)  # about the point [N m]
    at: typing.Sequence[float] = (0, 0, 0)  # the point, in the undeformed link's frame [m]
    follows: bool = False  # True: axes of the link's material at the point, which turn with it; False: world axes
    target: typing.Sequence[float] = (0, 0, 0)  # place in the world to which the spring pulls the point [m]
    stiffness: float = 0  # of the spring [N/m]
    damping: float = 0  # of the damper parallel to the spring [N s/m]
