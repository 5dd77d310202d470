"""Computes the moments of gravity in the joints of a URDF, with forward kinematics in numpy, independently of flexarm.

moments(path, positions) -> {joint: (moment, largest, position, lower, upper)}, for each joint that is not fixed:

  moment   generalised force of gravity on the coordinate, including joints that mimic it [N m or N]
  largest  the same if the weight of each outboard link acted perpendicular to its lever arm [N m or N]

`positions`: coordinate -> value [rad or m]; other coordinates are 0. Handles fixed, revolute, continuous and prismatic
joints; raises ValueError if a joint of another kind moves a mass. Gravity is -9.81 m/s^2 along z. The root link, or the
link `world`, is held.
"""

import xml.etree.ElementTree

import numpy as np

GRAVITY = np.array([0.0, 0.0, -9.81])  # [m/s^2]
SCALAR = ("revolute", "continuous", "prismatic")


def numbers(element, name, default):
    return np.array([float(x) for x in (element.get(name, default) if element is not None else default).split()])


def rotation_about(axis, angle):
    """The 3 x 3 rotation matrix about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def rotation_of(rpy):
    r, p, y = rpy
    return rotation_about((0, 0, 1), y) @ rotation_about((0, 1, 0), p) @ rotation_about((1, 0, 0), r)


class Joint:
    def __init__(self, element):
        origin, limit, mimic = element.find("origin"), element.find("limit"), element.find("mimic")
        self.name, self.kind = element.get("name"), element.get("type")
        self.parent, self.child = element.find("parent").get("link"), element.find("child").get("link")
        self.offset, self.turn = numbers(origin, "xyz", "0 0 0"), rotation_of(numbers(origin, "rpy", "0 0 0"))
        axis = numbers(element.find("axis"), "xyz", "1 0 0")
        self.axis = axis / (np.linalg.norm(axis) or 1)
        has_limits = limit is not None and self.kind in ("revolute", "prismatic")
        self.lower = float(limit.get("lower", 0)) if has_limits else -np.inf
        self.upper = float(limit.get("upper", 0)) if has_limits else np.inf
        self.master = None if mimic is None else mimic.get("joint")
        self.multiplier = 1.0 if mimic is None else float(mimic.get("multiplier", 1))


class Robot:
    def __init__(self, path):
        with open(path, encoding="utf-8", errors="replace") as file:
            root = xml.etree.ElementTree.fromstring(file.read().strip())
        joints = [element for element in root.findall("joint") if element.find("parent") is not None]
        self.joints = {joint.name: joint for joint in map(Joint, joints)}
        self.masses = {}
        for link in root.findall("link"):
            inertial = link.find("inertial")
            if inertial is not None and inertial.find("mass") is not None:
                self.masses[link.get("name")] = (float(inertial.find("mass").get("value")),
                                                 numbers(inertial.find("origin"), "xyz", "0 0 0"))
        children = {joint.child for joint in self.joints.values()}
        self.roots = [link.get("name") for link in root.findall("link") if link.get("name") not in children]

    def depth(self, joint):
        """The number of mimics between a joint and the joint that it finally follows."""
        return 0 if joint.master not in self.joints else 1 + self.depth(self.joints[joint.master])

    def outboard(self, link):
        links = [link]
        for joint in self.joints.values():
            if joint.parent == link:
                links += self.outboard(joint.child)
        return links

    def place(self, positions):
        """Poses {link: (position, rotation)} in the world [m], and joint axes {joint: (anchor, axis)}."""
        poses, anchors, waiting = {root: (np.zeros(3), np.eye(3)) for root in self.roots}, {}, list(self.roots)
        while waiting:
            link = waiting.pop()
            for joint in self.joints.values():
                if joint.parent != link:
                    continue
                position = poses[link][0] + poses[link][1] @ joint.offset
                rotation = poses[link][1] @ joint.turn
                axis, value = rotation @ joint.axis, positions.get(joint.name, 0.0)
                anchors[joint.name] = (position, axis)
                if joint.kind == "prismatic":
                    position = position + value * axis
                elif joint.kind in SCALAR:
                    rotation = rotation @ rotation_about(joint.axis, value)
                poses[joint.child] = (position, rotation)
                waiting.append(joint.child)
        return poses, anchors


def moments(path, positions):
    robot = Robot(path)
    poses, anchors = robot.place(positions)
    result = {}
    for joint in robot.joints.values():
        if joint.kind == "fixed":
            continue
        anchor, axis = anchors[joint.name]
        moment = largest = 0.0
        for link in robot.outboard(joint.child):
            mass, centre = robot.masses.get(link, (0.0, np.zeros(3)))
            if mass and joint.kind not in SCALAR:
                raise ValueError(f"joint '{joint.name}' is {joint.kind}")
            arm = poses[link][0] + poses[link][1] @ centre - anchor
            moment += mass * GRAVITY @ (axis if joint.kind == "prismatic" else np.cross(axis, arm))
            largest += mass * np.linalg.norm(GRAVITY) * (1 if joint.kind == "prismatic" else np.linalg.norm(arm))
        result[joint.name] = [moment, largest, positions.get(joint.name, 0.0), joint.lower, joint.upper]
    # Joints that follow followers come first.
    for joint in sorted(robot.joints.values(), key=robot.depth, reverse=True):
        if joint.master in result and joint.name in result:
            moment, largest, position, lower, upper = result.pop(joint.name)
            master = result[joint.master]
            master[0] += joint.multiplier * moment
            master[1] += abs(joint.multiplier) * largest
            # A follower at its stop stops its master, too.
            sign = 1 if joint.multiplier > 0 else -1
            if position <= lower:
                master[3 if sign > 0 else 4] = master[2]
            if position >= upper:
                master[4 if sign > 0 else 3] = master[2]
    return {name: tuple(values) for name, values in result.items()}


def left_over(path, positions, held=()):
    """The largest moment of gravity in a joint that neither a stop nor `held` carries, relative to the largest of all
    possible moments; and the name of that joint."""
    joints = moments(path, positions)
    largest = max((values[1] for values in joints.values()), default=0.0)
    worst, name = 0.0, ""
    for joint, (moment, _, position, lower, upper) in joints.items():
        is_stopped = (position <= lower and moment <= 0) or (position >= upper and moment >= 0)
        if largest > 0 and not is_stopped and joint not in held and abs(moment) / largest > worst:
            worst, name = abs(moment) / largest, joint
    return worst, name
