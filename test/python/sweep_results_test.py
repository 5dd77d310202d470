"""Test the command `flexarm sweep`: its results, which survive killed processes and full disks, and histories."""

import csv
import os
import pty
import signal
import subprocess
import sys
import time

import h5py
import pytest

from conftest import bits, command_line, read_csv
from flexarm.sweep.input import InputError
from flexarm.sweep.results import Results
from flexarm.sweep.run import Outcome
from sweeping import GRID, LONG, SCENE, command, outcomes, plan_of, sweep, write


@pytest.fixture
def folder(tmp_path):
    plan_of(tmp_path, GRID)
    return tmp_path


def content(folder, name="plan_results.csv"):
    return (folder / name).read_bytes()


def rows_of(folder, name="plan_results.csv"):
    with open(folder / name, encoding="utf-8", newline="") as file:
        assert file.readline().startswith("# flexarm sweep 1, scene ")
        return list(csv.DictReader(file))


def test_results_are_those_of_single_runs_whatever_the_number_of_workers(folder):
    said, summary = sweep(folder, "--workers", 2)
    assert said == "" and summary.startswith("plan_results.csv: 12 runs, 12 of them now, in ")
    rows = rows_of(folder)
    plan = plan_of(folder, GRID)
    assert list(rows[0]) == ["run", "mass", "effort", "angle", "speed", "failure"]
    for number, row, values, measures in zip(range(1, 13), rows, plan.design.rows, outcomes(plan)):
        assert row["run"] == str(number) and row["failure"] == ""
        assert [float(row["mass"]), float(row["effort"])] == list(values)
        assert [float(row["angle"]), float(row["speed"])] == list(measures)
    assert sweep(folder, "--workers", 1, "--output", "one.csv", "--quiet") == ("", "")
    assert content(folder) == content(folder, "one.csv")


def keep(path, plan, outcome, order):
    """Add those of these runs that are missing. Return how many they are."""
    results = Results(path, plan)
    missing = [number for number in order if number in results.missing()]
    for number in missing:
        results.add(number, outcome[number - 1])
    if not results.missing():
        results.finish()
    results.close()
    return len(missing)


def test_what_is_there_is_not_done_again(folder):
    sweep(folder, "--quiet")
    before = content(folder)
    assert sweep(folder)[1].startswith("plan_results.csv: 12 runs, 0 of them now")
    lines = before.splitlines(keepends=True)
    (folder / "plan_results.csv").write_bytes(b"".join(lines[:2] + lines[9:3:-2]) + lines[5][:7])
    assert sweep(folder)[1].startswith("plan_results.csv: 12 runs, 9 of them now")
    assert content(folder) == before
    assert not (folder / "plan_results.csv.unfinished").exists()


def test_torn_files_are_repaired(folder):
    plan = plan_of(folder, GRID)
    outcome = [Outcome(measures, "") for measures in outcomes(plan)]
    path = folder / "results.csv"
    assert keep(path, plan, outcome, [3, 1, 2]) == 3
    assert keep(path, plan, outcome, range(12, 0, -1)) == 9
    before = path.read_bytes()
    lines = before.splitlines(keepends=True)
    assert [line.split(b",")[0] for line in lines[2:]] == [b"%d" % number for number in range(1, 13)]
    for torn in (b"", lines[5][:-1], lines[5][:7], b"1"):
        path.write_bytes(b"".join(lines[:2] + lines[9:3:-2]) + torn)
        assert keep(path, plan, outcome, range(1, 13)) == 9
        assert path.read_bytes() == before
    for torn in (b"", before[:1], before[:60], lines[0], lines[0] + lines[1][:-1]):
        path.write_bytes(torn)
        assert keep(path, plan, outcome, range(1, 13)) == 12
        assert path.read_bytes() == before


