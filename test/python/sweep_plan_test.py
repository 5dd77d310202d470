"""Test plans of sweeps: every design, commands, and the messages of errors."""

import math

import numpy
import pytest
import scipy.stats

import flexarm
from flexarm.sweep.commands import Pulse, effort_rows
from flexarm.sweep.designs import Range
from flexarm.sweep.input import InputError
from sweeping import GRID, SCENE, outcomes, plan_of, write

TAIL = """
    until: 2
    measures: {angle: {final: joint/hinge/position}}
"""


def design(folder, text):
    return plan_of(folder, "    design:\n" + text + TAIL).design


def test_a_grid_has_every_value_with_every_other(tmp_path):
    plan = plan_of(tmp_path, GRID)
    assert plan.design.names == ("mass", "effort")
    efforts = numpy.linspace(0, 1, 4)
    assert plan.design.rows == tuple((mass, effort) for mass in (1, 2, 4) for effort in efforts)


def test_a_grid_may_be_logarithmic_and_have_constants(tmp_path):
    grid = design(tmp_path, """
      kind: grid
      parameters: {mass: {from: 0.1, to: 10, count: 3, scale: log}, effort: 0.25}
    """)
    assert numpy.allclose(grid.rows, [[0.1, 0.25], [1, 0.25], [10, 0.25]], rtol=1e-15)
    assert (grid.rows[0][0], grid.rows[2][0]) == (0.1, 10)


def sampled(folder, kind, runs=64, seed="seed: 3"):
    return design(folder, """
      kind: %s
      runs: %d
      %s
      parameters: {effort: {from: -2, to: 2}, mass: {from: 0.1, to: 10, scale: log}, kick: [0, 1, 2, 3]}
    """ % (kind, runs, seed))


def parts(rows):
    """Return the relative positions of values in their ranges, from 0 to 1, shape (runs, 3)."""
    effort, mass, kick = numpy.transpose(rows)
    return numpy.transpose([(effort + 2) / 4, (numpy.log10(mass) + 1) / 2, (kick + 0.5) / 4])


with_qmc = pytest.mark.skipif(
    not hasattr(scipy.stats, "qmc"), reason="these designs need scipy 1.7 or later")


@pytest.mark.parametrize("kind", [pytest.param("latin_hypercube", marks=with_qmc),
                                  pytest.param("sobol", marks=with_qmc), "random"])
def test_samples_are_in_their_ranges_and_the_same_for_the_same_seed(tmp_path, kind):
    rows = sampled(tmp_path, kind).rows
    assert len(rows) == 64 and len(set(rows)) == 64
    assert (0 <= parts(rows)).all() and (parts(rows) <= 1).all()
    assert rows == sampled(tmp_path, kind).rows
    assert rows != sampled(tmp_path, kind, seed="seed: 4").rows
    assert sampled(tmp_path, kind, seed="").rows == sampled(tmp_path, kind, seed="seed: 0").rows


@with_qmc
def test_a_latin_hypercube_has_one_run_in_each_slice(tmp_path):
    slices = numpy.floor(64 * parts(sampled(tmp_path, "latin_hypercube").rows)[:, :2])
    for parameter in slices.T:
        assert sorted(parameter) == list(range(64))


@with_qmc
def test_sobol_points_are_even(tmp_path):
    """Check Sobol points: of 2^n points, each of 2^n equal intervals has one, and each quarter of two parameters has
    equally many."""
    position = parts(sampled(tmp_path, "sobol").rows)
    for parameter in position.T[:2]:
        assert sorted(numpy.floor(64 * parameter)) == list(range(64))
    quarters = numpy.floor(2 * position[:, 0]) + 2 * numpy.floor(2 * position[:, 1])
    assert [numpy.count_nonzero(quarters == quarter) for quarter in range(4)] == [16] * 4
    assert numpy.count_nonzero(position[:, 2] < 0.25) == 16  # a list: each value equally often


@with_qmc
def test_fewer_sobol_points_are_the_first_of_more(tmp_path):
    assert sampled(tmp_path, "sobol", 50).rows == sampled(tmp_path, "sobol", 64).rows[:50]
    assert len(sampled(tmp_path, "sobol", 1).rows) == 1


def test_rows_are_inline_or_in_a_file(tmp_path):
    inline = design(tmp_path, """
      kind: rows
      rows:
        - {mass: 1, effort: 2e-1}
        - {effort: 0.4, mass: 3}
    """)
    write(tmp_path, "rows.csv", "mass, effort\n1,0.2\n\n3,0.4\n")
    assert inline.rows == ((1, 0.2), (3, 0.4))
    assert design(tmp_path, "      kind: rows\n      file: rows.csv") == inline


