#!/usr/bin/python3
"""Runs the demo's arm with random commands; watches memory, speed, energy and all published numbers.

scripts/soak starts it after everything was built. It has its own ROS master.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import xml.etree.ElementTree
import xmlrpc.client

import rosgraph
import rospkg
import rospy
from flexarm.msg import BeamStateArray, JointForceCommand, SimulatorStatus
from flexarm.srv import Step
from sensor_msgs.msg import JointState
from soak_report import EnergyAccount, Sample, is_finite, write_report
from std_msgs.msg import Bool
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
PATIENCE = 30.0  # s, wall time for processes to start and to end
LONGEST_COMMAND = 3.0  # s, simulated time
LONGEST_WAIT, LONGEST_PAUSE = 0.5, 1.0  # s, wall time
BAG_SIZE, BAGS = 64, 4  # size of a bag [MB], and number of bags that are kept


def efforts_of(scene):
    """The effort limit of each joint that has one [N m]."""
    joints = xml.etree.ElementTree.parse(scene).findall("joint")
    return {joint.get("name"): float(joint.find("limit").get("effort")) for joint in joints
            if joint.find("limit") is not None}


@contextlib.contextmanager
def process(command, log, **options):
    """A program in a session of its own: Ctrl-C reaches only this script, which then ends the program."""
    with open(log, "w", encoding="utf-8") as file:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT,
                                 start_new_session=True, **options)
    try:
        yield child
    finally:
        child.send_signal(signal.SIGINT)
        try:
            child.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            child.kill()


@contextlib.contextmanager
def display():
    """Starts an invisible display. Yields its name."""
    reader, writer = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[writer], stderr=subprocess.DEVNULL, start_new_session=True)
    os.close(writer)
    try:
        with os.fdopen(reader) as number:
            yield ":" + number.readline().strip()
    finally:
        server.terminate()
        server.wait()


class Operator:
    """Sends random efforts and invalid commands, and calls all services."""

    def __init__(self, efforts, seed):
        self.efforts = efforts
        self.random = random.Random(seed)
        self.counts = dict.fromkeys(["efforts", "nonsense", "pause", "step", "reset", "emergency stop"], 0)
        self.commands = rospy.Publisher("joint_force_command", JointForceCommand, queue_size=100)
        self.stop = rospy.Publisher("flexarm/emergency_stop", Bool, queue_size=10)
        self.pause, self.resume, self.reset = (
            rospy.ServiceProxy("flexarm/" + name, Empty) for name in ("pause", "resume", "reset"))
        self.step = rospy.ServiceProxy("flexarm/step", Step)

    def run(self):
        """Acts until the process ends."""
        acts = [self.send_efforts, self.send_nonsense, self.call_pause, self.call_reset, self.press_emergency_stop]
        while True:
            time.sleep(self.random.uniform(0, LONGEST_WAIT))
            with contextlib.suppress(rospy.ServiceException):  # the node's status has the reason, or the node has ended
                self.random.choices(acts, weights=[100, 5, 4, 3, 2])[0]()

    def send_efforts(self):
        names = self.random.sample(sorted(self.efforts), self.random.randint(1, len(self.efforts)))
        efforts = [self.random.uniform(-1, 1) * self.efforts[name] for name in names]
        # Without a duration, an effort holds until the next command.
        duration = self.random.choice([0, self.random.uniform(0, LONGEST_COMMAND)])
        self.commands.publish(names=names, efforts=efforts, duration=rospy.Duration.from_sec(duration))
        self.counts["efforts"] += 1

    def send_nonsense(self):
        name = self.random.choice(sorted(self.efforts))
        names, efforts = self.random.choice([
            (["nobody"], [1.0]), ([name, name], [1.0, 2.0]), ([name], []), ([name], [float("nan")]),
            ([name], [float("inf")]), ([], [])])
        self.commands.publish(names=names, efforts=efforts)
        self.counts["nonsense"] += 1

    def call_pause(self):
        self.pause()
        time.sleep(self.random.uniform(0, LONGEST_PAUSE))
        self.counts["pause"] += 1
        if self.random.random() < 0.5:
            self.step(self.random.randint(1, 500))
            self.counts["step"] += 1
        self.resume()

    def call_reset(self):
        self.reset()
        self.counts["reset"] += 1

    def press_emergency_stop(self):
        self.stop.publish(True)
        time.sleep(self.random.uniform(0, LONGEST_PAUSE))
        self.stop.publish(False)
        self.counts["emergency stop"] += 1


class Observer:
    """Observes what the node publishes, and its process."""

    def __init__(self):
        self.status = rospy.wait_for_message("flexarm/status", SimulatorStatus, PATIENCE)
        self.first_step = self.status.steps
        self.account = EnergyAccount()
        self.not_finite = {}  # count by topic
        self.failures = []  # messages of failed steps
        self.markers = None
        self.pid = pid_of("/flexarm")
        self.start = time.monotonic()
        topics = {"joint_states": JointState, "/tf": TFMessage, "beam_states": BeamStateArray,
                  "flexarm/status": SimulatorStatus}
        for topic, kind in topics.items():
            rospy.Subscriber(topic, kind, self.check, topic, queue_size=100)
        rospy.Subscriber("flexarm/status", SimulatorStatus, self.receive_status, queue_size=100)
        # Markers have thousands of points, so they are stored unparsed, and only one a second is examined.
        rospy.Subscriber("beam_markers", rospy.AnyMsg, self.receive_markers, queue_size=1, buff_size=1 << 24)

    def check(self, message, topic):
        if not is_finite(message):
            self.not_finite[topic] = self.not_finite.get(topic, 0) + 1

    def receive_status(self, status):
        if status.failed and not self.status.failed:
            self.failures.append(status.message)
        self.account.add(status)
        self.status = status

    def receive_markers(self, message):
        self.markers = message

    def sample(self):
        """A Sample of the last second; None if the node has ended."""
        memory = resident_memory(self.pid)
        if memory is None:
            return None
        if self.markers is not None:
            self.check(MarkerArray().deserialize(self.markers._buff), "beam_markers")
        status = self.status
        return Sample(wall=time.monotonic() - self.start, memory=memory, paused=status.paused,
                      simulated=(status.steps - self.first_step) * status.step,
                      real_time_factor=status.real_time_factor, overruns=status.overruns,
                      iterations=status.iterations, halvings=status.halvings, other_guesses=status.other_guesses,
                      energy=status.kinetic_energy + status.strain_energy, work=status.work,
                      dissipated=status.dissipated, defect=self.account.take_largest(), error=status.message)


def pid_of(node):
    """The process id of a running node.

    Raises rosgraph.MasterException or OSError if the node does not run.
    """
    address = rosgraph.Master(rospy.get_name()).lookupNode(node)
    _, _, pid = xmlrpc.client.ServerProxy(address).getPid(rospy.get_name())
    return pid


def resident_memory(pid):
    """Resident memory [MiB]; None if the process does not exist or is a zombie."""
    try:
        with open(f"/proc/{pid}/status", encoding="utf-8") as file:
            lines = dict(line.split(":", 1) for line in file)
    except OSError:
        return None
    return int(lines["VmRSS"].split()[0]) / 1024 if "VmRSS" in lines else None


def memory_of_rviz():
    """Resident memory [MiB], as text; "none" if rviz does not run."""
    try:
        return f"{resident_memory(pid_of('/rviz')):.0f}"
    except (rosgraph.MasterException, OSError):
        return "none"


def free_port():
    with contextlib.closing(socket.socket()) as listener:
        listener.bind(("localhost", 0))
        return listener.getsockname()[1]


def observe(observer, seconds):
    """Takes a sample each second, until the time is over or the node has ended."""
    samples = []
    while len(samples) < seconds:
        time.sleep(max(0.0, observer.start + len(samples) + 1 - time.monotonic()))
        sample = observer.sample()
        if sample is None:
            break
        samples.append(sample)
        if len(samples) % 10 == 0:
            print(f"{sample.wall:6.0f} s   {sample.memory:.1f} MiB   real-time factor {sample.real_time_factor:.2f}"
                  f"   overruns {sample.overruns}   energy account {sample.defect:.1e} J", flush=True)
    return samples


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10, help="wall time")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random commands")
    parser.add_argument("--no-rviz", action="store_true")
    parser.add_argument("--output", default=os.path.join(ROOT, "docs", "reports", "soak"),
                        help="path of table, report and picture, without .csv, .md and .png")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{free_port()}"
    scene = os.path.join(rospkg.RosPack().get_path("flexarm"), "config", "demo_arm.urdf")
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="soak"))
        rviz = not arguments.no_rviz and None not in map(shutil.which, ("Xvfb", "rviz"))
        environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
        if rviz:
            environment["DISPLAY"] = stack.enter_context(display())
        demo = stack.enter_context(process(
            ["roslaunch", "flexarm", "simulate.launch", "scene:=" + scene, f"rviz:={str(rviz).lower()}"],
            os.path.join(folder, "demo.log"), env=environment))
        rospy.init_node("soak", disable_signals=True)
        rospy.wait_for_service("flexarm/reset", PATIENCE)
        bags = os.path.join(folder, "bags")
        os.mkdir(bags)
        stack.enter_context(process(
            ["rosbag", "record", "--all", "--output-name=soak", "--split", f"--size={BAG_SIZE}",
             f"--max-splits={BAGS}"], os.path.join(folder, "bag.log"), cwd=bags))
        observer = Observer()
        operator = Operator(efforts_of(scene), arguments.seed)
        threading.Thread(target=operator.run, daemon=True).start()
        samples = observe(observer, 60 * arguments.minutes)
        recorded = sum(os.path.getsize(os.path.join(bags, name)) for name in os.listdir(bags))
        died = observer.sample() is None or demo.poll() is not None
        conditions = {"seed": arguments.seed, "resident memory of rviz beside it [MiB]": memory_of_rviz(),
                      f"last bags, {BAGS} of {BAG_SIZE} at most [MB]": recorded // 10**6}
        with contextlib.suppress(AttributeError):  # rospy of Debian 11 calls Thread.isAlive()
            rospy.signal_shutdown("done")
    faults = write_report(arguments.output, samples, operator.counts, observer, died, conditions)
    draw = os.path.join(ROOT, "scripts", "plot_soak.py")
    subprocess.run([draw, arguments.output + ".csv", arguments.output + ".png"], check=True)
    print("\n".join(faults) or "nothing went wrong")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
