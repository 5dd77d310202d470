#!/usr/bin/python3
"""Adds up the results of all test runners: `count_tests.py CTEST-REPORT DIRECTORY`.

ctest knows every program that ran; a gtest or rostest left its single tests in DIRECTORY as JUnit XML (the test-name of
test/ros/NAME.test is NAME, so that its file can be found). A program without such a file, or that failed although each of its tests passed, counts as one test. The last line is `N passed, N failed`;
the exit status is 1 if a test failed, or if none ran.
"""

import os
import re
import sys
import xml.etree.ElementTree


def single_tests(path):
    """(name, passed) of every test in a JUnit file; skipped ones are left out. Raises ParseError."""
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        if case.get("status") == "notrun" or case.find("skipped") is not None:
            continue
        failed = case.find("failure") is not None or case.find("error") is not None
        yield "%s.%s" % (case.get("classname"), case.get("name")), not failed


def result_file(directory, program):
    """Where catkin's runner put the results of a ctest test, or None if it is not one of catkin's."""
    for pattern, file_name in (
        (r"_ctest_flexarm_gtest_(.*)", "gtest-%s.xml"),
        (r"_ctest_flexarm_rostest_test_ros_(.*)\.test", "rosunit-%s.xml"),
    ):
        match = re.fullmatch(pattern, program)
        if match:
            return os.path.join(directory, file_name % match.group(1))
    return None


def results_of(program, passed, directory):
    """(name, passed) of everything that a program tested."""
    path = result_file(directory, program)
    results = []
    if path and os.path.exists(path):
        try:
            results = list(single_tests(path))
        except xml.etree.ElementTree.ParseError:
            passed = False
    if not results or (not passed and all(single_passed for _, single_passed in results)):
        results.append((program, passed))
    return results


def main():
    report, directory = sys.argv[1:]
    results = []
    if os.path.exists(report):
        for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
            if case.get("status") in ("run", "fail"):
                results += results_of(case.get("name"), case.get("status") == "run", directory)
    failed = [name for name, passed in results if not passed]
    for name in failed:
        print("failed: " + name)
    print("%d passed, %d failed" % (len(results) - len(failed), len(failed)))
    return 1 if failed or not results else 0


if __name__ == "__main__":
    sys.exit(main())
