#!/usr/bin/python3
"""Tests the handles in rviz that pull on links, and the markers of a scene that contains everything."""

import math
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from simulated_arm import PATIENCE, CommandTopic, SimulatedArm, wait_until
from visualization_msgs.msg import InteractiveMarkerFeedback as Feedback
from visualization_msgs.msg import InteractiveMarkerInit, Marker, MarkerArray

FRAME = "bench/base"
PULL, SPRING = 100.0, 300.0  # N/m
TARGET = 0.2  # m, along the rail


def feedback(event, y=0.0, frame=FRAME, name="slider"):
    message = Feedback(client_id="/test", marker_name=name, control_name="pull", event_type=event)
    message.header.frame_id = frame
    message.pose.position.y = y
    message.pose.orientation.w = 1
    return message


class Pulls(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.warnings = []
        rospy.Subscriber("/rosout", Log, lambda log: log.level >= Log.WARN and cls.warnings.append(log.msg))
        cls.arm = SimulatedArm("/bench")
        cls.hand = CommandTopic("/bench/flexarm/pull/feedback", Feedback)

    def setUp(self):
        self.arm.reset()

    def position(self):
        return self.arm.joint("rail").position

    def drag(self, seconds, until=None, **arguments):
        """Drag a handle as rviz does, which sends the mouse position at least four times a second."""
        end = time.monotonic() + seconds
        self.hand.send(feedback(Feedback.MOUSE_DOWN))
        while time.monotonic() < end and not (until and until()):
            self.hand.send(feedback(Feedback.POSE_UPDATE, **arguments))
            time.sleep(0.1)

    def assert_goes_to(self, wanted, drag_to=None):
        """The mass is 1.6 kg between springs of 300 or 400 N/m, damped by 40 N s/m: after 1 s exp(-12) is left."""
        there = lambda: abs(self.position() - wanted) < 1e-3 * TARGET  # noqa: E731
        if drag_to is not None:
            self.drag(PATIENCE, there, y=drag_to)
        wait_until(there, "%g m, it is at %g" % (wanted, self.position()))

    def test_there_is_a_handle_on_each_link_that_moves(self):
        handles = rospy.wait_for_message("/bench/flexarm/pull/update_full", InteractiveMarkerInit, PATIENCE).markers
        self.assertEqual({handle.name for handle in handles}, {"slider", "rod"})
        for handle in handles:
            self.assertEqual(handle.header.frame_id, FRAME)
            self.assertTrue(handle.header.stamp.is_zero())  # otherwise rviz would answer in its own fixed frame

    def test_pulls_until_it_is_let_go(self):
        self.assert_goes_to(TARGET * PULL / (PULL + SPRING), drag_to=TARGET)
        self.hand.send(feedback(Feedback.MOUSE_UP))
        self.assert_goes_to(0)

    def test_who_is_not_heard_of_any_more_has_let_go(self):
        self.assert_goes_to(TARGET * PULL / (PULL + SPRING), drag_to=TARGET)
        self.assert_goes_to(0)

    def test_clearing_wrenches_and_a_reset_end_it(self):
        for end in (self.arm.clear_wrenches, self.arm.reset):
            self.assert_goes_to(TARGET * PULL / (PULL + SPRING), drag_to=TARGET)
            end()
            self.assert_goes_to(0)

    def test_what_is_no_place_is_refused(self):
        for arguments in ({"y": math.nan}, {"y": TARGET, "frame": "elsewhere"}):
            del self.warnings[:]
            self.drag(0.3, **arguments)
            wait_until(lambda: any("is not pulled" in text for text in self.warnings), "a warning")
            self.assertLess(abs(self.position()), 1e-3 * TARGET)
            time.sleep(1)  # because warnings are throttled

    def test_markers_show_everything(self):
        self.drag(0.5, y=TARGET)
        shown = {}

        def receive(message):
            for marker in message.markers:
                if marker.action == Marker.ADD:
                    shown.setdefault(marker.ns, []).append(marker)

        subscriber = rospy.Subscriber("/bench/beam_markers", MarkerArray, receive)
        self.drag(1, lambda: "trails" in shown, y=TARGET)
        wait_until(lambda: "trails" in shown, "trails")
        subscriber.unregister()
        self.hand.send(feedback(Feedback.MOUSE_UP))
        self.assertEqual(set(shown), {"rod", "trails", "applied wrenches", "reactions", "masses", "text", "legend"})
        self.assertEqual({marker.header.frame_id for markers in shown.values() for marker in markers}, {FRAME})
        # The beam is drawn as its box instead of the tube, whose radius would be 5 mm. It is bent by 3 N at its end.
        heights = [point.z for point in shown["rod"][-1].points]
        self.assertGreater(max(heights), 0.02)
        self.assertGreater(max(heights) + min(heights), 2e-3)
        self.assertIn("real time", shown["text"][-1].text)


if __name__ == "__main__":
    rospy.init_node("pulls_test")
    rostest.rosrun("flexarm", "pulls", Pulls)
