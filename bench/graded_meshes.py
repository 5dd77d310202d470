#!/usr/bin/python3
"""Measure the gain of meshes whose elements have different lengths within a beam: the tables of docs/notes/tuning.md,
8.

graded_meshes.py [WORD ...]: uses the scenes with one of these words in their names. All scenes take two minutes of
processor time. Element borders are chosen in two ways: where the error of the judged motion is least, which no rule
could know in advance, and by a rule from the curvature.
"""

import itertools
import os
import sys
import xml.etree.ElementTree as ElementTree

import numpy
import yaml
from scipy.optimize import minimize

import flexarm

CONFIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config")
ORDERS, MOST, COST = (1, 2, 3), 8, {1: 1, 2: 2, 3: 4}
ACCURACIES = (1e-2, 1e-3, 1e-4)


def section(bending, mass, axial, inertia=1e-4):
    return (f'<section ea="{axial}" ga2="{0.4 * axial}" ga3="{0.4 * axial}" gj="{bending}" ei2="{bending}" '
            f'ei3="{bending}" mass="{mass}" j1="{2 * inertia}" j2="{inertia}" j3="{inertia}"/>')


def cone(first, last):
    return (f'<stations> <station at="0"> <circle radius="{first}"/> </station> '
            f'<station at="2"> <circle radius="{last}"/> </station> </stations> '
            '<material young="70e9" poisson="0.33" density="2700"/>')


def force(at, xyz, history):
    return f'<load link="arm" at="{at} 0 0" force="{xyz}" history="{history}"/>'


def turned(duration):
    ramp = f"t/{duration} - sin(2*_pi*t/{duration})/(2*_pi)"
    return f'<motion joint="root" position="t &lt; {duration} ? {ramp} : 1"/>'


def arm(joint, beam, motion="", load=None, gravity="0 0 -9.81", damping=5e-4, length=1):
    """Return the scene of a straight beam along x. `load`: a mass [kg], its place along the beam [m], its inertia [kg
    m^2]."""
    carried = """
      <joint name="grip" type="fixed"> <parent link="arm"/> <child link="load"/> <origin xyz="{1} 0 0"/> </joint>
      <link name="load"> <inertial> <mass value="{0}"/> <inertia ixx="{2}" iyy="{2}" izz="{2}" ixy="0" ixz="0" iyz="0"/>
      </inertial> </link>""".format(*load) if load else ""
    axis = '<axis xyz="0 1 0"/>' if joint == "continuous" else ""
    return f"""<robot name="arm"> <link name="world"/>
      <joint name="root" type="{joint}"> <parent link="world"/> <child link="arm"/> {axis} </joint>
      <link name="arm"> <beam> <centerline> <line to="{length} 0 0"/> </centerline> <orientation y="0 1 0"/> {beam}
        <damping stiffness_proportional="{damping}"/> </beam> </link> {carried}
      <simulation> <gravity xyz="{gravity}"/> {motion}
        <probe name="tip" link="arm" at="{length} 0 0"/> </simulation> </robot>"""


def cantilever(bending, motion="", gravity="0 0 -9.81"):
    return arm("fixed", section(bending, 0.1, 1e5), motion, (0.5, 1, 1e-3), gravity, 2e-2)


def boom(last, motion, mass=0.3):
    return arm("continuous", cone(0.02, last), motion, (mass, 2, 1e-3), length=2)


def config(path):
    with open(os.path.join(CONFIG, path), encoding="utf-8") as file:
        return file.read()


