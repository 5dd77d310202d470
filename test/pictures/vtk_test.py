"""Test what files for ParaView say of beams, bodies, springs and tendons, and wrenches."""

import math
import os

import numpy
import pytest

from vtk_reading import (HOSTILE, array, line_of, part, positions, rows_of, run, run_of_arm, texts, times_of, vtk,
                         vtk_to_numpy)

import flexarm

CANTILEVER = """<robot name="cantilever"> <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
  <link name="arm"> <beam elements="4"> <centerline> <line to="2 0 0"/> </centerline> <circle radius="0.01"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <simulation> <gravity xyz="0 0 0"/> <initial equilibrium="true"/>
    <load link="arm" at="2 0 0" force="0 0 %g"/> </simulation> </robot>"""


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    return run_of_arm(tmp_path_factory.mktemp("arm"))


# ---------------------------------------------------------------- beams


def test_beams_are_those_of_python(arm):
    folder, rows, path = arm
    scene = flexarm.read_scene(str(path))
    simulation = flexarm.Simulation(scene)
    times = times_of(folder)
    compared = 0
    for row in rows:
        while simulation.time < row["time"] - 1e-9:
            simulation.step()
        if row["time"] not in times:
            continue
        data = part(folder, "beams", times.index(row["time"]))
        values = data.GetPointData()
        links = array(data.GetCellData(), "link")
        assert [texts(data, "link_names")[link] for link in links] == [HOSTILE, "rod"]
        line = line_of(data, 0)
        between = (len(line) - 1) // 6 - 1  # three elements of second order
        points = simulation.beam_points(HOSTILE, between)
        assert len(points) == len(line) >= 30
        assert numpy.array_equal(positions(data)[line], points["pose"][:, :3])
        for name, numbers in (("arc_length", points["arc_length"]), ("strain", points["strain"][:, :3]),
                              ("curvature", points["strain"][:, 3:]), ("force", points["resultant"][:, :3]),
                              ("moment", points["resultant"][:, 3:])):
            assert numpy.array_equal(array(values, name)[line], numbers), name
        force, moment = array(values, "force")[line], array(values, "moment")[line]
        axes = numpy.stack([array(values, "section_" + axis)[line] for axis in "xyz"], axis=2)
        assert numpy.allclose(axes, rotations(points["pose"][:, 3:]), rtol=0, atol=1e-14)
        for name, numbers in (("force", force), ("moment", moment)):
            in_world = array(values, name + "_in_world")[line]
            assert numpy.allclose(in_world, numpy.einsum("nij,nj->ni", axes, numbers), rtol=1e-13, atol=1e-13)
        assert (array(values, "radius")[line] == 0.01).all()
        assert values.GetScalars().GetName() == "edge_strain"
        # On the edge of a circle axial strain and bending add up; shear counts, too (von Mises).
        strain, curvature = array(values, "strain")[line], array(values, "curvature")[line]
        edge = array(values, "edge_strain")[line]
        bending = numpy.abs(strain[:, 0]) + 0.01 * numpy.hypot(curvature[:, 1], curvature[:, 2])
        assert (edge >= bending * (1 - 1e-12)).all()
        rigid = line_of(data, 1)
        assert numpy.isnan(array(values, "force")[rigid]).all()
        assert (array(values, "edge_strain")[rigid] == 0).all()
        compared += 1
    assert compared == len(times)


def rotations(quaternions):
    x, y, z, w = quaternions.T
    return numpy.stack([
        numpy.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=1),
        numpy.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=1),
        numpy.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)], axis=1)


