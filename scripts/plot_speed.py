#!/usr/bin/python3
"""Plots results of `flexarm bench speed`, time over error: a panel for each problem, a line for each scheme.

plot_speed.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run

# Runs with larger errors say nothing, since their motions have nothing in common with the true one.
LARGEST_ERROR = 1.0


def read(path):
    """Reads rows that have an error, by problem."""
    problems = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["completed"] == "1" and 0 < float(row["error"]):
                row["error"], row["seconds"] = float(row["error"]), float(row["seconds"])
                problems.setdefault(row["problem"], []).append(row)
    return problems


def front(rows):
    """The Pareto front: points of runs to which no other run is both faster and more accurate."""
    points, fastest = [], float("inf")
    for error, seconds in sorted((row["error"], row["seconds"]) for row in rows):
        if seconds < fastest and error <= LARGEST_ERROR:
            points.append((error, seconds))
            fastest = seconds
    return points


def series(rows):
    """The rows of each scheme, and of each variant of another program."""
    found = {}
    for row in rows:
        if row["program"] in ("reference", "target", "public"):
            continue
        name = row["scheme"] if row["program"] == "flexarm" else f"{row['program']} {row['scheme']}"
        found.setdefault(name, []).append(row)
    return found


def colour_of(name, is_peer, colours):
    """The colour for a name, the same in all panels. Other programs have another palette."""
    palette = pyplot.get_cmap("Dark2" if is_peer else "tab10").colors
    known = colours.setdefault(is_peer, [])
    if name not in known:
        known.append(name)
    return palette[known.index(name) % len(palette)]


def draw(axes, rows, colours):
    for name, group in series(rows).items():
        is_peer = group[0]["program"] != "flexarm"
        colour = colour_of(name, is_peer, colours)
        axes.plot(*zip(*((row["error"], row["seconds"]) for row in group)), ".", color=colour, markersize=2, alpha=0.3)
        points = front(group)
        if points:
            axes.plot(*zip(*points), "--" if is_peer else "-", marker="s" if is_peer else "o", markersize=3,
                      linewidth=1, color=colour, label=name)
    for program, marker in (("target", "*"), ("public", "X")):
        points = [(row["error"], row["seconds"]) for row in rows if row["program"] == program]
        if points:
            axes.plot(*zip(*points), marker, color="black", markersize=10, linestyle="none",
                      label="best public figure" if program == "public" else program)
    for row in rows:
        if row["program"] == "reference":
            axes.axvline(row["error"], color="grey", linestyle=":", label="error of the reference")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(right=LARGEST_ERROR)
    axes.set_xlabel("error")
    axes.set_ylabel("time [s]")
    axes.set_title(rows[0]["problem"].replace("_", " "))
    axes.grid(True, which="major", alpha=0.3)


def main(data, picture):
    problems = read(data)
    columns = min(3, max(1, len(problems)))
    lines = max(1, -(-len(problems) // columns))
    figure, grid = pyplot.subplots(lines, columns, figsize=(5.5 * columns, 4.5 * lines), squeeze=False)
    panels, colours = list(grid.flat), {}
    for axes, rows in zip(panels, problems.values()):
        draw(axes, rows, colours)
    for axes in panels[len(problems):]:
        axes.axis("off")
    handles = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=8, fontsize="small")
    figure.tight_layout(rect=(0, 0.03 + 0.03 / lines, 1, 1))
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
