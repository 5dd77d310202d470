#!/usr/bin/python3
"""The program that `flexarm show` becomes for results: writes a page that plays files of results."""

import sys

from flexarm.page_program import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
