"""Test scenes: their content, and the messages of errors."""

import warnings

import pytest

import flexarm
from conftest import command_line, example, hinged_rod


def test_a_scene_says_what_it_is():
    scene = flexarm.read_scene(example("flexible_two_link_arm"))
    assert scene.name == "flexible_two_link_arm"
    assert scene.beams == ["upper_arm", "forearm"]
    assert scene.joints == ["shoulder", "elbow", "grip"]
    assert scene.probes == ["payload"]
    assert scene.gravity == [0, 0, -9.81]
    assert (scene.scheme, scene.step) == ("auto", 1e-3)
    for part in ("'flexible_two_link_arm'", "4 links (2 with beams)", "3 joints", "step 0.001 s"):
        assert part in repr(scene)


def test_text_is_as_good_as_a_file():
    with open(example("rigid_double_pendulum"), encoding="utf-8") as file:
        text = file.read()
    scene = flexarm.read_scene_text(text, "pendulum")
    assert scene.file == "pendulum"
    assert flexarm.Simulation(scene).joint_names == ["shoulder", "elbow"]


def test_a_simulation_reads_the_file_of_its_scene(failing_scene, tmp_path):
    assert flexarm.Simulation(example("rigid_double_pendulum")).joint_names == ["shoulder", "elbow"]
    assert flexarm.Simulation(failing_scene, step=1e-2).step_size == 1e-2
    with pytest.raises(flexarm.SceneError, match="nowhere.urdf"):
        flexarm.Simulation(tmp_path / "nowhere.urdf")
    with pytest.raises(TypeError, match="scene: expected a Scene, or the path of a scene's file, got int"):
        flexarm.Simulation(3)


def broken(tmp_path, old, new):
    with open(example("flexible_two_link_arm"), encoding="utf-8") as file:
        text = file.read()
    assert old in text
    path = tmp_path / "broken.urdf"
    path.write_text(text.replace(old, new))
    return path


@pytest.mark.parametrize("old, new", [
    ('outer_radius="0.015"', 'outer_radius="-1"'),
    ('step="0.001"', 'step="0.001" frobnicate="1"'),
    ('child link="payload"', 'child link="nobody"'),
    ("</robot>", ""),
])
def test_errors_are_those_of_the_command_line(tmp_path, old, new):
    path = broken(tmp_path, old, new)
    with pytest.raises(flexarm.SceneError) as error:
        flexarm.read_scene(path)
    status, said = command_line("check", path)
    assert status == 2
    assert str(error.value) + "\n" == said
    assert isinstance(error.value, ValueError)


PARAMETERS = hinged_rod("0 1 0", "0 0 0", ["${mass/8}"] * 3, mass="${mass}",
                        parameters='  <parameter name="mass" value="3" min="0"/>\n')


def test_parameters_have_other_values(tmp_path):
    path = tmp_path / "rod.urdf"
    path.write_text(PARAMETERS)
    assert flexarm.Simulation(flexarm.read_scene(path)).mass == 3
    assert flexarm.Simulation(flexarm.read_scene(path, {"mass": 2.5})).mass == 2.5
    assert flexarm.Simulation(flexarm.read_scene_text(PARAMETERS, parameters={"mass": 2})).mass == 2
    for values in ({"mass": -1}, {"length": 1}):
        (name, value), = values.items()
        with pytest.raises(flexarm.SceneError) as error:
            flexarm.read_scene(path, values)
        said = command_line("check", path, "--set", "%s=%s" % (name, value))[1]
        assert str(error.value) + "\n" == said


def test_a_missing_file_is_an_error(tmp_path):
    path = tmp_path / "none.urdf"
    with pytest.raises(flexarm.SceneError) as error:
        flexarm.read_scene(path)
    assert str(error.value) + "\n" == command_line("check", path)[1]


def test_impossible_mechanisms_are_errors_of_the_scene(tmp_path):
    path = broken(tmp_path, '<mass value="0.5"/>', '<mass value="0.5"/> <origin xyz="0 0 0"/>')
    scene = flexarm.read_scene(path)
    with pytest.raises(flexarm.SceneError, match="nonsense"):
        flexarm.Simulation(scene, scheme="nonsense")
    with pytest.raises(ValueError, match="on_failure: expected 'stop' or 'dissipate', got 'go on'"):
        flexarm.Simulation(scene, on_failure="go on")


def test_findings_are_warnings(tmp_path):
    path = broken(tmp_path, '<initial joint="elbow" position="0.5"/>', '<initial joint="elbow" position="3"/>')
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        flexarm.read_scene(path)
    said = command_line("simulate", path, "--until", "0.001", "--quiet")[1]
    assert "".join(str(warning.message) + "\n" for warning in caught) == said != ""
    assert all(warning.category is flexarm.SceneWarning for warning in caught)
    assert all(warning.filename == __file__ for warning in caught)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(flexarm.SceneWarning):
            flexarm.read_scene(path)


def test_starts_outside_of_limits_may_be_clamped(tmp_path):
    path = broken(tmp_path, '<limit lower="-2.5" upper="2.5" effort="100" velocity="2"/>',
                  '<limit lower="0.25" upper="2.5" effort="100" velocity="2"/>')
    with pytest.warns(flexarm.SceneWarning, match="'shoulder': starts outside its limits"):
        flexarm.read_scene(path)
    scene = flexarm.read_scene(path, clamp_start=True)
    assert flexarm.Simulation(scene).positions[0] == 0.25


ROD = hinged_rod("0 1 0", "0 0 0", ["${half}"] * 3, mass="${mass}", parameters="""\
  <parameter name="mass" value="2" min="0.5"/>
  <parameter name="half" value="${mass/2}"/>
""")


def test_parameters_have_the_values_that_are_given():
    scene = flexarm.read_scene_text(ROD, parameters={"mass": 3})
    assert scene.parameters == [("mass", 3.0, 0.5, None), ("half", 1.5, None, None)]
    assert scene.parameters[0].min == 0.5
    assert flexarm.read_scene_text(ROD).parameters[1] == flexarm.Parameter("half", 1.0, None, None)


def test_values_of_parameters_must_be_finite():
    for value in (float("nan"), float("inf")):
        with pytest.raises(flexarm.SceneError, match="mass"):
            flexarm.read_scene_text(ROD, parameters={"mass": value})


def test_the_identity_is_that_of_states():
    def identity(mass, text=ROD):
        return flexarm.read_scene_text(text, parameters={"mass": mass}).identity

    assert identity(2) == identity(2, ROD.replace("\n", "\n\n"))
    assert identity(2) != identity(3)
