#!/usr/bin/python3
"""Tests that the view that show_in_rviz.py gives to rviz fits the scene of the simulator in its namespace."""

import math
import os
import re
import sys
import unittest
import xml.etree.ElementTree
from unittest import mock

import rospy
import rostest
import yaml

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
import show_in_rviz  # noqa: E402

ROUND_OFF = 1e-12


class Rviz(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with mock.patch("os.execvp") as execute, mock.patch("sys.argv", ["show_in_rviz.py", "__name:=rviz"]), \
                mock.patch("show_in_rviz.fault", return_value=""):
            show_in_rviz.main()
        (cls.program, cls.arguments), _ = execute.call_args
        with open(cls.arguments[2], encoding="utf-8") as file:
            cls.manager = yaml.safe_load(file)["Visualization Manager"]

    def test_starts_rviz_with_the_arguments_of_roslaunch(self):
        self.assertEqual(self.program, "rviz")
        self.assertEqual(self.arguments[:2] + self.arguments[3:], ["rviz", "-d", "__name:=rviz"])

    def test_says_where_rviz_is_not_installed(self):
        with mock.patch("shutil.which", return_value=None), self.assertRaises(SystemExit) as end:
            show_in_rviz.main()
        self.assertRegex(str(end.exception), "^rviz cannot start: it is not installed .* with web:=true")

    def test_view_fits_the_scene(self):
        """Two links of 1 m that rotate about the origin reach 2 m."""
        radius = 2.0
        self.assertEqual(self.manager["Global Options"]["Fixed Frame"], "left/world")
        camera = self.manager["Views"]["Current"]
        self.assertAlmostEqual(camera["Distance"], show_in_rviz.DISTANCE * radius, delta=ROUND_OFF)
        self.assertAlmostEqual(camera["Focal Point"]["X"], -show_in_rviz.LEGEND * radius, delta=ROUND_OFF)
        self.assertAlmostEqual(camera["Focal Point"]["Y"], 0, delta=ROUND_OFF)

    def test_the_picture_is_the_one_that_markers_are_placed_in(self):
        """src/messages/picture_axes must have the same camera, and the same apparent size of the reachable sphere."""
        camera = self.manager["Views"]["Current"]
        with open(os.path.join(ROOT, "src/messages/picture_axes.cpp"), encoding="utf-8") as file:
            yaw, pitch = re.search(r"kCameraYaw = ([\d.]+), kCameraPitch = ([\d.]+);", file.read()).groups()
        self.assertEqual((camera["Yaw"], camera["Pitch"]), (float(yaw), float(pitch)))
        with open(os.path.join(ROOT, "src/messages/picture_axes.h"), encoding="utf-8") as file:
            outline = float(re.search(r"kOutline = ([\d.]+);", file.read()).group(1))
        distance = show_in_rviz.DISTANCE
        self.assertLess(abs(outline - distance / math.sqrt(distance**2 - 1)), 2e-3)
        # Above and below there is space for five lines of text, each 1.3 times 6 % of the radius high.
        self.assertGreater(distance * math.tan(0.5 * camera["Field of View"]), outline + 5 * 1.3 * 0.06 + 0.02)

    def test_grid_is_as_large_as_the_scene(self):
        displays = {display["Class"]: display for display in self.manager["Displays"]}
        grid = displays["rviz/Grid"]
        self.assertTrue(grid["Enabled"])
        for radius in (0.013, 2.0, 70.0):
            show_in_rviz.fit_grid(grid, {"center": [3.3 * radius, 0, 0], "radius": radius})
            length = grid["Cell Size"] * grid["Plane Cell Count"]
            self.assertGreater(length, 2.2 * radius)
            self.assertLess(length, 3.4 * radius)
            self.assertTrue(6 <= grid["Plane Cell Count"] <= 30)
            self.assertLess(abs(grid["Offset"]["X"] - 3.3 * radius), grid["Cell Size"])
            lines = grid["Offset"]["X"] / grid["Cell Size"]
            self.assertAlmostEqual(lines, round(lines), delta=1e-9)
        self.assertTrue(show_in_rviz.has_ground("<robot name='r'><ground name='floor'/></robot>"))
        self.assertFalse(show_in_rviz.has_ground("<robot name='r'><link name='a'/></robot>"))

    def test_draws_rigid_links_and_beams(self):
        displays = {display["Class"]: display for display in self.manager["Displays"]}
        self.assertEqual(displays["rviz/MarkerArray"]["Marker Topic"], "beam_markers")
        handles = displays["rviz/InteractiveMarkers"]
        self.assertEqual((handles["Update Topic"], handles["Enabled"]), ("/left/flexarm/pull/update", False))
        model = displays["rviz/RobotModel"]
        self.assertEqual(model["TF Prefix"], "left")
        robot = xml.etree.ElementTree.fromstring(rospy.get_param(model["Robot Description"]))
        links = {link.get("name") for link in robot.findall("link")}
        self.assertEqual(links, {"world", "upper_arm", "forearm", "payload"})

    def test_shows_the_frames_of_what_has_no_shape(self):
        displays = {display["Class"]: display for display in self.manager["Displays"]}
        self.assertFalse(displays["rviz/TF"]["Enabled"])
        self.assertFalse(show_in_rviz.has_shape("<robot name='r'><link name='a'/></robot>"))
        self.assertTrue(show_in_rviz.has_shape("<robot name='r'><link name='a'><visual/></link></robot>"))

    def test_leaves_out_the_shapes_of_flexible_links_only(self):
        shapes = "<visual><geometry><sphere radius='1'/></geometry></visual><collision/>"
        text = show_in_rviz.rigid_links(
            "<robot name='r'><link name='a'>%s</link><link name='b'><beam/>%s</link></robot>" % (shapes, shapes)
        )
        rigid, flexible = xml.etree.ElementTree.fromstring(text).findall("link")
        self.assertEqual([child.tag for child in rigid], ["visual", "collision"])
        self.assertEqual([child.tag for child in flexible], ["beam"])

    def test_shapes_without_a_colour_are_grey(self):
        """rviz would make them red, a colour that looks like a warning."""
        text = show_in_rviz.rigid_links(
            "<robot name='r'><link name='a'><visual><material name='blue'/></visual><visual/></link></robot>")
        own, grey = xml.etree.ElementTree.fromstring(text).findall("link/visual/material")
        self.assertEqual((own.get("name"), len(own)), ("blue", 0))
        self.assertEqual(grey.find("color").get("rgba"), show_in_rviz.GREY)


if __name__ == "__main__":
    rospy.init_node("rviz_test")
    rostest.rosrun("flexarm", "rviz", __name__)
