from ._flexarm import __version__ as __version__
from ._flexarm import (
    read_scene,
    read_scene_text,
    tune,
    Batch,
    LinearModel,
    Recording,
    RunEvent,
    Scene,
    Sensitivities,
    Simulation,
    State,
    StepResult,
)
from .environment import Environment, VectorEnvironment
from .errors import AccuracyError, ResultsError, SceneError, SceneWarning, StepError
from .pages import Page, show
from .results import read_run, Run, Spectrum
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
    "Batch",
    "LinearModel",
    "Recording",
    "RunEvent",
    "Scene",
    "Sensitivities",
    "Simulation",
    "State",
    "StepResult",
    "AccuracyError",
    "ResultsError",
    "SceneError",
    "SceneWarning",
    "StepError",
    "Page",
    "show",
    "AccurateRun",
    "Contact",
    "Energies",
    "Mode",
    "Parameter",
    "Tuning",
    "Wrench",
    "read_run",
    "Run",
    "Spectrum",
    "Environment",
    "VectorEnvironment",
]
