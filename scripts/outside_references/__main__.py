#!/usr/bin/python3
"""Computes references for `flexarm bench accuracy` without flexarm: equations from its documentation, solved by scipy.

outside_references --output FOLDER [--only TEXT]      writes scenes and their motions
outside_references --judge SCENE.urdf [--until 2]     runs a scene in flexarm, and prints the true errors
"""

import argparse
import csv
import multiprocessing
import os
import re
import subprocess
import sys
import tempfile
from concurrent import futures

import numpy as np

from mechanism import Refused
from motion import TOLERANCE, Motion
from scenes import all_scenes

INTERVALS = 100
BAD = 1e-9  # relative to how far points move: if two runs of a reference differ by more, the reference is refused
COLUMNS = ["file", "group", "name", "cornered", "until", "intervals", "disagreement", "events", "reference"]


class BadReference(RuntimeError):
    """Two runs of a reference do not agree."""


def scale(points):
    """The largest distance of the points from their initial positions [m]."""
    return np.linalg.norm(points - points[0], axis=2).max()


def difference(points, reference):
    """The relative error as in flexarm's motion_error(): the worst point's root mean square over time."""
    squares = ((points - reference) ** 2).sum(axis=2)
    squares[0] *= 0.5
    squares[-1] *= 0.5
    return float(np.sqrt(squares.sum(axis=0) / (len(points) - 1)).max() / scale(reference))


def reference(text, until, intervals=INTERVALS):
    """Returns (times, positions (times, points, 3), difference of two runs, number of corners on the way)."""
    motion = Motion(text, until)
    times = np.linspace(0, until, intervals + 1)
    points = motion.run(times)
    events = motion.events
    other = motion.run(times, 20 * TOLERANCE, until / 37.3)
    gap = difference(other, points)
    if not gap < BAD:
        raise BadReference(f"two runs of the reference differ by {gap:.2g} of its way")
    return times, points, gap, events


def file_name(scene):
    return re.sub(r"[^a-z0-9.]+", "_", f"{scene.group} {scene.name}".lower())


def write(folder, scene):
    """Writes the files of a scene. Returns its line for the index."""
    stem = file_name(scene)
    with open(os.path.join(folder, stem + ".urdf"), "w", encoding="utf-8") as file:
        file.write(scene.text)
    line = [stem, scene.group, scene.name, int(scene.is_cornered), scene.until, INTERVALS]
    if not scene.is_rigid:
        return line + [0, 0, "finer"]
    times, points, gap, events = reference(scene.text, scene.until)
    with open(os.path.join(folder, stem + ".csv"), "w", encoding="utf-8") as file:
        count = points.shape[1]
        file.write("time" + "".join(f",{axis}{i}" for i in range(count) for axis in "xyz") + "\n")
        for time, row in zip(times, points.reshape(len(times), -1)):
            file.write(",".join(f"{value:.17g}" for value in (time, *row)) + "\n")
    return line + [f"{gap:.3g}", events, "outside"]


def generate(folder, only, jobs):
    scenes = [scene for scene in all_scenes() if only in f"{scene.group}: {scene.name}"]
    os.makedirs(folder, exist_ok=True)
    rows, failures = [], 0
    # Other ways to start a process, the default from Python 3.14 on, do not find functions of a folder's __main__.
    with futures.ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("fork")) as pool:
        waiting = [(scene, pool.submit(write, folder, scene)) for scene in scenes]
        for scene, result in waiting:
            try:
                rows.append(result.result())
            except (Refused, RuntimeError, ValueError, ArithmeticError) as error:
                failures += 1
                print(f"outside_references: {scene.group}: {scene.name}: {error}", file=sys.stderr)
    with open(os.path.join(folder, "index.csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)
    return 1 if failures else 0


def default_program():
    here = os.path.dirname(os.path.abspath(__file__))
    places = [os.path.join(here, "..", "flexarm"), os.path.join(here, "..", "..", "devel", "lib", "flexarm", "flexarm")]
    return next((place for place in places if os.path.exists(place)), "flexarm")


def simulated(program, path, until, options):
    """Runs flexarm. Returns (positions of the probes, its output)."""
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "run.csv")
        run = subprocess.run([program, "simulate", path, "--until", repr(until), "--output", output, *options],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        said = run.stdout.decode()
        if not os.path.exists(output):
            return None, said
        with open(output, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    names = [key[6:-2] for key in rows[0] if key.startswith("probe/") and key.endswith("/x")]
    return np.array([[[float(row[f"probe/{name}/{axis}"]) for axis in "xyz"] for name in names] for row in rows]), said


def judge(arguments):
    text = open(arguments.judge, encoding="utf-8").read()
    _, points, gap, events = reference(text, arguments.until)
    print(f"reference: both runs agree to {gap:.1e}, {events} corners met, points come {scale(points):.4g} m far")
    steps = [("--step", repr(step)) for step in arguments.step]
    runs = [("--accuracy", repr(accuracy)) for accuracy in arguments.accuracy] if not steps else steps
    for option, value in runs:
        every = (["--interval", repr(arguments.until / INTERVALS)] if option == "--accuracy"
                 else ["--every", str(round(arguments.until / INTERVALS / float(value)))])
        if arguments.scheme:
            every += ["--scheme", arguments.scheme]
        found, said = simulated(arguments.program, arguments.judge, arguments.until, [option, value, *every])
        last = said.strip().splitlines()[-1] if said.strip() else ""
        if found is None or found.shape != points.shape:
            print(f"{option} {value}: no such run: {last}")
            continue
        error = difference(found, points)
        ratio = f", {error / float(value):.3g} times the requested one" if option == "--accuracy" else ""
        line = next((line for line in said.splitlines() if "accuracy" in line or "error" in line), last)
        print(f"{option} {value}: true error {error:.3e}{ratio}; {line.strip()}")
    return 0


def main():
    parser = argparse.ArgumentParser(prog="outside_references", description=__doc__.splitlines()[0])
    parser.add_argument("--output", help="folder for scenes, motions and their index.csv")
    parser.add_argument("--only", default="", help="only scenes with this text in 'GROUP: NAME'")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="number of processes")
    parser.add_argument("--list", action="store_true", help="prints the names of the scenes")
    parser.add_argument("--judge", metavar="SCENE.urdf", help="runs a scene by flexarm and prints its true errors")
    parser.add_argument("--until", type=float, default=2.0, help="end of the judged run [s]")
    parser.add_argument("--accuracy", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4, 1e-5])
    parser.add_argument("--step", type=float, nargs="+", default=[], help="fixed steps instead of accuracies [s]")
    parser.add_argument("--scheme", help="scheme of the judged run")
    parser.add_argument("--program", default=default_program(), help="path of flexarm")
    arguments = parser.parse_args()
    try:
        if arguments.list:
            for scene in all_scenes():
                print(f"{scene.group}: {scene.name}")
            return 0
        if arguments.judge:
            return judge(arguments)
        if arguments.output:
            return generate(arguments.output, arguments.only, arguments.jobs)
    except (Refused, BadReference, OSError) as error:
        print(f"outside_references: {error}", file=sys.stderr)
        return 1
    parser.error("one of --output, --judge, --list is needed")
    return 2


if __name__ == "__main__":
    sys.exit(main())
