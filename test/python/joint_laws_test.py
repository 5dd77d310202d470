"""Test that each law of a joint is one law in all schemes: runs to an accuracy against scipy."""

import os
import sys

import numpy
import pytest

import flexarm

PACKAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts", "outside_references")
sys.path.insert(0, PACKAGE)
from motion import Motion  # noqa: E402

ACCURACY, INTERVALS = 1e-5, 50
CONSERVING = ("em", "em4", "edmc2")
EXPLICIT = ("rk4", "dop853")
SCHEMES = CONSERVING + EXPLICIT + ("newmark",)
ARM = """<robot name="law"><link name="world"/>
<link name="arm"><inertial><origin xyz="0.4 0 0"/><mass value="2"/>
<inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="world"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="{lower}" upper="3" effort="{effort}" velocity="1e9"/>{joint}</joint>{parts}
<simulation><gravity xyz="0 -9.81 0"/><integrator step="0.001"/><initial joint="hinge" position="1"/>
<probe name="tip" link="arm" at="0.8 0 0"/>{simulation}</simulation></robot>"""
# Of each law: what the scene has, and the schemes that are tried. Newmark's rule is left out where friction turns
# around within a hit on a stop: docs/schemes.md says why. Explicit schemes refuse dry friction, em4 refuses it and
# samples.
LAWS = {
    "damping": ({"joint": '<dynamics damping="0.7"/>'}, SCHEMES),
    "smooth friction": ({"joint": '<dynamics friction="0.8"/>'}, CONSERVING + EXPLICIT),
    "dry friction": ({"joint": '<dynamics friction="0.8"/><friction law="coulomb"/>'}, ("em", "edmc2", "newmark")),
    "stop": ({"lower": "-0.4"}, SCHEMES),
    "spring": ({"parts": '<spring joint="hinge" stiffness="30" rest="0.3"/>'}, SCHEMES),
    "motor with a limit": ({"effort": "4", "simulation": '<effort joint="hinge" history="9*sin(5*t)"/>'},
                           SCHEMES),
    "elastic gear with play": ({"parts": '<drive joint="hinge" gear="20" rotor_inertia="2e-4" stiffness="500" '
                                         'damping="2" backlash="0.02" friction="0.1"/>'}, SCHEMES),
    "servo": ({"parts": '<servo joint="hinge" mode="position" kp="80" kd="12" ki="60" '
                        'set_point="1 + 0.3*sin(4*t)"/>'}, SCHEMES),
    "servo at its limit": ({"parts": '<servo joint="hinge" mode="position" kp="90" kd="10" ki="100" set_point="0.4" '
                                     'effort_limit="9" anti_windup="0.1"/>'}, SCHEMES),
    "servo of velocity": ({"parts": '<servo joint="hinge" mode="velocity" kp="12" ki="40" '
                                    'set_point="sin(3*t)"/>'}, SCHEMES),
    "sampled servo": ({"parts": '<servo joint="hinge" mode="position" kp="80" kd="6" ki="40" sample_time="0.01" '
                                'delay="0.004" set_point="0.5"/>'}, ("em", "edmc2", "newmark") + EXPLICIT),
    "sampled servo, set point that jumps at a sample": (
        {"parts": '<servo joint="hinge" mode="position" kp="80" kd="6" sample_time="0.01" '
                  'set_point="t &lt; 0.2 ? 1 : 0.7"/>'}, ("em", "edmc2", "newmark") + EXPLICIT),
}


def scene(parts):
    values = {"lower": "-3", "effort": "1e9", "joint": "", "parts": "", "simulation": ""}
    return ARM.format(**{**values, **parts})


def difference(points, reference):
    """The largest root mean square error, relative to the way, as runs to an accuracy judge it."""
    squares = ((points - reference) ** 2).sum(axis=1)
    squares[[0, -1]] *= 0.5
    way = numpy.linalg.norm(reference - reference[0], axis=1).max()
    return numpy.sqrt(squares.sum() / (len(points) - 1)) / way


@pytest.mark.parametrize("law", LAWS)
def test_all_schemes_have_the_law(law, tmp_path):
    parts, schemes = LAWS[law]
    text = scene(parts)
    path = tmp_path / "scene.urdf"
    path.write_text(text)
    until = 0.9
    times = numpy.linspace(0, until, INTERVALS + 1)
    expected = Motion(text, until).run(times)[:, 0, :]
    for scheme in schemes:
        simulation = flexarm.Simulation(flexarm.read_scene(path), scheme=scheme)
        run = simulation.run_to_accuracy(until, ACCURACY, intervals=INTERVALS,
                                         record=["probe/tip/x", "probe/tip/y", "probe/tip/z"])
        assert difference(run.rows[:, 1:], expected) <= ACCURACY, scheme
