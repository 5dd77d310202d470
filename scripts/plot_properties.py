#!/usr/bin/python3
"""Plots the numerical dissipation that `flexarm bench properties` measured.

plot_properties.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run


def read(path):
    """Reads lists of (omega h, spectral radius) by scheme."""
    curves = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            curves.setdefault(row["scheme"], []).append((float(row["omega_h"]), float(row["spectral_radius"])))
    return curves


def merge_equal(curves):
    """Lets schemes whose curves look the same share one curve and its label."""
    merged = []
    for name, points in curves.items():
        for names, others in merged:
            if len(others) == len(points) and all(abs(a[1] - b[1]) < 1e-3 for a, b in zip(others, points)):
                names.append(name)
                break
        else:
            merged.append(([name], points))
    return merged


def label(names):
    lines, line = [], ""
    for name in names:
        if len(line) + len(name) > 40:
            lines.append(line.rstrip())
            line = ""
        line += name + " "
    return "\n".join(lines + [line.rstrip()])


def main(data, picture):
    figure, (radius, loss) = pyplot.subplots(1, 2, figsize=(12, 4.8))
    for names, points in merge_equal(read(data)):
        x = [point[0] for point in points]
        radius.semilogx(x, [point[1] for point in points], label=label(names))
        # Schemes without losses are left out, since only round-off would be plotted.
        losses = [1 - rho ** (4 * 3.141592653589793 / w) for w, rho in points]
        if max(losses) > 1e-6:
            loss.loglog(x, [max(part, 1e-8) for part in losses], label=label(names))
        else:
            loss.plot([], [])
    radius.set_xlabel("ωh")
    radius.set_ylabel("factor of the amplitude per step")
    radius.set_ylim(0, 1.05)
    radius.legend(fontsize="small")
    loss.set_xlabel("ωh")
    loss.set_ylabel("part of the energy lost per period")
    loss.set_ylim(1e-6, 2)
    for axes in (radius, loss):
        axes.grid(True, which="major", alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
