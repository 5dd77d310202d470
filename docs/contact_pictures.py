#!/usr/bin/python3
"""Draws docs/images/contact_examples.png: scenes of contact of config/examples from the side, at some times of each."""

import os
import xml.etree.ElementTree as ElementTree

import matplotlib
import numpy

import flexarm

matplotlib.use("Agg")
from matplotlib import patches, pyplot  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENES = [  # name, times [s], limits of x and z [m]
    ("falling_boxes", (0, 0.5, 0.75, 2), (-0.45, 0.75), (0, 0.8)),
    ("peg_in_hole", (0.2, 0.76, 0.9, 2), (-0.045, 0.045), (0, 0.16)),
    ("cable_over_pulley", (0, 1, 1.2, 2), (-0.12, 0.12), (0, 0.58)),
    ("wrapping_finger", (0, 0.5, 0.7, 2), (-0.03, 0.17), (-0.11, 0.04)),
]


def rotation(quaternion):
    """Matrix of x y z w, shape (3, 3)."""
    x, y, z, w = quaternion
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + 2 * w * cross + 2 * cross @ cross


def outline(points):
    """Convex hull of points in the plane, shape (n, 2), by Andrew's chain."""
    def chain(ordered):
        out = []
        for p in ordered:
            while len(out) > 1 and numpy.cross(out[-1] - out[-2], p - out[-2]) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]
    ordered = sorted(points, key=tuple)
    return numpy.array(chain(ordered) + chain(ordered[::-1]))


def draw_shape(axes, collision, pose):
    origin = collision.find("origin")
    at = [float(word) for word in origin.get("xyz").split()] if origin is not None else [0, 0, 0]
    turned = rotation(pose[3:])
    middle = pose[:3] + turned @ at
    shape = collision.find("geometry")[0]
    if shape.tag == "box":
        half = 0.5 * numpy.array([float(word) for word in shape.get("size").split()])
        signs = numpy.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * 2 - 1
        corners = middle + (signs * half) @ turned.T
        axes.add_patch(patches.Polygon(outline(corners[:, [0, 2]]), facecolor="#b8c8d8", edgecolor="black", alpha=0.7))
    else:
        axes.add_patch(patches.Circle(middle[[0, 2]], float(shape.get("radius")), facecolor="#d8c8b8",
                                      edgecolor="black"))


def draw(axes, simulation, robot):
    poses = dict(zip(simulation.link_names, simulation.link_poses))
    if robot.find("ground") is not None:
        axes.axhline(0, color="gray", linewidth=0.8)
    for link in robot.findall("link"):
        for visual in link.findall("collision") or link.findall("visual"):
            draw_shape(axes, visual, poses[link.get("name")])
        if link.find("beam") is not None:
            line = simulation.beam_points(link.get("name"), 4)["pose"]
            axes.plot(line[:, 0], line[:, 2], color="#c03020", linewidth=2)


def main():
    figure, grid = pyplot.subplots(len(SCENES), 4, figsize=(10, 12))
    for row, (name, times, x_limits, z_limits) in zip(grid, SCENES):
        path = os.path.join(ROOT, "config/examples", name + ".urdf")
        robot = ElementTree.parse(path).getroot()
        simulation = flexarm.Simulation(flexarm.read_scene(path))
        for axes, time in zip(row, times):
            while simulation.time < time - 0.5 * simulation.step_size:
                simulation.step()
            draw(axes, simulation, robot)
            axes.set(xlim=x_limits, ylim=z_limits, aspect="equal", xticks=[], yticks=[], title=f"{time:g} s")
        row[0].set_ylabel(name.replace("_", " "))
    figure.tight_layout()
    figure.savefig(os.path.join(ROOT, "docs/images/contact_examples.png"), dpi=80)


if __name__ == "__main__":
    main()
