#!/usr/bin/python3
"""Lets one thing after the other go wrong around a running node, and prints a table of what happens.

scripts/faults starts it after everything was built. It has its own ROS master, and a separate node for each fault.
"""

import argparse
import contextlib
import functools
import math
import os
import random
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import warnings

import rosgraph
import rospy
from flexarm.msg import JointForceCommand, SimulatorStatus
from flexarm.srv import LoadState, SaveState
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "test", "ros"))
import simulated_arm  # noqa: E402
from running_node import RunningNode  # noqa: E402

PATIENCE = 20.0  # s, wall time
wait_until = functools.partial(simulated_arm.wait_until, patience=PATIENCE)
JOINT = "left_shoulder"


class Wrong(Exception):
    """Something happened that should not happen."""


def require(condition, what):
    if not condition:
        raise Wrong(what)


def memory_of(pid):
    """Resident memory [MiB]."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024


class Node(RunningNode):
    """A separate node, its messages and its output. For a `with` block."""

    # SIGXFSZ stays ignored, so that a limit of file sizes acts like a full disk: write() fails.
    process_options = {"start_new_session": True, "restore_signals": False}

    def __init__(self, *parameters):
        super().__init__(*parameters, is_silent=True)
        self.status = self.states = None
        self.stamps = []

    def __enter__(self):
        super().__enter__()
        self.subscribers = [rospy.Subscriber("/flexarm/status", SimulatorStatus, self.receive_status),
                            rospy.Subscriber("/joint_states", JointState, self.receive_states, queue_size=100)]
        self.force = rospy.Publisher("/joint_force_command", JointForceCommand, queue_size=10)
        self.services = {name: rospy.ServiceProxy("/flexarm/" + name, kind) for name, kind in (
            ("pause", Empty), ("resume", Empty), ("save_state", SaveState), ("load_state", LoadState))}
        return self

    def __exit__(self, *error):
        super().__exit__(*error)
        for one in (*self.subscribers, self.force):
            one.unregister()

    def receive_status(self, message):
        self.status = message

    def receive_states(self, message):
        self.states = message
        self.stamps.append(message.header.stamp.to_sec())

    def wait(self):
        wait_until(lambda: self.status and self.states and self.force.get_num_connections() > 0, "the node")
        return self

    def joint(self):
        index = self.states.name.index(JOINT)
        return self.states.position[index], self.states.velocity[index], self.states.effort[index]

    def send(self, effort, names=(JOINT,), seconds=0.0):
        self.force.publish(names=names, efforts=[effort], duration=rospy.Duration.from_sec(seconds))

    def goes_on(self, what="steps to go on"):
        before = self.status.steps
        wait_until(lambda: self.status.steps > before + 100, what)

    def said(self, text):
        """Waits for a line with this text in the log. Returns it without colours and time."""
        found = []

        def look():
            found[:] = [line for line in self.output().splitlines() if text in line]
            return found

        wait_until(look, f"the message '{text}'")
        return found[-1].split("]: ", 1)[-1].replace("\x1b[0m", "").strip()


def stalled_subscriber(_):
    with Node("_publish_rate:=1000") as node:
        node.wait()
        reader = subprocess.Popen(["rostopic", "echo", "/joint_states"], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        try:
            time.sleep(2)
            reader.send_signal(signal.SIGSTOP)
            before, memory = node.status, memory_of(node.process.pid)
            time.sleep(5)
            after, growth = node.status, memory_of(node.process.pid) - memory
        finally:
            reader.kill()
            reader.wait()
        require(after.missed == before.missed, "states were passed over")
        require(growth < 50, f"memory grew by {growth:.1f} MiB")
        node.goes_on()
        return (f"{after.steps - before.steps} steps of 1 ms in 5 s, all published to the others; memory "
                f"{growth:+.1f} MiB", "the stalled one's oldest messages, beyond a second", "")


def command_flood(_):
    with Node() as node:
        node.wait()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # rospy warns of blocking sends, which are intended
            flood = rospy.Publisher("/joint_force_command", JointForceCommand, queue_size=None)
        wait_until(lambda: flood.get_num_connections() > 0, "the node")
        message = JointForceCommand(names=[JOINT], efforts=[0.0])
        count, begin = 0, time.monotonic()
        while time.monotonic() < begin + 3:
            last = message.efforts[0] = 0.1 + 1e-6 * count
            flood.publish(message)
            count += 1
        wait_until(lambda: node.joint()[2] == last, "the last command to act")
        node.goes_on()
        return (f"{count / 3:.0f} commands a second for 3 s; steps go on, the last one acts",
                "commands that a later one replaced before a step", "")


def nonsense(_):
    with Node() as node:
        node.wait()
        node.send(1.0)
        wait_until(lambda: node.joint()[2] == 1.0, "the effort")
        for effort, names in ((math.nan, (JOINT,)), (math.inf, (JOINT,)), (2.0, ("nobody",)), (2.0, ())):
            node.send(effort, names)
        message = node.said("refused")
        node.goes_on()
        require(node.joint()[2] == 1.0, "the effort is another one")
        require(all(map(math.isfinite, (*node.states.position, *node.states.velocity))), "a number is not finite")
        return "refused whole; what was commanded before acts on", "nothing", message


def time_jumps(_):
    rospy.set_param("/use_sim_time", True)
    clock = rospy.Publisher("/clock", Clock, queue_size=10)
    now, is_over = [100.0], threading.Event()

    def tick():
        while not is_over.wait(0.01):
            now[0] += 0.01
            clock.publish(rospy.Time.from_sec(now[0]))

    ticking = threading.Thread(target=tick)
    ticking.start()
    try:
        with Node() as node:
            node.wait()
            for place in (1000.0, 50.0):
                now[0] = place
                wait_until(lambda place=place: abs(node.stamps[-1] - place) < 5, f"stamps about {place} s")
                count = len(node.stamps)
                wait_until(lambda count=count: len(node.stamps) > count + 50, "more messages")
            message = node.said("set back")
            node.goes_on()
    finally:
        is_over.set()
        ticking.join()
        clock.unregister()
        rospy.set_param("/use_sim_time", False)
    return "stamps follow, forth by 900 s and back by 950 s; steps go on", "nothing", message


def terminated(_):
    with Node() as node:
        node.wait()
        begin = time.monotonic()
        node.process.send_signal(signal.SIGTERM)
        require(node.process.wait(PATIENCE) == 0, f"exit status {node.process.returncode}")
        took = time.monotonic() - begin
        known = {name for group in rosgraph.Master("/faults").getSystemState() for _, names in group for name in names}
        require("/flexarm" not in known, "it is still registered")
        return f"ends with status 0 after {took:.1f} s, unregistered", "nothing", ""


def killed_while_saving(folder):
    file, kills = os.path.join(folder, "state"), 8
    with Node("_paused:=true") as node:
        for _ in range(kills):
            node.status = None
            wait_until(lambda: node.status, "the node")
            rospy.wait_for_service("/flexarm/save_state", PATIENCE)
            if os.path.exists(file):
                answer = node.services["load_state"](file)
                require(answer.success, answer.message)
            killer = threading.Timer(random.uniform(0.05, 0.5), node.process.kill)
            killer.start()
            with contextlib.suppress(rospy.ServiceException, OSError):
                while True:
                    node.services["save_state"](file)
            killer.join()
            node.process.wait()
            node.start()
        wait_until(lambda: node.status, "the node")
        rospy.wait_for_service("/flexarm/load_state", PATIENCE)
        answer = node.services["load_state"](file)
        require(answer.success, answer.message)
    return f"{kills} times while it saved without a break: the file was whole each time", "the save under way", ""


def disk_full(folder):
    """A limit of the size of files stands for a full disk."""
    file = os.path.join(folder, "state_before")
    with Node() as node:
        node.wait()
        answer = node.services["save_state"](file)
        require(answer.success, answer.message)
        limits = resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, (1000, limits[1]))
        refused = node.services["save_state"](file)
        resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, limits)
        require(not refused.success, "a success was told")
        node.goes_on()
        answer = node.services["load_state"](file)
        require(answer.success, answer.message)
        return "~save_state says so, the file of before is whole; steps go on", "nothing", refused.message


def controller_dies(_):
    with Node("_command_timeout:=0.2") as node:
        node.wait()
        controller = subprocess.Popen(["rostopic", "pub", "-r", "100", "/joint_force_command",
                                       "flexarm/JointForceCommand", f"{{names: [{JOINT}], efforts: [0.3]}}"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            wait_until(lambda: node.joint()[2] == 0.3, "its effort")
        finally:
            controller.kill()
            controller.wait()
        begin = time.monotonic()
        wait_until(lambda: node.joint()[2] == 0.0, "no effort")
        took = time.monotonic() - begin
        node.goes_on()
        return f"effort zero {took:.2f} s later (command_timeout 0.2 s); steps go on", "nothing", ""


def step_fails(_):
    with Node() as node:
        node.wait()
        node.send(1e250)
        wait_until(lambda: node.status.failed and node.status.paused, "the failure")
        message = node.status.message
        require(all(map(math.isfinite, (*node.states.position, *node.states.velocity))), "a number is not finite")
        failed_at = node.status.time
        node.send(0.0)
        time.sleep(0.3)
        node.services["resume"]()
        wait_until(lambda: node.status.time > failed_at and not node.status.failed, "steps to go on")
        return "paused in the last good state; ~resume goes on from it with another command", "nothing", message


def overload(_):
    with Node("_real_time_factor:=1e5") as node:
        node.wait()
        wait_until(lambda: node.status.overruns > 0, "an overrun")
        time.sleep(3)
        factor = node.status.real_time_factor
        begin = time.monotonic()
        node.services["pause"]()
        took = time.monotonic() - begin
        require(took < 2, f"~pause took {took:.1f} s")
        return (f"as fast as it can, {factor:.1f} times real time; steps dropped and counted; "
                f"~pause answers in {1e3 * took:.0f} ms", "nothing", node.said("slower than real_time_factor"))


def master_dies(_):
    with Node() as node:
        node.wait()
        node.send(0.1)
        wait_until(lambda: node.joint()[2] == 0.1, "the effort")
        Master.one.process.kill()
        Master.one.process.wait()
        gone = node.said("does not answer")
        node.goes_on("steps without the master")
        Master.one.start()
        back = node.said("registered again")
        heard = subprocess.run(["rostopic", "echo", "-n", "1", "/flexarm/status/time"], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, timeout=PATIENCE, check=False, text=True).stdout
        require(heard.strip(), "a new subscriber hears nothing")
        called = subprocess.run(["rosservice", "call", "/flexarm/pause"], timeout=PATIENCE, check=False).returncode
        require(called == 0, "a service cannot be called")
        wait_until(lambda: node.status.paused, "the pause")
        subprocess.run(["rosservice", "call", "/flexarm/resume"], timeout=PATIENCE, check=False)
        subprocess.run(["timeout", "4", "rostopic", "pub", "-r", "10", "/joint_force_command",
                        "flexarm/JointForceCommand", f"{{names: [{JOINT}], efforts: [0.7]}}"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        require(node.joint()[2] == 0.7, "a new publisher is not heard")
        return ("steps and connections go on; new subscribers, publishers and callers find the node again",
                "parameters that the master had", gone + "; " + back)


FAULTS = {
    "a subscriber stalls": stalled_subscriber,
    "a flood of commands": command_flood,
    "commands of NaN, of nobody": nonsense,
    "ROS time jumps": time_jumps,
    "SIGTERM": terminated,
    "SIGKILL in saving a state": killed_while_saving,
    "disk full": disk_full,
    "the controller dies": controller_dies,
    "a step fails": step_fails,
    "overload": overload,
    "the master dies and comes back": master_dies,  # the last one, since the new master does not know this script
}


class Master:
    """A ROS master on a free port."""

    one = None

    def __init__(self):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            self.port = probe.getsockname()[1]
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{self.port}"
        os.environ["ROS_HOSTNAME"] = "localhost"
        Master.one = self

    def start(self):
        self.process = subprocess.Popen(["rosmaster", "--core", "-p", str(self.port)], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        wait_until(rosgraph.is_master_online, "the master")

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


REPORT = """# What goes wrong around a running node