ROTOR = section(0.05, 0.1, 1e4, 1e-6) + '<hub at="start" mass="10" inertia="10 10 10"/>'
SPUN = '<initial joint="root" velocity="20"/>' + force(1, "0 2 0", "0:0 0.1:0 0.2:1 0.3:0")
PULLED = force(1, "20 0 0", "0:0 0.3:1") + force(1, "0 0 4", "0:0 0.4:0 0.5:1 0.6:0")
# (name, beam): scene, borders that all its meshes have (relative to its length), time [s], step [s], steps between
# judged times.
SCENES = {
    ("demo arm", "upper_arm"): (config("demo_arm.urdf"), [], 5, 5e-3, 20),
    ("demo arm", "lower_arm"): (config("demo_arm.urdf"), [], 5, 5e-3, 20),
    ("two-link arm", "upper_arm"): (config("examples/flexible_two_link_arm.urdf"), [], 1, 2.5e-3, 4),
    ("two-link arm", "forearm"): (config("examples/flexible_two_link_arm.urdf"), [], 1, 2.5e-3, 4),
    ("slewing arm", "arm"): (config("sweep/slewing_arm.urdf"), [], 1.5, 2.5e-3, 5),
    ("six-axis arm", "forearm"): (config("examples/six_axis_arm.urdf"), [], 2, 4e-3, 10),
    ("four-bar", "coupler"): (config("examples/four_bar.urdf"), [], 2, 2e-3, 5),
    ("double pendulum", "upper"): (config("speed/double_pendulum.urdf"), [], 1.5, 4e-3, 5),
    ("double pendulum", "lower"): (config("speed/double_pendulum.urdf"), [], 1.5, 4e-3, 5),
    ("spin-up", "arm"): (config("speed/spin_up.urdf"), [], 20, 0.05, 2),
    ("flying spaghetti", "beam"): (config("speed/flying_spaghetti.urdf"), [], 8, 0.05, 1),
    ("right-angle cantilever", "legs"): (config("speed/right_angle_cantilever.urdf"), [0.5], 20, 0.1, 2),
    ("bent by 0.2 L", "arm"): (cantilever(10), [], 2, 5e-3, 5),
    ("load in the middle", "arm"): (
        arm("continuous", section(200, 1, 1e6), "", (10, 2, 0.05), length=4), [0.5], 1.5, 5e-3, 5),
    ("blow at 0.3 L", "arm"): (
        arm("continuous", section(20, 1, 1e6), force(0.3, "0 0 400", "0:0 0.01:0 0.015:1 0.02:0"), gravity="0 0 0"),
        [0.3], 0.3, 1e-3, 2),
    ("boom, 2 : 1", "arm"): (boom(0.01, turned(0.6)), [], 1.2, 2.5e-3, 4),
    ("boom, 4 : 1", "arm"): (boom(0.005, turned(0.6)), [], 1.2, 2.5e-3, 4),
    ("elastica", "arm"): (cantilever(1), [], 2, 5e-3, 5),
    ("pulled cable", "arm"): (
        arm("fixed", section(0.02, 0.1, 1e5, 1e-6), PULLED, (0.1, 1, 1e-5), "0 0 0"), [], 1.2, 2e-3, 4),
    ("soft rotor", "arm"): (arm("continuous", ROTOR, SPUN, None, "0 0 0", 2e-3), [], 0.8, 2e-3, 4),
    ("hanging hose", "arm"): (
        arm("fixed", section(0.02, 0.2, 1e4, 1e-6), force(1, "0 0 2", "0:0 0.2:1 0.4:0"), (0.2, 1, 1e-5), "9.81 0 0",
            1e-2), [], 2, 4e-3, 5),
}
# Other motions of the same beams, to test whether a mesh that is good for one motion is good for others.
OTHERS = {
    "elastica": {"pushed sideways": cantilever(1, force(1, "0 3 0", "0:0 0.3:1 0.6:0"), "0 0 0"),
                 "pulled along": cantilever(1, gravity="3 0 -1")},
    "boom, 4 : 1": {"let go": boom(0.005, ""), "thrice as fast, 1 kg": boom(0.005, turned(0.2), 1)},
}


def demo_efforts(steps, step):
    times, efforts = (numpy.arange(steps) + 0.5) * step, numpy.zeros((steps, 2))
    for command in yaml.safe_load(config("demo_commands.yaml"))["commands"]:
        for k in range(command.get("repeat", 1)):
            begin = command["time"] + k * command.get("every", 0)
            if begin < times[-1]:
                efforts[(times > begin) & (times < begin + command["duration"])] += command["efforts"]
    return {"efforts": efforts, "joints": ["shoulder_yaw", "wrist_yaw"]}


