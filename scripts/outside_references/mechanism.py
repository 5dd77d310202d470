"""Scenes of rigid links that move in a plane (or along its normal), read from URDF, and their equations of motion.

Only a part of docs/scene_format.md is supported. Everything else is refused, so that no force is left out silently. The
coordinates are those of the joints. Loops are closed by constraints on accelerations.
"""

import cmath
import xml.etree.ElementTree as ElementTree

import numpy as np

import time_functions


class Refused(ValueError):
    """The scene contains something that is not supported here."""


def numbers(text, count=3):
    found = [float(word) for word in text.split()]
    if len(found) != count:
        raise Refused(f"expected {count} numbers, got '{text}'")
    return np.array(found)


def number(element, name, default=None):
    return default if element is None or element.get(name) is None else float(element.get(name))


def set_free(root, floating):
    """Replaces a floating joint by two slides and a hinge, which are the same in the plane z = 0."""
    name, child = floating.get("name"), floating.find("child").get("link")
    if floating.find("axis") is not None:
        raise Refused(f"joint '{name}': an axis")
    root.remove(floating)
    parent, origin = floating.find("parent").get("link"), floating.find("origin")
    for kind, part, axis in (("prismatic", "x", "1 0 0"), ("prismatic", "y", "0 1 0"), ("continuous", "turn", "0 0 1")):
        to = child if part == "turn" else f"{child}/{part}"
        if to != child:
            ElementTree.SubElement(root, "link", name=to)
        joint = ElementTree.SubElement(root, "joint", name=f"{name}/{part}", type=kind)
        ElementTree.SubElement(joint, "parent", link=parent)
        ElementTree.SubElement(joint, "child", link=to)
        ElementTree.SubElement(joint, "axis", xyz=axis)
        if part == "x" and origin is not None:
            joint.append(origin)
        parent = to


class Joint:
    """`kind`: turn, slide, rise (along the normal) or screw. `sign`: of a turn. `direction`: of a slide."""

    def __init__(self, element, plane):
        self.name, self.type = element.get("name"), element.get("type")
        self.parent, self.child = element.find("parent").get("link"), element.find("child").get("link")
        origin, axis = element.find("origin"), element.find("axis")
        if origin is not None and np.any(numbers(origin.get("rpy", "0 0 0"))):
            raise Refused(f"joint '{self.name}': rpy")
        self.at, self.out_of_plane = plane.split(numbers(origin.get("xyz", "0 0 0")) if origin is not None
                                                 else np.zeros(3))
        self.kind, self.pitch, self.sign, self.direction = "fixed", 0.0, 1.0, None
        couple = element.find("couple")
        if self.type == "floating" and couple is not None and couple.get("kind") == "screw":
            self.kind, self.pitch = "screw", float(couple.get("pitch"))
        elif self.type in ("revolute", "continuous"):
            self.kind = "turn"
        elif self.type == "prismatic":
            self.kind = "slide"
        elif self.type != "fixed":
            raise Refused(f"joint '{self.name}' of type {self.type}")
        direction = numbers(axis.get("xyz")) if axis is not None else np.array([1.0, 0, 0])
        direction /= np.linalg.norm(direction)
        flat, height = plane.split(direction)
        if self.kind in ("turn", "screw"):
            if abs(abs(height) - 1) > 1e-12:
                raise Refused(f"joint '{self.name}': its axis is not normal to the plane")
            self.sign = 1.0 if height > 0 else -1.0
        elif self.kind == "slide":
            self.direction = flat
            if abs(height) > 1e-12:
                self.kind, self.sign = "rise", np.sign(height)
        self.element = element


class Plane:
    def __init__(self, normal):
        self.normal = normal / np.linalg.norm(normal)
        # The first coordinate axis that lies in the plane.
        self.x = next(e for e in np.eye(3) if abs(e @ self.normal) < 1e-12)
        self.y = np.cross(self.normal, self.x)

    def split(self, vector):
        return complex(self.x @ vector, self.y @ vector), float(self.normal @ vector)

    def join(self, flat, height):
        return self.x * flat.real + self.y * flat.imag + self.normal * height


