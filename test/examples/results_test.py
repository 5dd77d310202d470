#!/usr/bin/python3
"""The commands of docs/results.md, typed as they stand: `results_test.py PROGRAM`."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def text_of(name):
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return file.read()


class Results(unittest.TestCase):
    def test_commands(self):
        arm = re.search(r'<robot name="arm">.*?</robot>', text_of("guide.md"), re.DOTALL).group(0)
        commands = re.findall(r"^```sh\n(.*?)^```", text_of("results.md"), re.DOTALL | re.MULTILINE)
        self.assertEqual(len(commands), 5)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "arm.urdf"), "w", encoding="utf-8") as file:
                file.write(arm)
            script = "set -e\nflexarm() { '%s' \"$@\"; }\n%s" % (PROGRAM, "\n".join(commands))
            result = subprocess.run(
                ["bash", "-c", script],
                cwd=folder,
                env=dict(os.environ, PATH=os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"]),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                universal_newlines=True,
                check=False,
            )
        print(result.stdout)
        self.assertEqual(result.returncode, 0)
        for expected in ("arm em 0.001 s", "sensor/gauge/strain [1] 4001", "/sensors/cell geometry_msgs/WrenchStamped",
                         "/tf tf2_msgs/TFMessage 401", "largest pull"):
            self.assertIn(expected, result.stdout)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
