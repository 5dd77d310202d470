#!/usr/bin/python3
"""Test schemes for study without their library: `study_library_test.py PROGRAM LIBRARY`.

The program runs with links to all libraries that are beside LIBRARY, but not to LIBRARY itself."""

import os
import subprocess
import sys
import tempfile
import unittest

SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "demo_arm.urdf")


class WithoutTheLibrary(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        beside = os.path.dirname(LIBRARY)
        for name in os.listdir(beside):
            if name.startswith("libflexarm") and name != os.path.basename(LIBRARY):
                os.symlink(os.path.join(beside, name), os.path.join(folder.name, name))
        self.output = os.path.join(folder.name, "run.csv")
        self.environment = dict(os.environ, LD_LIBRARY_PATH=folder.name)

    def simulate(self, scheme):
        return subprocess.run(
            [PROGRAM, "simulate", SCENE, "--scheme", scheme, "--until", "0.01", "--quiet", "--output", self.output],
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
            check=False,
        )

    def test_the_error_names_scheme_and_library(self):
        for scheme in ("m1", "newmark", "hht3"):
            result = self.simulate(scheme)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("'%s'" % scheme, result.stdout)
            self.assertIn(os.path.basename(LIBRARY), result.stdout)
            self.assertIn("scripts/build", result.stdout)

    def test_other_schemes_do_not_need_it(self):
        for scheme in ("em", "edmc2"):
            result = self.simulate(scheme)
            self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    PROGRAM, LIBRARY = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
