"""A model rotor blade with a section table: frequencies over the speed, beside another program's."""

import math
import os
import tempfile

import numpy

from flexarm import Simulation, read_scene
from flexarm.validation import Row

INCH, POUND, PSI = 0.0254, 4.4482216, 6894.757  # m, N, Pa
GRAVITY = 386.2 * INCH  # with which the other program took weights for masses [m/s^2]
YOUNG, POISSON = 1.0e7 * PSI, 0.3
HINGE, TIP, CUT = 3.0, 55.0, 1e-6  # radii; half of the gap between sections in the table [in]
MODES = {"rigid_lag_Hz": ("lag", 0), "rigid_flap_Hz": ("flap", 0), "flap1_Hz": ("flap", 1), "flap2_Hz": ("flap", 2),
         "lag1_Hz": ("lag", 1), "flap3_Hz": ("flap", 3), "torsion1_Hz": ("torsion", 0)}
LIGHT, SMALL = 0.02, 1e-6  # mass and polar inertia of sections whose mass is a body's [kg/m, kg m]
# Another discretisation of the same table, and digits; how it splits the inertia of a section is not told.
UNCERTAINTY, DIGIT = 0.01, 0.01  # relative; Hz
SMALLEST = 0.5  # slower motions about the hinges at rest say nothing [Hz]


def station(section, is_offset):
    """Stiffnesses and inertia of a section in SI units; little mass if a body has most of it."""
    mass = LIGHT if is_offset else section["weight_lb_per_in"] * POUND / GRAVITY / INCH
    polar = SMALL if is_offset else section["weight_moment_of_inertia_lb_in2_per_in"] * POUND / GRAVITY * INCH
    shear = 5 / 6 * YOUNG / (2 * (1 + POISSON)) * section["spar_area_in2"] * INCH ** 2
    flap, chord = (YOUNG * section[key] * INCH ** 4 for key in ("I_flapwise_in4", "I_chordwise_in4"))
    share = section["I_flapwise_in4"] / (section["I_flapwise_in4"] + section["I_chordwise_in4"])
    return {"ea": YOUNG * section["spar_area_in2"] * INCH ** 2, "ga2": shear, "ga3": shear,
            "gj": YOUNG / (2 * (1 + POISSON)) * section["J_torsion_in4"] * INCH ** 4, "ei2": flap, "ei3": chord,
            "mass": mass, "j1": polar, "j2": share * polar, "j3": (1 - share) * polar}


def body(number, section, middle, length):
    """A rigid body with the mass of a section whose centre of mass is off the line."""
    mass = (section["weight_lb_per_in"] * POUND / GRAVITY - LIGHT * INCH) * length
    polar = (section["weight_moment_of_inertia_lb_in2_per_in"] * POUND / GRAVITY * INCH - SMALL) * length * INCH
    return ('<joint name="at_%d" type="fixed"> <parent link="blade"/> <child link="body_%d"/> '
            '<origin xyz="%.9g 0 0"/> </joint>\n'
            '<link name="body_%d"> <inertial> <origin xyz="0 %.9g 0"/> <mass value="%.9g"/> '
            '<inertia ixx="%.9g" iyy="%.9g" izz="%.9g" ixy="0" ixz="0" iyz="0"/> </inertial> </link>\n'
            % (number, number, (middle - HINGE) * INCH, number, section["cg_forward_of_elastic_axis_in"] * INCH, mass,
               polar, polar / 2, polar / 2))


def write_scene(case, folder):
    """Writes the scene with the section table. Returns its path."""
    sections = case.table("sections.csv")
    ends = [section["inboard_radius_in"] for section in sections[1:]] + [TIP]
    rows, bodies = [], ""
    for number, (section, end) in enumerate(zip(sections, ends)):
        begin, is_offset = section["inboard_radius_in"], section["cg_forward_of_elastic_axis_in"] != 0
        row = station(section, is_offset)
        places = begin + (CUT if begin > HINGE else 0), end - CUT
        rows += [[(place - HINGE) * INCH, *row.values()] for place in places]
        if is_offset:
            bodies += body(number, section, (begin + end) / 2, end - begin)
    numpy.savetxt(os.path.join(folder, "stations.csv"), rows, "%.12g", ",", header=",".join(["at", *row]), comments="")
    with open(case.path("blade.urdf"), encoding="utf-8") as file:
        text = file.read()
    # Sections are whole elements.
    pieces = "".join('<line to="%.9g 0 0"/> ' % ((end - HINGE) * INCH) for end in ends)
    text = text.replace('<line to="${tip - hinge} 0 0"/>', pieces).replace("<!-- BODIES -->", bodies)
    path = os.path.join(folder, "blade.urdf")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def frequencies(path, speed_rpm):
    """Frequencies [Hz] in ascending order, by the kind of motion of the tip."""
    simulation = Simulation(read_scene(path, {"speed": speed_rpm * math.pi / 30}))
    model = simulation.linearise([], ["velocity:edge:y", "velocity:edge:z", "velocity:corner:z"], about="steady")
    poles, shapes = numpy.linalg.eig(model.a)
    lag, flap, corner = abs(model.c @ shapes)[:3]
    corner = abs((model.c[2] - model.c[1]) @ shapes)
    found = {"lag": [], "flap": [], "torsion": []}
    for i in numpy.argsort(poles.imag):
        if poles[i].imag > 2 * math.pi * SMALLEST:
            # The corner is 50 mm from the line: in torsion it moves more than the line does.
            sizes = {"lag": lag[i], "flap": flap[i], "torsion": 2 * corner[i]}
            found[max(sizes, key=sizes.get)].append(poles[i].imag / (2 * math.pi))
    return found


def compare(case):
    rows = case.table("numbers.csv")
    with tempfile.TemporaryDirectory() as folder:
        path = write_scene(case, folder)
        found = {row["speed_rpm"]: frequencies(path, row["speed_rpm"]) for row in rows}
    curves = {key: [] for key in MODES}
    for row in rows:
        for key, (kind, number) in MODES.items():
            modes = found[row["speed_rpm"]][kind]
            # At rest the hinges are free: these two motions are then no vibrations.
            number -= kind != "torsion" and row["speed_rpm"] == 0
            curves[key].append(modes[number] if number >= 0 else 0.0)
            if row[key] > SMALLEST:
                yield Row("%g rpm: %s" % (row["speed_rpm"], key[:-3].replace("_", " ")), row[key], curves[key][-1],
                          UNCERTAINTY * row[key] + DIGIT, "Hz", "calculated",
                          "1 %: another discretisation, inertia of sections")
    case.draw(lambda axes: draw(axes, rows, curves))


def draw(axes, rows, curves):
    speeds = [row["speed_rpm"] for row in rows]
    for key, values in curves.items():
        axes.plot(speeds, values, color="black", linewidth=1)
        axes.plot(speeds, [row[key] for row in rows], "o", mfc="none", color="#D55E00")
    axes.plot([], [], "o", mfc="none", color="#D55E00", label="MBDyn")
    axes.plot([], [], color="black", label="flexarm")
    axes.set(xlabel="speed [rpm]", ylabel="frequency [Hz]")
    axes.legend()
