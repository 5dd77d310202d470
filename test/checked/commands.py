#!/usr/bin/python3
"""Run the commands of a program `flexarm` that was built with sanitizers over scenes, each for a short time.

    commands.py [--every N] PROGRAM BENCHMARKS

Scenes in config/ and in test/ get all commands. Of all pairs of a hard case of BENCHMARKS (`flexarm bench hard`) and a
command, every N-th is tried. A command must end by itself, with a status of its own and without a word of a sanitizer.
A command that uses up its processor time is stopped, which is no failure: sanitizers are slow, and some equilibria are
far away.
"""

import argparse
import collections
import concurrent.futures
import itertools
import os
import re
import resource
import subprocess
import sys
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
STEPS = 5  # of each simulation
SECONDS = 2  # of processor time for each command
PATIENCE = 3000  # s, wall time: at idle priority it may be long; who uses neither this nor its processor time hangs
OWN_STATUS = (0, 1, 2)  # see src/cli/exit_status.h
HARM = re.compile(r"runtime error: |ERROR: \w+Sanitizer|Assertion `|terminate called|malloc\(\)|free\(\)|core dumped")

Run = collections.namedtuple("Run", "scene words outcome said")


def commands(scene):
    """Yield the words of each command for a scene file."""
    with open(scene, encoding="utf-8") as file:
        step = re.search(r"<integrator\b[^>]*\bstep\s*=\s*[\"']([0-9.eE+-]+)[\"']", file.read())
    until = "%.17g" % (STEPS * float(step.group(1) if step else 1e-3))
    yield "check", scene
    yield "static", scene, "--page", "static.html", "--output", "static.csv"
    yield "modes", scene, "--page", "modes.html", "--json"
    yield "linearise", scene
    yield "simulate", scene, "--until", until, "--output", "run.csv"
    yield "show", scene, "--until", until, "--output", "run.html"


def run(program, words):
    """Run one command in a folder of its own."""

    def limit_time():
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))

    with tempfile.TemporaryDirectory() as folder:
        try:
            result = subprocess.run(
                [program, *words],
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                encoding="utf-8",
                errors="replace",
                preexec_fn=limit_time,
                timeout=PATIENCE,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return Run(words[1], words, "hangs", "")
    if HARM.search(result.stdout):
        outcome = "does harm"
    elif -result.returncode in (24, 9):  # SIGXCPU, SIGKILL: its processor time is used up
        outcome = "stopped"
    else:
        outcome = "done" if result.returncode in OWN_STATUS else "status %d" % result.returncode
    return Run(words[1], words, outcome, result.stdout)


def files_of_scenes():
    for top in ("config", "test"):
        for parent, _, names in sorted(os.walk(os.path.join(ROOT, top))):
            for name in sorted(names):
                if name.endswith(".urdf"):
                    yield os.path.join(parent, name)


def hard_scenes(benchmarks, folder):
    """Write the hard cases as files, and yield their paths."""
    text = subprocess.run([benchmarks, "hard", "--print"], stdout=subprocess.PIPE, encoding="utf-8", check=True).stdout
    for number, scene in enumerate(re.findall(r"<!--.*?-->\n.*?</robot>", text, re.DOTALL)):
        path = os.path.join(folder, "hard_%d.urdf" % number)
        with open(path, "w", encoding="utf-8") as file:
            file.write(re.sub(r"^<!--.*?-->\n", "", scene, count=1))
        yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("benchmarks", type=os.path.abspath)
    options = parser.parse_args()
    # The tests of the rooms look for leaks. The end of a program that is stopped is no leak.
    os.environ["ASAN_OPTIONS"] = "detect_leaks=0:strict_string_checks=1"
    os.environ["UBSAN_OPTIONS"] = "print_stacktrace=1"
    with tempfile.TemporaryDirectory() as folder:
        own = [words for scene in files_of_scenes() for words in commands(scene)]
        hard = [words for scene in hard_scenes(options.benchmarks, folder) for words in commands(scene)]
        if not own or not hard:
            sys.exit("there are no scenes")
        # Unless N and the number of commands have a common factor, all commands get their turn.
        chosen = own + hard[:: options.every]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
            runs = list(threads.map(run, itertools.repeat(options.program), chosen))
        counts = collections.Counter(each.outcome for each in runs)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        print("%d commands in %.0f s of processor time: %s" % (len(runs), used.ru_utime + used.ru_stime, dict(counts)))
        for each in runs:
            if each.outcome in ("done", "stopped"):
                continue
            print("\n%s: flexarm %s\n%s" % (each.outcome, " ".join(each.words), each.said[-4000:]))
            if each.scene.startswith(folder):
                with open(each.scene, encoding="utf-8") as file:
                    print(file.read())
    if set(counts) - {"done", "stopped"}:
        sys.exit(1)


if __name__ == "__main__":
    main()
