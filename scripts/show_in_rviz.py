#!/usr/bin/python3
"""Starts rviz with a view that fits the scene of a running simulator.

show_in_rviz.py [RVIZ-ARGUMENT...]

Fixed frame, camera and grid follow the simulator's parameters flexarm/view/...; grounds have grids of their own. The
displays are those of config/flexarm.rviz. Of the URDF, rviz draws only the rigid links, since the <visual> of a
flexible link would stay straight beside the bent beam. For this, the parameter rigid_links_description gets a URDF
without those. There, shapes without a colour are grey as in pages: rviz would make them red. If no link
has a shape or a mass, the frames are shown.
"""

import signal

# If the simulator dies at its start, roslaunch ends this script with SIGINT. No traceback should follow the simulator's
# message, not even if that happens during the imports below.
signal.signal(signal.SIGINT, signal.SIG_DFL)

import ctypes
import math
import os
import shutil
import sys
import time
import xml.etree.ElementTree

import rosgraph
import rospkg
import rospy
import yaml

TEMPLATE = "config/flexarm.rviz"
PATIENCE = 30.0  # s, wall time
# In radii of the scene:
DISTANCE = 3.6  # of the camera from the centre; its angle of view is 45 degrees
LEGEND = 0.25  # how far the camera looks past the centre, towards the legend
GRID = 1.2  # half of its length
CELLS = 10  # of the grid in the scene's diameter, about
GREY = "0.56 0.6 0.66 1"  # of shapes without a colour


def wait_for_view():
    """Waits for the simulator's parameters on the view: frame, center [m], radius [m]."""
    end = time.monotonic() + PATIENCE
    while not rospy.has_param("flexarm/view/radius"):  # set last
        if time.monotonic() > end:
            sys.exit("no parameter %s: is the simulator running?" % rospy.resolve_name("flexarm/view/radius"))
        time.sleep(0.1)
    return rospy.get_param("flexarm/view")


def rigid_links(description):
    """The URDF without the shapes of flexible links, and with a colour for each other shape."""
    robot = xml.etree.ElementTree.fromstring(description)
    for link in robot.findall("link"):
        if link.find("beam") is not None:
            for shape in link.findall("visual") + link.findall("collision"):
                link.remove(shape)
        for shape in link.findall("visual"):
            if shape.find("material") is None:  # a mesh with materials of its own keeps them
                material = xml.etree.ElementTree.SubElement(shape, "material", name="flexarm_grey")
                xml.etree.ElementTree.SubElement(material, "color", rgba=GREY)
    return xml.etree.ElementTree.tostring(robot, encoding="unicode")


def has_shape(description):
    """Whether rviz can draw more of the robot than its frames: shapes, beams, or markers of masses."""
    robot = xml.etree.ElementTree.fromstring(description)
    return any(robot.find("link/" + shape) is not None for shape in ("visual", "beam", "collision", "inertial"))


def has_ground(description):
    """Whether the markers have a ground with its own grid."""
    return xml.etree.ElementTree.fromstring(description).find("ground") is not None


def fit_grid(grid, view):
    """The grid is a square at the scene, whose lines go through the origin."""
    cell = 10.0 ** math.floor(math.log10(2 * view["radius"] / CELLS))
    cell *= next(factor for factor in (1, 2, 5, 10) if factor * cell * CELLS >= 1.5 * view["radius"])
    count = 2 * math.ceil(GRID * view["radius"] / cell)
    grid.update({"Cell Size": cell, "Plane Cell Count": count})
    x, y, _ = view["center"]
    grid["Offset"] = {"X": cell * round(x / cell), "Y": cell * round(y / cell), "Z": 0}


def fit(config, view, prefix, description, interactive=False):
    """Sets the scene's frame, place and size, and whether links have handles, in a configuration of rviz."""
    radius = view["radius"]
    manager = config["Visualization Manager"]
    manager["Global Options"]["Fixed Frame"] = view["frame"]
    camera = manager["Views"]["Current"]
    camera["Distance"] = DISTANCE * radius
    x, y, z = view["center"]
    camera["Focal Point"] = {"X": x - LEGEND * radius, "Y": y, "Z": z}
    camera["Near Clip Distance"] = 1e-3 * radius
    displays = {display["Class"]: display for display in manager["Displays"]}
    fit_grid(displays["rviz/Grid"], view)
    displays["rviz/Grid"]["Enabled"] = displays["rviz/Grid"]["Value"] = not has_ground(description)
    displays["rviz/TF"]["Marker Scale"] = radius
    displays["rviz/TF"]["Enabled"] = not has_shape(description)
    displays["rviz/RobotModel"]["TF Prefix"] = prefix.rstrip("/")
    handles = displays["rviz/InteractiveMarkers"]
    handles["Enabled"] = handles["Value"] = interactive
    # For the other displays, rviz resolves topics by its namespace, but not for this one.
    handles["Update Topic"] = rospy.resolve_name(handles["Update Topic"])
    return config


def fault():
    """Why rviz cannot open a window, or ""."""
    if shutil.which("rviz") is None:
        return "it is not installed (package rviz, which not every system has)"
    name = os.environ.get("DISPLAY", "")
    if not name:
        return "there is no display, as DISPLAY is not set"
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return ""  # rviz will say what is missing
    x11.XOpenDisplay.restype = ctypes.c_void_p
    return "" if x11.XOpenDisplay(None) else "the display %s cannot be opened" % name


def give_up(reason):
    sys.exit("rviz cannot start: %s. The simulation runs without it. With headless:=true, roslaunch does not try to "
             "start rviz; with web:=true, a browser shows the arm instead." % reason)


def main():
    if reason := fault():
        give_up(reason)
    view = wait_for_view()
    description = rospy.search_param("robot_description")
    if description is None:
        sys.exit("no parameter robot_description: it takes the text of the scene file")
    description = rigid_links(rospy.get_param(description))
    rospy.set_param("rigid_links_description", description)
    with open(os.path.join(rospkg.RosPack().get_path("flexarm"), TEMPLATE), encoding="utf-8") as file:
        config = fit(yaml.safe_load(file), view, rospy.get_param("flexarm/frame_prefix", ""), description,
                     rospy.get_param("flexarm/interactive", False))
    # The file must stay, because rviz replaces this process. One name per arm keeps such files from piling up.
    name = "flexarm" + rosgraph.names.get_ros_namespace().replace("/", "_").rstrip("_") + ".rviz"
    path = os.path.join(rospkg.get_ros_home(), name)
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(config, file)
    os.execvp("rviz", ["rviz", "-d", path, *sys.argv[1:]])


if __name__ == "__main__":
    try:
        main()
    except (OSError, rospy.ROSException) as error:
        sys.exit("show_in_rviz.py: %s" % error)  # the master is gone
