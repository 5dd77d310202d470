"""Finds values of a scene's parameters with which it moves as was measured, for `flexarm identify`. docs/identify.md

    plan = read_plan("plan.yaml", scene.parameters)          the unknowns and the measured columns
    measurements, begin = read_measurements("data.csv", plan)
    experiment = Experiment(...)                             simulates what would have been measured
    result = fit(experiment)                                 bounded nonlinear least squares
"""

from .efforts import EffortHistory, read_efforts
from .experiment import Experiment, Setting, choose_step
from .fit import Fit, FitError, Interruption, fit
from .inputs import InputError
from .measurements import Measurement, read_measurements
from .plan import Column, Plan, Unknown, read_plan

__all__ = ["Column", "EffortHistory", "Experiment", "Fit", "FitError", "InputError", "Interruption", "Measurement",
           "Plan", "Setting", "Unknown", "choose_step", "fit", "read_efforts", "read_measurements", "read_plan"]
