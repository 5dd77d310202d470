"""The scenes that have outside references: group, name, whether they have corners, end time, text.

Numbers come from random generators with fixed seeds: they are reproducible, and none of them is round.
"""

import math
import random
from collections import namedtuple

Scene = namedtuple("Scene", "group name is_cornered until text is_rigid")


def link(name, mass=1.0, centre=(0, 0), inertia=0.05):
    return (f'<link name="{name}"><inertial><origin xyz="{centre[0]!r} {centre[1]!r} 0"/><mass value="{mass!r}"/>'
            f'<inertia ixx="{inertia!r}" iyy="{inertia!r}" izz="{inertia!r}" ixy="0" ixz="0" iyz="0"/>'
            '</inertial></link>\n')


def joint(name, kind, parent, child, at=(0, 0), axis="0 0 1", inner=""):
    if kind == "prismatic" and "<limit" not in inner:
        inner += '<limit lower="-1e9" upper="1e9" effort="0" velocity="0"/>'
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{at[0]!r} {at[1]!r} 0"/><axis xyz="{axis}"/>{inner}</joint>\n')


def limit(lower, upper, restitution=0.3):
    return f'<limit lower="{lower!r}" upper="{upper!r}" effort="0" velocity="0" restitution="{restitution!r}"/>'


def coulomb(friction, coefficient=0.0):
    return (f'<dynamics friction="{friction!r}"/><friction law="coulomb"'
            + (f' coefficient="{coefficient!r}"' if coefficient else "") + "/>")


def escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;")


def effort(name, history):
    return f'<effort joint="{name}" history="{escaped(history)}"/>\n'


def motion(name, position):
    return f'<motion joint="{name}" position="{escaped(position)}"/>\n'


def initial(name, position=0.0, velocity=0.0):
    return f'<initial joint="{name}" position="{position!r}" velocity="{velocity!r}"/>\n'


def probe(name, at="0 0 0"):
    return f'<probe name="{name}" link="{name}" at="{at}"/>\n'


def scene(parts, simulation, gravity=9.81):
    return (f'<robot name="case">\n<link name="world"/>\n{parts}<simulation>\n<gravity xyz="0 {-gravity!r} 0"/>\n'
            f'{simulation}</simulation>\n</robot>\n')


def hinge(simulation, inner="", inertia=0.35, rest=""):
    """A body on an axis without gravity: I q'' = effort."""
    return scene(link("a", 1.0, (0, 0), inertia) + joint("h", "continuous", "world", "a", inner=inner) + rest,
                 simulation + probe("a", "1 0 0"), 0.0)


def pendulum(simulation, inner="", rest="", kind="continuous"):
    """A pendulum that hangs along -y."""
    return scene(link("a", 1.0, (0, -0.5)) + joint("h", kind, "world", "a", inner=inner) + rest,
                 simulation + probe("a", "0 -1 0"))


def double_pendulum(simulation, inner=("", ""), kind=("continuous", "continuous")):
    return scene(link("a", 1.0, (0, -0.3), 0.04) + joint("h", kind[0], "world", "a", inner=inner[0])
                 + link("b", 0.7, (0, -0.25), 0.02) + joint("k", kind[1], "a", "b", (0, -0.6), inner=inner[1]),
                 simulation + probe("a", "0 -0.6 0") + probe("b", "0 -0.5 0"))


def cart(simulation, inner="", rest="", mass=1.3, axis="1 0 0"):
    return scene(link("c", mass, (0, 0), 0.01) + joint("s", "prismatic", "world", "c", axis=axis, inner=inner) + rest,
                 simulation + probe("c"))


