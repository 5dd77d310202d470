"""Test sweeps on the workers of a Dask scheduler."""

import contextlib
import os
import signal
import socket
import subprocess
import time

import pytest

from sweeping import GRID, LONG, command, plan_of, sweep

distributed = pytest.importorskip("distributed", reason="python3-distributed is not installed")
# Before version 2 the option had the name of the dashboard's library.
NO_DASHBOARD = "--no-dashboard" if int(distributed.__version__.split(".")[0]) >= 2 else "--no-bokeh"


def free_port():
    with socket.socket() as place:
        place.bind(("127.0.0.1", 0))
        return place.getsockname()[1]


@contextlib.contextmanager
def programs(*commands):
    """Run programs until the end of the block."""
    running = [subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for words in commands]
    try:
        yield running
    finally:
        for program in running:
            program.kill()
            program.wait()


def scheduler(address, *options):
    host, port = address[len("tcp://"):].split(":")
    # The scheduler gives up a run after its worker has died once.
    setting = "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES=0"
    return ["env", setting, "dask-scheduler", "--host", host, "--port", port, NO_DASHBOARD, *options]


def worker(address, folder):
    return ["dask-worker", address, "--nthreads", "1", "--no-nanny", NO_DASHBOARD, "--local-directory", str(folder)]


@pytest.fixture
def address():
    return "tcp://127.0.0.1:%d" % free_port()


def begin(folder, address, *options):
    return subprocess.Popen(command("rod.urdf", "plan.yaml", "--scheduler", address, *options), cwd=folder,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


def wait_for_rows(folder, count):
    path = folder / "plan_results.csv"
    end = time.monotonic() + 120
    while not path.exists() or path.read_bytes().count(b"\n") < 2 + count:
        assert time.monotonic() < end
        time.sleep(0.02)


def test_two_workers_give_the_results_of_processes(tmp_path, address):
    plan_of(tmp_path, GRID + "    history: csv\n")
    sweep(tmp_path, "--quiet", "--output", "here.csv")
    by_file = str(tmp_path / "scheduler.json")
    workers = [worker(address, tmp_path)] * 2
    with programs(scheduler(address, "--scheduler-file", by_file), *workers):
        assert sweep(tmp_path, "--scheduler", address)[1].startswith("plan_results.csv: 12 runs, 12 of them now")
        assert (tmp_path / "plan_results.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()
        for name in os.listdir(tmp_path / "here_histories"):
            there, here = (tmp_path / (stem + "_histories") / name for stem in ("plan_results", "here"))
            assert there.read_bytes() == here.read_bytes()
        # Failed runs are rows in the results, and so are impossible scenes.
        plan_of(tmp_path, """
            design: {kind: rows, rows: [{kick: 0}, {kick: 1e4}]}
            until: 2
            measures: {angle: {final: joint/hinge/position}}
        """)
        for place in (["--scheduler", by_file, "--output", "there.csv"], ["--output", "at_home.csv"]):
            assert "; 1 failed" in sweep(tmp_path, *place)[1]
        assert (tmp_path / "there.csv").read_bytes() == (tmp_path / "at_home.csv").read_bytes()


def test_a_killed_worker_costs_its_run_and_a_killed_sweep_goes_on(tmp_path, address):
    plan_of(tmp_path, LONG)
    sweep(tmp_path, "--quiet", "--output", "here.csv")
    with programs(scheduler(address), worker(address, tmp_path), worker(address, tmp_path)) as (_, victim, _):
        program = begin(tmp_path, address)
        wait_for_rows(tmp_path, 1)
        victim.send_signal(signal.SIGKILL)
        wait_for_rows(tmp_path, 2)
        program.kill()
        program.communicate(timeout=1000)
        sweep(tmp_path, "--scheduler", address)
    assert (tmp_path / "plan_results.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()


def test_a_run_whose_worker_dies_may_be_a_row(tmp_path, address):
    plan_of(tmp_path, LONG.replace("runs: 8", "runs: 2").replace("10000", "200000"))
    with programs(scheduler(address), worker(address, tmp_path)) as (_, victim):
        program = begin(tmp_path, address, "--retries", "0")
        wait_for_rows(tmp_path, 1)
        victim.send_signal(signal.SIGKILL)
        program.communicate(timeout=1000)
    assert program.returncode == 0
    rows = (tmp_path / "plan_results.csv").read_text().splitlines()[2:]
    reason = ",nan,its worker died more often than the scheduler allows"
    assert sorted(row.endswith(reason) for row in rows) == sorted(row.endswith(",") for row in rows) == [False, True]


def test_without_a_scheduler_it_is_told(tmp_path, address):
    plan_of(tmp_path, GRID)
    said, _ = sweep(tmp_path, "--scheduler", address, status=2)
    assert "flexarm: --scheduler: cannot connect to '%s'" % address in said
    said, _ = sweep(tmp_path, "--scheduler", "nonsense://x", status=2)
    assert "--scheduler: cannot connect to 'nonsense://x'" in said


def test_a_scheduler_that_is_gone_ends_the_sweep(tmp_path, address):
    plan_of(tmp_path, LONG)
    with programs(scheduler(address), worker(address, tmp_path)) as (gone, _):
        program = begin(tmp_path, address)
        wait_for_rows(tmp_path, 1)
        gone.send_signal(signal.SIGKILL)
        said = program.communicate(timeout=1000)[1]
    assert program.returncode == 1
    assert "flexarm: the scheduler at '%s' is gone" % address in said
    sweep(tmp_path, "--quiet")
    sweep(tmp_path, "--quiet", "--output", "here.csv")
    assert (tmp_path / "plan_results.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()