def test_velocities_are_those_of_probes(arm):
    folder, rows, _ = arm
    at_time = {row["time"]: row for row in rows}
    fastest = 0
    for index, when in enumerate(times_of(folder)):
        data = part(folder, "beams", index)
        velocities, row = array(data.GetPointData(), "velocity"), at_time[when]
        arc, line, rod = array(data.GetPointData(), "arc_length"), line_of(data, 0), line_of(data, 1)
        for probe, point in (("middle", line[numpy.argmin(abs(arc[line] - 0.5))]), ("tip", line[-1]), ("end", rod[-1])):
            place = [row["probe/%s/%s" % (probe, axis)] for axis in "xyz"]
            velocity = [row["probe/%s/v%s" % (probe, axis)] for axis in "xyz"]
            assert numpy.allclose(positions(data)[point], place, rtol=0, atol=1e-13), probe
            assert numpy.allclose(velocities[point], velocity, rtol=1e-12, atol=1e-12), probe
            fastest = max(fastest, numpy.linalg.norm(velocity))
    assert fastest > 1


def test_velocities_between_nodes_are_derivatives(arm, tmp_path):
    run(arm[2], tmp_path, "--until", 0.3, "--vtk-rate", 1e9)
    before, now, after = (part(tmp_path, "beams", k) for k in (199, 200, 201))
    differences = (positions(after) - positions(before)) / 2e-3
    velocities = array(now.GetPointData(), "velocity")
    assert numpy.abs(velocities).max() > 1
    assert numpy.abs(velocities - differences).max() < 2e-3 * numpy.abs(velocities).max()


@pytest.mark.parametrize("force", [1e-4, 3])
def test_bending_moment_of_a_cantilever(tmp_path, force):
    scene = tmp_path / "cantilever.urdf"
    scene.write_text(CANTILEVER % force)
    run(scene, tmp_path / "vtk", "--until", 0)
    data = part(tmp_path / "vtk", "beams", 0)
    values, x = data.GetPointData(), positions(data)[:, 0]
    moment = array(values, "moment_in_world")
    # M = F (L - x) about -y, with the place of the bent tip.
    assert numpy.allclose(moment[:, 1], -force * (x[-1] - x), rtol=0, atol=1e-5 * force)
    assert numpy.abs(moment[:, [0, 2]]).max() < 1e-9 * force
    assert numpy.allclose(array(values, "force_in_world"), [0, 0, force], rtol=0, atol=1e-3 * force)
    if force < 1e-3:  # it hardly bends
        assert numpy.allclose(moment[:, 1], -force * (2 - array(values, "arc_length")), rtol=0, atol=1e-12 * force)
        stiffness = 70e9 * math.pi * 0.01**4 / 4
        assert positions(data)[-1, 2] == pytest.approx(force * 8 / (3 * stiffness), rel=1e-4)  # and shear


# ---------------------------------------------------------------- bodies


def volume_and_area(data, cells):
    """Return what VTK computes of some triangles."""
    triangles, points = vtk.vtkCellArray(), vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.DeepCopy(data.GetPoints())
    for cell in cells:
        triangles.InsertNextCell(data.GetCell(int(cell)))
    closed = vtk.vtkPolyData()
    closed.SetPoints(points)
    closed.SetPolys(triangles)
    mass = vtk.vtkMassProperties()
    mass.SetInputData(closed)
    return mass.GetVolume(), mass.GetSurfaceArea()


def sphere_of_polygons(radius, sides, bands):
    """Return volume and area of a polyhedron on a sphere."""
    polygon = sides / 2 * math.sin(2 * math.pi / sides)
    rings = [(radius * math.cos(a), radius * math.sin(a))
             for a in (math.pi * (k / bands - 0.5) for k in range(bands + 1))]
    volume = area = 0
    for (inner, low), (outer, high) in zip(rings, rings[1:]):
        volume += (high - low) / 3 * polygon * (inner**2 + inner * outer + outer**2)
        slant = math.hypot(high - low, (outer - inner) * math.cos(math.pi / sides))
        area += sides * math.sin(math.pi / sides) * (inner + outer) * slant
    return volume, area


