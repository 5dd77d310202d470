from ._flexarm import __version__ as __version__
from ._flexarm import (
    read_scene,
    read_scene_text,
    tune,
    LinearModel,
    RunEvent,
    Scene,
    Sensitivities,
    Simulation,
    State,
    StepResult,
)
from .environment import Environment, VectorEnvironment
from .errors import AccuracyError, SceneError, SceneWarning, StepError
from .values import (
    AccurateRun,
    Contact,
    Energies,
    Mode,
    Parameter,
    Tuning,
    Wrench,
)

__all__ = [
    "read_scene",
    "read_scene_text",
    "tune",
    "LinearModel",
    "RunEvent",
    "Scene",
    "Sensitivities",
    "Simulation",
    "State",
    "StepResult",
    "AccuracyError",
    "SceneError",
    "SceneWarning",
    "StepError",
    "AccurateRun",
    "Contact",
    "Energies",
    "Mode",
    "Parameter",
    "Tuning",
    "Wrench",
    "Environment",
    "VectorEnvironment",
]
