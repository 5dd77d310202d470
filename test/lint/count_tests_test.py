#!/usr/bin/python3
"""Test scripts/count_tests.py: it counts passed, failed and skipped tests, and fails when it must."""

import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "count_tests.py")


def program(name, status, completion="Completed", said=""):
    """Return an element of ctest's Test.xml, with only the parts that count_tests.py reads."""
    return (
        '<Test Status="%s"><Name>%s</Name><Results><NamedMeasurement name="Execution Time"><Value>1</Value>'
        '</NamedMeasurement><NamedMeasurement name="Completion Status"><Value>%s</Value></NamedMeasurement>'
        "<Measurement><Value>%s</Value></Measurement></Results></Test>" % (status, name, completion, said)
    )


def single(name, inner="", status="run"):
    return '<testcase classname="A" name="%s" status="%s">%s</testcase>' % (name, status, inner)


class CountTests(unittest.TestCase):
    def count(self, programs, results=None, file_name="gtest-math.xml"):
        """Return (exit status, last line) for the reports of ctest and of the gtest `math`, or of another runner."""
        status, lines = self.lines(programs, results, file_name)
        return status, lines[-1]

    def lines(self, programs, results=None, file_name="gtest-math.xml"):
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, "ctest.xml")
            with open(report, "w", encoding="utf-8") as file:
                names = "<TestList><Test>./good</Test></TestList>"
                file.write("<Site><Testing>%s%s</Testing></Site>" % (names, "".join(programs)))
            if results is not None:
                with open(os.path.join(folder, file_name), "w", encoding="utf-8") as file:
                    file.write(results)
            run = subprocess.run([sys.executable, PROGRAM, report, folder], stdout=subprocess.PIPE, check=False)
            return run.returncode, run.stdout.decode().splitlines()

    def test_programs(self):
        programs = [program("good", "passed"), program("skips", "notrun", "SKIP_RETURN_CODE=77")]
        programs += [program("off", "notrun", "Disabled")]
        self.assertEqual(self.count(programs), (0, "1 passed, 0 failed, 2 skipped"))
        programs += [program("bad", "failed"), program("absent", "notrun", "Unable to find executable")]
        self.assertEqual(self.count(programs), (1, "1 passed, 2 failed, 2 skipped"))

    def test_single_tests(self):
        tests = [single("good"), single("skips", "<skipped/>"), single("off", status="notrun")]
        gtest = "<testsuites><testsuite>%s</testsuite></testsuites>"
        name = "_ctest_flexarm_gtest_math"
        ran, broke = program(name, "passed"), program(name, "failed")
        self.assertEqual(self.count([ran], gtest % "".join(tests)), (0, "1 passed, 0 failed, 2 skipped"))
        # A program that crashed after its last test counts as failed, and so does a program with an unreadable report.
        self.assertEqual(self.count([broke], gtest % "".join(tests)), (1, "1 passed, 1 failed, 2 skipped"))
        self.assertEqual(self.count([ran], "<testsuites>"), (1, "0 passed, 1 failed, 0 skipped"))
        tests.append(single("bad", "<failure/>"))
        self.assertEqual(self.count([broke], gtest % "".join(tests)), (1, "1 passed, 1 failed, 2 skipped"))

    def test_runners(self):
        results = "<testsuites><testsuite>%s</testsuite></testsuites>" % "".join([single("one"), single("other")])
        for name, file_name in (("_ctest_flexarm_gtest_math", "gtest-math.xml"),
                                ("_ctest_flexarm_rostest_test_ros_bags.test", "rosunit-bags.xml"),
                                ("pytest_python", "pytest-python.xml")):
            counted = self.count([program(name, "passed")], results, file_name)
            self.assertEqual(counted, (0, "2 passed, 0 failed, 0 skipped"))

    def test_last_lines_of_what_failed(self):
        said = "\n".join("line %d &lt;" % n for n in range(100))
        status, lines = self.lines([program("good", "passed", said=said), program("bad", "failed", said=said)])
        self.assertEqual(status, 1)
        self.assertEqual(lines[0], "failed: bad")
        self.assertEqual(lines[-2], "    line 99 <")
        self.assertLess(len(lines), 30)

    def test_nothing_passed(self):
        self.assertEqual(self.count([]), (1, "0 passed, 0 failed, 0 skipped"))
        self.assertEqual(self.count([program("off", "notrun", "Disabled")]), (1, "0 passed, 0 failed, 1 skipped"))


if __name__ == "__main__":
    unittest.main()
