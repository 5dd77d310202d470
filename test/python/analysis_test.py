"""Test statics, modes, linear models and runs to an accuracy in Python."""

import math

import numpy
import pytest

import flexarm
from conftest import bits, command_line, example, hinged_rod, read_csv


def test_statics_are_those_of_the_command_line(tmp_path):
    path = tmp_path / "static.csv"
    status, said = command_line("static", example("cantilever"), "--output", path)
    assert status == 0, said
    names, rows = read_csv(path)
    simulation = flexarm.Simulation(flexarm.read_scene(example("cantilever")))
    simulation.solve_static()
    columns = [name for name in names if not name.startswith("solver/")]
    assert columns == names
    assert bits(simulation.row(names)) == bits(rows[0])
    assert simulation.energies.strain > 0 and simulation.energies.kinetic == 0


def test_no_equilibrium(tmp_path):
    """A rotor with a constant moment has no equilibrium."""
    path = tmp_path / "rotor.urdf"
    path.write_text(hinged_rod("0 0 1", "0 0 0", (1, 1, 1), '<effort joint="hinge" history="1"/>'))
    simulation = flexarm.Simulation(flexarm.read_scene(path))
    before = bits(simulation.row())
    with pytest.raises(flexarm.StepError) as caught:
        simulation.solve_static()
    status, said = command_line("static", path)
    assert status == 1
    assert said == "flexarm: %s\n" % caught.value
    assert bits(simulation.row()) == before
    with pytest.raises(ValueError):
        simulation.solve_static(load_steps=0)


def test_a_warning_says_what_falls():
    """A rod stands upright on a hinge; gravity pulls it down."""
    simulation = flexarm.Simulation(flexarm.read_scene_text(hinged_rod("0 1 0", "0 0 1", (0.1, 0.1, 0.1))))
    with pytest.warns(flexarm.SceneWarning, match="would fall from it"):
        simulation.solve_static(stable=False)
    assert bits(simulation.positions) == bits(numpy.zeros(1))
    with pytest.warns(flexarm.SceneWarning, match="stable=False"):
        simulation.solve_static()
    assert abs(simulation.positions[0]) == pytest.approx(math.pi)


def test_modes():
    with open(example("rigid_double_pendulum"), encoding="utf-8") as file:
        text = file.read().replace('<dynamics damping="0.01" friction="0.002"/>', "")
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    simulation.set_joint_state({"shoulder": math.pi / 2})  # the arm hangs
    modes = simulation.natural_modes(2)
    # The equations of two rods, M q'' + K q = 0 in the absolute angles of the rods, by Lagrange.
    length, mass, gravity = 1.0, 1.0, 9.81
    inertia = 0.0833333333333 + mass * length**2 / 4
    m = numpy.array([[inertia + mass * length**2, mass * length**2 / 2], [mass * length**2 / 2, inertia]])
    k = numpy.diag([1.5 * mass * gravity * length, 0.5 * mass * gravity * length])
    expected = numpy.sort(numpy.sqrt(numpy.linalg.eigvals(numpy.linalg.solve(m, k)))) / (2 * math.pi)
    for mode, frequency in zip(modes, expected):
        assert mode.frequency == pytest.approx(frequency, rel=1e-9)
        assert mode.rate == pytest.approx(0, abs=1e-9)
        assert mode.node_motion.shape == (simulation.node_count, 6) and mode.joint_motion.shape == (2,)
        assert mode.node_motion.dtype == mode.joint_motion.dtype == complex
        assert abs(mode.node_motion).max() == pytest.approx(1)
    with pytest.raises(ValueError):
        simulation.natural_modes(0)