def test_results_of_something_else_are_refused(folder):
    sweep(folder, "--quiet")
    before = content(folder)
    write(folder, "plan.yaml", GRID.replace("count: 4", "count: 5"))
    said, _ = sweep(folder, status=2)
    assert "plan_results.csv' has results of another plan (scene " in said
    for text, scene, what in ((GRID.replace("until: 2", "until: 3"), SCENE, "another plan"),
                              (GRID, SCENE.replace("0.5 0 0", "0.4 0 0"), "another scene")):
        with pytest.raises(InputError, match="has results of " + what):
            Results(folder / "plan_results.csv", plan_of(folder, text, scene))
    assert content(folder) == before
    for other in ("rod.urdf", "plan.yaml"):
        kept = content(folder, other)
        assert "--output would overwrite '%s'" % other in sweep(folder, "--output", other, status=2)[0]
        assert content(folder, other) == kept
    other = write(folder, "other.csv", "a,b\n1,2\n")
    with pytest.raises(InputError, match="other.csv' is not a file of results of a sweep"):
        Results(other, plan_of(folder, GRID))
    assert content(folder, "other.csv") == b"a,b\n1,2\n"
    with pytest.raises(InputError, match="cannot write '.*none/x.csv': No such file or directory"):
        Results(folder / "none" / "x.csv", plan_of(folder, GRID))


@pytest.mark.parametrize("wrong", [b"x,1,2,3,4,\n", b"13,1,2,3,4,\n", b"3,1,2,3,\n", b"\0\0\0\n"])
def test_a_line_that_cannot_be_is_an_error(folder, wrong):
    plan = plan_of(folder, GRID)
    path = folder / "results.csv"
    keep(path, plan, [Outcome((1.0, 2.0), "")] * 12, range(1, 13))
    lines = path.read_bytes().splitlines(keepends=True)
    text = b"".join(lines[:4]) + wrong + lines[5]
    path.write_bytes(text)
    with pytest.raises(InputError, match="results.csv:5: expected the 6 columns of a run, got '"):
        Results(path, plan)
    assert path.read_bytes() == text


def test_runs_that_fail_are_rows(tmp_path):
    plan_of(tmp_path, """
        design: {kind: rows, rows: [{mass: 1, kick: 0}, {mass: 1, kick: 1e4}, {mass: 2, kick: 0}]}
        until: 2
        history: csv
        measures: {angle: {final: joint/hinge/position}}
    """)
    said, summary = sweep(tmp_path)
    assert summary.endswith("; 1 failed, the column 'failure' says why\n")
    rows = rows_of(tmp_path)
    assert [row["failure"] == "" for row in rows] == [True, False, True]
    assert rows[1]["angle"] == "nan" and "Newton" in rows[1]["failure"]
    # The history contains the run up to the failure.
    names, history = read_csv(tmp_path / "plan_results_histories" / "run_000002.csv")
    assert 0.85 < history[-1, names.index("time")] < 1.1
    assert sweep(tmp_path)[1].startswith("plan_results.csv: 3 runs, 0 of them now")
    assert sweep(tmp_path, "--repeat-failed")[1].startswith("plan_results.csv: 3 runs, 1 of them now")
    assert rows_of(tmp_path) == rows


def test_scenes_that_are_impossible_are_rows(tmp_path):
    scene = SCENE.replace('<link name="world"/>',
                          '<parameter name="less" value="${1 - mass}" min="-1"/> <link name="world"/>')
    plan_of(tmp_path, GRID, scene)
    sweep(tmp_path)
    for row in rows_of(tmp_path):
        if float(row["mass"]) == 4:
            assert row["failure"].startswith("rod.urdf:6: ") and "less" in row["failure"]  # not the folder of the file
        else:
            assert row["failure"] == ""


