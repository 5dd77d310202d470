#!/usr/bin/python3
"""Test includes: rooms include only rooms below them, in the order of the table in docs/architecture.md. Users need
public headers alone."""

import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SOURCES = (".h", ".cpp")
# Folders outside of the core, which use it like any user. All of them may use `pictures`, `messages`, `stepping` and
# `web`, and one node uses parts of the other node.
OUTSIDE = ("src/messages", "src/stepping", "src/ros", "src/ros_control", "examples")
SHARED = ("pictures/", "messages/", "stepping/", "web/", "ros/", "ros_control/")
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.MULTILINE)


def rooms():
    """Return the names of the rooms from the lowest to the highest."""
    with open(os.path.join(ROOT, "docs", "architecture.md"), encoding="utf-8") as file:
        return re.findall(r"^\| `(\w+)/` \|", file.read(), re.MULTILINE)


def files(folder):
    """Yield the paths of the sources below a folder, relative to the root."""
    for path, _, names in os.walk(os.path.join(ROOT, folder)):
        for name in sorted(names):
            if name.endswith(SOURCES):
                yield os.path.relpath(os.path.join(path, name), ROOT)


def includes(path):
    """Return pairs of '"' or '<' and the included name."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return INCLUDE.findall(file.read())


def is_public(name):
    return os.path.isfile(os.path.join(ROOT, "include", name))


class Rooms(unittest.TestCase):
    def test_every_folder_is_in_the_table(self):
        folders = {name for parent in ("src", "include/flexarm") for name in os.listdir(os.path.join(ROOT, parent))}
        self.assertEqual(folders, set(rooms()))

    def test_nothing_includes_upwards(self):
        order = rooms()
        upwards = []
        for height, room in enumerate(order):
            above = set(order[height + 1 :])
            for folder in ("src/" + room, "include/flexarm/" + room):
                for path in files(folder):
                    for bracket, name in includes(path):
                        if bracket == "<":
                            continue  # another project's header, for example <ros/time.h>
                        parts = name.split("/")
                        included = parts[1] if parts[0] == "flexarm" and len(parts) > 2 else parts[0]
                        if len(parts) > 1 and included in above:
                            upwards.append("%s includes %s" % (path, name))
        self.assertEqual(upwards, [])

    def test_users_include_public_headers_only(self):
        inside = []
        for folder in OUTSIDE:
            for path in files(folder):
                for _, name in includes(path):
                    if os.path.isfile(os.path.join(ROOT, "src", name)) and not name.startswith(SHARED):
                        inside.append("%s includes %s" % (path, name))
        self.assertEqual(inside, [])


class PublicHeaders(unittest.TestCase):
    def test_include_public_headers_the_standard_library_and_eigen(self):
        others = []
        for path in files("include"):
            for bracket, name in includes(path):
                is_standard = bracket == "<" and re.fullmatch(r"[a-z_]+", name)
                if not (is_standard or name.startswith("Eigen/") or is_public(name)):
                    others.append("%s includes %s" % (path, name))
        self.assertEqual(others, [])

    def test_compile_alone(self):
        """Compile each public header alone, with the compiler and include folders that are given as arguments."""
        compiler, *folders = ARGUMENTS
        options = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++", "-"]
        for path in files("include"):
            header = os.path.relpath(path, "include")
            with self.subTest(header):
                result = subprocess.run(
                    [compiler, "-I" + os.path.join(ROOT, "include")] + ["-isystem" + f for f in folders] + options,
                    input='#include "%s"\n' % header,
                    stderr=subprocess.PIPE,
                    universal_newlines=True,
                    check=False,
                )
                self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    ARGUMENTS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