def crank(simulation, inner=("", "", ""), angle=0.7, gravity=9.81):
    """A slider-crank: r = 0.2, l = 0.5."""
    rod = -math.asin(0.2 * math.sin(angle) / 0.5)
    start = (initial("a", angle) + initial("b", rod - angle)
             + initial("s", 0.2 * math.cos(angle) + 0.5 * math.cos(rod)))
    return scene(link("crank", 1.0, (0.1, 0.0), 0.01) + joint("a", "continuous", "world", "crank", inner=inner[0])
                 + link("rod", 0.8, (0.25, 0.0), 0.02)
                 + joint("b", "continuous", "crank", "rod", (0.2, 0), inner=inner[1])
                 + link("slider", 1.5, (0, 0), 0.001)
                 + joint("s", "prismatic", "world", "slider", axis="1 0 0", inner=inner[2])
                 + '<loop_joint name="pin" type="continuous"><parent link="rod"/><child link="slider"/>'
                   '<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></loop_joint>\n',
                 start + simulation + probe("slider") + probe("rod", "0.25 0 0"), gravity)


def four_bar(simulation, inner="", angle=0.9, gravity=9.81):
    """Ground 0.5, crank 0.2, coupler 0.45, rocker 0.4. Coupler and rocker meet where circles about their pins do."""
    pin = complex(0.2 * math.cos(angle), 0.2 * math.sin(angle))
    way = 0.5 - pin
    distance = abs(way)
    along = (0.45 ** 2 - 0.4 ** 2 + distance ** 2) / (2 * distance)
    meet = pin + way / distance * complex(along, math.sqrt(0.45 ** 2 - along ** 2))
    coupler = math.atan2((meet - pin).imag, (meet - pin).real)
    rocker = math.atan2(meet.imag, (meet - 0.5).real)
    start = initial("a", angle) + initial("b", coupler - angle) + initial("r", rocker)
    return scene(link("crank", 0.6, (0.1, 0.0), 0.004) + joint("a", "continuous", "world", "crank", inner=inner)
                 + link("coupler", 0.9, (0.225, 0.0), 0.015) + joint("b", "continuous", "crank", "coupler", (0.2, 0))
                 + link("rocker", 0.8, (0.2, 0.0), 0.011) + joint("r", "continuous", "world", "rocker", (0.5, 0))
                 + '<loop_joint name="pin" type="continuous"><parent link="coupler"/><child link="rocker"/>'
                   '<origin xyz="0.45 0 0"/><child_origin xyz="0.4 0 0"/><axis xyz="0 0 1"/></loop_joint>\n',
                 start + simulation + probe("coupler", "0.225 0 0") + probe("rocker", "0.4 0 0"), gravity)


def carried_pendulum(simulation, inner=""):
    """A cart on which a pendulum hangs. The motion of the cart is up to `simulation`."""
    return scene(link("c", 1.0) + joint("s", "prismatic", "world", "c", axis="1 0 0")
                 + link("a", 0.8, (0, -0.4), 0.03) + joint("h", "continuous", "c", "a", inner=inner),
                 simulation + probe("a", "0 -0.8 0"))


def screw(simulation, inner="", pitch=0.05):
    return scene(link("n", 1.2, (0, 0), 0.02)
                 + '<joint name="u" type="floating"><parent link="world"/><child link="n"/><axis xyz="0 0 1"/>'
                   f'<couple kind="screw" pitch="{pitch!r}"/>{inner}</joint>\n',
                 simulation + probe("n", "0.1 0 0")).replace("0 -9.81 0", "0 0 -9.81")


def table(rng, until, points, size):
    times = sorted(rng.uniform(0, until) for _ in range(points))
    return " ".join(f"{t!r}:{rng.uniform(-size, size)!r}" for t in times)


def jump(rng, size, until):
    return f"t < {rng.uniform(0.25, 0.6) * until!r} ? {rng.uniform(0.7, 1) * size!r} : {-rng.uniform(0.5, 1) * size!r}"


