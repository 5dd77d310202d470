#!/usr/bin/python3
"""Sums up the results of all test runners: `count_tests.py CTEST-REPORT DIRECTORY`.

CTEST-REPORT is the Test.xml of `ctest -T Test --no-compress-output`, which all releases of CMake write. It lists all
programs that ran. A gtest, rostest or pytest also writes the results of its single tests to DIRECTORY, as JUnit XML
(the test-name of test/ros/NAME.test is NAME, so that its file can be found). A program counts as one test if it has
no such file, or if it failed although all of its tests passed. Tests count as skipped if they say so themselves, or
if they are disabled. A program that could not be started has failed. For each program that failed, the last lines of
its output are printed. The last line is `N passed, N failed, N skipped`. The exit status is 1 if a test failed, or if
none passed.
"""

import os
import re
import sys
import xml.etree.ElementTree


PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"
LAST_LINES = 15


def single_tests(path):
    """Yields (name, outcome) of each test in a JUnit file. Raises ParseError."""
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        outcome = PASSED
        if case.find("failure") is not None or case.find("error") is not None:
            outcome = FAILED
        elif case.get("status") == "notrun" or case.find("skipped") is not None:
            outcome = SKIPPED
        yield "%s.%s" % (case.get("classname"), case.get("name")), outcome


def outcome_of_program(test):
    """The outcome of a program by ctest's report."""
    completion = test.findtext("Results/NamedMeasurement[@name='Completion Status']/Value") or ""
    if completion == "Disabled" or completion.startswith("SKIP_"):
        return SKIPPED
    return PASSED if test.get("Status") == "passed" else FAILED


def result_file(directory, program):
    """The file of single results of a ctest test, or None if its kind has none."""
    for pattern, file_name in (
        (r"_ctest_flexarm_gtest_(.*)", "gtest-%s.xml"),
        (r"_ctest_flexarm_rostest_test_ros_(.*)\.test", "rosunit-%s.xml"),
        (r"pytest_(.*)", "pytest-%s.xml"),
    ):
        match = re.fullmatch(pattern, program)
        if match:
            return os.path.join(directory, file_name % match.group(1))
    return None


def results_of(program, outcome, directory):
    """A list of (name, outcome) of everything that a program tested."""
    path = result_file(directory, program)
    results = []
    if path and os.path.exists(path):
        try:
            results = list(single_tests(path))
        except xml.etree.ElementTree.ParseError:
            outcome = FAILED
    if not results or (outcome == FAILED and all(single != FAILED for _, single in results)):
        results.append((program, outcome))
    return results


def main():
    report, directory = sys.argv[1:]
    counts = {PASSED: 0, FAILED: 0, SKIPPED: 0}
    has_report = os.path.exists(report)
    programs = xml.etree.ElementTree.parse(report).getroot().iterfind(".//Test[@Status]") if has_report else []
    for test in programs:
        results = results_of(test.findtext("Name"), outcome_of_program(test), directory)
        for name, outcome in results:
            counts[outcome] += 1
            if outcome != PASSED:
                print("%s: %s" % (outcome, name))
        if any(outcome == FAILED for _, outcome in results):
            for line in (test.findtext("Results/Measurement/Value") or "").splitlines()[-LAST_LINES:]:
                print("    " + line)
    print(", ".join("%d %s" % (count, outcome) for outcome, count in counts.items()))
    return 1 if counts[FAILED] or not counts[PASSED] else 0


if __name__ == "__main__":
    sys.exit(main())
