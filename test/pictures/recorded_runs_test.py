"""Tests what pages of files of results show: the same as pages of the simulation, as far as the files have columns."""

import os
import shutil

import numpy as np
import pytest

flexarm = pytest.importorskip("flexarm")

from page_reader import read_page  # noqa: E402
from show_test import ARM, ROOT, flexarm_program, half_step  # noqa: E402

RATE = "2000"  # all rows are in the page


def expect_arrows(again, direct, kind, more=0.0, parts=range(9)):
    """Compare arrows of a kind. @param more  tolerance, per range, beside the steps of both pages' numbers"""
    shown, expected = again.arrows[kind], direct.arrows[kind]
    assert shown.shape == expected.shape and expected.shape[1] > 0
    for place in range(expected.shape[1]):
        for part in parts:
            a, b = shown[:, place, part], expected[:, place, part]
            assert a == pytest.approx(b, abs=half_step(a) + half_step(b) + more * np.ptp(b)), (kind, place, part)


def runs_of(folder, scene, until, *files, commands=()):
    """Return a page's run of a scene, and those of files with all columns."""
    words = scene, "--until", until, *commands
    flexarm_program(folder, "show", *words, "--rate", RATE, "--output", "direct.html")
    for name in files:
        columns = () if name.endswith(".bag") else ("--columns", "*")
        flexarm_program(folder, "simulate", *words, *columns, "--output", name)
    flexarm_program(folder, "show", scene, "--rate", RATE, "--output", "again.html", "--runs", *files)
    direct, = read_page(folder / "direct.html")
    again = read_page(folder / "again.html")
    for run in again:
        assert run.times == pytest.approx(direct.times, abs=2e-9)
    return direct, again


# ---------------------------------------------------------------- arrows

LOADED = """<sensor name="cell" kind="wrench" link="payload" at="0.01 0 0.02"/>
  <sensor name="hold" kind="reaction" link="forearm"/>
  <simulation> <load link="payload" at="0 0.1 0" force="0 1 2*t" moment="0.1 0 0"/>
  <load link="forearm" at="0.3 0 0" force="0 0 3" frame="follower" history="sin(9*t)"/>"""


@pytest.mark.parametrize("name", ["run.csv", "run.h5", "run.bag"])
def test_efforts_loads_and_reactions_of_files_are_those_of_the_run(tmp_path, name):
    with open(ARM, encoding="utf-8") as file:
        text = file.read().replace("<simulation>", LOADED.replace("2*t", "2"), 1)
    (tmp_path / "arm.urdf").write_text(text)
    (tmp_path / "commands.yaml").write_text("period: 1\ncommands:\n  - {time: 0, names: [shoulder, elbow], "
                                            "efforts: [2, -0.7], duration: 0.05}\n")
    direct, (again,) = runs_of(tmp_path, "arm.urdf", "0.1", name, commands=("--commands", "commands.yaml"))
    for kind in ("effort", "reaction"):
        expect_arrows(again, direct, kind, 1e-9)
    # Of a bag the line between the ends of a beam is approximate, so the place and the axes of a load on it are, too.
    if name.endswith(".bag"):
        expect_arrows(again, direct, "load", 2e-2, range(3, 9))
    else:
        expect_arrows(again, direct, "load", 1e-9)
    assert not [note for note in again.picture["notes"] if "not drawn" in note]


def test_efforts_of_joints_of_all_kinds(tmp_path):
    shutil.copy(os.path.join(ROOT, "config", "examples", "joints.urdf"), tmp_path / "joints.urdf")
    (tmp_path / "commands.yaml").write_text(
        "period: 1\ncommands:\n  - {time: 0, names: [hinge, wheel, ball/rx, ball/rz, cardan/1, cardan/2, sleeve/2], "
        "efforts: [1, 0.5, 0.2, -0.3, 0.4, 0.1, 0.6], duration: 1}\n")
    direct, (again,) = runs_of(tmp_path, "joints.urdf", "0.2", "run.h5", commands=("--commands", "commands.yaml"))
    assert np.abs(direct.arrows["effort"][:, :, 3:]).max() > 0.5
    expect_arrows(again, direct, "effort", 1e-6)


