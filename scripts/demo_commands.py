#!/usr/bin/python3
"""Plays a schedule of joint efforts against a running simulation, again and again.

Parameters: ~commands, a list of {time: s, names: [joint, ...], efforts: [N m or N, ...], duration: s}, and ~period, the
simulated time after which the schedule starts again [s]. It follows the simulated time of flexarm/status, so that it
pauses, slows down and starts again together with the simulation.
"""

import rospy
from flexarm.msg import JointForceCommand, SimulatorStatus


class Schedule:
    def __init__(self, commands, period):
        self.commands = sorted(commands, key=lambda command: command["time"])
        self.period = period
        self.last_time = -1.0  # s, simulated
        self.publisher = rospy.Publisher("joint_force_command", JointForceCommand, queue_size=100)

    def receive(self, status):
        if self.publisher.get_num_connections() == 0:
            return
        if status.time < self.last_time:  # the simulation was reset
            self.last_time = -1.0
        for command in self.commands:
            # The latest repetition of this command up to now.
            repetition = (status.time - command["time"]) // self.period
            if repetition >= 0 and command["time"] + repetition * self.period > self.last_time:
                self.send(command)
        self.last_time = status.time

    def send(self, command):
        self.publisher.publish(
            names=command["names"],
            efforts=command["efforts"],
            duration=rospy.Duration.from_sec(command["duration"]),
        )


def main():
    rospy.init_node("demo_commands")
    schedule = Schedule(rospy.get_param("~commands"), rospy.get_param("~period"))
    rospy.Subscriber("flexarm/status", SimulatorStatus, schedule.receive, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