def forces(rng):
    """Otherwise smooth problems, with efforts that have jumps and kinks."""
    r = rng.uniform
    yield "jump, hinge", 1.0, hinge(effort("h", jump(rng, 3, 1)))
    yield "jump at sqrt(0.1)", 1.0, hinge(effort("h", "t < sqrt(0.1) ? 3 : -3"), inertia=1.0)
    yield "two jumps, cart", 3.0, cart(effort("s", "t < 0.7 ? 2 : (t < 1.4 ? -2 : 1)"))
    yield "jump, pendulum", 2.0, pendulum(effort("h", jump(rng, 4, 2)))
    yield "jump, double pendulum", 1.5, double_pendulum(effort("h", jump(rng, 5, 1.5)))
    begin = r(0.2, 0.5)
    yield "pulse, hinge", 2.0, hinge(effort("h", f"t > {begin!r} && t < {begin + r(0.02, 0.05)!r} ? 20 : 0"))
    begin = r(0.3, 0.6)
    yield "pulse, pendulum", 2.0, pendulum(effort("h", f"t > {begin!r} && t < {begin + r(0.1, 0.3)!r} ? 6 : 0"))
    yield "table, hinge", 2.0, hinge(effort("h", table(rng, 2, 9, 4)))
    yield "table, pendulum", 2.0, pendulum(effort("h", table(rng, 2, 14, 5)))
    yield "two tables, double pendulum", 1.5, double_pendulum(effort("h", table(rng, 1.5, 8, 5))
                                                              + effort("k", table(rng, 1.5, 8, 2)))
    period = r(0.2, 0.35)
    yield "sawtooth, hinge", 2.0, hinge(effort("h", f"5*(t/{period!r} - rint(t/{period!r}))"))
    yield "sawtooth, pendulum", 2.0, pendulum(effort("h", f"6*(t/{period!r} - rint(t/{period!r}))"))
    yield "abs, cart", 2.0, cart(effort("s", f"4*abs(sin({r(4, 6)!r}*t)) - 2"))
    yield "sign, hinge", 2.0, hinge(effort("h", f"2*sign(sin({r(5, 8)!r}*t + 0.4))"))
    yield "sign, pendulum", 2.0, pendulum(effort("h", f"3*sign(cos({r(4, 6)!r}*t))"))
    yield "min of a ramp, pendulum", 2.0, pendulum(effort("h", f"min({r(2, 3)!r}, {r(4, 6)!r}*t)"))
    yield "cut sine, cart", 2.0, cart(effort("s", f"max(-1.5, min(1.5, 4*sin({r(5, 7)!r}*t)))"))
    yield "load with a jump, double pendulum", 1.5, double_pendulum(
        f'<load link="b" at="0 -0.5 0" force="{r(4, 6)!r} 0 0" frame="follower" '
        f'history="t &lt; {r(0.5, 0.8)!r} ? 1 : -0.5"/>')


def stops(rng):
    r = rng.uniform
    start = initial("h", r(0.9, 1.1))
    for restitution in (0.1, 0.3, 0.7):
        yield f"pendulum, restitution {restitution}", 2.0, pendulum(
            start, limit(-r(0.3, 0.5), 1.6, restitution), kind="revolute")
    yield "fall on a stop", 1.5, cart(initial("s", r(0.3, 0.5)), limit(0.0, 1.0, 0.5), axis="0 1 0")
    yield "falls and rests", 2.0, cart(initial("s", r(0.1, 0.2)), limit(0.0, 1.0, 0.1), axis="0 1 0")
    yield "to and fro between stops", 2.0, cart(initial("s", 0.05, r(1.5, 2)), limit(-0.4, 0.5, 0.8))
    yield "pushed into stops", 1.5, cart(effort("s", f"3*sin({r(3, 4)!r}*t)"), limit(-0.21, 0.33, 0.2))
    yield "fast hit", 1.0, hinge(initial("h", 0.0, r(15, 20)), limit(-0.7, 0.6, 0.4)).replace("continuous", "revolute")
    yield "elbow at its stop, double pendulum", 1.2, double_pendulum(
        initial("h", 0.9) + initial("k", 0.3), ("", limit(-0.5, 0.6, 0.3)), ("continuous", "revolute"))
    yield "stop and jump", 2.0, cart(effort("s", jump(rng, 4, 2)), limit(-0.5, 0.4, 0.3))


