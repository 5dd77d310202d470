"""Tests pages of the program and of the Python package: what they contain is what simulations compute."""

import os
import re
import shutil
import subprocess

import numpy as np
import pytest

flexarm = pytest.importorskip("flexarm")

from page_reader import read_page, runs_of  # noqa: E402

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
ARM = os.path.join(ROOT, "config", "examples", "flexible_two_link_arm.urdf")
HOSTILE = '</script><script>alert("1")</script> "quoted" \\ ünïcode \u202e'


def flexarm_program(folder, *words, status=0):
    """Run the program in a folder. Return what it prints, errors included."""
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], *words], cwd=folder, check=False, timeout=1000,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    printed = result.stdout.decode()
    assert result.returncode == status, printed
    return printed


def half_step(values):
    """Return the largest error of values that a page has, by their range, with round-off."""
    return (0.5 / 65534 + 1e-12) * (np.nanmax(values) - np.nanmin(values)) + 1e-12


def expect_equal(shown, expected):
    assert shown.shape == expected.shape
    for index in np.ndindex(expected.shape[1:]):
        at = (slice(None), *index)
        assert shown[at] == pytest.approx(expected[at], abs=half_step(expected[at]), nan_ok=True), index


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """Return a run in a page, and the same run in Python: rows, and sections of the forearm at its nodes."""
    folder = tmp_path_factory.mktemp("show")
    printed = flexarm_program(folder, "show", ARM, "--until", "1", "--step", "0.01", "--rate", "50",
                              "--output", "a.html")
    assert "a.html shows it in a browser" in printed
    simulation = flexarm.Simulation(ARM, step=0.01)
    rows, sections = [simulation.row()], [simulation.beam_points("forearm")]
    for _ in range(50):
        simulation.run(2)
        rows.append(simulation.row())
        sections.append(simulation.beam_points("forearm"))
    names = [name for name, _ in simulation.columns()]
    run, = read_page(folder / "a.html")
    return run, dict(zip(names, np.transpose(rows))), np.array(sections), simulation


def test_instants_are_at_the_rate(shown):
    run, columns, _, _ = shown
    assert run.frames == 51
    assert run.times == pytest.approx(columns["time"], abs=1e-12)


def test_links_are_where_the_simulation_has_them(shown):
    run, columns, _, simulation = shown
    for name in simulation.link_names:
        poses = run.link(name)
        expect_equal(poses[:, :3], np.transpose([columns["frame/%s/%s" % (name, axis)] for axis in "xyz"]))
        quaternions = np.transpose([columns["frame/%s/q%s" % (name, axis)] for axis in "xyzw"])
        # Signs of a page's quaternions change continuously.
        assert (np.sum(poses[1:, 3:] * poses[:-1, 3:], axis=1) > 0).all()
        assert abs(np.sum(poses[:, 3:] * quaternions, axis=1)) == pytest.approx(1, abs=4 / 65534)


def test_beams_are_bent_as_the_simulation_has_them(shown):
    run, _, sections, simulation = shown
    links = [link["name"] for link in run.picture["links"]]
    index, = (i for i, beam in enumerate(run.picture["beams"]) if links[beam["link"]] == "forearm")
    arcs = np.array(run.picture["beams"][index]["arc_lengths"])
    nodes = [int(np.argmin(abs(arcs - arc))) for arc in sections[0]["arc_length"]]
    assert arcs[nodes] == pytest.approx(sections[0]["arc_length"], abs=1e-12)
    beam = run.beams[index][:, nodes]
    expect_equal(beam[:, :, :3], sections["pose"][:, :, :3])
    expect_equal(beam[:, :, 7:13], sections["strain"])
    expect_equal(beam[:, :, 13:], sections["resultant"])


def test_columns_are_those_of_results(shown):
    run, columns, _, _ = shown
    for name, values in columns.items():
        if not name.startswith("solver/"):  # counts since the last row
            expect_equal(run.columns[name], values)


def test_joints_know_their_columns(shown):
    run, _, _, _ = shown
    names = [column["name"] for column in run.picture["columns"]]
    for joint in run.picture["joints"]:
        expected = [] if joint["kind"] == "fixed" else ["position", "velocity", "effort"]
        assert [names[i] for i in joint["columns"]] == ["joint/%s/%s" % (joint["name"], what) for what in expected]


