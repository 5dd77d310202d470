#!/usr/bin/python3
"""Tests the page that shows a running node, by its requests and in a browser."""

import os
import socket
import sys
import time
import unittest

import numpy as np
import rospy
import rostest
from flexarm.srv import DeleteLink, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion
from running_node import RunningNode
from simulated_arm import SimulatedArm, wait_until
from tf2_msgs.msg import TFMessage
from web_viewer import Viewer, ask, place_of, track_count, url_in

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
ARM = "_scene:=" + os.path.join(ROOT, "config", "examples", "flexible_two_link_arm.urdf")
BALL = """<robot name="ball"> <link name="ball"> <inertial> <mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link> </robot>"""
MOST_VIEWERS = 16


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def is_open(place):
    try:
        socket.create_connection(place, timeout=5).close()
    except OSError:
        return False
    return True


def matrix(position, quaternion):
    """Return a pose as a matrix. @param quaternion  x y z w"""
    x, y, z, w = quaternion
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    out = np.eye(4)
    out[:3, :3] += 2 * w * cross + 2 * cross @ cross
    out[:3, 3] = position
    return out


class Web(unittest.TestCase):
    def start(self, *arguments):
        node = RunningNode(ARM, "_web:=true", "_web_port:=0", *arguments)
        node.__enter__()
        self.addCleanup(node.__exit__)
        self.node = node
        wait_until(lambda: url_in(node.output()), "the page's address")
        self.url = url_in(node.output())
        self.arm = SimulatedArm()

    def look(self, **headers):
        viewer = Viewer(self.url, **headers)
        self.addCleanup(viewer.close)
        return viewer

    def test_the_page_is_served_and_nothing_else(self):
        self.start("_paused:=true")
        self.assertEqual(place_of(self.url)[0], "127.0.0.1")
        status, page = ask(self.url)
        self.assertEqual(status, 200)
        self.assertIn('class="flexarm-live">{"stream": "/stream"}</script>', page)
        self.assertEqual(ask(self.url, "/robot.urdf")[0], 404)
        self.assertEqual(ask(self.url, method="POST")[0], 405)
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
            self.assertEqual(ask(self.url, **headers)[0], 403)
            self.assertEqual(self.look(**headers).status, 403)

    def test_the_state_is_that_of_tf(self):
        self.start("_paused:=true")
        self.assertTrue(self.arm.step(300).success)
        viewer = self.look()
        started, (moment, numbers) = time.monotonic(), viewer.next_instant()
        self.assertLess(time.monotonic() - started, 2)
        self.assertAlmostEqual(moment, 0.3)
        picture = viewer.picture
        self.assertEqual(len(numbers), track_count(picture))
        self.assertEqual((picture["name"], picture["title"]),
                         ("flexible_two_link_arm", "flexible_two_link_arm (/flexarm)"))
        names = [link["name"] for link in picture["links"]]
        poses = {name: matrix(numbers[7 * k:7 * k + 3], numbers[7 * k + 3:7 * k + 7]) for k, name in enumerate(names)}
        compared = set()
        for transform in rospy.wait_for_message("/tf", TFMessage, 10).transforms:
            if transform.child_frame_id in poses:
                t, r = transform.transform.translation, transform.transform.rotation
                expected = poses[transform.header.frame_id] @ matrix((t.x, t.y, t.z), (r.x, r.y, r.z, r.w))
                np.testing.assert_allclose(poses[transform.child_frame_id], expected, atol=1e-12)
                compared.add(transform.child_frame_id)
        self.assertEqual(compared, {"upper_arm", "forearm", "payload"})
        columns = dict(zip((column["name"] for column in picture["columns"]), numbers[-len(picture["columns"]):]))
        self.assertEqual(columns["joint/elbow/position"], self.arm.joint("elbow").position)
        self.assertNotEqual(columns["joint/elbow/velocity"], 0)

    def test_instants_come_at_their_rate_to_all_viewers(self):
        self.start("_web_rate:=20")
        first, second = self.look(), self.look()
        first.next_instant()
        begin = time.monotonic()
        moments = [first.next_instant()[0] for _ in range(20)]
        self.assertAlmostEqual(time.monotonic() - begin, 1, delta=0.3)
        self.assertEqual(moments, sorted(set(moments)))
        self.assertAlmostEqual(moments[-1] - moments[0], 0.95, delta=0.3)
        others = {second.next_instant()[0] for _ in range(21)}
        self.assertGreater(len(others & set(moments)), 15)

    def test_while_paused_an_instant_comes_once(self):
        self.start()
        viewer = self.look()
        viewer.next_instant()
        self.arm.pause()
        viewer.socket.settimeout(0.5)
        with self.assertRaises(socket.timeout):
            while True:
                last = viewer.next_instant()[0]
        self.assertEqual(self.look().next_instant()[0], last)
        self.assertAlmostEqual(last, self.arm.status().time, delta=1e-9)
        with self.assertRaises(socket.timeout):
            viewer.next_instant()  # still none, though somebody else has come

    def test_pictures_follow_the_scene(self):
        self.start()
        viewer = self.look()
        viewer.next_instant()
        count = len(viewer.picture["links"])
        spawn = rospy.ServiceProxy("/flexarm/spawn", SpawnModel)
        delete = rospy.ServiceProxy("/flexarm/delete", DeleteLink)
        answer = spawn(model_xml=BALL, pose=Pose(Point(0, 0, 5), Quaternion()))
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(viewer.next_picture()["links"][-1]["name"], "ball")
        self.assertEqual(len(viewer.next_instant()[1]), track_count(viewer.picture))
        self.assertTrue(delete("ball").success)
        self.assertEqual(len(viewer.next_picture()["links"]), count)
        before = viewer.next_instant()[0]
        self.arm.reset()
        self.assertEqual(len(viewer.next_picture()["links"]), count)
        self.assertLess(viewer.next_instant()[0], before)
        for _ in range(7):
            self.arm.apply_wrench("payload", force=(0, 0, 1))
        self.assertGreaterEqual(viewer.next_picture()["arrows"][1]["count"], 7)
        self.assertEqual(len(viewer.next_instant()[1]), track_count(viewer.picture))

    def test_one_viewer_too_many_is_told(self):
        self.start()
        viewers = [self.look() for _ in range(MOST_VIEWERS)]
        self.assertEqual({viewer.status for viewer in viewers}, {101})
        self.assertEqual(self.look().status, 503)
        status, text = ask(self.url)
        self.assertEqual(status, 503)
        self.assertIn("16 browsers look at this page already", text)
        viewers.pop().close()
        wait_until(lambda: self.look().status == 101, "a free place")
        for viewer in viewers:
            viewer.next_instant()

    def test_garbage_changes_nothing(self):
        self.start()
        garbage = bytes(k * k % 251 for k in range(3000))
        many = b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 5000 + b"\r\n"
        for request in (garbage, many, b"POST / HTTP/1.1\r\n\r\n" + garbage):
            with socket.create_connection(place_of(self.url), timeout=60) as connection:
                connection.sendall(request)
        for data in (garbage, b"\x81\x85\0\0\0\0reset", b"\x88\x80\0\0\0\0"):
            with self.look() as viewer:
                viewer.next_picture()
                viewer.socket.sendall(data)
                with self.assertRaises((EOFError, ConnectionError, AssertionError)):
                    while True:
                        viewer.next_instant()
        self.assertEqual(ask(self.url)[0], 200)
        viewer = self.look()
        self.assertGreater(viewer.next_instant()[0], 0)
        self.assertFalse(self.arm.status().paused)

    def test_without_the_parameter_there_is_no_page(self):
        port = free_port()
        with RunningNode(ARM, "_web_port:=%d" % port) as node:
            self.assertFalse(is_open(("127.0.0.1", port)))
            self.assertIsNone(url_in(node.output()))

    def test_a_port_in_use_is_told_and_the_simulation_goes_on(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            with RunningNode(ARM, "_web:=true", "_web_port:=%d" % port) as node:
                self.assertIn("there is no page: cannot listen at 127.0.0.1, port %d: Address already in use" % port,
                              node.output())
                self.assertGreater(SimulatedArm().status().time, 0)

    def test_other_addresses_are_warned_of(self):
        with RunningNode(ARM, "_web:=true", "_web_port:=0", "_web_address:=0.0.0.0") as node:
            self.assertIn("everybody who reaches 0.0.0.0 can look at the page", node.output())
            port = place_of(url_in(node.output()))[1]
            url = "http://127.0.0.1:%d/" % port
            for host, status in ((socket.gethostname(), 200), ("10.1.2.3:80", 200), ("evil.example", 403)):
                self.assertEqual(ask(url, Host=host)[0], status, host)

    def test_values_that_cannot_be_used_are_named(self):
        with RunningNode(ARM, "_web_port:=70000", "_web_address:=localhost", "_web_rate:=0", is_silent=True) as node:
            self.assertEqual(node.process.wait(20), 1)
            output = node.output()
        self.assertIn("/flexarm/web_port: must be <= 65535, got 70000", output)
        self.assertIn("/flexarm/web_address: must be an IP address, such as 127.0.0.1, got 'localhost'", output)
        self.assertIn("/flexarm/web_rate: must be finite and > 0", output)

    def test_a_browser_shows_how_the_arm_moves(self):
        sys.path.insert(0, os.path.join(ROOT, "test", "pictures"))
        import pytest
        from browser import Browser
        try:
            browser = Browser()
            self.addCleanup(browser.quit)
            browser.skip_unless_it_draws()
        except pytest.skip.Exception as reason:
            self.skipTest(str(reason))
        self.start()
        self.assertEqual(browser.open(self.url), [])
        browser.until("flexarm.runs.length && flexarm.runs[0].end > flexarm.runs[0].start")
        tip = "[...flexarm.runs[0].values.slice(7 * (flexarm.runs[0].picture.links.length - 1)).slice(0, 3)]"
        browser.frame()
        before = browser.run("return " + tip)
        moment = browser.run("return flexarm.time")
        browser.until("flexarm.time > %r + 0.5" % moment)
        browser.frame()
        self.assertGreater(np.linalg.norm(np.subtract(browser.run("return " + tip), before)), 1e-4)
        self.assertEqual(browser.text("#live-text"), "live")
        self.arm.reset()
        browser.until("flexarm.time < %r && flexarm.runs[0].store.count > 2" % moment)
        self.assertEqual(browser.run("return flexarm.errors"), [])
        self.assertEqual([entry for entry in browser.driver.get_log("browser") if entry["level"] != "INFO"], [])


if __name__ == "__main__":
    rospy.init_node("web_test")
    rostest.rosrun("flexarm", "web", Web)