def frictions(rng):
    r = rng.uniform
    for amplitude in (1.2, 2.0, 4.0, 9.0):
        yield f"cart, Coulomb, {amplitude} N", 3.0, cart(effort("s", f"{amplitude!r}*sin({r(4, 6)!r}*t)"), coulomb(1.0))
    for friction in (0.3, 0.8, 1.6):
        yield f"pendulum, Coulomb, {friction} N m", 3.0, pendulum(
            initial("h", r(1, 1.3)) + effort("h", f"1.5*sin({r(5, 7)!r}*t)"), coulomb(friction))
    yield "slides to rest", 2.0, cart(initial("s", 0.0, r(2, 3)), coulomb(0.0, 0.2))
    yield "coefficient, slope", 2.0, cart(effort("s", f"9*sin({r(5, 6)!r}*t)"), coulomb(0.5, 0.3), axis="0.8 0.6 0")
    speed = r(0.15, 0.25)
    yield "stick and slip on a belt", 3.0, scene(
        link("belt", 1.0) + joint("d", "prismatic", "world", "belt", axis="1 0 0")
        + link("c", 1.0, (0, 0), 0.01) + joint("s", "prismatic", "belt", "c", axis="1 0 0", inner=coulomb(3.0))
        + '<spring from="world" from_at="-1 0 0" to="c" stiffness="20" rest_length="1"/>\n',
        motion("d", f"{speed!r}*(t < 1 ? 0.5*t*t : t - 0.5)") + probe("c"))
    yield "Coulomb and jump, double pendulum", 1.5, double_pendulum(
        initial("h", 0.8) + effort("h", jump(rng, 4, 1.5)), (coulomb(0.4), coulomb(0.2)))
    for friction in (0.3, 0.7):
        yield f"pendulum, smooth law, {friction} N m", 2.0, pendulum(
            initial("h", r(0.9, 1.1)) + effort("h", f"2*sin({r(2, 3)!r}*t)"), f'<dynamics friction="{friction!r}"/>')
    yield "cart, smooth law", 2.0, cart(effort("s", f"3*sin({r(5, 7)!r}*t)"), '<dynamics friction="1"/>')
    yield "smooth law and damping, double pendulum", 1.5, double_pendulum(
        initial("h", 0.9), ('<dynamics friction="0.4"/>', '<dynamics damping="0.05"/>'))


def drives(rng):
    r = rng.uniform
    elastic = '<drive joint="h" gear="60" rotor_inertia="3e-5" stiffness="2000" damping="1" {}/>\n'
    for play in (0.01, 0.05, 0.12):
        yield f"play {play}", 1.0, hinge(effort("h", f"2*sin({r(5, 7)!r}*t)"),
                                         rest=elastic.format(f'backlash="{play!r}"'))
    yield "play, pendulum", 1.5, pendulum(initial("h", 0.4) + effort("h", f"3*sin({r(7, 9)!r}*t)"),
                                          rest=elastic.format('backlash="0.04"'))
    yield "play and friction of the motor", 1.0, hinge(
        effort("h", f"3*sin({r(6, 8)!r}*t)"), rest=elastic.format('backlash="0.05" friction="0.5"'))
    yield "play and a jump", 1.0, hinge(effort("h", jump(rng, 2, 1)), rest=elastic.format('backlash="0.03"'))
    yield "line of torque and speed", 2.0, hinge(
        effort("h", f"6*sin({r(2, 3)!r}*t)"),
        rest='<drive joint="h" gear="50" rotor_inertia="2e-5" effort_limit="2.5" velocity_limit="3"/>\n')
    yield "rigid gear, Coulomb", 2.0, pendulum(
        initial("h", 0.9), coulomb(0.3), '<drive joint="h" gear="50" rotor_inertia="2e-5" friction="0.4"/>\n')


