"""Sensitivities of runs over stops and dry friction, against ODE solvers with events."""

import math

import numpy
import pytest
from scipy.integrate import solve_ivp

import flexarm

ARM = """<robot name="p"> <parameter name="angle" value="1"/> <parameter name="fc" value="{friction}"/>
  <link name="world"/>
  <link name="a"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1.0"/>
    <inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <joint name="h" type="{kind}"> <parent link="world"/> <child link="a"/> <axis xyz="0 -1 0"/> {joint} </joint>
  <simulation> <integrator step="{step}"/> <initial joint="h" position="${{angle}}"/> {more} </simulation> </robot>"""
INERTIA, WEIGHT = 0.3, 9.81 * 0.5
PRECISE = dict(method="DOP853", rtol=1e-12, atol=1e-14)


def fourth_order(value, way):
    """The derivative at 0 of a function."""
    return (8 * (value(way) - value(-way)) - (value(2 * way) - value(-2 * way))) / (12 * way)


def sensitivity(scene, parameter, until):
    simulation = flexarm.Simulation(scene)
    run = simulation.sensitivities([parameter])
    run.run(round(until / simulation.step_size))
    assert run.lost == ""
    return run.positions[0, 0], run.events


def event(function):
    function.terminal, function.direction = True, -1
    return function


# ---------------------------------------------------------------- dry friction

def rubbing(friction, until):
    """The angle at the end, by the exact law."""
    time, state = 0.0, [1.0, 0.0]
    while time < until:
        push = -WEIGHT * math.cos(state[0])
        if abs(push) <= friction:
            return state[0]
        way = math.copysign(1, push)
        solution = solve_ivp(lambda _, y: [y[1], (-WEIGHT * math.cos(y[0]) - way * friction) / INERTIA], (time, until),
                             state, events=event(lambda _, y: way * y[1]), **PRECISE)
        time, state = solution.t[-1], [solution.y[0, -1], 0.0]
    return solution.y[0, -1]


@pytest.mark.parametrize("until", [0.8, 1.6, 2.5, 3.5])  # before, after a reversal, after two, at rest
def test_dry_friction(until):
    exact = fourth_order(lambda way: rubbing(1.5 + way, until), 1e-4)
    for step in (1e-3, 1e-4):
        scene = flexarm.read_scene_text(ARM.format(
            kind="continuous", joint='<dynamics friction="${fc}"/> <friction law="coulomb"/>', friction=1.5, step=step,
            more=""))
        found, _ = sensitivity(scene, "fc", until)
        # A run stands for up to a step at each reversal; its derivative changes by up to 4.5 in a second, 5 of which
        # the reversals themselves may bring about.
        assert found == pytest.approx(exact, abs=2 * 5 * step)


# ---------------------------------------------------------------- stops

def bouncing(angle, step, until):
    """The angle at the end by the documented law of stops (docs/notes/stops.md 2)."""
    frequency, give = math.pi / (10 * step), 0.1 * 2.0
    stiffness, damping = INERTIA * frequency**2, 2 * 0.497239 * INERTIA * frequency

    def push(y):
        depth = -0.4 - y[0]
        part = depth / give
        room = 1 - part * part
        return (1 + 3 * part * part) / room**3 * (stiffness * depth / room**2 - damping * y[1])

    def rates(t, y, touches):
        effort = -WEIGHT * math.cos(y[0]) + 0.3 * math.sin(4 * t)
        return [y[1], (effort + (push(y) if touches else 0)) / INERTIA]

    time, state = 0.0, [angle, 0.0]
    for touches, ends in ((False, event(lambda _, y: y[0] + 0.4)), (True, event(lambda _, y: push(y))), (False, None)):
        solution = solve_ivp(lambda t, y, touches=touches: rates(t, y, touches), (time, until), state, events=ends,
                             **PRECISE)
        time, state = solution.t[-1], solution.y[:, -1]
        if time >= until:
            break
    return state[0]


@pytest.mark.parametrize("step", [1e-3, 1e-4])
def test_stop(step):
    scene = flexarm.read_scene_text(ARM.format(
        kind="revolute", joint='<limit lower="-0.4" upper="1.6" effort="0" velocity="0"/>', friction=0, step=step,
        more='<effort joint="h" history="0.3*sin(4*t)"/>'))
    exact = fourth_order(lambda way: bouncing(1 + way, step, 0.56), 1e-5)
    found, events = sensitivity(scene, "angle", 0.56)
    assert [own.what for own in events] == ["touches its stop", "leaves its stop"]
    assert {own.joint for own in events} == {"h"} and not any(own.doubt for own in events)
    # Two terms of 1.5 that are opposite, and a run whose restitution is right to 5 %.
    assert found == pytest.approx(exact, abs=0.05 * 1.5)
    numpy.testing.assert_allclose(exact, {1e-3: -0.58524, 1e-4: -0.54070}[step], atol=1e-5)
