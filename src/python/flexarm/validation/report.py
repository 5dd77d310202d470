"""The table on the terminal, and pages in Markdown."""

import math
import os

from .case import TEXT
from .rows import FITTED, MEASURED, WITHIN, count

MISSED = 0.05  # share of results that are outside of an uncertainty of 95 %
REPOSITORY = "../../bench/validation"  # seen from docs/validation


def number(value):
    """Four digits; without an exponent where that is as short."""
    text = "%.4g" % value
    return "%.0f" % value if "e+0" in text else text


def size(row):
    """The error as the table shows it."""
    return "-" if math.isnan(row.flexarm) else "%+.3g" % row.error


def state(outcome):
    """In a few words: how a case ended."""
    if outcome.failure:
        return "failed: " + outcome.failure.splitlines()[-1]
    within, all_of_them = count(outcome.rows)
    if not outcome.rows:
        return "not run: %s is not there" % outcome.missing
    text = "%d of %d within" % (within, all_of_them)
    return text + (", rest not run: %s is not there" % outcome.missing if outcome.missing else "")


def columns(table):
    """Lines of a table whose columns are aligned: numbers, which begin with a digit or sign, on the right."""
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    return ["  ".join(text.rjust(width) if 0 < i < 5 else text.ljust(width)
                      for i, (text, width) in enumerate(zip(row, widths))).rstrip() for row in table]


def cells(row):
    """The texts of a row of the table."""
    return [row.quantity, number(row.published), number(row.flexarm), size(row), "%.2g" % row.uncertainty, row.unit,
            row.kind, row.verdict]


HEADER = ["quantity", "published", "flexarm", "error", "uncertainty", "unit", "kind", "verdict"]
PARTS = ["own part", "identified part"]  # of the uncertainty


def terminal_table(outcomes):
    """One table of all cases, with the case's name and state above its rows."""
    lines = columns([HEADER] + [cells(row) for outcome in outcomes for row in outcome.rows])
    text, rest = [lines[0]], lines[1:]
    for outcome in outcomes:
        text.append("%s: %s" % (outcome.name, state(outcome)))
        text += rest[:len(outcome.rows)]
        rest = rest[len(outcome.rows):]
    return "\n".join(text)


def by_chance(rows):
    """How many predictions are outside, and how many would be if uncertainties of 95 % were all there is; or ""."""
    within, all_of_them = count(rows)
    if not all_of_them:
        return ""
    return "%d of %d, by chance %.1f, at most %d" % (all_of_them - within, all_of_them, MISSED * all_of_them,
                                                     most(all_of_them, MISSED))


def is_by_chance(rows):
    """Whether there are predictions, and not more outside than may be by chance."""
    within, all_of_them = count(rows)
    return all_of_them > 0 and all_of_them - within <= most(all_of_them, MISSED)


def most(trials, chance):
    """The least number of successes that is not exceeded with a probability of 95 % (binomial distribution)."""
    successes, total = 0, (1 - chance) ** trials
    term = total
    while total < 0.95:
        term *= (trials - successes) / (successes + 1) * chance / (1 - chance)
        successes += 1
        total += term
    return successes


def whole(lists):
    """How many of these lists of rows have predictions, and all of them within."""
    return sum(within == whole > 0 for within, whole in map(count, lists))


def summary(outcomes):
    """The last line: how many cases have all predictions within their uncertainty, and how many all measured ones."""
    run = [outcome.rows for outcome in outcomes if outcome.rows and not outcome.failure]
    counts = [count(rows) for rows in run]
    text = "%d of %d predictions are within the uncertainty; %d of %d cases are with all of theirs" % (
        sum(within for within, _ in counts), sum(each for _, each in counts), whole(run), len(run))
    measured = [[row for row in rows if row.kind == MEASURED] for rows in run]
    if not any(measured):
        return text
    return text + ", %d with all measured ones. Measured ones outside: %s; in %d of %d cases not more than that" % (
        whole(measured), by_chance([row for rows in measured for row in rows]),
        sum(is_by_chance(rows) for rows in measured), sum(count(rows)[1] > 0 for rows in measured))


def markdown_row(texts):
    return "| %s |" % " | ".join(text.replace("|", "\\|") for text in texts)


def markdown_table(rows):
    """The table of a page. If numbers were identified, both parts of the uncertainty stand beside it."""
    parts = PARTS if any(row.propagated for row in rows) else []
    lines = [markdown_row(HEADER[:5] + parts + HEADER[5:] + ["note"]),
             "|---|" + "--:|" * (4 + len(parts)) + "---|" * 4]
    for row in rows:
        texts = cells(row)
        verdict = row.verdict if row.verdict in (WITHIN, FITTED) else "**%s**" % row.verdict
        sizes = ["%.2g" % size for size in (row.own, row.propagated)][:len(parts)]
        lines.append(markdown_row(texts[:5] + sizes + texts[5:-1] + [verdict, row.note]))
    return "\n".join(lines)


