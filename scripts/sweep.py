#!/usr/bin/python3
"""The program that `flexarm sweep` runs: runs a scene many times, with the parameters of a plan.

docs/sweep.md
"""

import os
import sys

# From Python 3.11 on, worker processes then import no modules from the working folder.
os.environ["PYTHONSAFEPATH"] = "1"

from flexarm.sweep.__main__ import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