def test_efforts_of_loop_joints(tmp_path):
    scene = os.path.join(ROOT, "config", "examples", "four_bar.urdf")
    direct, (again,) = runs_of(tmp_path, scene, "0.2", "run.h5")
    assert np.abs(direct.arrows["effort"][:, :, 3:]).max() > 0.1
    expect_arrows(again, direct, "effort", 1e-6, range(3, 9))


def columns_of_contacts(run, part):
    return [values for name, values in run.columns.items()
            if name.startswith("contact/") and name.endswith("/" + part)]


def expect_forces_of_columns(run):
    """The arrows of contacts have the forces of the columns, in sum."""
    shown = run.arrows["contact"]
    for part, axis in enumerate(("fx", "fy", "fz")):
        total = np.sum(columns_of_contacts(run, axis), axis=0)
        step = sum(half_step(shown[:, place, 3 + part]) for place in range(shown.shape[1]))
        assert shown[:, :, 3 + part].sum(axis=1) == pytest.approx(total, abs=step + half_step(total) + 1e-9)


@pytest.mark.parametrize("name", ["wrapping_finger", "cable_over_pulley"])
def test_forces_of_contacts_are_shared_out_among_the_points_that_touch(tmp_path, name):
    scene = os.path.join(ROOT, "config", "examples", name + ".urdf")
    direct, (again,) = runs_of(tmp_path, scene, "0.4", "run.h5")
    expect_arrows(again, direct, "load", 1e-9)
    expect_forces_of_columns(again)
    points = columns_of_contacts(again, "points")
    assert max(map(max, points)) > 2
    shown, expected = again.arrows["contact"], direct.arrows["contact"]
    last, step = shown[-1], np.array([half_step(expected[:, :, part]) for part in range(9)])
    used = np.linalg.norm(expected[-1, :, 3:6], axis=1) > 4 * step[3:6].max()
    assert used.sum() == pytest.approx(max(values[-1] for values in points), abs=0.01)
    # The positions of all nodes tell where the bodies touch.
    assert last[used, :3] == pytest.approx(expected[-1, used, :3], abs=4 * step[:3].max())


def test_contacts_of_beams_between_their_ends_have_the_forces_of_the_columns(tmp_path):
    scene = os.path.join(ROOT, "config", "examples", "cable_over_pulley.urdf")
    flexarm_program(tmp_path, "simulate", scene, "--until", "0.3", "--output", "run.csv")
    flexarm_program(tmp_path, "show", scene, "--runs", "run.csv", "--output", "page.html")
    run, = read_page(tmp_path / "page.html")
    expect_forces_of_columns(run)  # although such a cable may be deep inside of the pulley
    largest = np.linalg.norm([np.sum(columns_of_contacts(run, axis), axis=0) for axis in ("fx", "fy", "fz")], axis=0)
    assert np.linalg.norm(run.arrows["contact"][:, :, 3:6], axis=2).max() <= largest.max() * (1 + 1e-3)


def test_arrows_without_columns_are_told(tmp_path):
    scene = os.path.join(ROOT, "config", "examples", "wrapping_finger.urdf")
    flexarm_program(tmp_path, "simulate", scene, "--until", "0.1", "--columns", "frame/*", "--output", "run.csv")
    flexarm_program(tmp_path, "show", scene, "--runs", "run.csv", "--output", "page.html")
    run, = read_page(tmp_path / "page.html")
    assert run.arrows["contact"].shape[1] == 0 and run.arrows["load"].shape[1] == 1
    assert any(note.startswith("contacts are not drawn") for note in run.picture["notes"])


def test_frames_of_a_bag_are_composed_and_interpolated():
    bags = pytest.importorskip("flexarm.identification.bags")
    half = np.sqrt(0.5)
    still = np.array([[0.0, 0, 1, 0, 0, half, half]])  # 1 m up, turned by 90 degrees about z
    moves = np.array([[1.0, 0, 0, 0, 0, 0, 1], [3.0, 0, 0, 0, 0, 0, -1]])  # the same quaternion with both signs
    edges = {"hand": ("arm", np.array([0.0, 2.0]), moves), "arm": ("world", np.array([0.0]), still),
             "a": ("b", np.array([0.0]), still), "b": ("a", np.array([0.0]), still)}  # these two carry each other
    found = bags.frames_at(edges, np.array([0.0, 1.0, 5.0]))
    assert found["hand"][:, :3] == pytest.approx(np.array([[0, 1, 1], [0, 2, 1], [0, 3, 1]]), abs=1e-15)
    assert abs(found["hand"][:, 3:] @ [0, 0, half, half]) == pytest.approx(1, abs=1e-15)
    assert (found["world"] == [0, 0, 0, 0, 0, 0, 1]).all() and {"a", "b"} <= set(found)


