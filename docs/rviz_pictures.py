#!/usr/bin/python3
"""Makes docs/images/*_rviz.png anew, on a screen of its own: all, or those of the names given, such as rod.

After scripts/build, and with devel/setup.bash sourced; half a minute for each picture. It needs rviz, Xvfb and ffmpeg.
The UR10 also needs https://github.com/Gepetto/example-robot-data, whose parent folder is EXAMPLE_ROBOTS; without it,
its picture stays.
"""

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time

import rosgraph
import rospy
from visualization_msgs.msg import InteractiveMarkerFeedback

from flexarm.srv import Step

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
EXAMPLES = os.path.join(ROOT, "config/examples")
SCREEN = "1280x800"
PATIENCE = 60  # until something has started [s]
SETTLE = 4  # until rviz has drawn everything [s]
PULL = 0.6  # so long the mouse pulls, farther than the arm reaches [s]
FRAME = 0.03  # of simulated time between two steps, so that trails are smooth [s]


def wait_until(condition, what):
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            sys.exit("rviz_pictures.py: no %s" % what)
        time.sleep(0.1)


@contextlib.contextmanager
def running(*words, **options):
    """A program, which ends with the block."""
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        program = subprocess.Popen(words, start_new_session=True, stdout=nowhere, stderr=nowhere, **options)
        try:
            yield program
        finally:
            os.killpg(program.pid, signal.SIGINT)
            program.wait()


@contextlib.contextmanager
def screen():
    """An X server with a number that is free."""
    read, write = os.pipe()
    with running("Xvfb", "-displayfd", str(write), "-screen", "0", SCREEN + "x24", pass_fds=[write]):
        os.close(write)
        with os.fdopen(read) as number:
            os.environ["DISPLAY"] = ":" + number.readline().strip()
        os.environ.update(LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1")
        yield


@contextlib.contextmanager
def master():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    with running("roscore", "-p", str(port)):
        wait_until(rosgraph.is_master_online, "master")
        rospy.init_node("rviz_pictures", disable_signals=True)
        yield


def wait_for_rviz():
    def is_listening():
        _, subscribers, _ = rosgraph.Master("/rviz_pictures").getSystemState()
        return any(topic == "/beam_markers" for topic, _ in subscribers)
    wait_until(is_listening, "rviz")
    time.sleep(SETTLE)


@contextlib.contextmanager
def launched(name, *arguments):
    """A simulation in rviz, and the function that advances it, if it is paused, to a time [s]."""
    with running("roslaunch", "flexarm", name, *arguments):
        wait_for_rviz()
        step = rospy.ServiceProxy("/flexarm/step", Step)

        def advance(until, step_size=0.001):
            left, of_frame = round(until / step_size), round(FRAME / step_size)
            while left:
                step(min(left, of_frame))
                left -= min(left, of_frame)
                time.sleep(0.05)
            time.sleep(SETTLE)
        yield advance


def shoot(name):
    path = os.path.join(ROOT, "docs/images", name + "_rviz.png")
    subprocess.check_call(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-video_size", SCREEN,
                           "-draw_mouse", "0", "-i", os.environ["DISPLAY"], "-frames:v", "1", path])
    print(path, os.path.getsize(path), "bytes")


def part_of_docs(page, first, last):
    """Return the lines of a page from a line that begins so to one that ends so."""
    with open(os.path.join(ROOT, "docs", page), encoding="utf-8") as file:
        return re.search(r"^%s.*?%s$" % (re.escape(first), re.escape(last)), file.read(), re.M | re.S).group()


def scene_of_guide(name):
    """Write a scene of the guide into the working folder, and return its path."""
    path = os.path.abspath(name + ".urdf")
    with open(path, "w", encoding="utf-8") as file:
        file.write(part_of_docs("guide.md", '<robot name="%s">' % name, "</robot>"))
    return path


# ---------------------------------------------------------------- the pictures

def paused(scene, until):
    with launched("simulate.launch", "scene:=" + scene, "paused:=true") as advance:
        advance(until)
        yield


def demo():
    with open("demo.urdf", "w", encoding="utf-8") as file:
        subprocess.check_call([os.path.join(ROOT, "docs/demo_numbers.py"), "--scene"], stdout=file)
    yield from paused(os.path.abspath("demo.urdf"), 4.9)


def rod():
    yield from paused(scene_of_guide("rod"), 0.47)


def six_axis_arm():
    yield from paused(os.path.join(EXAMPLES, "six_axis_arm.urdf"), 2)


def cylindrical_manipulator():
    with launched("cylindrical_manipulator.launch", "paused:=true") as advance:
        advance(0.4, 0.002)
        yield


def pull():
    scene = os.path.join(EXAMPLES, "flexible_two_link_arm.urdf")
    with launched("simulate.launch", "scene:=" + scene, "interactive:=true"):
        hand = rospy.Publisher("/flexarm/pull/feedback", InteractiveMarkerFeedback, queue_size=1)
        feedback = InteractiveMarkerFeedback(client_id="/rviz_pictures", marker_name="payload", control_name="pull",
                                             event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        feedback.header.frame_id = "world"
        feedback.pose.position.x, feedback.pose.position.y, feedback.pose.orientation.w = 1.0, 3.2, 1.0
        end = time.monotonic() + PULL
        while time.monotonic() < end:
            hand.publish(feedback)
            time.sleep(0.1)
        yield


def bag():
    scene_of_guide("arm")
    subprocess.check_call(part_of_docs("results.md", "sed 's|", "sensing_arm.urdf"), shell=True)
    subprocess.check_call("flexarm simulate sensing_arm.urdf --until 1 --every 10 --output arm.bag", shell=True)
    rospy.set_param("/use_sim_time", True)
    with open("sensing_arm.urdf", encoding="utf-8") as file:
        rospy.set_param("/robot_description", file.read())
    rospy.set_param("/flexarm/view", {"frame": "world", "center": [0.0, 0.0, 0.0], "radius": 2.0})
    with running("rosrun", "flexarm", "show_in_rviz.py"):
        wait_for_rviz()
        with running("rosbag", "play", "--clock", "-u", "0.9", "arm.bag"):
            time.sleep(SETTLE)
            yield
    rospy.delete_param("/use_sim_time")
    rospy.delete_param("/flexarm/view")


def ur10():
    folder = os.environ.get("EXAMPLE_ROBOTS")
    if not folder:
        return
    os.symlink(os.path.join(os.path.abspath(folder), "example-robot-data"), "example-robot-data")
    os.environ["ROS_PACKAGE_PATH"] = os.getcwd() + ":" + os.environ.get("ROS_PACKAGE_PATH", "")
    program = part_of_docs("guide.md", "import xml.etree.ElementTree as xml", 'tree.write("ur10.urdf")')
    subprocess.check_call([sys.executable, "-c", program])
    yield from paused(os.path.abspath("ur10.urdf"), 0.65)


PICTURES = {make.__name__: make for make in (demo, rod, six_axis_arm, cylindrical_manipulator, pull, bag, ur10)}


def main(names):
    with tempfile.TemporaryDirectory() as folder, screen(), master():
        os.chdir(folder)
        for name in names or PICTURES:
            for _ in PICTURES[name]():
                shoot(name)


if __name__ == "__main__":
    main(sys.argv[1:])
