"""Test the example of docs/sweep.md, and the lists of kinds and functions there."""

import csv
import os
import re
import shutil
import subprocess

import pytest
import scipy.stats
from conftest import ROOT
from flexarm.sweep.designs import SAMPLES
from flexarm.sweep.expressions import FUNCTIONS
from flexarm.sweep.measures import KINDS

with open(os.path.join(ROOT, "docs", "sweep.md"), encoding="utf-8") as file:
    TEXT = file.read()


@pytest.mark.skipif(not hasattr(scipy.stats, "qmc"), reason="the example needs scipy 1.7 or later")
def test_the_example_runs_as_it_stands(tmp_path):
    for name in ("slewing_arm.urdf", "slewing_arm_plan.yaml"):
        shutil.copy(os.path.join(ROOT, "config", "sweep", name), tmp_path)
    commands = re.findall(r"^```sh\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)
    assert len(commands) == 2
    path = os.path.dirname(os.environ["FLEXARM_PROGRAM"]) + ":" + os.environ["PATH"]
    result = subprocess.run(["bash", "-euc", "\n".join(commands)], cwd=tmp_path, env={**os.environ, "PATH": path},
                            check=True, stdout=subprocess.PIPE, universal_newlines=True)
    assert len(re.findall("^.* kg, .* N m: .* m/s for each radian$", result.stdout, re.MULTILINE)) == 2
    with open(tmp_path / "slewing_arm_plan_results.csv", encoding="utf-8", newline="") as file:
        file.readline()
        rows = list(csv.DictReader(file))
    assert len(rows) == 200 and {row["failure"] for row in rows} == {""}
    # The purpose of the demo: light payloads swing for long, and some slews do not swing at all.
    settled = [row["settling_time"] != "nan" for row in rows]
    assert any(settled) and not all(settled)


def test_the_plan_is_the_one_of_the_file():
    plan = re.search(r"^```yaml\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE).group(1)
    with open(os.path.join(ROOT, "config", "sweep", "slewing_arm_plan.yaml"), encoding="utf-8") as file:
        assert file.read().split("\n", 1)[1] == plan


def test_all_kinds_and_functions_are_listed():
    for word in ("grid", "rows", *SAMPLES, *KINDS):
        assert "`%s`" % word in TEXT, word
    listed = re.search(r"`(abs\s.*?)`", TEXT, re.DOTALL).group(1).split()
    assert sorted(listed + ["min", "max"]) == sorted(FUNCTIONS)
