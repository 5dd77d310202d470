"""Tests what stands for meshes that cannot be read, and who is told."""

import numpy as np
import pytest

pytest.importorskip("flexarm")

from page_reader import read_page  # noqa: E402
from show_test import body, flexarm_program, scene_of  # noqa: E402

LOST = '<visual> <geometry> <mesh filename="file:///nowhere/none.stl"/> </geometry> </visual>'
SPHERE = '<visual> <geometry> <sphere radius="0.5"/> </geometry> </visual>'
TOUCHING = '<collision> <origin xyz="1 2 3"/> <geometry> <cylinder radius="0.1" length="0.4"/> </geometry> </collision>'
# Of the size 1 m x 2 m x 3 m.
HEAVY = """<link name="heavy"> <inertial> <origin xyz="0.1 0 0"/> <mass value="12"/>
  <inertia ixx="13" iyy="10" izz="5" ixy="0" ixz="0" iyz="0"/> </inertial> %s </link>
  <joint name="fall" type="floating"> <parent link="world"/> <child link="heavy"/> </joint>""" % LOST


def test_something_stands_for_a_missing_mesh(tmp_path):
    scene = scene_of(("touching", LOST + TOUCHING), ("with another shape", LOST + SPHERE), extra=HEAVY)
    (tmp_path / "lost.urdf").write_text(scene.replace('<link name="world"/>', '<link name="world"> %s </link>' % LOST))
    printed = flexarm_program(tmp_path, "show", "lost.urdf", "--until", "0.01")
    run, = read_page(tmp_path / "lost.html")
    shapes = {link["name"]: link["shapes"] for link in run.picture["links"]}
    assert [shape["kind"] for shape in shapes["touching"]] == ["cylinder"]
    assert shapes["touching"][0]["pose"][:3] == [1, 2, 3]
    assert [shape["kind"] for shape in shapes["with another shape"]] == ["sphere"]
    box, = shapes["heavy"]
    assert box["kind"] == "box" and sorted(box["size"]) == pytest.approx([1, 2, 3]) and box["pose"][0] == 0.1
    x, y, z, w = box["pose"][3:]
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    moments = [sum(np.square(box["size"])) - size**2 for size in box["size"]]
    assert turn @ np.diag(moments) @ turn.T == pytest.approx(np.diag([13, 10, 5]), abs=1e-9)
    assert [shape["kind"] for shape in shapes["world"]] == ["sphere"]  # without <collision> and inertia
    for name, what in (("touching", ", but its <collision>: "), ("heavy", ", but a box with its mass and inertia: "),
                       ("world", ", but a sphere: "), ("with another shape", ": ")):
        assert printed.count("warning: link '%s': the mesh 'file:///nowhere/none.stl' is not shown%s"
                             % (name, what)) == 1


HINGED = """<robot name="lost"> <link name="world"/> <joint name="hinge" type="continuous"> <parent link="world"/>
  <child link="a"/> <axis xyz="0 1 0"/> </joint> %s </robot>"""


def test_results_and_other_commands_tell_of_missing_meshes(tmp_path):
    (tmp_path / "lost.urdf").write_text(HINGED % body("a", LOST).replace("<mass", '<origin xyz="0.5 0 0"/> <mass'))
    flexarm_program(tmp_path, "simulate", "lost.urdf", "--until", "0.01", "--output", "run.csv")
    for words in (("show", "lost.urdf", "--runs", "run.csv"), ("static", "lost.urdf", "--show")):
        assert flexarm_program(tmp_path, *words).count("warning: link 'a': the mesh") == 1