def body(name, shape):
    return """<link name="%s"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
      </inertial> %s </link>""" % (name, shape)


def scene_of(*links, extra=""):
    joints = "".join('<joint name="j%d" type="floating"> <parent link="world"/> <child link="%s"/> </joint>'
                     % (i, name) for i, (name, _) in enumerate(links))
    return '<robot name="bodies"> %s <link name="world"/> %s %s </robot>' % (
        extra, "".join(body(*link) for link in links), joints)


def visual(geometry, rest=""):
    return '<visual> <origin xyz="1 2 3"/> <geometry> %s </geometry> %s </visual>' % (geometry, rest)


def still(scene):
    run, = runs_of(flexarm.show(flexarm.Simulation(flexarm.read_scene_text(scene))).text)
    return run


def test_shapes_and_colours_of_rigid_links():
    green = '<material name="green"> <color rgba="0 1 0 0.5"/> </material>'
    run = still(scene_of(("a", visual('<box size="1 2 3"/>', '<material name="green"/>')),
                         ("b", visual('<cylinder radius="1" length="2"/>',
                                      '<material name="own"> <color rgba="1 0 0 1"/> </material>')),
                         ("c", visual('<sphere radius="2"/>')), extra=green))
    shapes = [link["shapes"][0] for link in run.picture["links"][1:]]
    assert [shape["kind"] for shape in shapes] == ["box", "cylinder", "sphere"]
    assert [shape["color"] for shape in shapes] == [[0, 1, 0, 0.5], [1, 0, 0, 1], None]
    assert all(shape["pose"] == [1, 2, 3, 0, 0, 0, 1] for shape in shapes)
    assert shapes[0]["size"] == [1, 2, 3] and shapes[1]["radius"] == 1 and shapes[1]["length"] == 2


def test_a_mass_without_shape_is_a_ball(tmp_path):
    """A ball of 5 kg and 0.1 m, by its inertia; a link with a shape or without mass has none."""
    inertia = 0.4 * 5 * 0.1**2
    run = still("""<robot name="bob"> <link name="world"/> <link name="rod"/> <link name="bob"> <inertial>
        <origin xyz="0 0 -1.5"/> <mass value="5"/> <inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/>
        </inertial> </link> {1}
        <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
        <joint name="weld" type="fixed"> <parent link="rod"/> <child link="bob"/> <origin xyz="0 0 -0.5"/> </joint>
        <joint name="free" type="floating"> <parent link="world"/> <child link="box"/> </joint>
        </robot>""".format(inertia, body("box", visual('<box size="1 1 1"/>'))))
    links = {link["name"]: link for link in run.picture["links"]}
    assert links["bob"]["mass"] == {"at": [0, 0, -1.5], "radius": pytest.approx(0.1, rel=1e-12)}
    assert links["bob"]["stick"] == [[0, 0, -1.5]]
    assert links["rod"]["stick"] == [[0, 0, -0.5]]
    assert [links[name]["mass"] for name in ("world", "rod", "box")] == [None] * 3


def test_extent_is_of_what_moves_during_the_run():
    """A ball is thrown along a parabola, 4 m far and 1.27 m high, beside a house and a wall."""
    def fixed(name, place, size):
        return """<link name="%s"> <visual> <geometry> <box size="%s"/> </geometry> </visual> </link>
            <joint name="weld_%s" type="fixed"> <parent link="world"/> <child link="%s"/> <origin xyz="%s"/>
            </joint>""" % (name, size, name, name, place)
    scene = """<robot name="throw"> <link name="world"/> %s %s %s
        <joint name="free" type="floating"> <parent link="world"/> <child link="ball"/> </joint>
        <ground name="floor"/> </robot>""" % (
            body("ball", '<visual> <geometry> <sphere radius="0.1"/> </geometry> </visual>'),
            fixed("house", "60 0 5", "10 10 10"), fixed("post", "2 0.5 0.5", "0.1 0.1 1"))
    simulation = flexarm.Simulation(flexarm.read_scene_text(scene))
    simulation.set_joint_state(velocities={"free/x": 4, "free/z": 5})
    recording = flexarm.Recording(simulation)
    recording.run(until=1.0)
    run, = runs_of(flexarm.show(recording).text)
    extent, (floor,) = run.picture["extent"], run.picture["floors"]
    low, high = (np.array(extent["center"]) + sign * np.array(extent["half"]) for sign in (-1, 1))
    top = np.max(run.link("ball")[:, 2])
    assert low == pytest.approx([-0.1, -0.1, -0.1], abs=2e-3)
    assert high == pytest.approx([4.1, 0.55, top + 0.1], abs=2e-3)
    assert np.linalg.norm(extent["half"]) == pytest.approx(extent["radius"], rel=0.1)
    assert floor["ground"] and floor["pose"][2:] == [0, 0, 0, 0, 1]
    assert 4.1 < floor["size"][0] < 7 and 1 < floor["size"][1] < 4


