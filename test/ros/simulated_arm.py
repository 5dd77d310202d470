"""Helpers of the node's tests: the node's services and topics as one object."""

import time

import rosgraph
import rospy
from flexarm.msg import JointForceCommand, SimulatorStatus
from flexarm.srv import ApplyWrench, LoadState, SaveState, SetJointState, Step, SwitchMode
from geometry_msgs.msg import Point, Vector3, Wrench
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty, Trigger

PATIENCE = 60.0  # s, wall time; long enough for a node to start on a busy machine


def wait_until(condition, what, patience=PATIENCE):
    """Wait for a condition in wall time, because ROS time may stand still."""
    end = time.monotonic() + patience
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("waited in vain for " + what)
        time.sleep(0.01)


class Joint:
    def __init__(self, states, name):
        index = states.name.index(name)
        self.position = states.position[index]
        self.velocity = states.velocity[index]
        self.effort = states.effort[index]


class SimulatedArm:
    def __init__(self, namespace=""):
        self.namespace = namespace
        for service in ("pause", "resume", "reset", "step"):
            rospy.wait_for_service(namespace + "/flexarm/" + service, PATIENCE)
        self.pause = rospy.ServiceProxy(namespace + "/flexarm/pause", Empty)
        self.resume = rospy.ServiceProxy(namespace + "/flexarm/resume", Empty)
        self.reset = rospy.ServiceProxy(namespace + "/flexarm/reset", Empty)
        self.reset_with_clock = rospy.ServiceProxy(namespace + "/flexarm/reset_with_clock", Trigger)
        self.reload = rospy.ServiceProxy(namespace + "/flexarm/reload", Trigger)
        self.step = rospy.ServiceProxy(namespace + "/flexarm/step", Step)
        self.save_state = rospy.ServiceProxy(namespace + "/flexarm/save_state", SaveState)
        self.load_state = rospy.ServiceProxy(namespace + "/flexarm/load_state", LoadState)
        self.set_joint_state = rospy.ServiceProxy(namespace + "/flexarm/set_joint_state", SetJointState)
        self.switch_mode = rospy.ServiceProxy(namespace + "/flexarm/switch_mode", SwitchMode)
        self.clear_wrenches = rospy.ServiceProxy(namespace + "/flexarm/clear_wrenches", Empty)
        self.call_apply_wrench = rospy.ServiceProxy(namespace + "/flexarm/apply_wrench", ApplyWrench)

    def apply_wrench(self, link, force=(0, 0, 0), moment=(0, 0, 0), at=(0, 0, 0), frame="", start=rospy.Time(),
                     duration=-1.0):
        return self.call_apply_wrench(link=link, point=Point(*at), wrench=Wrench(Vector3(*force), Vector3(*moment)),
                                      frame=frame, start=start, duration=rospy.Duration.from_sec(duration))

    # While the simulation is paused, a new subscriber gets the messages that were sent before the last service
    # returned.
    def status(self):
        return rospy.wait_for_message(self.namespace + "/flexarm/status", SimulatorStatus, PATIENCE)

    def joint_states(self):
        return rospy.wait_for_message(self.namespace + "/joint_states", JointState, PATIENCE)

    def joint(self, name):
        return Joint(self.joint_states(), name)


class CommandTopic:
    """A publisher that is connected before it is used."""

    def __init__(self, name, message_type):
        self.publisher = rospy.Publisher(name, message_type, queue_size=100)
        wait_until(lambda: self.publisher.get_num_connections() > 0, "a subscriber to " + name)

    def send(self, *args, **fields):
        self.publisher.publish(*args, **fields)


def force_command(names, efforts, seconds=0.0):
    return JointForceCommand(names=names, efforts=efforts, duration=rospy.Duration.from_sec(seconds))


def wait_for_log(act, word):
    """Call `act` again and again, until a node logs a text that contains `word`."""
    heard = []
    subscriber = rospy.Subscriber("/rosout", Log, lambda log: word in log.msg and heard.append(log.msg))
    master = rosgraph.Master(rospy.get_name())

    def hears_all():
        nodes = [nodes for topic, nodes in master.getSystemState()[0] if topic == "/rosout"]
        return nodes and subscriber.get_num_connections() >= len(nodes[0])

    wait_until(hears_all, "the logs of all nodes")
    for _ in range(int(PATIENCE)):
        act()
        end = time.monotonic() + 1.1  # refusals are logged once a second
        while not heard and time.monotonic() < end:
            time.sleep(0.01)
        if heard:
            break
    subscriber.unregister()
    assert heard, "waited in vain for the log of: " + word


def wait_for_arrival(force):
    """Wait until the node has received all that was sent on a topic of efforts. Messages of one topic come in order, so
    the refusal of another message says so."""
    wait_for_log(lambda: force.send(force_command(["nobody"], [0.0])), "no joint coordinate 'nobody'")


def release_stop(stop):
    """Release the emergency stop, and wait until commands are accepted again."""

    def release():
        stop.send(True)  # its release is said once, and that message may be missed
        stop.send(False)

    wait_for_log(release, "emergency stop released")


def warnings_during(act, word):
    """Return the texts of the node's warnings that contain `word`, while `act` is called."""
    warnings = []

    def receive(log):
        if word in log.msg:
            warnings.append(log.msg)

    subscriber = rospy.Subscriber("/rosout", Log, receive)
    time.sleep(1.2)  # until warnings of other tests have passed
    del warnings[:]
    act()
    wait_until(lambda: warnings, "a warning")
    time.sleep(0.3)
    subscriber.unregister()
    return warnings


def warnings_of_flood(send, word="refused"):
    """The same, while `send` is called fifty times."""
    return warnings_during(lambda: [send() for _ in range(50)], word)
