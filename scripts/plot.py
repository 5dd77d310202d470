#!/usr/bin/python3
"""The program that `flexarm plot` runs: draws columns of results.

docs/plot.md
"""

import sys

from flexarm.plotting.program import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