def servos(rng):
    r = rng.uniform
    servo = '<servo joint="h" {}/>\n'
    yield "step, cut", 1.5, hinge("", rest=servo.format(
        f'mode="position" kp="40" kd="5" set_point="{r(0.9, 1.2)!r}" effort_limit="4"'))
    yield "sine, cut, pendulum", 2.0, pendulum("", rest=servo.format(
        f'mode="position" kp="60" kd="6" set_point="0.9*sin({r(4, 5)!r}*t)" effort_limit="5"'))
    for tracking in ("", ' anti_windup="0.05"'):
        yield "integral" + (", windup" if not tracking else ", tracking"), 2.0, pendulum("", rest=servo.format(
            f'mode="position" kp="40" kd="6" ki="60" set_point="{r(0.8, 1.0)!r}" effort_limit="6"{tracking}'))
    yield "velocity, cut", 1.5, hinge("", rest=servo.format(
        f'mode="velocity" kp="4" ki="10" set_point="t &lt; {r(0.6, 0.8)!r} ? 2 : -1" effort_limit="3"'))
    yield "table of set points", 2.0, hinge("", rest=servo.format(
        f'mode="position" kp="60" kd="8" set_point="{table(rng, 2, 7, 0.8)}"'))
    for period, delay in ((0.01, 0.0), (0.02, 0.0), (0.02, 0.007)):
        yield f"sampled, {period} s, delay {delay} s", 2.0, pendulum("", rest=servo.format(
            f'mode="position" kp="30" kd="3" set_point="{r(0.5, 0.8)!r}" sample_time="{period!r}" delay="{delay!r}"'))
    yield "sampled, cut, integral", 2.0, pendulum("", rest=servo.format(
        f'mode="position" kp="40" kd="4" ki="50" set_point="{r(0.8, 1.0)!r}" sample_time="0.02" effort_limit="6" '
        'anti_windup="0.1"'))
    yield "cut at a stop", 2.0, pendulum("", limit(-1.0, 0.55, 0.3), servo.format(
        f'mode="position" kp="50" kd="4" set_point="{r(0.7, 0.8)!r}" effort_limit="8"'), "revolute")
    yield "effort limit of the joint", 2.0, pendulum(
        effort("h", f"5*sin({r(4, 5)!r}*t)"), '<limit lower="-100" upper="100" effort="3" velocity="0"/>',
        kind="revolute")


def loops(rng):
    r = rng.uniform
    yield "crank, jump", 1.5, crank(effort("a", jump(rng, 4, 1.5)))
    yield "crank, sign", 1.5, crank(effort("a", f"4*sign(sin({r(4, 5)!r}*t))"), gravity=0.0)
    yield "crank, Coulomb at the slide", 1.5, crank("", ("", "", coulomb(2.0)))
    yield "crank, stop of the slide", 1.2, crank("", ("", "", limit(0.5, 0.69, 0.3)), r(0.6, 0.8))
    yield "crank, servo that is cut", 1.5, crank("", angle=0.7).replace(
        "<simulation>", f'<servo joint="a" mode="velocity" kp="3" set_point="{r(3, 4)!r}" effort_limit="5"/>\n'
        '<simulation>')
    yield "four-bar, jump", 1.5, four_bar(effort("a", jump(rng, 4, 1.5)))
    yield "four-bar, table", 1.5, four_bar(effort("a", table(rng, 1.5, 9, 4)))
    yield "four-bar, Coulomb", 1.5, four_bar("", coulomb(0.4))
    yield "four-bar, smooth law", 1.5, four_bar("", '<dynamics friction="0.4"/>', r(0.8, 1.0))