def test_shapes_have_their_volumes_and_areas(arm):
    folder = arm[0]
    polygon = 16 * math.sin(2 * math.pi / 32) * 0.1**2
    side = 2 * 32 * math.sin(math.pi / 32) * 0.1 * 0.4
    expected = [(12, (0.1 * 0.2 * 0.3, 2 * (0.1 * 0.2 + 0.2 * 0.3 + 0.3 * 0.1))),
                (4 * 32, (polygon * 0.4, side + 2 * polygon)),
                (2 * 32 * 20, sphere_of_polygons(0.2, 32, 20)),
                (4, (1e-3 / 6, 1e-2 * (3 / 2 + math.sqrt(3) / 2)))]
    for index in (0, 9):
        data = part(folder, "bodies", index)
        first = data.GetNumberOfLines()
        assert data.GetNumberOfPolys() == sum(count for count, _ in expected)
        for count, (volume, area) in expected:
            found = volume_and_area(data, range(first, first + count))
            assert found == pytest.approx((volume, area), rel=2e-5)  # numbers of 32 bits
            first += count


def test_bodies_move_with_their_links(arm):
    folder, rows, _ = arm
    at_time = {row["time"]: row for row in rows}
    for index, when in enumerate(times_of(folder)):
        data, row = part(folder, "bodies", index), at_time[when]
        pose = numpy.array([row["frame/hand/" + name] for name in ("x", "y", "z", "qx", "qy", "qz", "qw")])
        rotation = rotations(pose[None, 3:])[0]
        lines = data.GetNumberOfLines()
        box = numpy.unique(numpy.concatenate([line_of(data, lines + k) for k in range(12)]))
        in_hand = (positions(data)[box] - pose[:3]) @ rotation
        roll, pitch, yaw = 0.3, 0.2, 0.1
        half = [math.sin(a / 2) for a in (roll, pitch, yaw)] + [math.cos(a / 2) for a in (roll, pitch, yaw)]
        sr, sp, sy, cr, cp, cy = half
        turn = rotations(numpy.array([[sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                                       cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy]]))[0]
        in_box = (in_hand - [0.1, 0, 0]) @ turn
        assert numpy.allclose(abs(in_box), [0.05, 0.1, 0.15], rtol=0, atol=1e-6)
        # Normals point outwards.
        normals = array(data.GetPointData(), "Normals")[box] @ rotation @ turn
        assert (numpy.einsum("ni,ni->n", normals, in_box) > 0.04).all()
        names = texts(data, "link_names")
        assert {names[k] for k in array(data.GetCellData(), "link")[lines:]} == {"hand"}
        colors = array(data.GetCellData(), "color")[lines:]
        assert colors[0].tolist() == [255, 128, 0, 51]
        assert colors[20].tolist() == [191, 191, 191, 255]


def test_triangles_face_outwards(arm):
    data = part(arm[0], "bodies", 0)
    x, normals = positions(data).astype(float), vtk_to_numpy(data.GetPointData().GetNormals())
    for cell in range(data.GetNumberOfLines(), data.GetNumberOfCells()):
        a, b, c = line_of(data, cell)
        face = numpy.cross(x[b] - x[a], x[c] - x[a])
        assert (normals[[a, b, c]] @ face >= -1e-12).all(), cell


def test_meshes_that_cannot_be_read_are_warnings(arm, tmp_path):
    printed = run(arm[2], tmp_path, "--until", 0.01)
    assert printed.count("link 'hand': the mesh 'file:///nowhere/none.stl' is not shown") == 1, printed


# ---------------------------------------------------------------- springs and tendons


