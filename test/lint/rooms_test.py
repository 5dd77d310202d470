#!/usr/bin/python3
"""Test includes: rooms include only rooms below them, in the order of the table in docs/architecture.md. Users need
public headers alone."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SOURCES = (".h", ".cpp")
# Folders outside of the core, which use it like any user. All of them may use `pictures`, `messages`, `stepping` and
# `web`, and one node uses parts of the other node.
OUTSIDE = ("src/messages", "src/stepping", "src/ros", "src/ros_control", "examples")
SHARED = ("pictures/", "messages/", "stepping/", "web/", "ros/", "ros_control/")
# What each version of Eigen includes: whoever includes the one has the others.
INCLUDED_BY = {"Eigen/Core": ("algorithm", "cassert", "cmath", "complex", "cstddef", "functional", "limits", "string")}
INCLUDED_BY["Eigen/Geometry"] = ("Eigen/Core",) + INCLUDED_BY["Eigen/Core"]
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


def errors_of(text):
    """Return the errors of a text, with the compiler and include folders that are given as arguments."""
    compiler, *folders = ARGUMENTS
    options = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++", "-"]
    options.append("-Wno-unused-const-variable")  # constants of headers are for others
    result = subprocess.run(
        [compiler] + ["-isystem" + folder for folder in folders] + options,
        input=text,
        stderr=subprocess.PIPE,
        universal_newlines=True,
        check=False,
    )
    return (result.stderr or "status %d" % result.returncode) if result.returncode else ""


def texts_of_headers_alone(folder):
    """Return a few texts that compile without warnings if each header of the folder does so alone.

    Each header has a namespace of its own, in which it sees only what it includes from the folder. Other projects'
    headers are outside, since parsing them, above all Eigen, takes nearly all the time. What is outside only becomes
    more along a text, and a header that does not include all of it goes into another text."""
    texts = []  # pairs of what is outside, and the lines
    alone = []
    for parent, _, names in os.walk(folder):
        for name in names:
            outside, lines = set(), []
            expand(os.path.relpath(os.path.join(parent, name), folder), folder, set(), outside, lines)
            alone.append((sorted(outside), lines))
    for number, (outside, lines) in enumerate(sorted(alone, key=lambda each: (len(each[0]), each))):
        fitting = [text for text in texts if text[0] <= set(outside)]
        if not fitting:
            texts.append((set(), []))
        before = max(fitting or texts[-1:], key=lambda text: len(text[0]))
        before[1].extend("#include <%s>" % name for name in outside if name not in before[0])
        before[0].update(outside)
        before[1].extend(["namespace alone_%d {" % number] + lines + ["}"])
    return ["\n".join(lines) + "\n" for _, lines in texts]


def expand(header, folder, seen, outside, lines):
    """Append the lines of a header to `lines`, in place of includes the lines of the folder's headers, each once. Other
    headers are added to `outside`."""
    seen.add(header)
    path = os.path.join(folder, header)
    lines.append('#line 1 "%s"' % path)
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            include = INCLUDE.match(line)
            if include and os.path.isfile(os.path.join(folder, include.group(2))):
                if include.group(2) not in seen:
                    expand(include.group(2), folder, seen, outside, lines)
                lines.append('#line %d "%s"' % (number + 1, path))
            else:
                if include:
                    outside.update({include.group(2)}.union(INCLUDED_BY.get(include.group(2), ())))
                lines.append("" if include or line.startswith("#pragma once") else line.rstrip())


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
        for text in texts_of_headers_alone(os.path.join(ROOT, "include")):
            errors = errors_of(text)
            self.assertFalse(errors, errors)

    def test_headers_that_do_not_compile_alone_are_found(self):
        headers = {
            "base.h": "#include <string>\nnamespace own { using Name = std::string; }\n",
            "good.h": '#include <vector>\n#include "base.h"\nnamespace own { using Names = std::vector<Name>; }\n',
        }
        self.assertEqual(self.errors_of_all(headers), "")
        without_standard = '#include "base.h"\nnamespace own { using Numbers = std::vector<int>; }\n'
        self.assertRegex(self.errors_of_all(dict(headers, **{"bad.h": without_standard})), "bad.h:2:.*vector")
        without_own = "#include <string>\n#include <vector>\nnamespace own { using More = Name; }\n"
        self.assertRegex(self.errors_of_all(dict(headers, **{"bad.h": without_own})), "bad.h:3:.*Name")

    def errors_of_all(self, headers):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in headers.items():
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            return "".join(map(errors_of, texts_of_headers_alone(folder)))


if __name__ == "__main__":
    ARGUMENTS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
