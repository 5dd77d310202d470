"""Run `flexarm simulate --vtk`, and read its files by VTK. The variable FLEXARM_PROGRAM is the path of flexarm."""

import csv
import os
import subprocess
from xml.etree import ElementTree

import numpy
import pytest

vtk = pytest.importorskip("vtk", reason="Python's VTK is not installed (python3-vtk9, or python3-paraview)")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

PARTS = ("beams", "bodies", "lines", "wrenches")
HOSTILE = 'a<b>&"c"\'/../é'
ESCAPED = "a&lt;b&gt;&amp;&quot;c&quot;'/../é"

# A flexible arm falls. It carries a hand with shapes of all kinds, and a rigid beam.
ARM = """<robot name="arm &amp; &lt;hand&gt;">
  <link name="world"/>
  <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="%(name)s"/> <axis xyz="0 1 0"/> </joint>
  <link name="%(name)s"> <beam elements="3"> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <joint name="wrist" type="continuous"> <parent link="%(name)s"/> <child link="hand"/> <origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/> <dynamics damping="0.01"/> </joint>
  <link name="hand"> <inertial> <mass value="1"/>
    <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/> </inertial>
    <visual> <origin xyz="0.1 0 0" rpy="0.3 0.2 0.1"/> <geometry> <box size="0.1 0.2 0.3"/> </geometry>
      <material name="m"> <color rgba="1 0.5 0 0.2"/> </material> </visual>
    <visual> <origin xyz="0 0.5 0" rpy="1 0 0"/> <geometry> <cylinder radius="0.1" length="0.4"/> </geometry> </visual>
    <visual> <geometry> <sphere radius="0.2"/> </geometry> </visual>
    <visual> <geometry> <mesh filename="file://%(mesh)s" scale="0.1 0.1 0.1"/> </geometry> </visual>
    <visual> <geometry> <mesh filename="file:///nowhere/none.stl"/> </geometry> </visual>
  </link>
  <joint name="bolt" type="fixed"> <parent link="hand"/> <child link="rod"/> <origin xyz="0 0 0.1"/> </joint>
  <link name="rod"> <beam elements="0"> <centerline> <line to="0 0.5 0"/> </centerline> <circle radius="0.02"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <simulation> <integrator step="1e-3"/> <load link="hand" at="0 0 0.1" force="0 1 2" moment="0.1 0.2 0.3"/>
    <probe name="middle" link="%(name)s" at="0.5 0 0"/> <probe name="tip" link="hand" at="0 0 0"/>
    <probe name="end" link="rod" at="0 0.5 0"/> </simulation>
  <sensor name="cell" kind="wrench" link="hand"/>
</robot>"""

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"

def simulate(scene, *options):
    command = [os.environ["FLEXARM_PROGRAM"], "simulate", "--quiet", str(scene)] + [str(option) for option in options]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=999,
                          check=False)


def run(scene, folder, *options):
    result = simulate(scene, "--vtk", folder, *options)
    assert result.returncode == 0, result.stderr
    return result.stderr


def listed(path):
    """Return times, names of parts, files of a .pvd."""
    sets = ElementTree.parse(str(path)).getroot().findall("./Collection/DataSet")
    return [(float(entry.get("timestep")), entry.get("name"), entry.get("file")) for entry in sets]


def times_of(folder):
    entries = listed(folder / "run.pvd")
    assert [name for _, name, _ in entries] == list(PARTS) * (len(entries) // len(PARTS))
    return [when for when, name, _ in entries if name == "beams"]


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    assert reader.CanReadFile(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def part(folder, name, index):
    return read(folder / name / ("%s_%06d.vtp" % (name, index)))


def array(data, name):
    found = data.GetArray(name)
    assert found is not None, name
    return vtk_to_numpy(found)


def texts(data, name):
    found = data.GetFieldData().GetAbstractArray(name)
    return [found.GetValue(i) for i in range(found.GetNumberOfValues())]


def positions(data):
    return vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else numpy.empty((0, 3))


def rows_of(path):
    with open(str(path), encoding="utf-8") as lines:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


def line_of(data, cell):
    ids = data.GetCell(cell).GetPointIds()
    return numpy.array([ids.GetId(i) for i in range(ids.GetNumberOfIds())])


def run_of_arm(folder):
    """Run the arm. Return the folder for ParaView, the rows of the table beside it, the scene."""
    (folder / "tetrahedron.obj").write_text(TETRAHEDRON)
    scene = folder / "arm.urdf"
    scene.write_text(ARM % {"name": ESCAPED, "mesh": folder / "tetrahedron.obj"}, encoding="utf-8")
    run(scene, folder / "vtk", "--until", 0.5, "--output", folder / "arm.csv", "--columns",
        "time,frame/*,probe/*,joint/*,sensor/*")
    return folder / "vtk", rows_of(folder / "arm.csv"), scene
