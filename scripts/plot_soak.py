#!/usr/bin/python3
"""Plots results of `scripts/soak` over wall time: memory, speed and energy of the node.

plot_soak.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run

LEAST_ENERGY = 1e-12  # J; less means that the simulation was just reset


def read(path):
    """Reads columns by name."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = ("wall", "memory", "simulated", "real_time_factor", "overruns", "energy", "defect")
    return {name: [float(row[name]) for row in rows] for name in names}


def main(data, picture):
    columns = read(data)
    figure, (memory, speed, energy) = pyplot.subplots(3, 1, figsize=(9, 8), sharex=True)
    memory.plot(columns["wall"], columns["memory"])
    memory.set_ylabel("resident memory [MiB]")
    memory.set_ylim(0, 1.2 * max(columns["memory"]))

    speed.plot(columns["wall"], columns["real_time_factor"], linewidth=0.8)
    speed.set_ylabel("real-time factor (0: paused)")
    overruns = speed.twinx()
    overruns.plot(columns["wall"], columns["overruns"], color="C3")
    overruns.set_ylabel("overruns [steps]", color="C3")
    overruns.set_ylim(0, 1.2 * max(1, *columns["overruns"]))

    energy.semilogy(columns["wall"], columns["energy"], linewidth=0.8, label="kinetic and strain")
    energy.semilogy(columns["wall"], columns["defect"], linewidth=0.8, label="change of total - work + dissipated")
    energy.set_ylabel("energy [J]")
    energy.set_xlabel("wall time [s]")
    energy.set_ylim(bottom=LEAST_ENERGY)
    energy.legend(loc="lower right", fontsize="small")
    for axes in (memory, speed, energy):
        axes.grid(True, alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