def test_meshes_are_in_the_page_and_missing_ones_are_told(tmp_path):
    (tmp_path / "wedge.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    mesh = '<mesh filename="file://%s"/>'
    run = still(scene_of(("a", visual(mesh % (tmp_path / "wedge.obj"))), ("b", visual(mesh % (tmp_path / "none.stl")))))
    (places, triangles), = run.meshes
    corners = places[triangles]
    volume = np.linalg.det(corners).sum() / 6
    assert volume == pytest.approx(1 / 6, abs=1e-4)  # coordinates have 16 bits
    assert [len(link["shapes"]) for link in run.picture["links"]] == [0, 1, 1]
    note, = run.picture["notes"]
    assert "none.stl" in note and "link 'b'" in note


def test_names_of_a_scene_are_no_elements_of_the_page():
    escaped = HOSTILE.replace("<", "&lt;").replace('"', "&quot;")
    run = still(scene_of((escaped, visual('<box size="1 1 1"/>'))))
    assert run.picture["links"][1]["name"] == HOSTILE


def test_contacts_and_loads_are_arrows():
    simulation = flexarm.Simulation(os.path.join(ROOT, "config", "examples", "falling_boxes.urdf"))
    recording = flexarm.Recording(simulation, rate=20)
    recording.run(1.0)
    run, = runs_of(flexarm.show(recording).text)
    contacts = run.arrows["contact"]
    now = [contact for contact in simulation.contacts if np.linalg.norm(contact.force) > 0]
    shown_now = [arrow for arrow in contacts[-1] if np.linalg.norm(arrow[3:6]) > half_step(contacts[:, :, 3:6])]
    assert contacts.shape[1] >= len(now) == len(shown_now) > 0
    for contact, arrow in zip(now, shown_now):
        assert arrow[:3] == pytest.approx(contact.position, abs=half_step(contacts[:, :, :3]))
        assert arrow[3:6] == pytest.approx(contact.force, abs=half_step(contacts[:, :, 3:6]))


def test_long_runs_have_fewer_instants():
    simulation = flexarm.Simulation(os.path.join(ROOT, "config", "examples", "rigid_double_pendulum.urdf"), step=0.01)
    recording = flexarm.Recording(simulation, rate=100)
    recording.run(210.0)
    run, = runs_of(flexarm.show(recording).text)
    assert 10000 <= run.frames <= 20000 and run.times[-1] == pytest.approx(210)
    assert np.diff(run.times)[:-1] == pytest.approx(0.02, abs=1e-9)


def test_modes_swing_about_the_configuration(tmp_path):
    flexarm_program(tmp_path, "modes", os.path.join(ROOT, "config", "examples", "cantilever.urdf"), "--count", "2",
                    "--show", "--page", "modes.html")
    run, = read_page(tmp_path / "modes.html")
    simulation = flexarm.Simulation(os.path.join(ROOT, "config", "examples", "cantilever.urdf"))
    simulation.solve_static()
    frequencies = [mode.frequency for mode in simulation.natural_modes(2)]
    clips = run.picture["clips"]
    assert [clip["name"] for clip in clips] == ["mode %d: %.4g Hz" % pair for pair in enumerate(frequencies, 1)]
    assert run.picture["still"] == 0 and (np.diff(run.times) >= 0).all()
    tip, rest = run.beams[0][:, -1, :3], run.beams[0][0, -1, :3]
    for clip in clips:
        swing = tip[clip["first"]:clip["first"] + clip["count"]] - rest
        half = (clip["count"] - 1) // 2
        step = half_step(tip)
        assert swing[half] == pytest.approx(-swing[0], abs=3 * step)  # half a period later
        assert swing[-1] == pytest.approx(swing[0], abs=3 * step)
        assert 0.05 < abs(swing).max() / run.picture["extent"]["radius"] < 0.11


def test_an_equilibrium_is_beside_the_start(tmp_path):
    flexarm_program(tmp_path, "static", os.path.join(ROOT, "config", "examples", "cantilever.urdf"), "--show")
    run, = read_page(tmp_path / "cantilever_equilibrium.html")
    simulation = flexarm.Simulation(os.path.join(ROOT, "config", "examples", "cantilever.urdf"))
    start = simulation.beam_points(simulation.flexible_links[0])["pose"][-1, :3]
    simulation.solve_static()
    end = simulation.beam_points(simulation.flexible_links[0])["pose"][-1, :3]
    tip = run.beams[0][:, -1, :3]
    assert run.picture["still"] == 0
    for axis in range(3):
        assert tip[:2, axis] == pytest.approx([start[axis], end[axis]], abs=half_step(tip[:, axis]))
    # It sags by 2 mm per metre, which is hardly seen, so the page has it enlarged, too.
    first, enlarged = run.picture["clips"]
    assert first == {"name": "equilibrium", "first": 1, "count": 1}
    assert enlarged == {"name": "deflections × 20", "first": 2, "count": 1} and run.frames == 3
    assert run.times[2] > run.times[1]  # so that programs can choose it by its time
    assert (tip[2] - start)[2] == pytest.approx(20 * (end - start)[2], abs=2 * half_step(tip[:, 2]))
    assert run.beams[0][2, :, 7:] == pytest.approx(run.beams[0][1, :, 7:], abs=1e-12)
    assert run.columns["energy/strain"][2] == run.columns["energy/strain"][1] > 0


@pytest.mark.parametrize("name", ["run.csv", "run.h5"])
def test_results_are_shown_again(tmp_path, name):
    flexarm_program(tmp_path, "simulate", ARM, "--until", "0.5", "--step", "0.01", "--columns", "*", "--output", name)
    flexarm_program(tmp_path, "show", ARM, "--until", "0.5", "--step", "0.01", "--rate", "100", "--output", "a.html")
    flexarm_program(tmp_path, "show", ARM, "--runs", name, "--rate", "100", "--output", "b.html")
    (direct,), (again,) = read_page(tmp_path / "a.html"), read_page(tmp_path / "b.html")
    assert again.picture["notes"] == [] and again.frames == direct.frames
    assert again.link("payload")[:, :3] == pytest.approx(direct.link("payload")[:, :3], abs=1e-6)
    assert again.beams[1][:, -1] == pytest.approx(direct.beams[1][:, -1], rel=1e-6, abs=half_step(direct.beams[1]))


def test_results_with_frames_only_are_bent_to_their_ends(tmp_path):
    flexarm_program(tmp_path, "simulate", ARM, "--until", "0.5", "--step", "0.01", "--output", "run.csv")
    flexarm_program(tmp_path, "show", ARM, "--runs", "run.csv", "--output", "b.html")
    run, = read_page(tmp_path / "b.html")
    assert len(run.picture["notes"]) == 2 and "--columns '*'" in run.picture["notes"][0]
    # The payload is fixed at the forearm's end.
    expect = run.link("payload")[:, :3]
    assert run.beams[1][:, -1, :3] == pytest.approx(expect, abs=half_step(run.beams[1][:, :, :3]) + half_step(expect))


def test_results_with_joints_only_are_where_joints_put_them(tmp_path):
    scene = os.path.join(ROOT, "config", "examples", "rigid_double_pendulum.urdf")
    for name, columns in (("joints.csv", "joint/*"), ("all.csv", "*")):
        flexarm_program(tmp_path, "simulate", scene, "--until", "0.5", "--columns", columns, "--output", name)
    flexarm_program(tmp_path, "show", scene, "--runs", "joints.csv", "all.csv", "--output", "b.html")
    by_joints, by_frames = read_page(tmp_path / "b.html")
    assert "positions of joints" in by_joints.picture["notes"][-1]
    expect = by_frames.link("forearm")[:, :3]
    assert by_joints.link("forearm")[:, :3] == pytest.approx(expect, abs=2 * half_step(expect))


def test_results_without_any_place_are_plots_beside_the_arm_at_its_start(tmp_path):
    (tmp_path / "energies.csv").write_text("time,energy/total\n0,1\n0.5,3\n1,2\n")
    printed = flexarm_program(tmp_path, "show", ARM, "--runs", "energies.csv", "--output", "a.html")
    run, = read_page(tmp_path / "a.html")
    assert "no column places a link" in run.picture["notes"][-1] and run.picture["notes"][-1] in printed
    assert run.columns["energy/total"] == pytest.approx([1, 3, 2], abs=1e-4)
    start = flexarm.Simulation(ARM)
    for name, pose in zip(start.link_names, start.link_poses):
        assert run.link(name)[-1] == pytest.approx(pose, abs=1e-12)


def test_errors_say_what_is_wrong(tmp_path):
    assert "NAME.html" in flexarm_program(tmp_path, "show", ARM, "--output", "run.mp4", status=2)
    (tmp_path / "empty.csv").write_text("")
    assert "expected columns" in flexarm_program(tmp_path, "show", ARM, "--runs", "empty.csv", status=2)
    assert "cannot write" in flexarm_program(tmp_path, "show", ARM, "--output", "none/run.html", status=2)
    assert "--show" in flexarm_program(tmp_path, "modes", ARM, "--page", "run.html", status=2)
    simulation = flexarm.Simulation(ARM)
    with pytest.raises(ValueError, match="rate"):
        flexarm.Recording(simulation, rate=0)
    with pytest.raises(ValueError, match="scene"):
        flexarm.show(flexarm.Run(["time"], ["s"], [[0.0]]))


def test_a_run_that_fails_is_shown_until_then(tmp_path):
    scene = """<robot name="rod"> <link name="world"/> <joint name="hinge" type="continuous"> <parent link="world"/>
      <child link="rod"/> <axis xyz="0 1 0"/> </joint> %s <simulation> <integrator step="0.1" max_iterations="4"
      max_halvings="0"/> <effort joint="hinge" history="t &lt; 0.95 ? 0 : 1e4"/> </simulation> </robot>"""
    (tmp_path / "failing.urdf").write_text(scene % body("rod", ""))
    printed = flexarm_program(tmp_path, "show", "failing.urdf", "--until", "2", status=1)
    run, = read_page(tmp_path / "failing.html")
    assert "simulation failed" in printed and run.times[-1] == pytest.approx(0.9)


def test_a_notebook_shows_a_page():
    page = flexarm.show(flexarm.Simulation(ARM), height=400)
    shown_there = page._repr_html_()
    assert shown_there.startswith("<iframe srcdoc=") and "height: 400px" in shown_there
    assert "<script" not in shown_there  # is escaped


def test_commands_move_joints(tmp_path):
    (tmp_path / "commands.yaml").write_text(
        "period: 1\ncommands:\n  - {time: 0, names: [shoulder], efforts: [1], duration: 1}\n")
    scene = os.path.join(ROOT, "config", "examples", "rigid_double_pendulum.urdf")
    flexarm_program(tmp_path, "show", scene, "--commands", "commands.yaml", "--until", "0.5", "--output", "a.html")
    run, = read_page(tmp_path / "a.html")
    assert run.columns["joint/shoulder/effort"][-1] == pytest.approx(1)


def test_the_page_of_the_documentation_is_true(tmp_path, monkeypatch):
    """Run the commands and the example of docs/show.md, in this order, except for that of the demo."""
    with open(os.path.join(ROOT, "docs", "show.md"), encoding="utf-8") as file:
        text = file.read()
    shutil.copy(ARM, tmp_path / "arm.urdf")
    commands = [command for command in re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
                if "demo_arm" not in command]
    assert len(commands) == 2
    path = os.path.dirname(os.environ["FLEXARM_PROGRAM"]) + ":" + os.environ["PATH"]
    subprocess.run(["bash", "-euc", "\n".join(commands)], cwd=tmp_path, check=True, env={**os.environ, "PATH": path},
                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    names = ["arm.html", "arm_modes.html", "equilibrium.html", "fine.html", "state.html", "further.html"]
    assert all(read_page(tmp_path / name) for name in names)
    program, = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "docs/show.md", "exec"), {"__name__": "example"})
    run, = read_page("arm.html")
    assert run.times[-1] == pytest.approx(2)


