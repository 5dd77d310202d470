"""Reports results as text, JSON and CSV."""

import csv
import io
import json
import math
import re
from xml.parsers import expat

import numpy

from .certainty import succession
from .inputs import InputError

HIGH_CORRELATION = 0.99
# With a correct model, residuals are as large as the noise, and independent. Much smaller ones are no noise: then the
# measurements come from another simulation.
LARGE_RESIDUALS, SMALL_RESIDUALS = 2.0, 0.1
HIGH_SUCCESSION = 0.5


def doubts(experiment, fit):
    """Reasons why a result is doubtful, as sentences."""
    names = [unknown.name for unknown in experiment.unknowns]
    found = []
    for group in fit.certainty.undetermined:
        if len(group) == 1:
            found.append("the measurements do not depend on '%s'" % names[group[0]])
        else:
            found.append("the measurements cannot distinguish %s: they can be changed together without a visible "
                         "effect" % " and ".join("'%s'" % names[i] for i in group))
    for i, unknown in enumerate(experiment.unknowns):
        if fit.at_limit[i]:
            found.append("'%s' is at its limit: standard errors are not valid" % unknown.name)
        elif unknown.scale < fit.certainty.standard_errors[i] < math.inf:
            found.append("the measurements say little about '%s': its standard error is larger than its size"
                         % unknown.name)
        for j in range(i):
            if abs(fit.certainty.correlations[i, j]) > HIGH_CORRELATION:
                found.append("'%s' and '%s' are hard to tell apart: their correlation is %.4f"
                             % (names[j], names[i], fit.certainty.correlations[i, j]))
    for column in columns(experiment, fit):
        if column["noise_is_given"] and column["rms"] > LARGE_RESIDUALS * column["noise"]:
            found.append("residuals of '%s' are %.3g times its noise: the scene's motion differs from the "
                         "measured one, or there is more noise" % (column["name"], column["rms"] / column["noise"]))
        # Independent residuals exceed this bound once in 15000 times.
        is_noisy = not column["noise_is_given"] or column["rms"] > SMALL_RESIDUALS * column["noise"]
        if is_noisy and column["succession"] > max(HIGH_SUCCESSION, 4 / math.sqrt(column["values"])):
            found.append("successive residuals of '%s' are correlated (correlation %.2f): they are not noise, "
                         "and standard errors are too small" % (column["name"], column["succession"]))
    return found


def columns(experiment, fit):
    """A dictionary of results for each column."""
    residuals = fit.predicted - experiment.measured
    return [{
        "name": measurement.column.name,
        "unit": unit,
        "values": len(measurement.values),
        "noise": float(noise),
        "noise_is_given": measurement.column.noise is not None,
        "rms": float(numpy.sqrt((residuals[part] ** 2).mean())),
        "succession": succession(residuals[part]),
    } for measurement, unit, part, noise in zip(experiment.measurements, experiment.units, experiment.parts, fit.noise)]


def text(experiment, fit):
    """Tables and sentences for people."""
    lines = ["%-28s %14s %14s %10s %14s  %s" % ("unknown", "estimate", "std. error", "relative", "start", "limits")]
    for unknown, value, error in zip(experiment.unknowns, fit.values, fit.certainty.standard_errors):
        part = "%.3g %%" % (100 * error / abs(value)) if value and math.isfinite(error) else "-"
        lines.append("%-28s %14.7g %14s %10s %14.7g  %s" % (unknown.name, value, _error(error), part, unknown.start,
                                                            _limits(unknown)))
    if len(experiment.unknowns) > 1:
        lines += ["", "correlations"]
        for i, unknown in enumerate(experiment.unknowns):
            row = fit.certainty.correlations[i, : i + 1]
            texts = ["%7s" % ("-" if math.isnan(value) else "%.3f" % value) for value in row]
            lines.append("%-28s %s" % (unknown.name, " ".join(texts)))
    lines += ["", "%-28s %6s %8s %12s %12s" % ("column", "unit", "values", "residuals", "noise")]
    for column in columns(experiment, fit):
        found = "" if column["noise_is_given"] else " (estimated)"
        lines.append("%-28s %6s %8d %12.4g %12.4g%s" % (column["name"], column["unit"], column["values"], column["rms"],
                                                        column["noise"], found))
    lines += ["", "%s after %d iterations and %d simulations of %d steps of %g s; residuals are %.4g times the noise"
              % (fit.ending, fit.iterations, fit.simulations, experiment.steps, experiment.step, fit.factor)]
    return "\n".join(lines)


def _error(error):
    return "%.3g" % error if math.isfinite(error) else "-"


def _limits(unknown):
    parts = ["at least %g" % unknown.min] * math.isfinite(unknown.min) + ["at most %g" % unknown.max] * math.isfinite(
        unknown.max)
    return " and ".join(parts)


def _number(value):
    """The number, or None for NaN and infinity, which JSON does not have."""
    return float(value) if math.isfinite(value) else None


def as_json(experiment, fit, files):
    """Everything as JSON. `files`: a dictionary of the input files' names, which is included."""
    data = {
        **files,
        "converged": fit.is_converged,
        "ending": fit.ending,
        "iterations": fit.iterations,
        "simulations": fit.simulations,
        "step": experiment.step,
        "residuals_over_noise": fit.factor,
        "unknowns": [{
            "name": unknown.name,
            "kind": "coordinate at the start" if unknown.of_start else "parameter",
            "estimate": float(value),
            "standard_error": _number(error),
            "start": unknown.start,
            "min": _number(unknown.min),
            "max": _number(unknown.max),
            "at_limit": bool(at_limit),
        } for unknown, value, error, at_limit in zip(experiment.unknowns, fit.values, fit.certainty.standard_errors,
                                                     fit.at_limit)],
        "correlations": [[_number(value) for value in row] for row in fit.certainty.correlations],
        "columns": columns(experiment, fit),
        "warnings": doubts(experiment, fit),
    }
    return json.dumps(data, indent=2) + "\n"


def as_csv(experiment, fit):
    """Measured and simulated values as CSV, one row for each value."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["column", "unit", "time", "measured", "simulated", "noise"])
    for measurement, unit, part, noise in zip(experiment.measurements, experiment.units, experiment.parts, fit.noise):
        for time, measured, simulated in zip(measurement.times, measurement.values, fit.predicted[part]):
            writer.writerow([measurement.column.name, unit, *map(repr, map(float, (time, measured, simulated, noise)))])
    return file.getvalue()


# A start tag of <parameter>, up to and including its value.
UNTIL_VALUE = re.compile(rb"""<parameter(?:\s+[^\s=]+\s*=\s*(?:"[^"]*"|'[^']*'))*?\s+value\s*=\s*(["'])(.*?)\1""",
                         re.DOTALL)


def with_values(scene, path, values):
    """The bytes of a scene's file with other values of parameters; all other bytes stay as they are.

    scene: the bytes. path: for error messages. values: by names of parameters.
    """
    places = {}
    parser = expat.ParserCreate()
    depth = 0

    def begin(name, attributes):
        nonlocal depth
        if depth == 1 and name == "parameter" and attributes.get("name") in values:
            places[attributes["name"]] = parser.CurrentByteIndex
        depth += 1

    def end(name):
        nonlocal depth
        depth -= 1

    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.Parse(scene, True)
    for name, place in sorted(places.items(), key=lambda item: -item[1]):
        found = UNTIL_VALUE.match(scene, place)
        if not found:
            raise InputError("%s: <parameter name='%s'> has no value that can be replaced" % (path, name))
        scene = scene[: found.start(2)] + repr(float(values[name])).encode() + scene[found.end(2):]
    return scene