def motions(rng):
    r = rng.uniform
    yield "cart by a table", 2.0, carried_pendulum(motion("s", "0:0 0.30103:0 0.9:0.4 1.4142:0.1 2:0.3"))
    yield "cart by abs", 2.0, carried_pendulum(motion("s", f"0.15*abs(sin({r(3, 4)!r}*t + 2)) - 0.13639461402385225"))
    yield "cart by a cubic table", 2.0, carried_pendulum(motion("s", "0:0:0 0.7:0.3:0.5 1.3:0.1:-0.4 2:0.2:0"))
    yield "kink and friction", 2.0, carried_pendulum(motion("s", f"{r(0.5, 0.7)!r}*max(0, t - 0.4321)"), coulomb(0.2))
    yield "lifted by min", 2.0, carried_pendulum(initial("h", 0.5) + motion("s", f"min(0.3, {r(0.4, 0.5)!r}*t*t)"))


def couplings(rng):
    r = rng.uniform
    yield "point spring and jump", 2.0, pendulum(
        effort("h", jump(rng, 3, 2)),
        rest='<spring from="world" from_at="0.4 0.2 0" to="a" to_at="0 -0.5 0" stiffness="30" rest_length="0.6" '
             'damping="0.4"/>\n')
    mimic = (link("b", 0.5, (0, -0.25), 0.02)
             + joint("k", "continuous", "a", "b", (0, -0.6), inner='<mimic joint="h" multiplier="-1.7" offset="0.2"/>'))
    yield "mimic and table", 2.0, pendulum(effort("h", table(rng, 2, 9, 4)) + probe("b", "0 -0.5 0"), rest=mimic)
    yield "screw, jump", 1.0, screw(effort("u", jump(rng, 1.5, 1)))
    yield "screw, stop", 1.0, screw("", limit(-2.0, 1.0, 0.3), r(0.1, 0.2))
    yield "screw, Coulomb", 2.0, screw(effort("u", f"1.2*sin({r(4, 5)!r}*t)"), coulomb(0.25))
    yield "joint spring and Coulomb", 2.0, hinge(initial("h", r(0.9, 1.1)), coulomb(0.6),
                                                 rest='<spring joint="h" stiffness="20"/>\n')


def smooth(rng):
    r = rng.uniform
    yield "hinge", 2.0, hinge(effort("h", f"2*sin({r(4, 6)!r}*t)"))
    yield "pendulum", 2.0, pendulum(initial("h", r(1, 1.4)))
    yield "double pendulum", 1.5, double_pendulum(initial("h", 0.9) + effort("k", f"sin({r(4, 5)!r}*t)"))
    yield "crank", 1.5, crank(effort("a", f"2*sin({r(3, 4)!r}*t)"))
    yield "four-bar", 1.5, four_bar("", '<dynamics damping="0.1"/>')
    yield "elastic gear", 1.0, hinge(effort("h", f"2*sin({r(5, 7)!r}*t)"), rest=(
        '<drive joint="h" gear="60" rotor_inertia="3e-5" stiffness="2000" damping="1"/>\n'))
    yield "servo", 2.0, pendulum("", rest='<servo joint="h" mode="position" kp="60" kd="6" ki="20" '
                                      'set_point="0.5*sin(3*t)"/>\n')
    yield "cart that is driven", 2.0, carried_pendulum(motion("s", f"0.2*(1 - cos({r(4, 5)!r}*t))"))
    yield "point spring", 2.0, pendulum(initial("h", 0.7), rest=(
        '<spring from="world" from_at="0.4 0.2 0" to="a" to_at="0 -0.5 0" stiffness="30" rest_length="0.6"/>\n'))


