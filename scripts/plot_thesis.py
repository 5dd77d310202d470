#!/usr/bin/python3
"""Draws the histories of an example that `flexarm bench thesis` measured.

plot_thesis.py DATA.csv PICTURE
"""

import csv
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("plot_thesis.py: python3-matplotlib is not installed")

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

# A run that has blown up must not spoil the scale of the others.
FAR = 3.0


def read(path):
    """Runs by their name, each a list of rows, and the names of the observables."""
    runs = {}
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        for row in reader:
            key = f"{row['run']}, {row['step']} s"
            runs.setdefault(key, []).append({k: float(v) for k, v in row.items() if k not in ("run", "step")})
        observables = reader.fieldnames[5:]
    return runs, observables


def limits(runs, name):
    """A range that the runs which end without a large energy defect need."""
    good = [rows for rows in runs.values() if max(row["energy_defect"] for row in rows) < 0.1] or list(runs.values())
    values = sorted(row[name] for rows in good for row in rows)
    low, high = values[len(values) // 500], values[-1 - len(values) // 500]
    margin = 0.1 * (high - low) or 1.0
    return low - margin, high + margin


def draw(axes, runs, name, styles):
    for key, rows in runs.items():
        axes.plot([row["time"] for row in rows], [row[name] for row in rows], linewidth=0.9, **styles[key])
    axes.set_ylim(*limits(runs, name))
    axes.set_ylabel(name.replace("_", " "))


def main(data, picture):
    runs, observables = read(data)
    colours = pyplot.get_cmap("tab20").colors
    lines = ["-", "--", ":"]
    styles = {
        key: {"color": colours[i % 20], "linestyle": lines[(i // 20 + i) % 3], "label": key}
        for i, key in enumerate(runs)
    }
    shown = observables[:4] + (["theta_x"] if "theta_x" in observables else [])
    columns = len(shown) + 2
    rows = (columns + 1) // 2
    figure, grid = pyplot.subplots(rows, 2, figsize=(13, 3.2 * rows), sharex=True)
    panels = list(grid.flat)
    for name, axes in zip(shown, panels):
        draw(axes, runs, name, styles)
    for name, axes in zip(("energy_defect", "angular_momentum_defect"), panels[len(shown):]):
        for key, history in runs.items():
            axes.semilogy([row["time"] for row in history], [max(row[name], 1e-17) for row in history],
                          linewidth=0.9, **styles[key])
        axes.set_ylim(1e-17, FAR)
        axes.set_ylabel(name.replace("_", " "))
    for axes in panels[columns:]:
        axes.axis("off")
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3, fontsize=7)
    height = 0.16 * ((len(labels) + 2) // 3) + 0.5
    figure.tight_layout(rect=(0, height / (3.2 * rows), 1, 1))
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
