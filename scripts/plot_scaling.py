#!/usr/bin/python3
"""Plots results of `flexarm bench scaling`: time and memory over the size of a mechanism.

plot_scaling.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run

PANELS = (
    ("step", "time per step [s]"),
    ("build", "time to build [s]"),
    ("read", "time to read [s]"),
    ("bytes", "memory [bytes]"),
)


def read(path):
    """Reads lists of rows by name of the family."""
    families = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            label = f"{row['family']} ({row['unit']})"
            families.setdefault(label, []).append({k: float(v) for k, v in row.items() if k not in ("family", "unit")})
    return families


def draw_linear(axes, families, quantity):
    """Draws a dashed line of slope one through the highest point of all."""
    rows = [row for family in families.values() for row in family]
    if not rows:
        raise SystemExit("plot_scaling.py: no point to draw")
    last = max(rows, key=lambda row: row[quantity])
    first = min(row["size"] for row in rows)
    axes.loglog([first, last["size"]], [last[quantity] * first / last["size"], last[quantity]],
                color="0.6", linestyle="--", linewidth=0.9, label="linear")


def main(data, picture):
    families = read(data)
    figure, grid = pyplot.subplots(2, 2, figsize=(11, 8), sharex=True)
    for axes, (quantity, label) in zip(grid.flat, PANELS):
        draw_linear(axes, families, quantity)
        for name, rows in families.items():
            axes.loglog([row["size"] for row in rows], [row[quantity] for row in rows], marker="o", markersize=3,
                        linewidth=1.0, label=name)
        axes.set_ylabel(label)
        axes.grid(True, which="major", linewidth=0.3)
    for axes in grid[-1]:
        axes.set_xlabel("size")
    grid[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


if __name__ == "__main__":
    run(main, __doc__)
