#!/usr/bin/python3
"""The program that `flexarm bench validation` runs: flexarm beside published measurements.

bench/validation/README.md
"""

import os
import sys

sys.dont_write_bytecode = True  # beside the scripts of the cases
# One case per processor; threads of numpy beside them would only get in each other's way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# From Python 3.11 on, worker processes then import no modules from the working folder.
os.environ["PYTHONSAFEPATH"] = "1"

from flexarm.validation.program import main  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # of the sources, or of the installation's share

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], os.path.join(ROOT, "bench", "validation")))
