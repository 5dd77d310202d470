#!/usr/bin/python3
"""Prints what the parameter robot_description is to be: the text of a scene file.

robot_description.py FILE [NAME=VALUE...]

A file *.xacro is expanded by xacro with these arguments where that is installed; where it is not, the simulator says
what to do. Other words are passed over. What cannot be read is named by its whole path, with the reason.
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
