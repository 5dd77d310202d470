#!/usr/bin/python3
"""Plots results of `flexarm bench hard`: a line for each case, a column for each scheme.

plot_hard.py DATA.csv PICTURE
"""

import csv
import math

from headless_pyplot import pyplot, run

# Number of panels side by side, so that all cases fill one page.
COLUMNS = 3
FAILED, WRONG, WARNED, DIAGNOSED, LEFT_OUT = "#d62728", "#ff9f40", "#ffe08a", "#9ecae1", "#e5e5e5"
MOST_ITERATIONS = 50
LONGEST_NAME = 50


def read(path):
    """Reads verdicts and iterations by case, in the file's order, and the list of schemes."""
    cases, schemes = {}, []
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            results = cases.setdefault((row["group"], row["case"]), {})
            results[row["scheme"]] = (row["verdict"], float(row["iterations"]))
            if row["scheme"] not in schemes:
                schemes.append(row["scheme"])
    return cases, schemes


def colour(verdict, iterations):
    """For right results green (quick) to blue (slow); other verdicts have colours of their own."""
    if verdict == "right":
        share = math.log(max(iterations, 1)) / math.log(MOST_ITERATIONS)
        return pyplot.get_cmap("viridis")(0.8 - 0.55 * min(share, 1))
    others = {"wrong": WRONG, "warned": WARNED, "diagnosed": DIAGNOSED, "left out": LEFT_OUT}
    return others.get(verdict, FAILED)


def lines(cases):
    """Lines of the plot: (heading, None) before each group, and (name, results) for each case."""
    out, last = [], None
    for (group, name), results in cases.items():
        if group != last:
            out.append((group, None))
            last = group
        out.append((name, results))
    return out


def shortened(name):
    return name if len(name) <= LONGEST_NAME else name[:LONGEST_NAME - 1] + "…"


def draw(axes, part, schemes):
    for y, (name, results) in enumerate(part):
        if results is None:
            axes.text(0, y + 0.85, name, fontsize=5.5, fontweight="bold")
            continue
        for x, scheme in enumerate(schemes):
            if scheme in results:
                axes.add_patch(pyplot.Rectangle((x, y + 0.05), 0.95, 0.9, color=colour(*results[scheme]), linewidth=0))
        axes.text(len(schemes) + 0.15, y + 0.8, shortened(name), fontsize=4.5)
    axes.set_xlim(0, len(schemes) + 14)
    axes.axis("off")


def legend(figure):
    entries = [(f"right, {n} iterations a step", colour("right", n)) for n in (1, 3, 10, 50)]
    entries += [("wrong", WRONG), ("wrong, warned", WARNED), ("failed, or unsound and not diagnosed", FAILED),
                ("unsound, diagnosed", DIAGNOSED), ("the scheme refuses it", LEFT_OUT)]
    handles = [pyplot.Rectangle((0, 0), 1, 1, color=shade) for _, shade in entries]
    figure.legend(handles, [text for text, _ in entries], loc="lower center", ncol=5, fontsize=6)


def main(data, picture):
    cases, schemes = read(data)
    everything = lines(cases)
    height = max(1, -(-len(everything) // COLUMNS))
    figure, panels = pyplot.subplots(1, COLUMNS, figsize=(8.3, 11.7))
    for i, axes in enumerate(panels):
        draw(axes, everything[i * height:(i + 1) * height], schemes)
        axes.set_ylim(height, -2.5)
        for x, scheme in enumerate(schemes):
            axes.text(x + 0.6, -0.2, scheme, fontsize=5, rotation=90, ha="center", va="bottom")
    legend(figure)
    figure.subplots_adjust(left=0.02, right=0.99, top=0.99, bottom=0.05, wspace=0.02)
    figure.savefig(picture, dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
