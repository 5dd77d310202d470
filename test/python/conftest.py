"""Fixtures and helpers of the tests of the Python package. The variable FLEXARM_PROGRAM is the path of the command-line
program."""

import os
import subprocess

import numpy
import pytest

import flexarm

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def hinged_rod(axis, centre, inertia, simulation="", mass="1", parameters="", dynamics=""):
    """Return the scene of a rod on a hinge: axis, centre of mass [m], three moments of inertia [kg m^2], mass [kg].

    simulation: content of <simulation>. parameters: lines before all links. dynamics: elements of the joint.
    """
    return """
<robot name="rod">
%s  <link name="world"/>
  <joint name="hinge" type="continuous">
    <parent link="world"/> <child link="rod"/> <axis xyz="%s"/> %s
  </joint>
  <link name="rod">
    <inertial>
      <origin xyz="%s"/> <mass value="%s"/>
      <inertia ixx="%s" ixy="0" ixz="0" iyy="%s" iyz="0" izz="%s"/>
    </inertial>
  </link>
  <simulation> %s </simulation>
</robot>
""" % (parameters, axis, dynamics, centre, mass, *inertia, simulation)


# From 1 s on, steps of this scene fail: they may not be halved, and Newton's method gets too few iterations.
FAILING = hinged_rod("0 1 0", "0.5 0 0", (1e-4, 0.1, 0.1), """
    <integrator step="0.1" max_iterations="4" max_halvings="0"/>
    <effort joint="hinge" history="t &lt; 0.95 ? 0 : 1e4"/>""")


def example(name):
    return os.path.join(ROOT, "config", "examples", name + ".urdf")


@pytest.fixture
def pendulum():
    return flexarm.Simulation(flexarm.read_scene(example("rigid_double_pendulum")))


@pytest.fixture
def arm():
    return flexarm.Simulation(flexarm.read_scene(example("flexible_two_link_arm")))


@pytest.fixture
def failing_scene(tmp_path):
    path = tmp_path / "failing.urdf"
    path.write_text(FAILING)
    return path


def command_line(*arguments, folder=None):
    """Run `flexarm ...`. Return its exit status and its error output."""
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], *map(str, arguments)], cwd=folder, check=False,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    return result.returncode, result.stderr


def read_csv(path):
    """Return names of columns, and rows, bit for bit."""
    with open(path, encoding="utf-8") as file:
        names = file.readline().rstrip("\n").split(",")
        return names, numpy.array([[float(field) for field in line.split(",")] for line in file])


def bits(array):
    """Return bytes for comparisons: zeros of different signs differ, and NaN equals itself."""
    return numpy.ascontiguousarray(array).tobytes()
