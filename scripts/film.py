#!/usr/bin/python3
"""The program that `flexarm film` runs: films a run.

docs/film.md
"""

import sys

from flexarm.film.program import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