def test_a_tuned_scene_is_beside_the_given_one(tmp_path):
    flexarm_program(tmp_path, "tune", os.path.join(ROOT, "config", "examples", "rigid_double_pendulum.urdf"),
                    "--accuracy", "1e-2", "--until", "0.5", "--show", "--page", "both.html")
    before, after = read_page(tmp_path / "both.html")
    assert after.picture["title"] == before.picture["title"] + ", tuned"
    scale = np.ptp(before.link("forearm")[:, :3], axis=0).max()
    assert after.link("forearm")[-1, :3] == pytest.approx(before.link("forearm")[-1, :3], abs=2e-2 * scale)


def test_runs_of_a_sweep_are_side_by_side(tmp_path, monkeypatch):
    (tmp_path / "plan.yaml").write_text("design: {kind: grid, parameters: {payload: [0.5, 1.0, 1.5]}}\n"
                                        "until: 0.2\nmeasures: {energy: {maximum: energy/total}}\n")
    scene = os.path.join(ROOT, "config", "sweep", "slewing_arm.urdf")
    flexarm_program(tmp_path, "sweep", scene, "plan.yaml", "--workers", "1", "--quiet", "--show", "3,1")
    heavy, light = read_page(tmp_path / "plan_results.html")
    assert heavy.picture["title"] == "run 3: payload = 1.5" and light.picture["title"] == "run 1: payload = 0.5"
    assert heavy.times[-1] == light.times[-1] == pytest.approx(0.2)
    assert "up to 3" in flexarm_program(tmp_path, "sweep", scene, "plan.yaml", "--show", "4", status=2)
    (tmp_path / "plan_results.html").unlink()
    (tmp_path / "browser").write_text('#!/bin/sh\necho "$@" > "%s"\n' % (tmp_path / "opened"))
    (tmp_path / "browser").chmod(0o755)
    monkeypatch.setenv("BROWSER", str(tmp_path / "browser"))
    flexarm_program(tmp_path, "sweep", scene, "plan.yaml", "--workers", "1", "--quiet", "--show", "2", "--open")
    assert (tmp_path / "opened").read_text().strip() == (tmp_path / "plan_results.html").as_uri()
    assert "--show" in flexarm_program(tmp_path, "sweep", scene, "plan.yaml", "--open", status=2)