@pytest.mark.parametrize("format", ["hdf5", "csv"])
def test_histories_are_those_of_the_command_line(tmp_path, format):
    plan_of(tmp_path, """
        design: {kind: grid, parameters: {mass: [1, 2], effort: 0.3}}
        until: 1.5
        every: 4
        history: {format: %s, columns: ["joint/*", probe/tip/x]}
    """ % format)
    sweep(tmp_path, "--quiet")
    columns = "joint/*,probe/tip/x"
    for number, mass in ((1, 1), (2, 2)):
        command_line("simulate", "rod.urdf", "--set", "mass=%d" % mass, "effort=0.3", "--until", 1.5, "--every", 4,
                     "--columns", columns, "--output", "expected.csv", "--quiet", folder=tmp_path)
        names, expected = read_csv(tmp_path / "expected.csv")
        path = tmp_path / "plan_results_histories" / "run_{:06d}.{}".format(number, {"hdf5": "h5"}.get(format, format))
        if format == "csv":
            assert read_csv(path)[0] == names
            assert bits(read_csv(path)[1]) == bits(expected)
            continue
        with h5py.File(path, "r") as file:
            assert (file.attrs["robot"], file.attrs["run"], file.attrs["parameter/mass"]) == ("rod", number, mass)
            for name, column in zip(names, expected.T):
                assert bits(file[name][:]) == bits(column)
                assert file[name].attrs["name"] == name
            assert file["joint/hinge/velocity"].attrs["unit"] == "rad/s"


