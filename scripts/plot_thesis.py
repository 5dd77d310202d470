#!/usr/bin/python3
"""Plots the histories of an example that `flexarm bench thesis` measured.

plot_thesis.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run

# Upper end of the axis, so that a run that has blown up does not spoil the scale for the others.
FAR = 3.0


def read(path):
    """Reads lists of rows by run, and the names of observables and of defects of invariants."""
    runs = {}
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        for row in reader:
            key = f"{row['run']}, {row['step']} s"
            runs.setdefault(key, []).append({k: float(v) for k, v in row.items() if k not in ("run", "step")})
        names = [name for name in reader.fieldnames if name not in ("run", "step", "time")]
    return runs, [n for n in names if not n.endswith("_defect")], [n for n in names if n.endswith("_defect")]


def limits(runs, name):
    """The range of values in runs that end without a large energy defect, with a margin."""
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
    runs, observables, defects = read(data)
    colours = pyplot.get_cmap("tab20").colors
    lines = ["-", "--", ":"]
    styles = {
        key: {"color": colours[i % 20], "linestyle": lines[(i // 20 + i) % 3], "label": key}
        for i, key in enumerate(runs)
    }
    rows = (len(observables) + len(defects) + 2) // 3
    figure, grid = pyplot.subplots(rows, 3, figsize=(16, 3.0 * rows), sharex=True, squeeze=False)
    panels = list(grid.flat)
    for name, axes in zip(observables, panels):
        draw(axes, runs, name, styles)
    for name, axes in zip(defects, panels[len(observables):]):
        for key, history in runs.items():
            axes.semilogy([row["time"] for row in history], [max(row[name], 1e-17) for row in history],
                          linewidth=0.9, **styles[key])
        axes.set_ylim(1e-17, FAR)
        axes.set_ylabel(name.replace("_", " "))
    for axes in panels[len(observables) + len(defects):]:
        axes.axis("off")
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    handles, labels = panels[0].get_legend_handles_labels()
    height = 0.17 * ((len(labels) + 3) // 4) + 0.3
    figure.set_size_inches(16, 3.0 * rows + height)
    figure.legend(handles, labels, loc="lower center", ncol=4, fontsize=7)
    figure.tight_layout(rect=(0, height / (3.0 * rows + height), 1, 1))
    figure.savefig(picture, dpi=80)


if __name__ == "__main__":
    run(main, __doc__)
