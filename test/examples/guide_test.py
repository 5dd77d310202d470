#!/usr/bin/python3
"""Test that the output of `flexarm check` in the guide is what the program prints: `guide_test.py PROGRAM`."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

from typed_commands import text_of

DIGITS = 1e-3  # relative: other compilers round differently


def parts_of(text):
    """Return the words and numbers of a text, as one list for each line."""
    return [line.split() for line in text.strip().splitlines()]


def number(word):
    try:
        return float(word.rstrip(",;"))
    except ValueError:
        return None


class Guide(unittest.TestCase):
    def test_output_of_check(self):
        part = text_of("guide.md").split("\n## 3.")[1].split("\n## 4.")[0]
        scene = re.search(r"^```xml\n(<robot name=\"arm\">.*?)^```", part, re.DOTALL | re.MULTILINE).group(1)
        shown = re.search(r"^```text\n(.*?)^```", part, re.DOTALL | re.MULTILINE).group(1)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "arm.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(scene)
            done = subprocess.run([PROGRAM, "check", path], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  universal_newlines=True, check=True)
        self.assertEqual(done.stderr, "", "an ordinary flexible arm has no warnings")
        printed, expected = parts_of(done.stdout), parts_of(shown)
        self.assertEqual(len(printed), len(expected))
        for line, wanted in zip(printed, expected):
            self.assertEqual(len(line), len(wanted), (line, wanted))
            for word, other in zip(line, wanted):
                if number(word) is None:
                    self.assertEqual(word, other, (line, wanted))
                else:
                    self.assertAlmostEqual(number(word), number(other), delta=DIGITS * abs(number(other)))


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