def identified_text(numbers):
    """A list of what was identified; empty if nothing was."""
    lines = []
    for each in numbers:
        error = "" if math.isnan(each.standard_error) else " ± %s" % number(each.standard_error)
        value = " ".join(part for part in (number(each.value) + error, each.unit) if part)
        scatter = "" if each.birge <= 1 else ", which scatter by %.2g of their uncertainties" % each.birge
        lines.append("- %s: %s, from %s%s" % (each.name, value, each.source, scatter))
    return "Identified (± standard error):\n\n" + "\n".join(lines) + "\n\n" if lines else ""


def page(outcome):
    """The page of a case."""
    parts = ["# %s\n\n%s\n\n" % (outcome.title, outcome.text)]
    if outcome.has_picture:
        parts.append("![flexarm beside the published numbers](%s.png)\n\n" % outcome.name)
    parts.append(identified_text(outcome.identified))
    if outcome.rows:
        parts.append(markdown_table(outcome.rows) + "\n\n")
    if outcome.missing:
        parts.append("Not run: %s is not there.\n\n" % outcome.missing)
    parts.append("Scenes, numbers and script: [bench/validation/%s](%s/%s). `flexarm bench validation %s` makes this "
                 "page.\n" % (outcome.name, REPOSITORY, outcome.name, outcome.name))
    return "".join(parts)


INDEX_TEXT = """# Beside measurements

flexarm beside numbers that others have published: measured ones, and such that other programs or closed forms give.
Each case has its own page, with what agrees, what does not, and why. `flexarm bench validation` computes all of it
anew. A row is *within* if the difference between flexarm and the published number is not larger than the uncertainty.
Rows that were used to identify a number are *fitted*, and do not count.

Uncertainties are expanded ones, about 95 % (k = 2). They have two parts, whose squares add up: the row's own one, of
the measurement and of what the scene is made of, and that of the identified numbers, propagated to the predicted row
(ASME V&V 20, GUM). The README of [bench/validation](../../bench/validation) says how.

The first count is the strict one. Beside it: how many measured rows are outside, how many would be by chance if the
uncertainties of 95 % were all there is (5 % of them in the mean; at most so many in 95 of 100 cases, by the binomial
distribution). Rows of a case are not independent, so that this is only a rule of thumb.

Recorded files of others are not part of the repository: `--data FOLDER` names the folder that has them. The pages
say where they are from.

"""


def groups(rows):
    """How many predictions are within: of each group of rows, or of all if they have no groups."""
    parts = []
    for group in dict.fromkeys(row.group for row in rows):
        within, whole = count([row for row in rows if row.group == group])
        if whole:
            parts.append("%s%d of %d" % (group and group + ": ", within, whole))
    return ", ".join(parts)


def index_row(outcome):
    ratios = [row.ratio for row in outcome.rows if not row.is_fitted]
    measured = [row for row in outcome.rows if row.kind == MEASURED]
    others = [row for row in outcome.rows if row.kind != MEASURED]
    text = groups(measured)
    if not outcome.rows or outcome.missing or outcome.failure:
        text += (text and "; ") + state(outcome)
    within, whole = count(others)
    return markdown_row(["[%s](%s.md)" % (outcome.title, outcome.name), text,
                         "%d of %d" % (within, whole) if whole else "", "%.2g" % max(ratios) if ratios else "",
                         by_chance(measured), ", ".join(each.name for each in outcome.identified)])


def index(outcomes):
    """The page that lists all cases: first those with measurements."""
    parts = [INDEX_TEXT]
    is_measured = [not outcome.rows or any(row.kind == MEASURED for row in outcome.rows) for outcome in outcomes]
    for title, kind in (("Measured", True), ("Calculated", False)):
        chosen = [outcome for outcome, each in zip(outcomes, is_measured) if each == kind]
        if not chosen:
            continue
        lines = [markdown_row(["case", "measured, within", "calculated or closed form, within",
                               "largest error / uncertainty", "measured, outside", "identified"]),
                 "|---|---|--:|--:|---|---|"]
        lines += [index_row(outcome) for outcome in chosen]
        parts.append("## %s\n\n%s\n\n%s.\n\n" % (title, "\n".join(lines), summary(chosen)))
        parts += ["[![%s](%s.png)](%s.md)\n\n" % (outcome.title, outcome.name, outcome.name)
                  for outcome in chosen if outcome.has_picture]
    return "".join(parts).rstrip("\n") + "\n"


def write(outcomes, folder, with_index):
    """Writes a page for each case, and the index."""
    for outcome in outcomes:
        _write(os.path.join(folder, outcome.name + ".md"), page(outcome))
    if with_index:
        _write(os.path.join(folder, TEXT), index(outcomes))


def _write(path, text):
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)
