"""A tendon robot: height of its tip over the pull of a tendon."""

import math

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_numbers

FITTED = 5  # the pull from which the slack is identified [mm]
# Readings of the three tendons differ by 3 mm. The discs are printed: 5 % of their radius.
READING, RADIUS = 3.0, 0.05  # mm; relative
LENGTH, DISTANCE, OUTER, INNER = 250.0, 6.0, 0.61, 0.477  # of tube, tendon, and radii of the tube [mm]
MODEL = 1.0  # of the authors' model: discs, numbers of elements [mm]


def height(case, pull_mm, slack_mm=0.0, distance_mm=DISTANCE, points=12):
    """Of the tip [mm]. points: that guide the tendon."""
    values = {"pull": 1e-3 * pull_mm, "slack": 1e-3 * slack_mm, "distance": 1e-3 * distance_mm, "points": points}
    simulation = Simulation(case.scene("robot.urdf", values))
    simulation.solve_static(load_steps=5)
    return 1e3 * simulation.probe_poses[0, 2]


def arc(pull_mm, pieces):
    """Height of the tip of a circular arc whose tendon runs along chords between discs [mm].

    The tension EI angle/(L r), r the distance of the tendon, shortens the tube by angle EI/(EA r).
    """
    from scipy.optimize import brentq

    def excess(angle):
        length = LENGTH - angle * (OUTER ** 2 + INNER ** 2) / 4 / DISTANCE
        return LENGTH - 2 * pieces * (length / angle - DISTANCE) * math.sin(angle / (2 * pieces)) - pull_mm

    angle = brentq(excess, 1e-3, 3)
    return LENGTH * math.sin(angle) / angle


def compare(case):
    rows = case.table("numbers.csv")
    for pull in (5, 10):
        yield Row("arc, pull %g mm" % pull, arc(pull, 11), height(case, pull), 0.5, "mm", "closed form",
                  "0.5 mm: the tube is bent less between discs than at them")
        model = next(row["model_mm"] for row in rows if row["pull_mm"] == pull)
        yield Row("authors' model, pull %g mm" % pull, model, height(case, pull, points=45), MODEL, "mm", "calculated",
                  "continuous tendon")
    used = [row for row in rows if row["pull_mm"] == FITTED]
    estimate = fit_numbers(lambda x: [height(case, FITTED, x[0])] * len(used), [1.0],
                           [row["measured_mm"] for row in used], [READING] * len(used))
    (slack,), (error,) = estimate.values, estimate.standard_errors
    case.identify("slack of the tendon", slack, "mm", "the three readings with %g mm" % FITTED, error)
    for row in rows:
        (found,), (part,) = estimate.predict(lambda x: [height(case, row["pull_mm"], x[0])])
        other = height(case, row["pull_mm"], slack, DISTANCE * (1 + RADIUS))
        yield Row("tendon %g, pull %g mm" % (row["tendon"], row["pull_mm"]), row["measured_mm"], found,
                  math.hypot(READING, other - found), "mm", note="own: reading, 5 % of the discs' radius",
                  group="height", is_fitted=row["pull_mm"] == FITTED, propagated=part)
    case.draw(lambda axes: draw(case, axes, rows, slack))


def draw(case, axes, rows, slack):
    pulls = [0.5 * i for i in range(1, 23)]
    axes.plot([row["pull_mm"] for row in rows], [row["measured_mm"] for row in rows], "o", mfc="none", color="#D55E00",
              label="measured")
    axes.plot(pulls, [height(case, pull, slack) for pull in pulls], color="black", label="flexarm, with slack")
    axes.plot(pulls, [height(case, pull) for pull in pulls], color="gray", linestyle="--",
              label="flexarm, without slack")
    axes.plot([5, 10], [230.01, 149.92], "x", color="#0072B2", label="authors' model")
    axes.set(xlabel="pull of a tendon [mm]", ylabel="height of the tip [mm]")
    axes.legend()