Written by `scripts/faults`. Each fault has a node of its own, an arm with a flexible link at real time
(`test/ros/two_arms.urdf`).

{}
"""


def table(rows):
    lines = ["| fault | | what happened | what was lost | what the node says |", "|---|---|---|---|---|"]
    for name, is_survived, (happened, lost, message) in rows:
        cells = [name, "survived" if is_survived else "**NOT SURVIVED**", happened, lost, message and f"`{message}`"]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", action="append", choices=FAULTS, help="only this fault; may be given several times")
    parser.add_argument("--output", help="file for the report, in Markdown")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder, Master():
        rospy.init_node("faults", anonymous=True, disable_signals=True)
        for name in arguments.only or FAULTS:
            print(name, "...", flush=True)
            try:
                rows.append((name, True, FAULTS[name](folder)))
            except Exception as error:  # after any error the other faults are still tested
                rows.append((name, False, (f"{type(error).__name__}: {error}", "", "")))
    print(table(rows))
    if arguments.output:
        with open(arguments.output, "w", encoding="utf-8") as report:
            report.write(REPORT.format(table(rows)))
    sys.stdout.flush()
    os._exit(0 if all(is_survived for _, is_survived, _ in rows) else 1)  # rospy's exit would wait for its master


if __name__ == "__main__":
    main()