# ---------------------------------------------------------------- beams

def test_strains_of_beams_without_columns_are_unknown(tmp_path):
    shutil.copy(ARM, tmp_path / "arm.urdf")
    for name in ("run.csv", "run.bag"):
        flexarm_program(tmp_path, "simulate", "arm.urdf", "--until", "0.1", "--output", name)
        flexarm_program(tmp_path, "show", "arm.urdf", "--runs", name, "--output", "page.html")
        run, = read_page(tmp_path / "page.html")
        assert len(run.beams) == 2 and all(np.isnan(beam[:, :, 7:]).all() for beam in run.beams)
        assert all(np.isfinite(beam[:, :, :7]).all() for beam in run.beams)


def test_beams_of_a_bag_end_where_its_frames_have_them(tmp_path):
    shutil.copy(ARM, tmp_path / "arm.urdf")
    direct, (bag,) = runs_of(tmp_path, "arm.urdf", "0.3", "run.bag")
    assert bag.times[0] == 0
    for shown, expected in zip(bag.beams, direct.beams):
        steps = half_step(shown[:, :, :3]) + half_step(expected[:, :, :3])
        assert shown[:, [0, -1], :3] == pytest.approx(expected[:, [0, -1], :3], abs=steps + 1e-9)
        turns = abs(np.sum(shown[:, -1, 3:7] * expected[:, -1, 3:7], axis=1))
        assert turns == pytest.approx(1, abs=4 / 65534)
    for link in ("upper_arm", "forearm", "payload"):
        assert bag.link(link)[:, :3] == pytest.approx(direct.link(link)[:, :3], abs=1e-4)
    for note in bag.picture["notes"]:  # no bag has such columns
        assert "which CSV and HDF5 files have by `--columns '*'`" in note


CANTILEVER = """<robot name="cantilever"> <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
  <link name="arm"> <beam elements="6"> <centerline> <line to="2 0 0"/> </centerline> <circle radius="0.01"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <joint name="weld" type="fixed"> <parent link="arm"/> <child link="end"/> <origin xyz="2 0 0"/> </joint>
  <link name="end"> <inertial> <mass value="0.1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <simulation> <gravity xyz="0 0 0"/> <initial equilibrium="true"/>
    <load link="end" at="0 0 0" force="0 0 0.05" moment="0 -0.2 0"/> </simulation> </robot>"""


def test_a_beam_with_a_force_and_a_moment_at_its_end_is_a_cubic(tmp_path):
    (tmp_path / "cantilever.urdf").write_text(CANTILEVER)
    flexarm_program(tmp_path, "simulate", "cantilever.urdf", "--until", "0.002", "--output", "run.csv")
    flexarm_program(tmp_path, "show", "cantilever.urdf", "--runs", "run.csv", "--output", "page.html")
    run, = read_page(tmp_path / "page.html")
    x = np.array(run.picture["beams"][0]["arc_lengths"])
    stiffness, force, moment = 70e9 * np.pi * 0.01**4 / 4, 0.05, 0.2  # the moment about -y bends upwards, too
    exact = (force * x**2 * (6 - x) / 6 + moment * x**2 / 2) / stiffness
    assert exact[-1] > 5e-4
    # Shear adds F x / (k G A) at most; sections between nodes are as far from the cubic as elements are.
    assert run.beams[0][0, :, 2] == pytest.approx(exact, abs=2e-3 * exact[-1])


# ---------------------------------------------------------------- size

def test_a_minute_of_the_demo_is_below_5_megabytes(tmp_path):
    config = os.path.join(ROOT, "config")
    flexarm_program(tmp_path, "show", os.path.join(config, "demo_arm.urdf"), "--commands",
                    os.path.join(config, "demo_commands.yaml"), "--until", "60", "--output", "demo.html")
    run, = read_page(tmp_path / "demo.html")
    assert run.frames >= 60 * 59 and run.times[-1] == pytest.approx(60)
    assert os.path.getsize(str(tmp_path / "demo.html")) < 5e6
