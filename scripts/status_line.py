#!/usr/bin/python3
"""Shows the state of a running simulation: one line that is updated on a terminal, else a new line each second.

status_line.py [--duration SECONDS]: ends after this simulated time. The exit status is 1 if the simulation fails, or if
it sends nothing for 20 s.
"""

import argparse
import sys
import threading
import time

import rospy
from flexarm.msg import SimulatorStatus

PATIENCE = 20.0  # s, wall time


def format_status(status):
    if status.failed:
        return "failed: " + status.message
    return "t = %8.2f s   real-time factor %5.2f   overruns %d   energy %.6g J (kinetic %.3g, strain %.3g)%s" % (
        status.time,
        status.real_time_factor,
        status.overruns,
        status.total_energy,
        status.kinetic_energy,
        status.strain_energy,
        "   paused" if status.paused else "",
    )


class StatusLine:
    def __init__(self, duration):
        self.duration = duration
        self.ended = threading.Event()
        self.exit_status = 0
        self.last_heard = time.monotonic()
        self.last_shown = 0.0
        self.is_terminal = sys.stdout.isatty()

    def receive(self, status):
        self.last_heard = time.monotonic()
        at_end = self.duration is not None and status.steps * status.step >= self.duration
        self.show(status, at_end or status.failed)
        if status.failed:
            self.exit_status = 1
        if (at_end or status.failed) and not self.ended.is_set():
            self.ended.set()

    def show(self, status, is_last):
        if self.ended.is_set():
            return
        if self.is_terminal:
            sys.stdout.write("\r\033[K" + format_status(status) + ("\n" if is_last else ""))
        elif is_last or time.monotonic() - self.last_shown >= 1:
            self.last_shown = time.monotonic()
            sys.stdout.write(format_status(status) + "\n")
        sys.stdout.flush()

    def run(self):
        while not self.ended.wait(0.2) and not rospy.is_shutdown():
            # A paused simulation is silent, too. Only one that has never sent anything counts as missing.
            if self.last_shown == 0 and time.monotonic() - self.last_heard > PATIENCE and not self.is_alive():
                print("nothing is heard of the simulation", file=sys.stderr)
                return 1
        return self.exit_status

    @staticmethod
    def is_alive():
        try:
            rospy.wait_for_message("flexarm/status", SimulatorStatus, 1)
            return True
        except rospy.ROSException:
            return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--duration", type=float, help="simulated time after which to end [s]")
    line = StatusLine(parser.parse_args(rospy.myargv()[1:]).duration)
    rospy.init_node("status_line", anonymous=True)
    rospy.Subscriber("flexarm/status", SimulatorStatus, line.receive, queue_size=1)
    return line.run()


if __name__ == "__main__":
    sys.exit(main())