class Beam:
    """The error that the mesh of one beam causes in the probes. All other beams have two elements of order 3."""

    def __init__(self, name, link, scene, fixed, until, step, every):
        self.scene, self.link, self.step, self.every = scene, link, step, every
        self.fixed, self.steps = [0, *fixed, 1], round(until / step)
        self.commands = demo_efforts(self.steps, step) if name == "demo arm" else {}
        lines = ElementTree.fromstring(scene).findall(f"link[@name='{link}']/beam/centerline/line")
        self.corners = numpy.array([[0.0] * 3] + [[float(x) for x in line.get("to").split()] for line in lines])
        lengths = numpy.linalg.norm(numpy.diff(self.corners, axis=0), axis=1)
        self.corners_at = numpy.append(0, numpy.cumsum(lengths)) / lengths.sum()
        self.rich = self.positions(16, 4)
        self.scale = numpy.linalg.norm(self.rich - self.rich[0], axis=2).max()

    def simulation(self, mesh, order):
        """Return a simulation. `mesh` is a number of equally long elements, or the list of their borders; then the
        centreline gets a straight piece for each element."""
        root = ElementTree.fromstring(self.scene)
        for link in root.findall("link[beam]"):
            beam, is_judged = link.find("beam"), link.get("name") == self.link
            count = mesh if isinstance(mesh, int) else len(mesh) - 1
            beam.set("elements", str(count if is_judged else 2))
            beam.set("order", str(order if is_judged else 3))
            if is_judged and not isinstance(mesh, int):
                line = beam.find("centerline")
                line[:] = []
                for s in mesh[1:]:
                    point = [float(numpy.interp(s, self.corners_at, self.corners[:, i])) for i in range(3)]
                    ElementTree.SubElement(line, "line", to=" ".join(map(repr, point)))
        scene = flexarm.read_scene_text(ElementTree.tostring(root, encoding="unicode"))
        return flexarm.Simulation(scene, scheme="em", step=self.step, tolerance=1e-8)

    def positions(self, mesh, order):
        rows = self.simulation(mesh, order).run(self.steps, record=["probe/*/[xyz]"], every=self.every, **self.commands)
        return rows[:, 1:].reshape(len(rows), -1, 3)

    def error(self, mesh, order):
        """Return the error as docs/notes/accuracy.md defines it, or infinity if a step fails."""
        try:
            squares = ((self.positions(mesh, order) - self.rich) ** 2).sum(axis=2)
        except flexarm.StepError:
            return numpy.inf
        squares[-1] /= 2
        return numpy.sqrt(squares.sum(axis=0) / len(squares)).max() / self.scale

    def allocations(self, count):
        """Return how many elements lie between each two fixed borders: the four allocations nearest to equal
        lengths."""
        parts = numpy.diff(self.fixed)
        found = [c for c in itertools.product(range(1, count + 1), repeat=len(parts)) if sum(c) == count]
        return sorted(found, key=lambda c: abs(numpy.array(c) - count * parts).sum())[:4]

    def borders(self, allocation, logarithms):
        """Return the borders of elements whose lengths have these logarithms, scaled to fit between the fixed
        borders."""
        out, first = [0.0], 0
        for begin, end, count in zip(self.fixed, self.fixed[1:], allocation):
            lengths = numpy.exp(logarithms[first:first + count])
            out += [*(begin + (end - begin) * numpy.cumsum(lengths) / lengths.sum())[:-1], float(end)]
            first += count
        return out

    def best(self, count, order):
        """Return the least error found, and its mesh. The search varies two numbers or, for up to four elements, each
        length."""
        found = [(self.error(count, order), count)]

        def judge(allocation, logarithms):
            if numpy.ptp(logarithms) > 5:
                return 1e3
            mesh = self.borders(allocation, logarithms)
            found.append((self.error(mesh, order), mesh))
            return numpy.log10(max(found[-1][0], 1e-12))

        for allocation in self.allocations(count):
            if max(allocation) == 1:
                continue
            along = numpy.concatenate([numpy.linspace(-1, 1, n) if n > 1 else [0] for n in allocation])
            ways = numpy.array([along, abs(along) - 0.5])
            starts = [(-1.2, 0), (-0.5, 0), (0, 0), (0.5, 0), (1.2, 0), (0, -0.8), (0, 0.8), (0.5, 0.8), (-0.5, 0.8)]
            base = min((numpy.array(x) @ ways for x in starts), key=lambda x: judge(allocation, x))
            if count <= 4:
                ways = numpy.delete(numpy.eye(count), numpy.cumsum((0,) + allocation[:-1]), axis=0)
            corners = numpy.vstack([numpy.zeros(len(ways)), 0.3 * numpy.eye(len(ways))])
            minimize(lambda x: judge(allocation, base + x @ ways), corners[0], method="Nelder-Mead",
                     options={"maxfev": 60, "initial_simplex": corners, "xatol": 0.02, "fatol": 0.01})
        return min(found, key=lambda x: x[0])

    def by_curvature(self, count, order):
        """Return borders so that h^(p+1) |d^p curvature / ds^p| is the same in all elements. The derivative is a root
        mean square over time."""
        simulation, strains, every = self.simulation(10, 4), [], self.steps // 40
        for k in range(40):
            commands = dict(self.commands)
            if commands:
                commands["efforts"] = commands["efforts"][k * every:(k + 1) * every]
            simulation.run(every, **commands)
            points = simulation.beam_points(self.link, 3)
            strains.append(points["strain"][:, 3:])
        x, fine = 2 * points["arc_length"] / points["arc_length"][-1] - 1, numpy.linspace(-1, 1, 801)
        curvature = numpy.polynomial.chebyshev.chebfit(x, numpy.moveaxis(strains, 1, 0).reshape(len(x), -1), 10)
        derivative = numpy.polynomial.chebyshev.chebval(fine, numpy.polynomial.chebyshev.chebder(curvature, order))
        density = numpy.sqrt((derivative ** 2).mean(axis=0)) ** (1 / (order + 1))
        density += 0.1 * density.mean()
        share = numpy.append(0, numpy.cumsum(density[1:] + density[:-1]))
        return [0.0, *(0.5 + 0.5 * numpy.interp(numpy.arange(1, count) / count, share / share[-1], fine)), 1.0]


