#!/usr/bin/python3
"""Plots the measured and simulated values of `flexarm identify`, and the residuals with their noise.

plot_residuals.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run


def read(path):
    """Reads columns of numbers, by name and unit of the measured column."""
    series = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            numbers = [float(row[key]) for key in ("time", "measured", "simulated", "noise")]
            series.setdefault((row["column"], row["unit"]), []).append(numbers)
    return {column: list(zip(*rows)) for column, rows in series.items()}


def main(data, picture):
    series = read(data)
    figure, axes = pyplot.subplots(len(series), 2, figsize=(10, 2.2 * len(series) + 0.6), sharex=True, squeeze=False)
    for (motion, residuals), ((name, unit), columns) in zip(axes, series.items()):
        times, measured, simulated, noise = columns
        motion.plot(times, measured, ".", markersize=2, color="grey", label="measured")
        motion.plot(times, simulated, "-", linewidth=1, label="simulated")
        motion.set_ylabel(f"{name} [{unit}]", fontsize="x-small")
        residuals.plot(times, [b - a for a, b in zip(measured, simulated)], ".", markersize=2)
        residuals.axhspan(-noise[0], noise[0], color="grey", alpha=0.2)
        residuals.set_ylabel(f"residual [{unit}]", fontsize="x-small")
        for place in (motion, residuals):
            place.grid(True, alpha=0.3)
            place.tick_params(labelsize="x-small")
    axes[0][0].legend(fontsize="x-small")
    for place in axes[-1]:
        place.set_xlabel("time [s]", fontsize="small")
    figure.tight_layout()
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
