#!/usr/bin/python3
"""Prints the text of a scene file, for the parameter robot_description.

robot_description.py FILE [NAME=VALUE...]

A file *.xacro is expanded by xacro with these arguments if xacro is installed; if not, the simulator says what to do.
Other words are ignored. If the file cannot be read, its full path and the reason are printed.
"""

import os
import shutil
import sys


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    path = os.path.abspath(sys.argv[1])
    if path.endswith(".xacro") and shutil.which("xacro"):
        pairs = [word.split("=", 1) for word in sys.argv[2:] if "=" in word]
        os.execvp("xacro", ["xacro", path, *("%s:=%s" % (name.rstrip(":"), value) for name, value in pairs)])
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            sys.stdout.write(file.read())
    except OSError as error:
        sys.exit("scene %s: %s" % (path, error.strerror))


if __name__ == "__main__":
    main()