def errors(beam):
    """Return, for each order and number of elements, the errors of three meshes: equal lengths, best found, by
    curvature."""
    found = {}
    for order in ORDERS:
        for count in range(len(beam.fixed) - 1, MOST + 1):
            has_rule, is_done = len(beam.fixed) == 2, found.get((order, count - 1), [1])[0] <= min(ACCURACIES)
            equal = beam.error(count, order)
            best = equal if is_done else beam.best(count, order)[0]
            ruled = beam.error(beam.by_curvature(count, order), order) if has_rule else numpy.inf
            found[order, count] = (equal, best, ruled)
            if max(equal, ruled if has_rule else 0) <= min(ACCURACIES):
                break
    return found


def least(found, kind, accuracy, cost):
    """Return the least cost of a mesh that is accurate enough. `cost` is the cost of an element by its order."""
    enough = [cost[order] * count for (order, count), error in found.items()
              if order in cost and error[kind] <= accuracy]
    return str(min(enough, default="–"))


def main(words):
    chosen = [key for key in SCENES if not words or any(word in key[0] for word in words)]
    heads = [f"{of}{accuracy:.0e}" for of in ("", "cost, ") for accuracy in ACCURACIES]
    print("| scene, beam | " + " | ".join(heads) + " |")
    print("|---|" + 6 * "--:|")
    for name, link in chosen:
        beam = Beam(name, link, *SCENES[name, link])
        found, kinds = errors(beam), range(3 if len(beam.fixed) == 2 else 2)
        cells = [", ".join(least(found, kind, accuracy, cost) for kind in kinds)
                 for cost in ({2: 1}, COST) for accuracy in ACCURACIES]
        print(f"| {name}, {link} | " + " | ".join(cells) + " |", flush=True)
    print("\n| beam | other motion | elements | equal | best for the first motion | best |\n|---|---|--:|--:|--:|--:|")
    for name, link in chosen:
        for motion, scene in OTHERS.get(name, {}).items():
            first, other = Beam(name, link, *SCENES[name, link]), Beam(name, link, scene, *SCENES[name, link][1:])
            for count in (2, 3, 4):
                row = other.error(count, 2), other.error(first.best(count, 2)[1], 2), other.best(count, 2)[0]
                print(f"| {name} | {motion} | {count} | " + " | ".join(f"{x:.1e}" for x in row) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
