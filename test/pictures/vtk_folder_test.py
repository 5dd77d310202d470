"""Test the folder that `flexarm simulate --vtk` writes: its instants and lists, errors, interruptions."""

import os
import signal
import subprocess
import time
from xml.etree import ElementTree

import numpy
import pytest

from vtk_reading import PARTS, array, listed, part, positions, read, rows_of, run, run_of_arm, simulate, times_of


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    return run_of_arm(tmp_path_factory.mktemp("arm"))


# ---------------------------------------------------------------- times and lists


def test_times_are_those_of_the_rate_and_of_the_end(arm):
    folder, rows, _ = arm
    assert len(rows) == 501  # the table beside it has all rows
    times = times_of(folder)
    assert len(times) == 16
    assert numpy.allclose(times[:-1], numpy.arange(15) / 30, atol=0.51e-3, rtol=0)
    assert times[-1] == rows[-1]["time"]
    assert set(times) <= {row["time"] for row in rows}
    for name in PARTS:
        assert [when for when, _, _ in listed(folder / (name + ".pvd"))] == times
        for index, when in enumerate(times):
            assert array(part(folder, name, index).GetFieldData(), "TimeValue")[0] == when


def test_every_and_rate_choose_the_instants(arm, tmp_path):
    scene = arm[2]
    run(scene, tmp_path, "--until", 0.1, "--vtk-rate", 1e9)
    assert len(times_of(tmp_path)) == 101
    run(scene, tmp_path, "--until", 0.1, "--vtk-rate", 1e9, "--every", 10)
    assert len(times_of(tmp_path)) == 11
    # Nothing of the longer run is left.
    for name in PARTS:
        files = sorted(path.name for path in (tmp_path / name).iterdir())
        assert files == ["%s_%06d.vtp" % (name, k) for k in range(11)]
    run(scene, tmp_path, "--until", 0.1, "--vtk-rate", 1)
    assert len(times_of(tmp_path)) == 2


def test_files_of_others_in_the_folder_stay(arm, tmp_path):
    (tmp_path / "beams").mkdir()
    others = [tmp_path / "notes.txt", tmp_path / "beams" / "beams.vtp", tmp_path / "beams" / "my_beams_000001.vtp"]
    for other in others:
        other.write_text("mine")
    run(arm[2], tmp_path, "--until", 0.01)
    assert [other.read_text() for other in others] == ["mine"] * 3


def test_run_to_an_accuracy(arm, tmp_path):
    run(arm[2], tmp_path / "vtk", "--until", 0.29, "--accuracy", 0.05, "--output", tmp_path / "arm.csv")
    times = times_of(tmp_path / "vtk")
    assert numpy.allclose(times, numpy.linspace(0, 0.29, 9), atol=1e-9)  # 8 intervals: no shorter than 1/30 s
    rows = rows_of(tmp_path / "arm.csv")
    assert [row["time"] for row in rows] == times
    x = [positions(part(tmp_path / "vtk", "beams", k))[0] for k in range(9)]
    assert numpy.abs(x).max() < 1e-12  # the shoulder
    last = positions(part(tmp_path / "vtk", "beams", 8))
    tip = [rows[-1]["probe/tip/" + axis] for axis in "xyz"]
    assert numpy.abs(last - tip).sum(axis=1).min() < 1e-12


# ---------------------------------------------------------------- errors


def test_folders_that_cannot_be_written(arm, tmp_path):
    scene = arm[2]
    file = tmp_path / "file"
    file.write_text("mine")
    for folder, reason in ((file, "cannot write into the folder '%s': Not a directory"),
                           (file / "below", "cannot write into the folder '%s': Not a directory"),
                           ("/proc/none/vtk", "cannot write into the folder '%s': No such file or directory"),
                           ("-", "--vtk: expected a folder, got '%s'")):
        result = simulate(scene, "--until", 0.1, "--vtk", folder)
        assert result.returncode == 2, result.stderr
        assert reason % folder in result.stderr
    assert file.read_text() == "mine"
    (tmp_path / "vtk" / "run.pvd").mkdir(parents=True)
    result = simulate(scene, "--until", 0.1, "--vtk", tmp_path / "vtk")
    assert result.returncode == 2
    assert "'%s' cannot be written: it is not a regular file" % (tmp_path / "vtk" / "run.pvd") in result.stderr


def test_rates_that_make_no_sense(arm, tmp_path):
    for rate in ("0", "-1", "nan", "inf", "often"):
        result = simulate(arm[2], "--until", 0.1, "--vtk", tmp_path, "--vtk-rate", rate)
        assert result.returncode == 2, rate
        assert "--vtk-rate" in result.stderr
    result = simulate(arm[2], "--until", 0.1, "--vtk-rate", 10)
    assert result.returncode == 2 and "--vtk" in result.stderr


def test_an_error_on_the_way_leaves_what_was_written(arm, tmp_path):
    obstacle = tmp_path / "bodies" / "bodies_000003.vtp"
    obstacle.mkdir(parents=True)
    result = simulate(arm[2], "--until", 1, "--vtk", tmp_path)
    assert result.returncode == 1, result.returncode
    assert "cannot write '%s': Is a directory" % obstacle in result.stderr
    assert len(times_of(tmp_path)) == 3
    for _, _, file in listed(tmp_path / "run.pvd"):
        read(tmp_path / file)


def test_a_disk_that_is_full(arm, tmp_path):
    if os.geteuid() != 0:
        pytest.skip("only root may mount a small disk")
    command = ["unshare", "-m", "sh", "-c",
               "mount -t tmpfs -o size=200k none \"$1\" && \"$2\" simulate --quiet \"$3\" --until 5 --vtk \"$1/vtk\"; "
               "echo $?; cat \"$1/vtk/run.pvd\"", "sh", str(tmp_path), os.environ["FLEXARM_PROGRAM"], str(arm[2])]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                            timeout=1000, check=False)
    if "mount:" in result.stderr or "unshare:" in result.stderr:
        pytest.skip("no small disk can be mounted here: " + result.stderr)
    assert "No space left on device" in result.stderr
    status, collection = result.stdout.split("\n", 1)
    assert status == "1"
    assert ElementTree.fromstring(collection).findall("./Collection/DataSet")


@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGINT])
def test_an_interrupted_run_is_complete_so_far(arm, tmp_path, kind):
    program = subprocess.Popen([os.environ["FLEXARM_PROGRAM"], "simulate", "--quiet", str(arm[2]), "--until", "1e5",
                                "--vtk", str(tmp_path), "--vtk-rate", "300"], stderr=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 60
        while not (tmp_path / "run.pvd").exists() or len(listed(tmp_path / "run.pvd")) <= 3:
            assert time.monotonic() < deadline and program.poll() is None  # the list is complete at any time
    finally:
        program.send_signal(kind)
        program.wait()
    entries = listed(tmp_path / "run.pvd")
    assert len(entries) > 3 and len(entries) % len(PARTS) == 0
    for _, _, file in entries:
        read(tmp_path / file)
