"""The command `flexarm plot`."""

import argparse
import os
import shutil
import sys

from ..errors import ResultsError
from ..results import Run, read_columns
from . import curves, figures, terminal

DONE, FAILED, BAD_INPUT = 0, 1, 2  # exit status, as of flexarm's other commands
EXTENSIONS_OF_RUNS = ".csv", ".h5", ".hdf5", ".bag"
EXTENSIONS_OF_PICTURES = ".png", ".svg", ".pdf"


def read_arguments(words):
    parser = argparse.ArgumentParser(
        prog="flexarm plot", usage="flexarm plot [OPTIONS] RUN... COLUMN...",
        description="Draws columns of results over time: as a picture with --output, else in a window, or in the "
                    "terminal if there is no display (docs/plot.md). Without COLUMN it lists the columns.")
    parser.add_argument("words", nargs="+", metavar="RUN... COLUMN...",
                        help="files of results: .csv, .h5 or .bag, any existing file, or - for CSV on the standard "
                             "input; all other words are names or patterns of columns, such as 'joint/*/position'")
    parser.add_argument("--output", metavar="FILE", help="file for the picture: .png, .svg or .pdf")
    parser.add_argument("--terminal", action="store_true", help="draws in the terminal, even if there is a display")
    parser.add_argument("--difference", action="store_true",
                        help="draws the other runs minus the first one, at the first one's times")
    parser.add_argument("--spectrum", action="store_true", help="draws amplitudes over frequency")
    parser.add_argument("--window", default="flattop", metavar="NAME",
                        help="window of spectra, by its name in scipy.signal.get_window (flattop)")
    parser.add_argument("--max-frequency", type=positive, metavar="FREQUENCY", default=float("inf"),
                        help="of spectra [Hz]; what is above is not drawn")
    parser.add_argument("--phase", nargs=2, metavar=("X", "Y"), action="append", default=[],
                        help="draws column Y over column X; may be repeated")
    parser.add_argument("--from", dest="begin", type=float, metavar="TIME", default=-float("inf"),
                        help="first time that is drawn [s]")
    parser.add_argument("--until", dest="end", type=float, metavar="TIME", default=float("inf"),
                        help="last time that is drawn [s]")
    parser.add_argument("--log", choices=("x", "y", "xy"), default="", help="axes with a logarithmic scale")
    parser.add_argument("--title", help="title of the plot")
    parser.add_argument("--size", type=size_of, metavar="WIDTHxHEIGHT",
                        help="in pixels, of which an inch has 100; in the terminal in characters")
    arguments = parser.parse_intermixed_args(words)
    arguments.runs = [word for word in arguments.words if is_run(word)]
    arguments.columns = [pattern for word in arguments.words if not is_run(word) for pattern in word.split(",")]
    if not arguments.runs:
        parser.error("there is no file '%s'; expected a file of results first" % arguments.words[0])
    if arguments.phase and arguments.columns:
        parser.error("expected no columns beside those of --phase, got '%s'" % arguments.columns[0])
    if arguments.output and os.path.splitext(arguments.output)[1].lower() not in EXTENSIONS_OF_PICTURES:
        parser.error("--output: expected a name that ends in .png, .svg or .pdf, got '%s'" % arguments.output)
    if not arguments.begin < arguments.end:
        parser.error("expected --from before --until, got %g and %g" % (arguments.begin, arguments.end))
    return arguments


def size_of(text):
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and 0 < int(width) <= 10000 and 0 < int(height) <= 10000):
        raise argparse.ArgumentTypeError("expected WIDTHxHEIGHT in whole numbers up to 10000, got '%s'" % text)
    return int(width), int(height)


def positive(text):
    try:
        value = float(text)
    except ValueError:
        value = 0
    if not value > 0:
        raise argparse.ArgumentTypeError("expected a number > 0, got '%s'" % text)
    return value


def is_run(word):
    return word == "-" or os.path.isfile(word) or os.path.splitext(word)[1] in EXTENSIONS_OF_RUNS


def list_columns(runs):
    for run in runs:
        print(curves.printable("%s: %d rows" % (run.name, len(run.rows))
                               + (", %g s to %g s" % (run.times[0], run.times[-1]) if len(run.rows) else "")))
        for name, unit in zip(run.names, run.units):
            print("  " + curves.printable(curves.labelled(name, unit)))


def read(path, columns):
    """Reads a run as read_run() does. Of a file that has lost its end, what is left, with a warning."""
    losses = []
    try:
        table = read_columns(path, columns, losses)
    finally:  # also if what is left does not do
        for loss in losses:
            print("flexarm: plot: warning: %s" % curves.printable(loss), file=sys.stderr)
    return Run(table.names, table.units, table.rows, "standard input" if path == "-" else path)


def plot(arguments):
    wanted = arguments.columns or [pattern for pair in arguments.phase for pattern in pair]
    runs = [read(path, wanted or None) for path in arguments.runs]
    if not wanted:
        return list_columns(runs)
    runs = [run.between(arguments.begin, arguments.end) for run in runs]
    chosen = curves.choose(runs, arguments.columns, arguments.difference, arguments.spectrum, arguments.phase,
                           arguments.log, arguments.window, arguments.max_frequency, arguments.title)
    if arguments.output:
        try:
            figures.save(chosen, arguments.output, arguments.size)
        except OSError as error:
            raise OSError("cannot write '%s': %s" % (arguments.output, error.strerror)) from None
    elif arguments.terminal or not figures.has_display():
        print_plot(chosen, arguments.size)
    elif not figures.show(chosen, arguments.size):
        print("flexarm: plot: no window could be opened on the display (python3-tk is one of the packages that draw "
              "windows)", file=sys.stderr)
        print_plot(chosen, shutil.get_terminal_size())
    return None


def print_plot(chosen, size):
    print(terminal.draw(chosen, *(size or shutil.get_terminal_size())), end="")


def main(words):
    """Runs the command line. Returns the exit status."""
    arguments = read_arguments(words)
    try:
        plot(arguments)
        sys.stdout.flush()
        return DONE
    except ResultsError as error:
        print("flexarm: plot: %s" % curves.printable(str(error)), file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:  # of a pager that has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except OSError as error:
        print("flexarm: plot: %s" % curves.printable(str(error)), file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        return 130
