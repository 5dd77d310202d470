"""Test what type checkers know of the package: its stubs and its annotations."""

import ast
import os
import re
import subprocess
import sys

import numpy
import pytest

import flexarm
import flexarm._flexarm

mypy = pytest.importorskip("mypy.version")
pytestmark = pytest.mark.skipif(tuple(map(int, numpy.__version__.split(".")[:2])) < (1, 20),
                                reason="numpy says nothing of its types before 1.20")

PACKAGE = os.path.dirname(flexarm._flexarm.__file__)
# Differences that the checker shall ignore. Classes made by pybind11 have another metaclass and no constructor. The
# stand-ins for gymnasium are defined twice. A name that is imported for types alone does not exist at run time.
OVERLOOKED = r"""
flexarm(\._flexarm|\.environment)?\.(Batch|Scene|Simulation|State|StepResult)(\.__init__)?
flexarm(\._flexarm)?\.(LinearModel|RunEvent|Sensitivities)(\.__init__)?
flexarm(\._flexarm)?\.Recording(\.__init__)?
flexarm\.spaces\..*-redefinition
flexarm\.values\.Scene
"""

GOOD = """
import typing

import numpy
import flexarm

simulation = flexarm.Simulation("arm.urdf", step=1e-3)
rows = simulation.run(10, record=["time"])
number: float = rows[0, 0] + simulation.energies.total + simulation.natural_modes(1)[0].frequency
simulation.run(10, numpy.zeros(2))
simulation.apply_wrenches([flexarm.Wrench("hand", force=(0, 0, 1))])
model, values = simulation.linearise(about="steady").reduced(4)
names: typing.List[str] = model.states
version: str = flexarm.__version__
run = flexarm.Run(["time"], ["s"], rows)
largest: float = run.minus(flexarm.read_run("arm.h5")).times.max() + run.spectrum("time").amplitudes[0]


def reward(observation: numpy.ndarray, action: numpy.ndarray, simulation: flexarm.Simulation) -> float:
    return simulation.mass


environment = flexarm.VectorEnvironment(simulation, reward, num_envs=2)
observations, infos = environment.reset(seed=1)
"""
# Each of these lines is wrong.
BAD = """
flexarm.Simulation(3)
simulation.run("10")
simulation.linearise(about="now")
simulation.frobnicate()
simulation.time = 2.0
flexarm.read_scene("arm.urdf", {}, True)
"""


def run(tmp_path, *command):
    """Run a Python module with only the package's API on the path, without messages and program folders. Return its
    status and output."""
    own = tmp_path / "own" / "flexarm"
    own.mkdir(parents=True, exist_ok=True)
    for name in os.listdir(PACKAGE):
        if os.path.isfile(os.path.join(PACKAGE, name)) and not (own / name).exists():
            (own / name).symlink_to(os.path.join(PACKAGE, name))
    (tmp_path / "mypy.ini").write_text(
        "[mypy]\nstrict = True\ndisallow_any_generics = False\ncache_dir = /dev/null\n"
        "[mypy-gymnasium.*]\nignore_missing_imports = True\n[mypy-flexarm.*]\nwarn_unused_ignores = False\n"
        "disallow_subclassing_any = False\n")
    result = subprocess.run([sys.executable, "-m", *command], cwd=tmp_path,
                            env=dict(os.environ, MYPYPATH="own", PYTHONPATH="own:" + os.environ.get("PYTHONPATH", "")),
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    print(result.stdout)
    return result.returncode, result.stdout


def test_programs_are_checked(tmp_path):
    (tmp_path / "good.py").write_text(GOOD)
    assert run(tmp_path, "mypy", "good.py")[0] == 0
    (tmp_path / "bad.py").write_text(GOOD + BAD)
    said = run(tmp_path, "mypy", "bad.py")[1]
    first = (GOOD + BAD).split("\n").index("flexarm.Simulation(3)") + 1
    for line in range(first, first + BAD.strip().count("\n") + 1):
        assert "bad.py:%d: error" % line in said


def test_the_package_itself_is_checked(tmp_path):
    modules = ("flexarm." + name for name in ("errors", "values", "spaces", "environment",
                                           "cut_hdf5", "result_files", "results"))
    assert run(tmp_path, "mypy", *(word for module in modules for word in ("-m", module)))[0] == 0


def test_stubs_have_all_names_and_no_others(tmp_path):
    (tmp_path / "overlooked").write_text(OVERLOOKED)
    assert run(tmp_path, "mypy.stubtest", "flexarm", "--mypy-config-file", "mypy.ini", "--allowlist", "overlooked",
               "--ignore-unused-allowlist")[0] == 0


def functions():
    """Return the functions of the extension module: (name, the object, its declarations in the stub)."""
    with open(os.path.join(PACKAGE, "_flexarm.pyi"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    found = {}
    for node in tree.body:
        owner = node.name if isinstance(node, ast.ClassDef) else None
        for each in node.body if owner else [node]:
            if isinstance(each, ast.FunctionDef) and not each.decorator_list or is_overload(each):
                thing = getattr(flexarm._flexarm, owner) if owner else flexarm._flexarm
                found.setdefault((owner, each.name), (getattr(thing, each.name), []))[1].append(each)
    return found


def is_overload(node):
    return isinstance(node, ast.FunctionDef) and any(getattr(each, "id", "") == "overload"
                                                     for each in node.decorator_list)


def test_arguments_have_the_names_of_the_module():
    """Check names of arguments, which stubtest cannot see: the module has them only in its docstrings."""
    seen = 0
    for (owner, name), (thing, declarations) in functions().items():
        if name.startswith("__") and name != "__init__":
            continue
        told = re.findall(r"(?<=[(\s])(\w+): ", thing.__doc__.split("\n")[0])
        for declaration in declarations:
            assert [each.arg for each in declaration.args.args + declaration.args.kwonlyargs] == told, (owner, name)
        seen += 1
    assert seen > 40
