#!/usr/bin/python3
"""Test shell functions of scripts/common.sh: with a ROS in a folder of its own below /opt/ros, and with lines of
dependencies.txt."""

import os
import subprocess
import tempfile
import unittest

COMMON = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "common.sh")


def run(commands, **environment):
    """Source common.sh, run `commands`, and return what they print. The environment has only these variables and
    PATH."""
    result = subprocess.run(
        ["bash", "-c", "set -euo pipefail; source '%s'\n%s" % (COMMON, commands)],
        env={"PATH": "/usr/bin:/bin", **environment},
        stdout=subprocess.PIPE,
        check=True,
    )
    return result.stdout.decode().splitlines()


class Common(unittest.TestCase):
    def test_a_ros_of_its_own_folder_is_kept_and_workspaces_above_it_are_not(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "noetic"))
            with open(os.path.join(folder, "noetic", "setup.sh"), "w", encoding="utf-8") as file:
                file.write("export ROS_DISTRO=noetic CMAKE_PREFIX_PATH=%s/noetic; false; : $NOT_SET\n" % folder)
            commands = """
                ros_prefix=%s build=%s/build
                clean_environment
                echo "${ROS_DISTRO:-none} ${CMAKE_PREFIX_PATH:-none}" """ % (folder, folder)
            path = "/home/me/devel:%s/noetic" % folder
            self.assertEqual(run(commands, ROS_DISTRO="noetic", CMAKE_PREFIX_PATH=path), ["noetic %s/noetic" % folder])
            for distribution in "debian", "":  # Debian's ROS, which is in /usr; and none
                self.assertEqual(run(commands, ROS_DISTRO=distribution, CMAKE_PREFIX_PATH=path), ["none none"])

    def test_python_packages_of_the_user_are_hidden(self):
        with tempfile.TemporaryDirectory() as folder:
            ask = "/usr/bin/python3 -c 'import site; print(site.ENABLE_USER_SITE)'"
            self.assertEqual(run(ask, HOME=folder), ["True"])
            self.assertEqual(run("build=%s/build; clean_environment; %s" % (folder, ask), HOME=folder), ["False"])

    def test_lines_of_a_key_can_be_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "scripts"))
            with open(os.path.join(folder, "scripts", "dependencies.txt"), "w", encoding="utf-8") as file:
                file.write("# a comment\none|- one\nrviz|- rviz\n#----\nlast -\n")
            commands = """
                root=%s
                is_installed() { echo "$1"; }
                install_dependencies %s"""
            self.assertEqual(run(commands % (folder, "run")), ["one", "rviz"])
            self.assertEqual(run(commands % (folder, "run rviz")), ["one"])
            self.assertEqual(run(commands % (folder, "test")), ["one", "rviz", "last"])

    def test_packages_that_do_for_a_line(self):
        self.assertEqual(run("candidates 'libroscpp-dev' roscpp"), ["libroscpp-dev"])
        self.assertEqual(run("candidates 'one|other|-' -"), ["one", "other", "-"])
        self.assertEqual(
            run("candidates 'libtf2-ros-dev' tf2_ros", ROS_DISTRO="noetic"), ["ros-noetic-tf2-ros", "libtf2-ros-dev"]
        )
        self.assertEqual(
            run("candidates 'libtf2-ros-dev' tf2_ros", ROS_DISTRO="one"), ["ros-one-tf2-ros", "libtf2-ros-dev"]
        )
        self.assertEqual(run("candidates 'one|-' -", ROS_DISTRO="noetic"), ["one", "-"])

    def test_the_first_package_that_is_known_is_taken(self):
        known = "apt-cache() { case $2 in known | later) echo Package: $2 ;; mentioned) ;; *) return 100 ;; esac; }\n"
        self.assertEqual(run(known + "first_known other known later -"), ["known"])
        self.assertEqual(run(known + "first_known other -"), [])
        self.assertEqual(run(known + "first_known mentioned -"), [])
        self.assertEqual(run(known + "(first_known other another 2>&1) || echo failed"),
                         ["bash: the package archive has none of: other another", "failed"])

    def test_one_installed_package_is_enough(self):
        self.assertEqual(run("is_installed no-such-package bash && echo yes"), ["yes"])
        self.assertEqual(run("is_installed no-such-package - || echo no"), ["no"])

    def test_it_is_told_where_the_program_is_missing(self):
        with tempfile.TemporaryDirectory() as folder:
            told = "devel=%s; say_what_is_missing 2>&1" % folder
            self.assertEqual(run(told), ["== scripts/build builds the rest: the program flexarm and the Python module"])
            os.makedirs(os.path.join(folder, "lib", "flexarm"))
            os.symlink("/bin/true", os.path.join(folder, "lib", "flexarm", "flexarm"))
            self.assertEqual(run(told), [])


if __name__ == "__main__":
    unittest.main()
