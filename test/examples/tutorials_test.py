#!/usr/bin/python3
"""The commands of the tutorials, typed as they stand, in one folder: `tutorials_test.py PROGRAM`."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
TUTORIALS = "tutorial_flexible_link.md", "tutorial_servo.md"  # the second goes on where the first ends


def commands_of(name):
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return re.findall(r"^```sh\n(.*?)^```", file.read(), re.DOTALL | re.MULTILINE)


class Tutorials(unittest.TestCase):
    def test_commands(self):
        commands = [command for name in TUTORIALS for command in commands_of(name)]
        self.assertEqual(len(commands), 8)
        # Before those of the environment, in which `flexarm` and python are looked up.
        path = [os.path.dirname(PROGRAM), os.path.dirname(sys.executable), os.environ["PATH"]]
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run(
                ["bash", "-c", "set -e\n" + "\n".join(commands)],
                cwd=folder,
                env=dict(os.environ, PATH=os.pathsep.join(path)),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                universal_newlines=True,
                check=False,
            )
            print(result.stdout)
            self.assertEqual(result.returncode, 0)
            self.assertGreater(os.path.getsize(os.path.join(folder, "shaped_slew.png")), 0)
        # What the text says that comes out.
        for expected in ("mode 2: 4.56", "motor -6.105 N m", "shoulder at the end: 0.999", "swing: 4.567",
                         "unshaped: the hand swings by 31.", "shaped: the hand swings by 0.8"):
            self.assertIn(expected, result.stdout)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
