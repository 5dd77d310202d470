#!/usr/bin/python3
"""Plots results of `flexarm bench accuracy`: true over requested error, and cost relative to the best fixed choice.

plot_accuracy.py DATA.csv PICTURE
"""

import csv

from headless_pyplot import pyplot, run


def read(path):
    """Reads the rows of runs that met their accuracy and have a true error."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["met"] == "1" and row["error"]]
    for row in rows:
        row["asked"], row["error"] = float(row["asked"]), float(row["error"])
    return [row for row in rows if row["error"] > 0]


def spread(rows):
    """Abscissas of the rows, spread around the requested error so that points do not hide each other."""
    counts, places = {}, []
    for row in rows:
        counts[row["asked"]] = counts.get(row["asked"], 0) + 1
        places.append(row["asked"] * 10 ** (0.35 * ((counts[row["asked"]] * 0.618034) % 1 - 0.5)))
    return places


def main(data, picture):
    rows = read(data)
    figure, (errors, costs) = pyplot.subplots(1, 2, figsize=(11, 4.8))
    for group in sorted({row["group"] for row in rows}):
        chosen = [row for row in rows if row["group"] == group]
        # A group with scenes of both kinds gets the mark of the majority.
        cornered = sum(row["corners"] == "cornered" for row in chosen) > len(chosen) / 2
        mark = "^" if cornered else "o"
        errors.plot(spread(chosen), [row["error"] for row in chosen], mark, markersize=4, alpha=0.7, label=group)
        priced = [row for row in chosen if row["fixed_seconds"] and float(row["fixed_seconds"]) > 0]
        costs.plot(spread(priced), [float(row["seconds"]) / float(row["fixed_seconds"]) for row in priced], mark,
                   markersize=4, alpha=0.7, label=group)
    if rows:
        above = sum(row["error"] > row["asked"] for row in rows)
        ends = [min(row["asked"] for row in rows) / 2, 2 * max(row["asked"] for row in rows)]
        errors.plot(ends, ends, "-", color="black", linewidth=1, label="as asked for")
        errors.plot(ends, [3 * end for end in ends], ":", color="black", linewidth=1, label="three times that")
        for axes in (errors, costs):
            axes.set_xlim(*ends)
            axes.set_xscale("log")
            axes.set_yscale("log")
        errors.set_title(f"above what was asked for: {above} of {len(rows)}, {100 * above / len(rows):.1f} %"
                         " (triangles: with corners)")
    costs.set_yticks([0.5, 1, 1.5, 2, 3, 5])
    costs.yaxis.set_major_formatter("{x:g}")
    costs.minorticks_off()
    costs.axhline(1.5, color="black", linestyle=":", linewidth=1)
    errors.set_ylabel("true error")
    costs.set_ylabel("time over that of the best fixed choice")
    for axes in (errors, costs):
        axes.set_xlabel("error asked for")
        axes.grid(True, which="major", alpha=0.3)
    errors.legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