def floating_robot(seed):
    """The text of a scene: a floating base with two to six joints in a chain, some damped, some with springs."""
    draw = numpy.random.RandomState(seed)
    vector = lambda size: " ".join("%.17g" % x for x in draw.uniform(-size, size, 3))  # noqa: E731
    inertial = lambda: """<inertial> <origin xyz="%s" rpy="%s"/> <mass value="%.17g"/> <inertia ixx="%.17g" iyy="%.17g"
      izz="%.17g" ixy="0" ixz="0" iyz="0"/> </inertial>""" % (  # noqa: E731
        vector(0.3), vector(3), draw.uniform(0.2, 5), *draw.uniform(0.02, 0.03, 3))
    parts, springs = ['<link name="0"> %s </link>' % inertial()], []
    for i in range(draw.randint(2, 7)):
        damping = draw.choice([0, 1]) * draw.uniform(0.05, 0.3)
        parts.append("""<joint name="j%d" type="continuous"> <parent link="%d"/> <child link="%d"/> <axis xyz="%s"/>
          <origin xyz="%s"/> <dynamics damping="%.17g"/> </joint> <link name="%d"> %s </link>""" % (
              i, i, i + 1, vector(1), vector(0.5), damping, i + 1, inertial()))
        if draw.rand() < 0.5:
            springs.append('<spring joint="j%d" stiffness="%.17g"/>' % (i, draw.uniform(1, 50)))
    return """<robot name="robot"> %s %s <simulation> <root type="floating"/> </simulation> </robot>""" % (
        " ".join(parts), " ".join(springs))


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.filterwarnings("ignore")
def test_modes_are_those_of_the_linear_model(seed):
    """A falling robot: eigenvalues of M, D and K, without those that are 0, by scipy. Gravity has no effect on them."""
    scipy_linalg = pytest.importorskip("scipy.linalg")
    text = floating_robot(seed)
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    model = simulation.linearise()
    size = len(model.coordinates)
    m, d, k = model.mass, model.damping, model.stiffness
    without = flexarm.Simulation(flexarm.read_scene_text(text.replace(
        '<root type="floating"/>', '<root type="floating"/> <gravity xyz="0 0 0"/>')))
    numpy.testing.assert_allclose(k, without.linearise().stiffness, atol=1e-12 * max(1, abs(k).max()))
    first = numpy.block([[numpy.zeros((size, size)), numpy.eye(size)], [-k, -d]])
    second = scipy_linalg.block_diag(numpy.eye(size), m)
    # Motions without stiffness and damping have double eigenvalues 0, which round-off splits by its square root.
    expected = scipy_linalg.eigvals(first, second)
    scale = abs(expected).max()
    expected = sorted(expected[expected.imag > -1e-9 * scale], key=abs)
    modes = simulation.natural_modes(2 * size)
    found = sorted((complex(mode.rate, 2 * math.pi * mode.frequency) for mode in modes
                    if mode.rate or mode.frequency), key=abs)
    assert all(mode.rate <= 0 for mode in modes)
    expected = [value for value in expected if abs(value) > 1e-5 * scale]
    assert len(found) == len(expected)
    for value, own in zip(expected, found):
        assert abs(own - value) < 1e-7 * abs(value)
    poles = [pole for pole in model.poles() if abs(pole) > 1e-9 * scale]
    assert len(poles) == len(found)
    for pole, own in zip(sorted(poles, key=abs), found):
        assert abs(own - pole) < 1e-9 * abs(own)


def test_falling_models():
    """The reference of a falling robot's model falls: x' of the reference is gravity."""
    text = """<robot name="drone"> <link name="body"> <inertial> <origin xyz="0.05 0 0.054"/> <mass value="1.325"/>
      <inertia ixx="0.04" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.06"/> </inertial> </link>
      <simulation> <root type="floating"/> </simulation> </robot>"""
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    model = simulation.linearise([], ["position:body"])
    assert not model.stiffness.any() and not model.poles().any()
    falls = numpy.zeros(12)
    falls[8] = -9.81
    numpy.testing.assert_allclose(model.drift, falls, atol=1e-12)
    assert [mode.frequency for mode in simulation.natural_modes(6)] == 6 * [0]