def test_constant_efforts_act_until_the_end(tmp_path):
    plan = plan_of(tmp_path, """
        design: {kind: grid, parameters: {mass: [1, 2]}}
        until: 2
        commands: {hinge: 0.7}
        measures:
          angle: {final: joint/hinge/position}
          effort: {mean: joint/hinge/effort, from: 0.1}
    """)
    for (mass,), (angle, effort) in zip(plan.design.rows, outcomes(plan)):
        simulation = flexarm.Simulation(flexarm.read_scene(plan.job.scene, parameters={"mass": mass}))
        simulation.command_effort("hinge", 0.7)
        simulation.run(20)
        assert angle == simulation.positions[0]
        assert math.isclose(effort, 0.7, rel_tol=1e-12)


def test_commands_may_be_a_file_of_the_demo(tmp_path):
    write(tmp_path, "commands.yaml", """
        period: 3
        commands:
          - {time: 0, names: [hinge], efforts: [1], duration: 0.5}
          - {time: 0.5, names: [hinge], efforts: [-2], duration: 0.05, repeat: 5, every: 0.1}
    """)
    plan = plan_of(tmp_path, """
        design: {kind: grid, parameters: {mass: 4}}
        until: 2
        commands: commands.yaml
        measures:
          left: {final: joint/hinge/velocity}
          angle: {final: joint/hinge/position}
    """)
    (left, angle), = outcomes(plan)
    tolerance = 20 * 1e-8 / 0.1  # Newton's tolerance in each of 20 steps [rad], as a velocity [rad/s]
    assert abs(left) < tolerance  # pulses shorter than steps keep their impulse: 1 0.5 - 2 5 0.05 N m s
    simulation = flexarm.Simulation(flexarm.read_scene(plan.job.scene, parameters={"mass": 4}))
    simulation.run(20, numpy.array([[1.0]] * 5 + [[-1.0]] * 5 + [[0.0]] * 10))
    assert abs(angle - simulation.positions[0]) < 20 * 1e-8


def test_efforts_of_a_step_are_the_mean_of_pulses():
    pulses = Pulse("a", 0.05, 0.3, 2.0), Pulse("b", 0.1, 0.2, 1.0), Pulse("a", 0.3, 0.4, 5.0)
    joints, efforts = effort_rows(pulses, 5, 0.1)
    assert joints == ["a", "b"]
    assert numpy.allclose(efforts, [[1, 0], [2, 1], [2, 0], [5, 0], [0, 0]], rtol=1e-12)


BROKEN = [
    # Text in GRID, its replacement, and the expected message with its line.
    ("kind: grid", "kind: cube",
     "3: design/kind: expected one of [grid, rows, latin_hypercube, sobol, random], got 'cube'"),
    ("mass: [1, 2, 4]", "mas: [1, 2, 4]",
     "5: design/parameters/mas: expected a parameter of the scene, one of [mass, effort, kick], got 'mas'"),
    ("mass: [1, 2, 4]", "mass: [1, 2, x]", "5: design/parameters/mass[3]: expected a finite number, got 'x'"),
    ("mass: [1, 2, 4]", "mass: [1, .nan]", "5: design/parameters/mass[2]: expected a finite number, got '.nan'"),
    ("mass: [1, 2, 4]", "mass: [1, 20]",
     "5: design/parameters/mass[2]: expected a value of at least 0.1 and at most 10, got 20"),
    ("mass: [1, 2, 4]", "mass: []", "5: design/parameters/mass: expected at least one value"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1", "6: design/parameters/effort: expected 'count' in it"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1, count: 4, step: 1",
     "6: design/parameters/effort/step: expected one of [from, to, count, scale]"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1, count: 0",
     "6: design/parameters/effort/count: expected a whole number >= 1, got '0'"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1, count: 2.5",
     "6: design/parameters/effort/count: expected a whole number >= 1, got '2.5'"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1, count: 4, scale: log",
     "6: design/parameters/effort/from: expected a number > 0 on a logarithmic scale, got '0'"),
    ("from: 0, to: 1, count: 4", "from: 0, to: 1, count: 400000",
     "5: design/parameters: expected at most 1000000 runs, got 1200000"),
    ("until: 2", "until: -2", "7: until: expected a number > 0, got '-2'"),
    ("until: 2", "until: [2]", "7: until: expected a number > 0, got a list"),
    ("until: 2", "until: 2\nuntil: 3", "8: 'until' is given twice"),
    ("until: 2", "untl: 2", "7: untl: expected one of [design, until, every, commands, measures, history]"),
    ("until: 2\n", "", "2: expected 'until' in it"),
    ("until: 2", "until: 2\nevery: 0", "8: every: expected a whole number >= 1, got '0'"),
    ("until: 2", "until: 2\ncommands: {elbow: 1}",
     "8: commands/elbow: expected a joint that takes efforts, one of [hinge], got 'elbow'"),
    ("until: 2", "until: 2\nhistory: xml", "8: history: expected one of [hdf5, csv], got 'xml'"),
    ("until: 2", "until: 2\nhistory: {format: csv, columns: [joint/elbow/*]}", "8: history/columns[1]: "),
    ("angle:", "run:", "9: measures/run: expected another name: results have a column 'run' already"),
    ("angle:", "mass:", "9: measures/mass: expected another name: results have a column 'mass' already"),
    ("angle:", "1st:", "9: measures/1st: expected a name of letters, digits and _, got '1st'"),
    ("{final: joint/hinge/position}", "joint/hinge/position",
     "9: measures/angle: expected a mapping with one of [maximum, minimum, mean, rms, final, value, settling_time], "),
    ("final:", "last:", "9: measures/angle: expected one of [maximum, "),
    ("final:", "value:", "9: measures/angle: expected 'at' in it"),
    ("final: joint/hinge/position", "value: joint/hinge/position, at: 3",
     "9: measures/angle/at: expected a time between 0 and 2, got '3'"),
    ("final: joint/hinge/position", "mean: joint/hinge/position, from: 1.5, to: 1",
     "9: measures/angle: expected 'from' before 'to'"),
    ("final: joint/hinge/position", "settling_time: joint/hinge/position, band: 0",
     "9: measures/angle/band: expected a number > 0, got '0'"),
    ("joint/hinge/position", "joint/elbow/position",
     "9: measures/angle/final: 'joint/elbow/position' is neither a column nor a parameter"),
    ("until: 2", "until: }", "7: "),
]