def test_tendons_are_lines_with_their_tension(tmp_path):
    scene = os.path.join(os.path.dirname(__file__), "..", "..", "config", "examples", "cable_robot.urdf")
    run(scene, tmp_path / "vtk", "--until", 0.5, "--output", tmp_path / "rows.csv")
    at_time = {row["time"]: row for row in rows_of(tmp_path / "rows.csv")}
    largest = 0
    for index, when in enumerate(times_of(tmp_path / "vtk")):
        data, row = part(tmp_path / "vtk", "lines", index), at_time[when]
        names = texts(data, "line_names")
        assert len(names) == data.GetNumberOfLines() == 4 and set(texts(data, "line_kinds")) == {"tendon"}
        assert array(data.GetCellData(), "line").tolist() == [0, 1, 2, 3]
        for cell, name in enumerate(names):
            points = positions(data)[line_of(data, cell)]
            length = numpy.linalg.norm(numpy.diff(points, axis=0), axis=1).sum()
            # Straight ropes; what the drums have wound up is not in the picture.
            assert len(points) > 2 or length == pytest.approx(row["tendon/%s/length" % name], rel=1e-12)
            for quantity in ("length", "tension"):
                shown = array(data.GetCellData(), quantity)[cell]
                assert shown == pytest.approx(row["tendon/%s/%s" % (name, quantity)], rel=1e-9, abs=1e-9), quantity
            largest = max(largest, array(data.GetCellData(), "tension")[cell])
    assert largest > 1


SPRING = """<robot name="spring"> <link name="world"/>
  <joint name="rail" type="prismatic"> <parent link="world"/> <child link="cart"/> <axis xyz="0 0 1"/>
    <limit lower="-9" upper="9"/> </joint>
  <link name="cart"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial>
  </link>
  <spring from="world" from_at="0 0 2" to="cart" to_at="0 0 0.5" stiffness="100" rest_length="1"/> </robot>"""


def test_springs_between_points_are_lines(tmp_path):
    (tmp_path / "spring.urdf").write_text(SPRING)
    run(tmp_path / "spring.urdf", tmp_path / "vtk", "--until", 0)
    data = part(tmp_path / "vtk", "lines", 0)
    assert positions(data)[line_of(data, 0)].tolist() == [[0, 0, 2], [0, 0, 0.5]]
    assert texts(data, "line_kinds") == ["spring"] and texts(data, "line_names") == [""]
    assert array(data.GetCellData(), "length")[0] == pytest.approx(1.5, rel=1e-12)
    assert array(data.GetCellData(), "tension")[0] == pytest.approx(100 * (1.5 - 1), rel=1e-12)


# ---------------------------------------------------------------- wrenches


def test_wrenches_are_loads_efforts_and_reactions(arm):
    folder, rows, _ = arm
    at_time = {row["time"]: row for row in rows}
    for index, when in enumerate(times_of(folder)):
        data, row = part(folder, "wrenches", index), at_time[when]
        assert texts(data, "kind_names") == ["effort", "load", "reaction", "contact"]
        values = data.GetPointData()
        kinds = array(values, "kind").tolist()
        assert kinds == [0, 0, 1, 2]
        assert data.GetNumberOfVerts() == 4
        assert array(values, "force")[2].tolist() == [0, 1, 2]
        assert array(values, "moment")[2].tolist() == [0.1, 0.2, 0.3]
        assert numpy.linalg.norm(array(values, "moment")[1]) == pytest.approx(abs(row["joint/wrist/effort"]), abs=1e-12)
        hand = [row["frame/hand/" + axis] for axis in "xyz"]
        assert numpy.allclose(positions(data)[3], hand, rtol=0, atol=1e-12)


def test_contacts_come_and_go(tmp_path):
    scene = os.path.join(os.path.dirname(__file__), "..", "..", "config", "examples", "falling_boxes.urdf")
    run(scene, tmp_path, "--until", 1)
    counts = []
    for index in range(len(times_of(tmp_path))):
        data = part(tmp_path, "wrenches", index)
        counts.append(sum(array(data.GetPointData(), "kind") == 3) if data.GetNumberOfPoints() else 0)
        assert part(tmp_path, "beams", index).GetNumberOfPoints() == 0  # there is none, and VTK reads the file
    assert max(counts) > 10 and len(set(counts)) > 3, counts
