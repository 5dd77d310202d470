"""The command `flexarm sweep`."""

import argparse
import os
import signal
import sys
import time
import warnings

SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 128  # exit status, as of flexarm's other commands

try:
    from . import cluster, pages, processes
    from .input import InputError
    from .plan import read_plan
    from .progress import ProgressBar, duration_text
    from .results import Results
except ModuleNotFoundError as error:
    sys.exit("flexarm: sweep needs Python's package '%s', Debian's python3-%s" % (error.name, error.name))


class Interrupted(Exception):
    """A signal has ended the program; the argument is its number."""


def interrupt(number, _frame):
    raise Interrupted(number)


def whole_number(least):
    def number(text):
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError("expected a whole number >= %d, got '%s'" % (least, text))
        return int(text)

    return number


def run_numbers(text):
    return [whole_number(1)(number) for number in text.split(",")]


def read_arguments(words):
    parser = argparse.ArgumentParser(
        prog="flexarm sweep", description="Runs a scene many times, with the parameters of a plan (docs/sweep.md).")
    parser.add_argument("scene", help="scene file, with parameters")
    parser.add_argument("plan", help="YAML file with the values of parameters and the quantities to be measured")
    parser.add_argument("--output", help="CSV file for the results; an existing one is continued (PLAN_results.csv)")
    places = parser.add_mutually_exclusive_group()
    places.add_argument("--workers", type=whole_number(1), help="number of processes (one for each processor)")
    places.add_argument("--scheduler", metavar="ADDRESS",
                        help="address of a Dask scheduler, whose workers do the runs, or its scheduler file, FILE.json")
    parser.add_argument("--retries", type=whole_number(0), default=2,
                        help="how often a run is repeated if its process dies (2)")
    parser.add_argument("--repeat-failed", action="store_true", help="repeats runs that failed")
    parser.add_argument("--show", metavar="RUN,...", type=run_numbers, default=[],
                        help="repeats these runs, and writes a page that plays them side by side in a browser")
    parser.add_argument("--open", action="store_true", help="opens the page in a browser")
    parser.add_argument("--quiet", action="store_true", help="no progress bar and no summary")
    arguments = parser.parse_args(words)
    if arguments.open and not arguments.show:
        parser.error("--open: expected --show beside it")
    return arguments


def output_of(arguments):
    """The output file; raises InputError if it is one of the input files."""
    stem = os.path.splitext(os.path.basename(arguments.plan))[0]
    output = arguments.output or stem + "_results.csv"
    for path in (arguments.scene, arguments.plan):
        if os.path.exists(output) and os.path.exists(path) and os.path.samefile(output, path):
            raise InputError("--output would overwrite '%s'" % path)
    return output


def runs_of(plan, output, numbers):
    """The arguments of perform() for each of the runs: number, parameters, and file of the history."""
    path = ""
    if plan.job.history:
        folder = os.path.abspath(os.path.splitext(output)[0] + "_histories")
        os.makedirs(folder, exist_ok=True)
        path = os.path.join(folder, "run_%06d." + {"hdf5": "h5", "csv": "csv"}[plan.job.history.format])
    return [(number, dict(zip(plan.design.names, plan.design.rows[number - 1])), path and path % number)
            for number in numbers]


def sweep(arguments):
    output = output_of(arguments)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        plan = read_plan(arguments.scene, arguments.plan)
    for warning in caught:
        print(warning.message, file=sys.stderr)
    for number in arguments.show:
        if number > len(plan.design.rows):
            raise InputError("--show: expected numbers of runs up to %d, got %d" % (len(plan.design.rows), number))
    results = Results(output, plan, arguments.repeat_failed)
    begin, there = time.monotonic(), len(results.rows)
    bar = ProgressBar(there, len(plan.design.rows), not arguments.quiet)
    runs = runs_of(plan, output, results.missing())
    if arguments.scheduler:
        outcomes = cluster.perform_all(plan.job, runs, arguments.scheduler, arguments.retries)
    else:
        workers = arguments.workers or len(os.sched_getaffinity(0))
        outcomes = processes.perform_all(plan.job, runs, workers, arguments.retries)
    failures = results.failures()
    try:
        for number, outcome in outcomes:
            signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)  # so that rows are always complete
            results.add(number, outcome)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
            failures += bool(outcome.failure)
            bar.show(len(results.rows), failures)
        results.finish()
    except (Interrupted, OSError):
        bar.clear()
        print("flexarm: %d of %d runs are in '%s'; the same command makes the others"
              % (len(results.rows), len(plan.design.rows), output), file=sys.stderr)
        raise
    finally:
        bar.clear()
        outcomes.close()
        results.close()
    if not arguments.quiet:
        print("%s: %d runs, %d of them now, in %s%s"
              % (output, len(results.rows), len(results.rows) - there, duration_text(time.monotonic() - begin),
                 "; %d failed, the column 'failure' says why" % failures if failures else ""))
    if arguments.show:
        page = os.path.splitext(output)[0] + ".html"
        pages.write_page(page, plan, arguments.show, arguments.open)
        print("%s shows it in a browser" % page)
    return DONE


def main(words=None):
    arguments = read_arguments(words)
    for number in SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, interrupt)
    try:
        return sweep(arguments)
    except InputError as error:
        print("flexarm: %s" % error, file=sys.stderr)
        return BAD_INPUT
    except Interrupted as error:
        print("flexarm: interrupted", file=sys.stderr)
        return INTERRUPTED + error.args[0]
    except (OSError, MemoryError) as error:
        print("flexarm: %s" % (error or "not enough memory"), file=sys.stderr)
        return FAILED


if __name__ == "__main__":
    sys.exit(main())
