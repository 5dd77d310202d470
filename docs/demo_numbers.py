#!/usr/bin/python3
"""Prints the numbers of docs/demo.md.

It makes variants of config/demo_arm.urdf (locked motors; the torques of config/demo_commands.yaml as <effort>), hands
them to the command line program, and evaluates what comes out.
"""

import argparse
import csv
import math
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENE = os.path.join(ROOT, "config/demo_arm.urdf")
BOOMS = {"upper_arm": "upper_arm_tip", "lower_arm": "lower_arm_tip"}  # link: probe at its end


def read_scene():
    return ElementTree.parse(SCENE)


def braked(with_payload):
    """The straight arm with every motor locked: of the drives the springs of their gears are left."""
    tree = read_scene()
    robot = tree.getroot()
    for drive in robot.findall("drive"):
        ElementTree.SubElement(robot, "spring", joint=drive.get("joint"), stiffness=drive.get("stiffness"))
        robot.remove(drive)
    for joint in robot.findall("joint"):
        if not with_payload and joint.get("name") == "grapple":
            robot.remove(joint)
    simulation = robot.find("simulation")
    for entry in simulation.findall("initial") + simulation.findall("probe"):
        simulation.remove(entry)
    if not with_payload:
        robot.remove(next(link for link in robot.findall("link") if link.get("name") == "payload"))
    return tree


def automatic():
    """The demo with the mesh that elements="auto" gives."""
    tree = read_scene()
    for beam in tree.getroot().iter("beam"):
        beam.set("elements", "auto")
    return tree


def commanded(commands):
    """The demo with commands as <effort>: tables of straight lines, with steep flanks."""
    tree = read_scene()
    pulses = {}
    for command in commands:
        for k in range(command.get("repeat", 1)):
            begin = command["time"] + k * command.get("every", 0)
            for joint, effort in zip(command["names"], command["efforts"]):
                pulses.setdefault(joint, []).append((begin, begin + command["duration"], effort))
    flank = 1e-5
    for joint, train in pulses.items():
        table = []
        for begin, end, effort in sorted(train):
            table += [(begin, 0), (begin + flank, effort), (end - flank, effort), (end, 0)]
        points = [point for i, point in enumerate(table) if i == 0 or point[0] > table[i - 1][0] + flank / 2]
        history = " ".join("%.9g:%.9g" % point for point in points)
        ElementTree.SubElement(tree.getroot().find("simulation"), "effort", joint=joint, history=history)
    return tree


def run(program, tree, command, *options):
    with tempfile.NamedTemporaryFile(suffix=".urdf") as scene:
        tree.write(scene.name)
        command_line = [program, command, scene.name, *options]
        return subprocess.run(command_line, check=True, stdout=subprocess.PIPE, text=True).stdout


def frequencies(program, tree, count):
    """Without damping, which is so strong in the joints that some motions do not oscillate."""
    for element in tree.getroot().iter():
        for damping in element.findall("damping") + element.findall("dynamics") + element.findall("servo"):
            element.remove(damping)
    for drive in tree.getroot().findall("drive"):
        drive.set("damping", "0")
    modes = run(program, tree, "modes", "--count", str(count))
    return [float(f) for f in re.findall(r"^mode \d+: (\S+) Hz", modes, re.M)]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def in_frame(row, link, vector):
    """A vector of the world in the axes of a link."""
    axis = [-row["frame/%s/q%s" % (link, c)] for c in "xyz"]
    twice = [2 * c for c in cross(axis, vector)]
    correction = cross(axis, twice)
    return [vector[i] + row["frame/%s/qw" % link] * twice[i] + correction[i] for i in range(3)]


def deflection(row, link, probe):
    """How far the boom's end is from the straight line along its root's x axis [m]."""
    offset = [row["probe/%s/%s" % (probe, c)] - row["frame/%s/%s" % (link, c)] for c in "xyz"]
    _, y, z = in_frame(row, link, offset)
    return math.hypot(y, z)


def simulate(program, commands, until):
    """Rows of the output, and the processor time that it took [s]."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as output:
        begin = os.times().children_user
        options = "--until", str(until), "--every", "10", "--output", output.name, "--quiet"
        run(program, commanded(commands), "simulate", *options)
        duration = os.times().children_user - begin
        with open(output.name) as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)], duration


def show_largest_deflections(rows):
    for link, probe in BOOMS.items():
        largest = max(rows, key=lambda row: deflection(row, link, probe))
        print("  %s: %.0f mm at %.2f s" % (link, 1e3 * deflection(largest, link, probe), largest["time"]))


def show_manoeuvre(program, schedule):
    rows, duration = simulate(program, schedule["commands"], schedule["period"])
    print("largest deflection of each boom's end from its root's axis, demo:")
    show_largest_deflections(rows)
    print("%8s %13s %13s %12s %12s %12s %14s" % ("time [s]", "upper [mm]", "lower [mm]", "kinetic [J]", "strain [J]",
                                                "work [J]", "dissipated [J]"))
    for row in rows:
        if abs(row["time"] / 2 - round(row["time"] / 2)) < 1e-6:
            values = [1e3 * deflection(row, link, probe) for link, probe in BOOMS.items()]
            values += [row["energy/" + kind] for kind in ("kinetic", "strain", "work", "dissipated")]
            print("%8.0f %13.1f %13.1f %12.2f %12.2f %12.1f %14.1f" % (row["time"], *values))
    balance = [row["energy/total"] - row["energy/work"] + row["energy/dissipated"] for row in rows]
    print("energy account: total - work + dissipated is constant within %.0e J" % (max(balance) - min(balance)))
    print("%.2f s of processor time for %g s, output included: real-time factor %.1f"
          % (duration, schedule["period"], schedule["period"] / duration))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", action="store_true",
                        help="print the demo with its torques as a scene, and nothing else")
    parser.add_argument("program", nargs="?", default=os.path.join(ROOT, "devel/lib/flexarm/flexarm"))
    arguments = parser.parse_args()
    program = arguments.program
    with open(os.path.join(ROOT, "config/demo_commands.yaml")) as file:
        schedule = yaml.safe_load(file)
    if arguments.scene:
        commanded(schedule["commands"]).write(sys.stdout.buffer)
        return

    print("natural frequencies without damping [Hz]")
    print("  straight, locked joints, no payload:  ", *("%.4f" % f for f in frequencies(program, braked(False), 4)))
    print("  straight, locked joints, with payload:", *("%.4f" % f for f in frequencies(program, braked(True), 4)))
    print("  demo, free joints, with payload:      ", *("%.4f" % f for f in frequencies(program, read_scene(), 12)[6:]))
    print("  the same with elements='auto':        ", *("%.4f" % f for f in frequencies(program, automatic(), 12)[6:]))
    show_manoeuvre(program, schedule)
    print("largest deflection, constant 1000 N m at the shoulder yaw joint for 4 s:")
    push = {"time": 0, "names": ["shoulder_yaw"], "efforts": [1000], "duration": 4}
    show_largest_deflections(simulate(program, [push], 4)[0])


if __name__ == "__main__":
    main()