def flexible(rng):
    """Beams have no outside reference: they are judged by finer runs of flexarm."""
    r = rng.uniform

    def arm(simulation, inner="", kind="continuous", rest="", gravity=9.81):
        beam = ('<link name="a"><beam elements="4" order="2"><centerline><line to="1 0 0"/></centerline>'
                '<circle radius="0.01"/>'
                '<material young="70e9" poisson="0.33" density="2700"/>'
                '<damping stiffness_proportional="1e-3"/></beam></link>\n')
        return scene(beam + joint("h", kind, "world", "a", inner=inner) + rest,
                     simulation + probe("a", "1 0 0"), gravity)

    yield "jump", 1.0, arm(effort("h", jump(rng, 4, 1)), gravity=0.0)
    yield "stop", 0.8, arm("", limit(-r(0.4, 0.6), 1.0), "revolute")
    yield "Coulomb", 1.0, arm(effort("h", f"3*sin({r(8, 10)!r}*t)"), coulomb(0.8), gravity=0.0)
    yield "play", 0.5, arm(effort("h", f"2*sin({r(8, 10)!r}*t)"), gravity=0.0, rest=(
        '<drive joint="h" gear="60" rotor_inertia="3e-5" stiffness="2000" damping="1" backlash="0.03"/>\n'))
    yield "servo that is cut", 1.0, arm("", gravity=0.0, rest=(
        f'<servo joint="h" mode="position" kp="40" kd="5" set_point="{r(0.9, 1.2)!r}" effort_limit="3"/>\n'))
    yield "clamped, jump", 0.3, arm('<load link="a" at="1 0 0" force="0 20 0" history="t &lt; 0.07071 ? 1 : -1"/>\n',
                                    "", "fixed", gravity=0.0)


def ball(name, radius, mass, at=(0, 0)):
    return (f'<link name="{name}"><inertial><mass value="{mass!r}"/><inertia ixx="{mass / 250!r}" iyy="{mass / 250!r}" '
            f'izz="{mass / 250!r}" ixy="0" ixz="0" iyz="0"/></inertial><collision><origin xyz="{at[0]!r} {at[1]!r} 0"/>'
            f'<geometry><sphere radius="{radius!r}"/></geometry></collision></link>\n')


def free(name, x, y):
    return (f'<joint name="{name}_free" type="floating"><parent link="world"/><child link="{name}"/>'
            f'<origin xyz="{x!r} {y!r} 0"/></joint>\n')


def ground(angle=0.0, offset=0.0):
    """A half-space whose surface is turned from the horizontal by this angle [rad]."""
    return f'<ground name="floor" normal="{-math.sin(angle)!r} {math.cos(angle)!r} 0" offset="{offset!r}"/>\n'


def contact(first, second, restitution, stiffness=None):
    rest = "" if stiffness is None else f' stiffness="{stiffness!r}"'
    return f'<contact first="{first}" second="{second}" restitution="{restitution!r}"{rest}/>\n'


def thrown(name, vx=0.0, vy=0.0, turn=0.0):
    return f'<initial link="{name}" linear="{vx!r} {vy!r} 0" angular="0 0 {turn!r}"/>\n'


