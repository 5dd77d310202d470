"""Tests how results and saved states are shown without their scene being named, and what is left of damaged files."""

import os
import shutil

import pytest

flexarm = pytest.importorskip("flexarm")

from page_reader import read_page  # noqa: E402
from show_test import ARM, flexarm_program, half_step  # noqa: E402

STEPS = "--until", "2.2", "--step", "1e-3"  # two chunks of HDF5, and a third one that is not full


@pytest.fixture
def folder(tmp_path):
    shutil.copy(ARM, tmp_path / "arm.urdf")
    return tmp_path


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Return a folder with the scene and a run of it as files of all kinds."""
    made = tmp_path_factory.mktemp("runs")
    shutil.copy(ARM, made / "arm.urdf")
    for name in ("run.h5", "run.csv", "run.bag"):
        flexarm_program(made, "simulate", "arm.urdf", *STEPS, "--output", name, "--checkpoint", "state")
    return made


def shown(folder, *words):
    printed = flexarm_program(folder, "show", *words, "--output", "page.html")
    return read_page(folder / "page.html"), printed


def cut(path, name, part):
    data = path.read_bytes()
    (path.parent / name).write_bytes(data[:int(part * len(data))])


@pytest.mark.parametrize("name", ["run.h5", "run.bag"])
def test_results_name_their_scene(runs, tmp_path, name):
    shutil.copy(runs / name, tmp_path / name)  # the scene's path is absolute
    (again,), _ = shown(tmp_path, name)
    (named,), _ = shown(tmp_path, str(runs / "arm.urdf"), "--runs", name)
    assert again.picture == named.picture and again.times[-1] == pytest.approx(2.2)
    assert (again.link("payload") == named.link("payload")).all()


def test_a_csv_file_needs_its_scene_or_that_of_another_run(runs):
    printed = flexarm_program(runs, "show", "run.csv", status=2)
    assert "run.csv: a CSV file does not name its scene; name it: flexarm show SCENE --runs run.csv" in printed
    (first, second), _ = shown(runs, "run.h5", "--runs", "run.csv")
    expected = first.link("payload")[:, :3]
    assert second.link("payload")[:, :3] == pytest.approx(expected, abs=2 * half_step(expected))


PARAMETERS = """<robot name="rod"> <parameter name="length" value="1"/> <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/>
    <origin xyz="0 0 ${length}"/> </joint>
  <link name="rod"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial>
    <visual> <geometry> <sphere radius="${length}"/> </geometry> </visual> </link>
  <simulation> <integrator step="0.01"/> </simulation> </robot>"""


@pytest.mark.parametrize("name", ["run.h5", "state"])
def test_the_scene_has_the_parameters_of_the_run(tmp_path, name):
    (tmp_path / "rod.urdf").write_text(PARAMETERS)
    option = "--checkpoint" if name == "state" else "--output"
    flexarm_program(tmp_path, "simulate", "rod.urdf", "--set", "length=0.3", "--until", "0.5", option, name)
    (run,), _ = shown(tmp_path, name)
    assert run.picture["links"][1]["shapes"][0]["radius"] == 0.3
    assert run.link("rod")[-1, 2] == pytest.approx(0.3)


def test_the_scene_has_the_arguments_of_xacro(tmp_path, monkeypatch):
    program = tmp_path / "xacro"  # stands for xacro, which may be missing
    program.write_text("#!/bin/sh\nsed \"s/\\$(arg length)/${2#length:=}/\" \"$1\"\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", "%s:%s" % (tmp_path, os.environ["PATH"]))
    text = PARAMETERS.replace('<parameter name="length" value="1"/>', "").replace("${length}", "$(arg length)")
    (tmp_path / "rod.xacro").write_text(text)
    words = "--xacro-args", "length:=0.3"
    flexarm_program(tmp_path, "simulate", "rod.xacro", *words, "--until", "0.5", "--output", "run.h5")
    (run,), _ = shown(tmp_path, "run.h5")
    assert run.picture["links"][1]["shapes"][0]["radius"] == 0.3
    (run,), _ = shown(tmp_path, "rod.xacro", *words, "--runs", "run.h5")
    assert run.picture["links"][1]["shapes"][0]["radius"] == 0.3


def test_a_saved_state_is_shown_by_itself_or_goes_on(runs):
    (still,), _ = shown(runs, "state")
    (named,), _ = shown(runs, "arm.urdf", "--resume", "state", "--step", "1e-3", "--until", "2.2")
    assert still.frames == 1 and still.times[0] == pytest.approx(2.2)
    assert (still.link("payload") == named.link("payload")[0]).all()
    assert still.picture["title"].endswith(", t = 2.2 s")
    (further,), _ = shown(runs, "state", "--until", "2.5")
    assert further.times[[0, -1]] == pytest.approx([2.2, 2.5])


@pytest.mark.parametrize("name, way", [("run.h5", "--runs"), ("run.bag", "--runs"), ("state", "--resume")])
def test_a_scene_that_has_moved_must_be_named(folder, name, way):
    option = "--checkpoint" if name == "state" else "--output"
    flexarm_program(folder, "simulate", "arm.urdf", "--until", "0.1", option, name)
    (folder / "arm.urdf").rename(folder / "moved.urdf")
    printed = flexarm_program(folder, "show", name, status=2)
    expected = "its scene '%s' is not there any more; name it: flexarm show SCENE %s %s"
    assert expected % (folder / "arm.urdf", way, name) in printed
    (run,), _ = shown(folder, "moved.urdf", way, name)
    assert run.frames > 0


@pytest.mark.parametrize("name, part, last", [("run.h5", 0.6, 1.023), ("run.bag", 0.6, 1.2), ("run.csv", 0.6, 1.3)])
def test_what_is_left_of_a_file_is_shown(runs, name, part, last):
    cut(runs / name, "cut_" + name, part)
    words = ("arm.urdf", "--runs") if name.endswith(".csv") else ()
    (run,), printed = shown(runs, *words, "cut_" + name)
    assert "warning: cut_" + name in printed
    assert run.picture["notes"][0] in printed
    assert 0.8 * last < run.times[-1] < 1.2 * last
    (whole,), _ = shown(runs, "arm.urdf", "--runs", name)
    expected = whole.columns["joint/shoulder/position"][:run.frames - 1]
    assert run.columns["joint/shoulder/position"][:-1] == pytest.approx(expected, abs=2 * half_step(expected))


@pytest.mark.parametrize("name, part", [("run.csv", 0), ("run.csv", 0.0002), ("run.h5", 0), ("run.h5", 0.0002),
                                        ("run.h5", 0.02), ("run.bag", 0), ("run.bag", 0.0002), ("run.bag", 0.01)])
def test_files_with_nothing_left_are_errors(runs, name, part):
    cut(runs / name, "cut_" + name, part)
    words = ("arm.urdf", "--runs") if name.endswith(".csv") else ()
    printed = flexarm_program(runs, "show", *words, "cut_" + name, "--output", "cut.html", status=2).splitlines()
    assert printed[-1].startswith("flexarm: cut_" + name + ": ") and "Traceback" not in "".join(printed)


def test_a_damaged_state_is_an_error(runs):
    cut(runs / "state", "cut_state", 0.5)
    assert "cut_state': is damaged" in flexarm_program(runs, "show", "cut_state", status=2)


def test_python_refuses_damaged_files(runs):
    cut(runs / "run.h5", "cut_run.h5", 0.6)
    with pytest.raises(flexarm.ResultsError, match="cannot be read: it has lost its end: there are only"):
        flexarm.read_run(str(runs / "cut_run.h5"))
