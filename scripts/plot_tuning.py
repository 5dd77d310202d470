#!/usr/bin/python3
"""Plots speed over error for all runs that `flexarm tune` made of a scene: a colour for each scheme, the best marked.

plot_tuning.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run

# Runs with larger errors say nothing, since their motions have nothing in common with the true one.
LARGEST_ERROR = 1.0


def read(path):
    """Reads rows of runs that were completed and have an error."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if not row["failure"] and row["role"] != "reference"]
    for row in rows:
        row["error"], row["times_real_time"] = float(row["error"]), float(row["times_real_time"])
    return [row for row in rows if 0 < row["error"] <= LARGEST_ERROR and row["times_real_time"] > 0]


def front(rows):
    """The Pareto front: points of runs to which no other run is both faster and more accurate."""
    points, fastest = [], 0
    for row in sorted(rows, key=lambda row: row["error"]):
        if row["times_real_time"] > fastest:
            fastest = row["times_real_time"]
            points.append((row["error"], fastest))
    return points


def main(data, picture):
    rows = read(data)
    figure, axes = pyplot.subplots(figsize=(7, 5))
    schemes = []
    for row in rows:
        if row["scheme"] not in schemes:
            schemes.append(row["scheme"])
    for scheme in schemes:
        points = [(row["error"], row["times_real_time"]) for row in rows if row["scheme"] == scheme]
        axes.plot(*zip(*points), "o", markersize=3, alpha=0.6, label=scheme)
    if rows:
        axes.plot(*zip(*front(rows)), "-", color="grey", linewidth=1, label="best of all")
    for role, marker, label in (("scene", "s", "the scene as it stands"), ("best", "*", "the tuned scene")):
        points = [(row["error"], row["times_real_time"]) for row in rows if row["role"] == role]
        if points:
            axes.plot(*zip(*points), marker, color="black", markersize=10, linestyle="none", label=label)
    axes.axhline(1, color="grey", linestyle=":", linewidth=1)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("error, relative to the largest displacement")
    axes.set_ylabel("speed, times real time")
    axes.grid(True, which="major", alpha=0.3)
    axes.legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
