"""An arm with dry friction or a stop: its scene, and its exact motion by an ODE solver with events."""

import math

import numpy
import scipy.integrate
from scipy.integrate import solve_ivp

ARM = """<robot name="p"> <parameter name="angle" value="1"/> <parameter name="fc" value="{friction}"/>
  <parameter name="lower" value="-0.4"/> <link name="world"/>
  <link name="a"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1.0"/>
    <inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <joint name="h" type="{kind}"> <parent link="world"/> <child link="a"/> <axis xyz="0 -1 0"/> {joint} </joint>
  <simulation> <integrator scheme="{scheme}" step="{step}"/> <initial joint="h" position="${{angle}}"/> {more}
  </simulation> </robot>"""
INERTIA, WEIGHT = 0.3, 9.81 * 0.5
START, LOWER, UPPER = 1.0, -0.4, 1.6
# scipy has DOP853 from version 1.4 on. RK45 gives the same, with more steps.
PRECISE = dict(method="DOP853" if hasattr(scipy.integrate, "DOP853") else "RK45", rtol=1e-12, atol=1e-14)


def rubbing_arm(step, friction=1.5, scheme="em"):
    """Return the text of a scene with a Coulomb friction of `friction` [N m], which is the parameter `fc`."""
    return ARM.format(kind="continuous", joint='<dynamics friction="${fc}"/> <friction law="coulomb"/>',
                      friction=friction, step=step, scheme=scheme, more="")


def bouncing_arm(step, scheme="em"):
    """Return the text of a scene with a stop at the parameter `lower` and a start at the parameter `angle`."""
    return ARM.format(kind="revolute", joint='<limit lower="${lower}" upper="%r" effort="0" velocity="0"/>' % UPPER,
                      friction=0, step=step, scheme=scheme, more='<effort joint="h" history="0.3*sin(4*t)"/>')


def event(function):
    """Return an event for solve_ivp: the integration ends where the function falls through zero."""
    function.terminal, function.direction = True, -1
    return function


def look(piece, times, found):
    """Fill in the motion at those of the times that lie in this piece of it."""
    inside = (times >= piece.t[0]) & (times <= piece.t[-1])
    if inside.any():
        found[:, inside] = piece.sol(times[inside])


def rubbing(friction, times):
    """Return {angle, rate} of the arm with Coulomb friction by the exact law, shape (2, times), and the number of
    reversals."""
    time, state, found, turns = 0.0, [START, 0.0], numpy.zeros((2, len(times))), -1
    while time < times[-1]:
        turns += 1
        push = -WEIGHT * math.cos(state[0])
        if abs(push) <= friction:
            found[0, times >= time], found[1, times >= time] = state[0], 0
            break
        way = math.copysign(1, push)
        piece = solve_ivp(lambda _, y, way=way: [y[1], (-WEIGHT * math.cos(y[0]) - way * friction) / INERTIA],
                          (time, times[-1]), state, events=event(lambda _, y, way=way: way * y[1]), dense_output=True,
                          **PRECISE)
        look(piece, times, found)
        time, state = piece.t[-1], [piece.y[0, -1], 0.0]
    return found, turns


def bouncing(angle, step, times, lower=LOWER, ratio=0.497239):
    """Return {angle, rate} of the arm over one hit by the documented law of stops (docs/notes/stops.md 2), shape (2,
    times).

    ratio: damping of the stop relative to critical damping. The default is for schemes whose forces are means over
    steps.
    """
    frequency, give = math.pi / (10 * step), 0.1 * (UPPER - lower)
    stiffness, damping = INERTIA * frequency**2, 2 * ratio * INERTIA * frequency

    def push(y):
        depth = lower - y[0]
        part = depth / give
        room = 1 - part * part
        return (1 + 3 * part * part) / room**3 * (stiffness * depth / room**2 - damping * y[1])

    def rates(t, y, touches):
        effort = -WEIGHT * math.cos(y[0]) + 0.3 * math.sin(4 * t)
        return [y[1], (effort + (push(y) if touches else 0)) / INERTIA]

    time, state, found = 0.0, [angle, 0.0], numpy.empty((2, len(times)))
    for touches, end in ((False, event(lambda _, y: y[0] - lower)), (True, event(lambda _, y: push(y))), (False, None)):
        piece = solve_ivp(lambda t, y, touches=touches: rates(t, y, touches), (time, times[-1]), state, events=end,
                          dense_output=True, **PRECISE)
        look(piece, times, found)
        time, state = piece.t[-1], piece.y[:, -1]
        if time >= times[-1]:
            break
    return found


def fourth_order(value, way):
    """Return the derivative of a function at 0 by differences of fourth order."""
    return (8 * (value(way) - value(-way)) - (value(2 * way) - value(-2 * way))) / (12 * way)
