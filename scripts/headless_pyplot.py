"""matplotlib's pyplot for scripts that draw into files: no display, and a message where it is not installed."""

import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(f"{os.path.basename(sys.argv[0])}: python3-matplotlib is not installed")

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

__all__ = ["pyplot", "run"]


def run(main, usage):
    """Calls main(data, picture) with the arguments of the command line, or says how the script is used."""
    if len(sys.argv) != 3:
        sys.exit(usage)
    main(*sys.argv[1:])
