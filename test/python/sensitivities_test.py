"""Test sensitivities of runs against differences of runs."""

import numpy
import pytest

import flexarm
from conftest import bits, hinged_rod

ROD = hinged_rod("0 1 0", "0.5 0 0", (0.01, 0.1, 0.1), """
    <integrator step="0.005" tolerance="1e-10" max_halvings="${14+elements}"/>
    <initial joint="hinge" position="${angle}"/> <probe name="end" link="rod" at="1 0 0"/>""",
                 mass="${mass}", dynamics='<dynamics damping="${damping}"/>', parameters="""\
  <parameter name="damping" value="0.2" min="0"/> <parameter name="mass" value="2"/>
  <parameter name="angle" value="0.4"/> <parameter name="elements" value="0"/>
""")
RECORD = ["joint/hinge/position", "probe/end/[xyz]"]
STEPS = 100


def simulation_of(**parameters):
    return flexarm.Simulation(flexarm.read_scene_text(ROD, parameters=parameters))


def rows_of(efforts=None, **parameters):
    return simulation_of(**parameters).run(STEPS, efforts, record=RECORD)


def difference(name, value, efforts=None):
    """Return the derivative by differences of fourth order."""
    def quotient(way):
        return (rows_of(efforts, **{name: value + way}) - rows_of(efforts, **{name: value - way})) / (2 * way)

    way = 1e-2 * value
    return (4 * quotient(way / 2) - quotient(way)) / 3


def test_derivatives_are_those_of_differences():
    simulation = simulation_of()
    sensitivities = simulation.sensitivities(["damping", "mass", "angle"])
    assert sensitivities.simulation is simulation
    assert sensitivities.directions == ["damping", "mass", "angle"]
    efforts = numpy.linspace(-1, 1, STEPS).reshape(STEPS, 1)
    found = sensitivities.run(STEPS, efforts, record=RECORD)
    assert found.shape == (STEPS, len(simulation.columns(RECORD)), 3)
    for i, (name, value) in enumerate([("damping", 0.2), ("mass", 2), ("angle", 0.4)]):
        expected = difference(name, value, efforts)
        assert abs(found[:, :, i] - expected).max() < 1e-6 * abs(expected).max()
    numpy.testing.assert_array_equal(found[-1, 1], sensitivities.positions[0])
    numpy.testing.assert_array_equal(found[-1, 2:], sensitivities.probe("end")[:3])
    numpy.testing.assert_array_equal(found[-1, 1], sensitivities.outputs(["position:hinge"])[0])


def test_what_sensors_measure():
    """Check samples of sensors: the runs with other parameters that differences need have the same noise."""
    cell = '<sensor name="cell" kind="wrench" link="rod" rate="50" noise="0.05"/> <simulation>'
    text = ROD.replace("<simulation>", cell)

    def simulation(mass):
        return flexarm.Simulation(flexarm.read_scene_text(text, parameters={"mass": mass}))

    def quotient(way):
        return (simulation(2 + way).run(STEPS, record=["sensor/*"])
                - simulation(2 - way).run(STEPS, record=["sensor/*"])) / (2 * way)

    sensitivities = simulation(2).sensitivities(["mass"])
    first = sensitivities.row(["sensor/*"])
    assert first.shape == (7, 1) and first[0, 0] == 0
    found = sensitivities.run(STEPS, record=["sensor/*"])
    expected = (4 * quotient(0.01) - quotient(0.02)) / 3
    assert abs(found[:, :, 0] - expected).max() < 1e-6 * abs(expected).max()
    numpy.testing.assert_array_equal(found[3:7, 1:], found[[3], 1:].repeat(4, axis=0))
    numpy.testing.assert_array_equal(found[-1], sensitivities.row(["sensor/*"]))


def test_run_keeps_its_bits():
    simulation = simulation_of()
    simulation.sensitivities(["mass"], initial_state=True).run(STEPS)
    assert bits(simulation.row([])) == bits(_after_run().row([]))


def _after_run():
    alone = simulation_of()
    alone.run(STEPS)
    return alone


def test_matrix_of_the_initial_state():
    sensitivities = simulation_of().sensitivities(["angle"], initial_state=True)
    assert sensitivities.directions == ["angle", "hinge", "d/dt hinge"]
    assert sensitivities.state_names == ["hinge", "d/dt hinge"]
    numpy.testing.assert_allclose(sensitivities.states[:, 1:], numpy.eye(2), atol=1e-7)
    for _ in range(STEPS):
        sensitivities.step()
    states = sensitivities.states
    assert states.shape == (2, 3)
    assert abs(states[:, 0] - states[:, 1]).max() < 1e-6 * abs(states).max()
    numpy.testing.assert_array_equal(sensitivities.velocities[0], states[1])


def test_every_other_step():
    once = simulation_of().sensitivities(["mass"]).run(STEPS, record=RECORD)
    other = simulation_of().sensitivities(["mass"]).run(STEPS, record=RECORD, every=2)
    numpy.testing.assert_array_equal(other, once[1::2])


@pytest.mark.parametrize("parameter, said", [
    ("weight", "unknown parameter 'weight': expected one of damping, mass, angle, elements"),
    ("elements", "the run cannot be differentiated with respect to parameter 'elements'"),
])
def test_parameters_that_have_none(parameter, said):
    with pytest.raises(ValueError, match=said):
        simulation_of().sensitivities([parameter])


def test_run_that_has_begun():
    simulation = simulation_of()
    simulation.step()
    with pytest.raises(ValueError, match="the simulation has moved; call reset"):
        simulation.sensitivities(["mass"])
    simulation.reset()
    sensitivities = simulation.sensitivities(["mass"])
    simulation.step()
    with pytest.raises(RuntimeError, match="the simulation was moved by other means"):
        sensitivities.step()


def test_schemes_without_them():
    text = ROD.replace("<integrator ", '<integrator scheme="m1" interpolation="iterative" ')
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    with pytest.raises(flexarm.SceneError, match="runs of scheme 'm1' have no derivatives"):
        simulation.sensitivities(["mass"])


def test_what_is_wrong_with_a_call():
    sensitivities = simulation_of().sensitivities(["mass"])
    with pytest.raises(ValueError, match="every: expected a number >= 1, got 0"):
        sensitivities.run(1, every=0)
    with pytest.raises(ValueError, match="expected the name of a probe, one of \\[end\\], or its index, got 'tip'"):
        sensitivities.probe("tip")
    with pytest.raises(ValueError, match="output 'acceleration:hinge' has no sensitivities"):
        sensitivities.outputs(["acceleration:hinge"])