@pytest.mark.parametrize("old, new, said", BROKEN, ids=[said for _, _, said in BROKEN])
def test_errors_say_where_and_what_was_expected(tmp_path, old, new, said):
    text = GRID.replace("\n    ", "\n")
    assert old in text
    with pytest.raises(InputError) as error:
        plan_of(tmp_path, text.replace(old, new))
    assert str(error.value).startswith("%s:%s" % (tmp_path / "plan.yaml", said))


@pytest.mark.parametrize("table, said", [
    ("mass,length\n1,2\n", "1: expected a parameter of the scene, one of [mass, effort, kick], got 'length'"),
    ("mass,mass\n1,2\n", "1: expected each parameter once, got 'mass,mass'"),
    ("mass,effort\n1,2\n3\n", "3: expected 2 numbers, got 1"),
    ("mass,effort\n1,two\n", "2: effort: expected a finite number, got 'two'"),
    ("mass,effort\n100,2\n", "2: mass: expected a value of at least 0.1 and at most 10, got 100"),
    ("mass,effort\n", " expected a line of names and at least one of numbers"),
])
def test_errors_of_tables_say_where(tmp_path, table, said):
    path = write(tmp_path, "rows.csv", table)
    with pytest.raises(InputError) as error:
        design(tmp_path, "      kind: rows\n      file: rows.csv")
    assert str(error.value) == "%s:%s" % (path, said)


def test_errors_of_other_files_say_where(tmp_path):
    path = write(tmp_path, "commands.yaml", "commands:\n  - {time: 0, names: [hinge], efforts: [1, 2], duration: 1}\n")
    with pytest.raises(InputError) as error:
        plan_of(tmp_path, GRID + "    commands: commands.yaml\n")
    assert str(error.value) == "%s:2: commands[1]: expected one effort for each name, got 2 for 1" % path
    with pytest.raises(InputError, match="cannot read '.*none.yaml': No such file or directory"):
        plan_of(tmp_path, GRID + "    commands: none.yaml\n")
    with pytest.raises(InputError, match="rod.urdf:2: "):
        plan_of(tmp_path, GRID, "\n<robot")
    with pytest.raises(InputError, match="rod.urdf: expected a scene with a <parameter>"):
        plan_of(tmp_path, GRID, "<robot name='empty'> <link name='world'/> </robot>")


def test_a_plan_that_asks_for_nothing_is_refused(tmp_path):
    with pytest.raises(InputError, match="plan.yaml: expected 'measures' or 'history' in it"):
        plan_of(tmp_path, GRID[:GRID.index("    measures")])
    with pytest.raises(InputError, match="plan.yaml: expected a mapping, got nothing"):
        plan_of(tmp_path, "")


def test_hashes_tell_plans_and_scenes(tmp_path):
    first = plan_of(tmp_path, GRID)
    other = plan_of(tmp_path, GRID.replace("until: 2", "# comment\n    until: 2.0"))
    assert (first.plan_hash, first.scene_hash) == (other.plan_hash, other.scene_hash)
    for old, new in (("count: 4", "count: 5"), ("until: 2", "until: 3"), ("final", "mean"), ("speed", "rate"),
                     ("abs(joint/hinge/velocity)", "joint/hinge/velocity"), ("    until", "    every: 2\n    until")):
        assert plan_of(tmp_path, GRID.replace(old, new)).plan_hash != first.plan_hash
    assert plan_of(tmp_path, GRID, SCENE.replace("0.5 0 0", "0.4 0 0")).scene_hash != first.scene_hash


def test_samples_stay_in_their_ranges_whatever_round_off_does():
    for first, last in ((0.1, 0.7), (0.7, 0.1), (3e-9, 1.1e5)):
        for is_logarithmic in (False, True):
            axis = Range(first, last, None, is_logarithmic)
            for part in (0.0, 0.5, 1 - 2**-53, 1.0):
                assert min(first, last) <= axis.at(part) <= max(first, last)
