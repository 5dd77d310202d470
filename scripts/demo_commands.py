#!/usr/bin/python3
"""Plays a schedule of joint efforts in a running simulation, again and again.

Parameters: ~period, the simulated time after which the simulation is reset and the schedule begins again [s], and
~commands, a list of entries of two kinds. The first is

    {time: s, names: [joint, ...], efforts: [N m or N, ...], duration: s, repeat: times, every: s}

where `repeat` (default 1) and `every` let a command repeat. The second is

    {names: [joint, ...], table: [[s, N m or N, ...], ...], every: s}

efforts that are linear between the times of a table. Every `every` seconds, a command with the mean effort is sent. The
schedule follows the simulated time in flexarm/status, so it pauses, slows down and restarts with the simulation.
"""

import threading
import time

import rospy
from flexarm.msg import JointForceCommand, SimulatorStatus
from std_srvs.srv import Empty


def interpolated(table, time):
    """Efforts at a time; constant before and after the table."""
    before = [row for row in table if row[0] <= time] or table[:1]
    after = [row for row in table if row[0] > time] or table[-1:]
    (t0, *first), (t1, *second) = before[-1], after[0]
    part = (time - t0) / (t1 - t0) if t1 > t0 else 0.0
    return [a + part * (b - a) for a, b in zip(first, second)]


def pulses(command):
    """Splits a command into pulses of constant effort: a list of pairs (time, command)."""
    every = command.get("every", 0.0)
    if "table" not in command:
        return [(command["time"] + k * every, command) for k in range(command.get("repeat", 1))]
    begin, end = command["table"][0][0], command["table"][-1][0]
    times = [begin + k * every for k in range(round((end - begin) / every))]
    # A pulse holds until the next one, so that no effort is missing if a message is late.
    return [
        (
            time,
            {
                **command,
                "efforts": interpolated(command["table"], time + 0.5 * every),
                "duration": every if time == times[-1] else 0.0,
            },
        )
        for time in times
    ]


def expand(commands):
    """The pulses of all commands, sorted by time."""
    return sorted((event for command in commands for event in pulses(command)), key=lambda event: event[0])


class Player:
    def __init__(self, commands, period):
        self.events = expand(commands)
        self.period = period
        self.next = 0  # index of the next event
        self.status = None
        self.heard_at = 0.0  # wall time of the last status [s]
        self.changed = threading.Condition()
        self.publisher = rospy.Publisher("joint_force_command", JointForceCommand, queue_size=100)
        self.reset = rospy.ServiceProxy("flexarm/reset", Empty)

    def receive(self, status):
        with self.changed:
            if self.status is None or status.time < self.status.time:  # the start, or a reset
                self.next = sum(due < status.time for due, _ in self.events)
            self.status = status
            self.heard_at = time.monotonic()
            self.changed.notify()

    def delay(self, due):
        """Wall time until the simulation reaches `due` [s]; None if it is unknown, or the simulation stands still.

        Status messages come ten times a second, but pulses are shorter. So the time is extrapolated between messages.
        """
        status = self.status
        if status is None or status.paused or status.failed or status.real_time_factor <= 0:
            return None
        return (due - status.time) / status.real_time_factor - (time.monotonic() - self.heard_at)

    def play_next(self):
        """Waits for the next event and sends it. Also returns, without sending, when the event's time may change."""
        with self.changed:
            at_end = self.next == len(self.events)
            due, command = (self.period, None) if at_end else self.events[self.next]
            delay = self.delay(due)
            if delay is None or delay > 0:
                self.changed.wait(0.1 if delay is None else min(delay, 0.1))
                return
            if at_end:
                self.status = None  # unknown until the first status after the reset
            else:
                self.next += 1
        if at_end:
            self.reset()
        else:
            self.publisher.publish(
                names=command["names"],
                efforts=command["efforts"],
                duration=rospy.Duration.from_sec(command["duration"]),
            )

    def start(self):
        """Resets the simulation as soon as it can receive commands, since it already ran before that."""
        self.reset.wait_for_service()
        while self.publisher.get_num_connections() == 0 and not rospy.is_shutdown():
            time.sleep(0.01)
        self.reset()

    def run(self):
        self.start()
        while not rospy.is_shutdown():
            try:
                self.play_next()
            except rospy.ServiceException as error:
                rospy.logwarn("the simulation could not be reset: %s", error)


def main():
    rospy.init_node("demo_commands")
    player = Player(rospy.get_param("~commands"), rospy.get_param("~period"))
    rospy.Subscriber("flexarm/status", SimulatorStatus, player.receive, queue_size=10)
    try:
        player.run()
    except rospy.ROSInterruptException:
        pass


if __name__ == "__main__":
    main()