def test_the_same_history_has_the_same_bits(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        plan_of(tmp_path / name, GRID + "    history: hdf5\n")
        sweep(tmp_path / name, "--quiet", "--workers", 2)
    files = sorted(os.listdir(tmp_path / "one" / "plan_results_histories"))
    assert files == ["run_%06d.h5" % number for number in range(1, 13)]
    for file in files:
        one, two = (content(tmp_path / name / "plan_results_histories", file) for name in ("one", "two"))
        assert one == two


# ---- killed processes

@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    plan_of(folder, LONG)
    sweep(folder, "--quiet")
    return content(folder)


def begin(folder, *arguments):
    """Start the program. When it has some rows, return it and the processes that it has started."""
    plan_of(folder, LONG)
    program = subprocess.Popen(command("rod.urdf", "plan.yaml", "--workers", 2, *arguments), cwd=folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    wait_until(lambda: rows_in(folder) >= 2)
    return program, workers_of(program.pid)


def rows_in(folder):
    path = folder / "plan_results.csv"
    return path.read_bytes().count(b"\n") - 2 if path.exists() else 0


def wait_until(condition, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def workers_of(parent):
    with open("/proc/%d/task/%d/children" % (parent, parent), encoding="ascii") as file:
        children = [int(child) for child in file.read().split()]
    return [child for child in children if b"spawn_main" in command_of(child)]


def command_of(process):
    try:
        with open("/proc/%d/cmdline" % process, "rb") as file:
            return file.read()
    except (FileNotFoundError, ProcessLookupError):
        return b""


def test_killed_workers_cost_nothing_but_time(tmp_path, undisturbed):
    program, workers = begin(tmp_path)
    for worker in workers:
        os.kill(worker, signal.SIGKILL)
    said = program.communicate(timeout=1000)[1]
    assert (program.returncode, said) == (0, "")
    assert content(tmp_path) == undisturbed


def test_a_run_whose_process_dies_again_and_again_is_a_row(tmp_path):
    plan_of(tmp_path, LONG.replace("runs: 8", "runs: 1").replace("10000", "1000000"))
    program = subprocess.Popen(command("rod.urdf", "plan.yaml", "--retries", 1, "--quiet"), cwd=tmp_path)
    killed = set()
    while program.poll() is None and len(killed) < 2:
        for worker in set(workers_of(program.pid)) - killed:
            os.kill(worker, signal.SIGKILL)
            killed.add(worker)
    assert program.wait(timeout=1000) == 0
    row, = rows_of(tmp_path)
    assert row["failure"] == "its process died of signal 9, 2 times" and row["angle"] == "nan"


def test_a_killed_sweep_goes_on_where_it_was(tmp_path, undisturbed):
    program, workers = begin(tmp_path)
    program.kill()
    program.communicate(timeout=1000)
    wait_until(lambda: not any(b"spawn_main" in command_of(worker) for worker in workers))  # the workers notice it
    done = rows_in(tmp_path)
    _, summary = sweep(tmp_path)
    assert summary.startswith("plan_results.csv: 8 runs, %d of them now" % (8 - done))
    assert content(tmp_path) == undisturbed


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_a_sweep_that_goes_on_later(tmp_path, undisturbed, number):
    program, workers = begin(tmp_path)
    program.send_signal(number)
    said = program.communicate(timeout=1000)[1]
    assert program.returncode == 128 + number
    assert said == ("flexarm: %d of 8 runs are in 'plan_results.csv'; the same command makes the others\n"
                    "flexarm: interrupted\n" % rows_in(tmp_path))
    assert not any(b"spawn_main" in command_of(worker) for worker in workers)
    sweep(tmp_path, "--quiet")
    assert content(tmp_path) == undisturbed


def test_two_sweeps_do_not_write_the_same_file(tmp_path, undisturbed):
    program, _ = begin(tmp_path)
    said, _ = sweep(tmp_path, status=2)
    assert "plan_results.csv' is being written by another sweep" in said
    assert program.communicate(timeout=1000)[1] == ""
    assert content(tmp_path) == undisturbed


def test_a_full_disk_is_told_and_repaired(folder):
    limited = ("import resource, sys, os; resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400)); "
               "os.execv(sys.argv[1], sys.argv[1:])")
    result = subprocess.run([sys.executable, "-c", limited, *command("rod.urdf", "plan.yaml")], cwd=folder, check=False,
                            stderr=subprocess.PIPE, universal_newlines=True, timeout=1000)
    assert result.returncode == 1
    assert "flexarm: [Errno 27] File too large" in result.stderr
    assert len(content(folder)) == 400
    sweep(folder, "--quiet")
    sweep(folder, "--quiet", "--output", "other.csv")
    assert content(folder) == content(folder, "other.csv")


# ---- messages

def test_a_terminal_shows_how_long_it_takes(folder):
    terminal, other_end = pty.openpty()
    plan_of(folder, LONG)
    with subprocess.Popen(command("rod.urdf", "plan.yaml", "--workers", 1), cwd=folder, stderr=other_end,
                          stdout=subprocess.DEVNULL) as program:
        os.close(other_end)
        shown = b""
        try:
            while piece := os.read(terminal, 4096):
                shown += piece
        except OSError:
            pass  # the other end is closed
        assert program.wait(timeout=1000) == 0
    os.close(terminal)
    assert b"] " in shown and b" of 8, " in shown and b" s left" in shown
    assert shown.endswith(b"\r\x1b[K")


def test_findings_about_the_scene_are_shown_once(tmp_path):
    plan_of(tmp_path, GRID, SCENE.replace('iyy="0.1"', 'iyy="0.5"'))
    said, _ = sweep(tmp_path)
    assert said.count("\n") == 1 and "rod.urdf:" in said and "warning" in said


@pytest.mark.parametrize("arguments, said", [
    (["--workers", "0"], "expected a whole number >= 1, got '0'"),
    (["--retries", "-1"], "expected"),
    (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "not allowed with argument"),
    (["--frobnicate"], "unrecognized arguments: --frobnicate"),
])
def test_wrong_options_are_refused(folder, arguments, said):
    assert said in sweep(folder, *arguments, status=2)[0]


def test_help_is_that_of_the_program():
    result = subprocess.run(command("--help"), check=True, stdout=subprocess.PIPE, universal_newlines=True)
    assert "usage: flexarm sweep" in result.stdout and "--scheduler ADDRESS" in result.stdout


def test_without_a_package_it_is_told_which_one(folder):
    write(folder, "sitecustomize.py", """
        import sys

        sys.modules["yaml"] = None
    """)
    result = subprocess.run(command("rod.urdf", "plan.yaml"), cwd=folder, check=False, stderr=subprocess.PIPE,
                            env={**os.environ, "PYTHONPATH": str(folder)}, universal_newlines=True)
    assert result.returncode == 1
    assert result.stderr == "flexarm: sweep needs Python's package 'yaml', Debian's python3-yaml\n"


def test_files_beside_the_scene_are_not_taken_for_modules(folder):
    for name in ("flexarm.py", "csv.py", "numpy.py", "plan.py"):
        write(folder, name, "raise SystemExit(77)")
    sweep(folder, "--quiet")


def test_the_package_can_be_used_by_itself(folder):
    subprocess.run([sys.executable, "-m", "flexarm.sweep", "rod.urdf", "plan.yaml", "--quiet"], cwd=folder, check=True)
    assert len(rows_of(folder)) == 12
