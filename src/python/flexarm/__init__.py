"""Simulations of flexible manipulators.

    import flexarm

    simulation = flexarm.Simulation("arm.urdf")
    rows = simulation.run(1000, record=["joint/*/position"])

docs/python.md has an example for each task; help(flexarm.Simulation) lists units and shapes. flexarm.msg and
flexarm.srv are the messages and services of the ROS node.
"""

import importlib

# The module of each name. Modules are imported when a name is first used, so that the messages alone need no simulator.
_HOMES = {
    "__version__": "_flexarm",
    "read_scene": "_flexarm",
    "read_scene_text": "_flexarm",
    "tune": "_flexarm",
    "Batch": "_flexarm",
    "LinearModel": "_flexarm",
    "Recording": "_flexarm",
    "RunEvent": "_flexarm",
    "Scene": "_flexarm",
    "Sensitivities": "_flexarm",
    "Simulation": "_flexarm",
    "State": "_flexarm",
    "StepResult": "_flexarm",
    "AccuracyError": "errors",
    "ResultsError": "errors",
    "SceneError": "errors",
    "SceneWarning": "errors",
    "StepError": "errors",
    "Page": "pages",
    "show": "pages",
    "AccurateRun": "values",
    "Contact": "values",
    "Energies": "values",
    "Mode": "values",
    "Parameter": "values",
    "Tuning": "values",
    "Wrench": "values",
    "read_run": "results",
    "Run": "results",
    "Spectrum": "results",
    "Environment": "environment",
    "VectorEnvironment": "environment",
}

__all__ = [name for name in _HOMES if name != "__version__"]


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError("module %r has no attribute %r" % (__name__, name))
    value = getattr(importlib.import_module("%s.%s" % (__name__, _HOMES[name])), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted(set(globals()) | set(_HOMES))
