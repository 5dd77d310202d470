"""matplotlib's pyplot for scripts that draw to files, without a display. Exits if it is not installed."""

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
    """Calls main(data, picture) with the command-line arguments, or prints the usage."""
    if len(sys.argv) != 3:
        sys.exit(usage)
    main(*sys.argv[1:])