BALL = """<robot name="ball"> <link name="world"/> <joint name="hinge" type="continuous"> <parent link="world"/>
  <child link="rod"/> <axis xyz="0 1 0"/> </joint> %s <simulation> <integrator step="0.01"/>
  <probe name="ball" link="rod" at="0.8 0.1 0.2"/> </simulation> </robot>""" % body("rod", """<visual>
  <origin xyz="0.8 0.1 0.2"/> <geometry> <sphere radius="0.06"/> </geometry>
  <material name="magenta"> <color rgba="1 0 1 1"/> </material> </visual>""").replace(
      "<mass value", '<origin xyz="0.5 0 0"/> <mass value')


def test_a_browser_shows_things_where_the_run_has_them(browser, tmp_path):
    from player_picture_test import centre_of, magenta, projected, size_of

    (tmp_path / "ball.urdf").write_text(BALL)
    flexarm_program(tmp_path, "show", "ball.urdf", "--until", "2", "--rate", "50", "--output", "ball.html")
    simulation = flexarm.Simulation(str(tmp_path / "ball.urdf"))
    assert browser.open(str(tmp_path / "ball.html")) == []  # messages of the console
    for time in (0.0, 1.0, 1.5):
        simulation.run(round((time - simulation.time) / 0.01))
        place = simulation.probe_poses[0, :3].tolist()
        browser.run("flexarm.setTime(arguments[0])", time)
        browser.frame()
        expected = projected(browser.run("return flexarm.camera"), (0, 0, 1), place, *size_of(browser))
        assert browser.run("return flexarm.project(arguments[0])", place) == pytest.approx(expected, abs=0.5)
        assert centre_of(browser.screen(), magenta)[0] == pytest.approx(expected, abs=2)
    assert browser.run("return flexarm.errors") == []
