"""The command `flexarm bench validation`."""

import argparse
import difflib
import os
import sys
import traceback
import warnings
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from typing import List

from ..errors import SceneWarning
from ..sweep.progress import ProgressBar
from . import report
from .case import Case, MissingRecord, find_cases
from .rows import Identified, Row

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


@dataclass
class Outcome:
    """What became of a case. missing: the recorded file that ended it; failure: an exception's text."""

    name: str
    title: str = ""
    text: str = ""
    rows: List[Row] = field(default_factory=list)
    identified: List[Identified] = field(default_factory=list)
    has_picture: bool = False
    missing: str = ""
    failure: str = ""


def run_case(folder, data, output):
    """Runs the script of a case. Rows that come before a missing file are kept. Returns an Outcome."""
    warnings.simplefilter("ignore", SceneWarning)  # what is doubtful about a scene is in the text of its case
    case = Case(folder, data, output)
    outcome = Outcome(case.name, case.name)
    try:
        outcome.title, outcome.text = case.text()
        for row in case.compare():
            outcome.rows.append(row)
        if not outcome.rows:
            raise ValueError("compare() has no rows")
    except MissingRecord as missing:
        outcome.missing = str(missing)
    except Exception:  # a case that fails leaves the others alone
        outcome.failure = traceback.format_exc().rstrip()
    outcome.identified, outcome.has_picture = case.identified, case.has_picture
    return outcome


def _arguments(words, own_folder):
    parser = argparse.ArgumentParser(
        prog="flexarm bench validation",
        description="flexarm beside published measurements: a table, and pages with pictures (docs/validation).")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="only these (all); --list has their names")
    parser.add_argument("--data", metavar="FOLDER", action="append", default=[],
                        help="folder of recorded files of others, which are not part of flexarm; may be repeated")
    parser.add_argument("--output", metavar="FOLDER", help="folder for pages and pictures (none)")
    parser.add_argument("--cases", dest="folder", metavar="FOLDER", default=own_folder,
                        help="folder of the cases (those that come with flexarm)")
    parser.add_argument("--workers", type=_count, default=len(os.sched_getaffinity(0)),
                        help="number of cases that run at the same time (one for each processor)")
    parser.add_argument("--list", action="store_true", help="prints the names of the cases")
    arguments = parser.parse_args(words)
    _check(arguments, parser)
    return arguments


def _count(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError("must be a number >= 1, got '%s'" % text)
    return int(text)


def _check(arguments, parser):
    """Folders and names, before anything is run."""
    for option, folder in [("--data", each) for each in arguments.data] + [("--cases", arguments.folder)]:
        if not os.path.isdir(folder):
            parser.error("%s: there is no folder '%s'" % (option, folder))
    names = find_cases(arguments.folder)
    if not names:
        parser.error("--cases: there are no cases in '%s'" % arguments.folder)
    for name in arguments.cases:
        if name not in names:
            near = difflib.get_close_matches(name, names, 1)
            parser.error("there is no case '%s'%s" % (name, "; '%s'?" % near[0] if near else ", see --list"))
    arguments.is_complete = not arguments.cases
    arguments.cases = [name for name in names if name in (arguments.cases or names)]
    if arguments.output:
        try:
            os.makedirs(arguments.output, exist_ok=True)
        except OSError as error:
            parser.error("--output: '%s' cannot be made: %s" % (arguments.output, error.strerror))
        if not os.access(arguments.output, os.W_OK):
            parser.error("--output: '%s' cannot be written" % arguments.output)


def _run(arguments):
    """Outcomes of all cases, in their order."""
    outcomes = {}
    bar = ProgressBar(0, len(arguments.cases), True)
    with ProcessPoolExecutor(arguments.workers) as pool:
        pending = [pool.submit(run_case, os.path.join(arguments.folder, name), arguments.data, arguments.output)
                   for name in arguments.cases]
        try:
            for done in as_completed(pending):
                outcome = done.result()
                outcomes[outcome.name] = outcome
                bar.show(len(outcomes), sum(bool(each.failure) for each in outcomes.values()))
        except KeyboardInterrupt:
            for each in pending:
                each.cancel()
            raise
        finally:
            bar.clear()
    return [outcomes[name] for name in arguments.cases]


def main(words, own_folder):
    """Runs the command. own_folder: that of flexarm's own cases. Returns the exit status."""
    arguments = _arguments(words, own_folder)
    if arguments.list:
        print("\n".join(arguments.cases))
        return DONE
    try:
        outcomes = _run(arguments)
    except KeyboardInterrupt:
        print("flexarm bench validation: interrupted, nothing is written", file=sys.stderr)
        return INTERRUPTED
    if arguments.output:
        report.write(outcomes, arguments.output, arguments.is_complete)
    print(report.terminal_table(outcomes))
    print(report.summary(outcomes))
    failures = [outcome for outcome in outcomes if outcome.failure]
    for outcome in failures:
        print("flexarm bench validation: %s failed:\n%s" % (outcome.name, outcome.failure), file=sys.stderr)
    return FAILED if failures else DONE