def test_linear_models():
    with open(example("rigid_double_pendulum"), encoding="utf-8") as file:
        text = file.read().replace('<dynamics damping="0.01" friction="0.002"/>', '<dynamics damping="0.1"/>')
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    simulation.set_joint_state({"shoulder": math.pi / 2})  # the arm hangs
    model = simulation.linearise(outputs=["position:elbow", "velocity:shoulder"])
    assert model.states == ["shoulder", "elbow", "d/dt shoulder", "d/dt elbow"]
    assert model.inputs == ["effort:shoulder", "effort:elbow"] and len(model.outputs) == 2
    assert model.a.shape == (4, 4) and model.b.shape == (4, 2) and model.c.shape == (2, 4) and model.d.shape == (2, 2)
    assert model.mass.shape == model.damping.shape == model.stiffness.shape == (2, 2)
    assert model.coordinates == ["shoulder", "elbow"] and model.left_out == []
    assert bits(model.drift) == bits(numpy.zeros(4))
    poles = numpy.linalg.eigvals(model.a)
    assert sorted(poles[poles.imag > 0], key=abs) == pytest.approx(list(model.poles()), rel=1e-12)
    frequencies = [0.1, 1.0]
    gains = model.frequency_response(frequencies)
    assert gains.shape == (2, 2, 2) and gains.dtype == complex
    for gain, frequency in zip(gains, frequencies):
        states = numpy.linalg.solve(2j * math.pi * frequency * numpy.eye(4) - model.a, model.b)
        numpy.testing.assert_allclose(gain, model.c @ states + model.d, rtol=1e-12)
    times, outputs = model.step_response(20000.0, intervals=4)
    assert times.tolist() == [0, 5000, 10000, 15000, 20000] and outputs.shape == (5, 2, 2)
    # The transient has decayed: only the static gain remains.
    numpy.testing.assert_allclose(outputs[-1], model.d - model.c @ numpy.linalg.solve(model.a, model.b), atol=1e-10)
    small, hankel = model.reduced(2)
    assert len(small.states) == 2 and len(hankel) == 4
    error = numpy.linalg.norm(small.frequency_response(frequencies) - gains, 2, axis=(1, 2))
    assert (error <= 2 * hankel[2:].sum()).all()
    with pytest.raises(ValueError, match="there are shoulder, elbow"):
        simulation.linearise(["effort:wrist"])
    with pytest.raises(ValueError, match="'now'"):
        simulation.linearise(about="now")


def test_runs_to_an_accuracy_are_those_of_the_command_line(tmp_path, pendulum):
    path = tmp_path / "accurate.csv"
    status, said = command_line("simulate", example("rigid_double_pendulum"), "--until", "1", "--accuracy", "1e-4",
                                "--interval", "0.1", "--output", path, "--quiet")
    assert status == 0, said
    names, rows = read_csv(path)
    run = pendulum.run_to_accuracy(1, 1e-4, intervals=10, record=[])
    assert [name for name, _ in pendulum.columns()] == [name for name in names if name != "solver/error_estimate"]
    kept = [names.index(name) for name, _ in pendulum.columns()]
    assert bits(run.rows) == bits(rows[:, kept])
    assert run.estimate <= 1e-4 and run.tries > 1 and run.scale > 0
    assert run.interval * 10 == pytest.approx(1)
    assert pendulum.time == pytest.approx(1) and pendulum.step_size == 1e-3


def test_an_accuracy_that_is_out_of_reach(pendulum):
    status, said = command_line("simulate", example("rigid_double_pendulum"), "--until", "0.02", "--accuracy", "1e-16",
                                "--interval", "0.01", "--quiet")
    assert status == 1
    with pytest.raises(flexarm.AccuracyError) as caught:
        pendulum.run_to_accuracy(0.02, 1e-16, intervals=2, record=["time"])
    assert "flexarm: %s\n" % caught.value == said
    assert caught.value.estimate > 1e-16 and caught.value.rows.shape == (3, 1)
    with pytest.raises(ValueError):
        pendulum.run_to_accuracy(1, 2)


def test_an_accurate_run_that_fails(failing_scene):
    simulation = flexarm.Simulation(flexarm.read_scene(failing_scene))
    with pytest.raises(flexarm.AccuracyError):
        simulation.run_to_accuracy(1, 1e-3, intervals=1, most_tries=2)