class Link:
    def __init__(self, element, plane):
        self.name = element.get("name")
        inertial = element.find("inertial")
        self.mass, self.inertia, self.centre = 0.0, 0.0, 0j
        if element.find("beam") is not None:
            raise Refused(f"link '{self.name}' is flexible")
        if inertial is None:
            return
        self.mass = float(inertial.find("mass").get("value"))
        tensor = inertial.find("inertia")
        xx, yy, zz, xy, xz, yz = (float(tensor.get(key)) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
        full = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        self.inertia = float(plane.normal @ full @ plane.normal)
        if inertial.find("origin") is not None:
            self.centre, _ = plane.split(numbers(inertial.find("origin").get("xyz", "0 0 0")))


class Mechanism:
    """Kinematics: for each link the origin, the angle, the height above the plane, and their Jacobians."""

    def __init__(self, text):
        root = ElementTree.fromstring(text)
        known = {"link", "joint", "loop_joint", "drive", "servo", "spring", "simulation", "parameter", "ground",
                 "contact"}
        for child in root:
            if child.tag not in known:
                raise Refused(f"<{child.tag}>")
        for element in root.findall("joint"):
            if element.get("type") == "floating" and element.find("couple") is None:
                set_free(root, element)
        elements = root.findall("joint")
        axes = [j.find("axis") for j in elements if j.get("type") in ("revolute", "continuous", "floating")]
        self.plane = Plane(numbers(axes[0].get("xyz")) if axes and axes[0] is not None else np.array([0, 0, 1.0]))
        self.links = {e.get("name"): Link(e, self.plane) for e in root.findall("link")}
        self.massive = [link for link in self.links.values() if link.mass or link.inertia]
        self.joints = self._sorted([Joint(e, self.plane) for e in elements])
        self.moving = [j for j in self.joints if j.kind != "fixed"]
        self.index = {j.name: i for i, j in enumerate(self.moving)}
        self.n = len(self.moving)
        self.simulation = root.find("simulation")
        gravity = self.simulation.find("gravity") if self.simulation is not None else None
        self.gravity, self.gravity_height = self.plane.split(
            numbers(gravity.get("xyz")) if gravity is not None else np.array([0, 0, -9.81]))
        self.loops = [self._loop(e) for e in root.findall("loop_joint")]
        self.point_springs = [e for e in root.findall("spring") if e.get("from")]
        self.root = root
        self.probes = [(p.get("link"), *self.plane.split(numbers(p.get("at", "0 0 0"))))
                       for p in self.simulation.findall("probe")]
        if not self.probes:
            raise Refused("a scene without a <probe>")

    def _sorted(self, joints):
        children = {j.child for j in joints}
        self.base = next(name for name in self.links if name not in children)
        ordered, reached = [], {self.base}
        while len(ordered) < len(joints):
            following = [j for j in joints if j.parent in reached and j.child not in reached]
            if not following:
                raise Refused("joints that form no tree")
            ordered += following
            reached |= {j.child for j in following}
        return ordered

    def _loop(self, element):
        origin, other = element.find("origin"), element.find("child_origin")
        if element.get("type") not in ("continuous", "revolute"):
            raise Refused("a loop joint that is no hinge")
        at = [self.plane.split(numbers(e.get("xyz", "0 0 0")))[0] if e is not None else 0j
              for e in (origin, other)]
        return element.find("parent").get("link"), at[0], element.find("child").get("link"), at[1]

    def place(self, q, v):
        """For each link (origin, rotation, height, J of the origin, J of the angle, J of the height, bias acceleration,
        angular velocity). Vectors in the plane are complex numbers and Jacobians are lists, since numpy is slow for few
        numbers."""
        zeros = [0.0] * self.n
        frames = {self.base: (0j, 1 + 0j, 0.0, zeros, zeros, zeros, 0j, 0.0)}
        for joint in self.joints:
            r, turn, height, jr, jphi, jh, bias, w = frames[joint.parent]
            arm, i, u = turn * joint.at, self.index.get(joint.name), 0j
            if joint.kind == "slide":
                u = turn * joint.direction
                arm += u * q[i]
            jr = [a + 1j * arm * b for a, b in zip(jr, jphi)]
            bias, height = bias - w * w * arm, height + joint.out_of_plane
            if joint.kind == "slide":
                jr[i] += u
                bias += 2j * w * v[i] * u
            if joint.kind in ("turn", "screw"):
                turn, w, jphi = turn * cmath.rect(1, joint.sign * q[i]), w + joint.sign * v[i], jphi[:]
                jphi[i] += joint.sign
            if joint.kind in ("rise", "screw"):
                rise = joint.sign * (joint.pitch if joint.kind == "screw" else 1.0)
                height, jh = height + rise * q[i], jh[:]
                jh[i] += rise
            frames[joint.child] = (r + arm, turn, height, jr, jphi, jh, bias, w)
        return frames

    @staticmethod
    def point(frame, at):
        """Position, Jacobian and bias acceleration of a point of a link."""
        r, turn, _, jr, jphi, _, bias, w = frame
        arm = turn * at
        return r + arm, [a + 1j * arm * b for a, b in zip(jr, jphi)], bias - w * w * arm

    def equations(self, q, v):
        """M, generalised forces of inertia and gravity, and the constraints of loops, for M a = force, J a = right."""
        frames, n = self.place(q, v), self.n
        mass, force = [[0.0] * n for _ in range(n)], [0.0] * n
        for link in self.massive:
            frame = frames[link.name]
            _, j, bias = self.point(frame, link.centre)
            jphi, jh, pull, m = frame[4], frame[5], self.gravity - bias, link.mass
            for a in range(n):
                row, ja, turn, rise = mass[a], j[a].conjugate() * m, link.inertia * jphi[a], m * jh[a]
                force[a] += (ja * pull).real + rise * self.gravity_height
                for b in range(n):
                    row[b] += (ja * j[b]).real + turn * jphi[b] + rise * jh[b]
        rows, right = [], []
        for a, at_a, b, at_b in self.loops:
            _, ja, bias_a = self.point(frames[a], at_a)
            _, jb, bias_b = self.point(frames[b], at_b)
            gap, bias = [x - y for x, y in zip(ja, jb)], bias_b - bias_a
            rows += [[x.real for x in gap], [x.imag for x in gap]]
            right += [bias.real, bias.imag]
        return frames, mass, force, rows, right

    def gaps(self, q):
        frames = self.place(q, [0.0] * self.n)
        return [abs(self.point(frames[a], at)[0] - self.point(frames[b], other)[0])
                for a, at, b, other in self.loops]

    def positions(self, q):
        """Positions of the probes in the world [m]."""
        frames = self.place(q, [0.0] * self.n)
        return np.array([self.plane.join(self.point(frames[link], flat)[0], frames[link][2] + height)
                         for link, flat, height in self.probes])

    def entries(self, tag):
        return self.simulation.findall(tag)

    def function_entries(self, tag, attribute):
        return {self.index[e.get("joint")]: time_functions.read(e.get(attribute)) for e in self.entries(tag)}
