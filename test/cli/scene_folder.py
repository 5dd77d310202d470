"""Helper of the tests of the command line: a scene in a folder that is removed."""

import os
import tempfile
import unittest


class Scenes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "arm.urdf")

    def write(self, text):
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(text)
