"""Helpers of the tests of sweeps: a scene of one rod, which is quick, and functions that sweep over it."""

import os
import subprocess
import textwrap

from conftest import hinged_rod
from flexarm.sweep.plan import read_plan
from flexarm.sweep.run import perform

# With a kick of 1e4 N m, steps after 1 s fail: they may not be halved, and Newton's method gets too few iterations.
SCENE = hinged_rod("0 1 0", "0.5 0 0", (1e-4, 0.1, 0.1), """
    <gravity xyz="0 0 0"/>
    <integrator step="0.1" max_iterations="4" max_halvings="0"/>
    <effort joint="hinge" history="t &lt; 0.95 ? ${effort} : ${kick}"/>
    <probe name="tip" link="rod" at="1 0 0"/>""", mass="${mass}", parameters="""\
  <parameter name="mass" value="1" min="0.1" max="10"/>
  <parameter name="effort" value="0.5"/>
  <parameter name="kick" value="0"/>
""")

GRID = """
    design:
      kind: grid
      parameters:
        mass: [1, 2, 4]
        effort: {from: 0, to: 1, count: 4}
    until: 2
    measures:
      angle: {final: joint/hinge/position}
      speed: {maximum: abs(joint/hinge/velocity)}
"""

# Runs of some tenths of a second, so that tests can interrupt them.
LONG = """
    design:
      kind: random
      runs: 8
      parameters: {effort: {from: -1, to: 1}}
    until: 10000
    every: 50000
    measures: {angle: {final: joint/hinge/position}}
"""


def write(folder, name, text):
    path = folder / name
    path.write_text(textwrap.dedent(text))
    return path


def plan_of(folder, text, scene=SCENE):
    return read_plan(str(write(folder, "rod.urdf", scene)), str(write(folder, "plan.yaml", text)))


def outcomes(plan):
    """Yield the measures of each run, made in this process. Check that none fails."""
    for number, row in enumerate(plan.design.rows, 1):
        outcome = perform(plan.job, number, dict(zip(plan.design.names, row)), "")
        assert outcome.failure == ""
        yield outcome.measures


def command(*arguments):
    return [os.environ["FLEXARM_PROGRAM"], "sweep", *map(str, arguments)]


def sweep(folder, *arguments, status=0):
    """Run `flexarm sweep rod.urdf plan.yaml ...` in the folder. Return its error output and its standard output."""
    result = subprocess.run(command("rod.urdf", "plan.yaml", *arguments), cwd=folder, check=False,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=1000)
    assert result.returncode == status, result.stderr
    return result.stderr, result.stdout