def contacts(rng):
    """Hits of balls and boxes, of free bodies and of mechanisms. Stiffnesses are declared, except where a contact time
    is named."""
    r = rng.uniform

    def stiffness(mass):
        """Such that a hit lasts 4 to 20 ms."""
        return mass * (math.pi / r(0.004, 0.02)) ** 2

    for i in range(14):
        radius, mass, restitution = r(0.03, 0.12), math.exp(r(-2, 2)), r(0.2, 0.95)
        yield f"ball {i}, restitution {restitution:.2f}", r(0.5, 1.5), scene(
            ground() + ball("b", radius, mass) + free("b", 0.0, radius + r(0.2, 0.8))
            + contact("b", "floor", restitution, stiffness(mass)), thrown("b", r(-0.5, 0.5), r(-1, 0.5)) + probe("b"))
    for restitution in (0.5, 0.8):
        yield f"ball of 10 ms, restitution {restitution}", 1.0, scene(
            ground() + ball("b", 0.06, 0.4) + free("b", 0.0, r(0.3, 0.6)) + contact("b", "floor", restitution),
            probe("b"))
    for i in range(5):
        radius, mass = r(0.05, 0.1), math.exp(r(-1, 1))
        yield f"ball on a slope {i}", 0.9, scene(
            ground(r(-0.5, 0.5)) + ball("b", radius, mass) + free("b", 0.0, radius + r(0.3, 0.6))
            + contact("b", "floor", r(0.4, 0.85), stiffness(mass)), thrown("b", r(-1, 1)) + probe("b"))
    for i in range(6):
        mass, angle = r(0.3, 1.5), r(0.4, 1.0)
        yield f"pendulum on a wall {i}", 1.5, scene(
            '<ground name="floor" normal="1 0 0" offset="-0.05"/>\n' + ball("b", 0.05, mass, (0, -0.5))
            .replace("<inertial>", '<inertial><origin xyz="0 -0.5 0"/>')
            + joint("h", "continuous", "world", "b") + contact("b", "floor", r(0.3, 0.9), stiffness(mass)),
            initial("h", angle) + probe("b", "0 -0.5 0"))
    for i in range(3):
        yield f"double pendulum on a wall {i}", 0.9, scene(
            '<ground name="floor" normal="1 0 0" offset="-0.1"/>\n' + link("a", 1.0, (0, -0.3), 0.04)
            + joint("h", "continuous", "world", "a") + ball("b", 0.05, 0.7, (0, -0.4))
            .replace("<inertial>", '<inertial><origin xyz="0 -0.3 0"/>')
            + joint("k", "continuous", "a", "b", (0, -0.6)) + contact("b", "floor", r(0.3, 0.8), stiffness(0.7)),
            initial("h", r(0.5, 0.8)) + initial("k", r(-0.2, 0.3)) + probe("b", "0 -0.4 0"))
    for i in range(4):
        m, n = math.exp(r(-1, 1)), math.exp(r(-1, 1))
        yield f"two balls {i}", 0.6, scene(
            ball("a", 0.08, m) + free("a", 0.0, 0.0) + ball("b", 0.06, n) + free("b", 0.5, r(-0.08, 0.08))
            + contact("a", "b", r(0.3, 0.9), stiffness(m * n / (m + n))),
            thrown("a", r(1, 2)) + thrown("b", -r(0.5, 1.5)) + probe("a") + probe("b"), 0.0)
    for i in range(2):
        yield f"ball on a ball {i}", 0.55, scene(
            ground() + ball("a", 0.08, 1.0) + free("a", 0.0, r(0.2, 0.4)) + ball("b", 0.05, 0.3) + free("b", 0.0, 0.6)
            + contact("a", "floor", r(0.5, 0.9), stiffness(1.0)) + contact("b", "a", r(0.5, 0.9), stiffness(0.3)),
            probe("a") + probe("b"))
    for i in range(4):
        tilt, spin = (0.0, 0.0) if i == 0 else (r(0.1, 0.6), r(-2, 2))
        yield f"box {i}", 0.6, scene(
            ground(tilt) + '<link name="b"><inertial><mass value="0.8"/><inertia ixx="1e-3" iyy="1e-3" izz="3e-3" '
            'ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><box size="0.2 0.12 0.1"/></geometry></collision>'
            '</link>\n' + free("b", 0.0, r(0.25, 0.4)) + contact("b", "floor", r(0.3, 0.8), stiffness(0.8) / 4),
            thrown("b", 0.0, 0.0, spin) + probe("b", "0.1 0.06 0"))


def all_scenes():
    found = []
    groups = (forces, stops, frictions, drives, servos, loops, motions, couplings, smooth, flexible, contacts)
    for seed, group in enumerate(groups):
        for name, until, text in group(random.Random(20261126 + seed)):
            found.append(Scene(group.__name__, name, group is not smooth, until, text, group is not flexible))
    return found
