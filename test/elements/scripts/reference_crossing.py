"""Two crossing beams of a published example, and the limit for finer meshes: docs/notes/contact.md 6.

The example is `beam3_line2_genalpha_contact_penalty_twocrossedbeams` of the tests of 4C Multiphysics, the program of
Meier, Popp and Wall. One beam is clamped at both ends. A straight one is moved across it, slowly compared with their
vibrations. The example gives the end of the motion, and the position of node 8 there. This file finds it as the minimum
of energy of the same elements, which are straight, with Reissner's strains at one point each. The penalty acts at the
nearest point of each element, if this point is inside of the element. For the limit, the same penalty per length acts
at nodes, over about one radius. Units are those of the example. Tests for pytest of the numbers that
test/reference/crossing_beams_test.cpp compares with.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stated_numbers import stated_numbers

LENGTH, RADIUS, PENALTY = 5.0, 0.3, 1e6
FROM, TO = np.array([-2.5, 0, 0]), np.array([1.830127018922193, -2.5, 0])
ACROSS = np.array([0.8550503583141718, 2.349231551964771, 0])  # direction of the upper beam
BEGIN, WAY = np.array([0, 0, 1.32]), np.array([-0.4, 0, -2.5])  # a point of the upper beam's line, and its displacement
AREA, SECOND_MOMENT = 0.282743, 0.00636173
STIFFNESS = np.array([1e5 * AREA, 5e4 * 1.1 * AREA, 5e4 * 1.1 * AREA,
                      5e4 * 0.0127235, 1e5 * SECOND_MOMENT, 1e5 * SECOND_MOMENT])
PUBLISHED = np.array([-2.35320636690075330e-01, 8.03793046908387043e-02, -1.64147761604003972e00])
PLACE = 7 / 19  # position of node 8 along the beam


class LowerBeam:
    """The lower beam in equilibrium, as the minimum of a sum of squares."""

    def __init__(self, elements, per_length=None):
        self.elements, self.size, self.per_length = elements, LENGTH / elements, per_length
        along = (TO - FROM) / LENGTH
        self.start = FROM + np.outer(np.linspace(0, 1, elements + 1), TO - FROM)
        self.frame = Rotation.from_matrix(np.column_stack([along, np.cross([0, 0, 1], along), [0, 0, 1]]))
        side = np.cross(ACROSS / np.linalg.norm(ACROSS), [0, 0, 1])
        self.plane = np.array([side, [0, 0, 1]])  # axes across the upper beam
        self.unknowns = np.zeros((elements - 1, 6))  # displacements and rotation vectors of inner nodes

    def nodes(self, unknowns):
        turns = np.zeros((self.elements + 1, 3))
        places = self.start.copy()
        places[1:-1] += unknowns[:, :3]
        turns[1:-1] = unknowns[:, 3:]
        return places, Rotation.from_rotvec(turns) * self.frame

    def penetrations(self, places, part):
        offset = (places - BEGIN - part * WAY) @ self.plane.T
        if self.per_length:
            return 2 * RADIUS - np.linalg.norm(offset[1:], axis=1)
        first, edge = offset[:-1], np.diff(offset, axis=0)
        at = -(first * edge).sum(1) / (edge * edge).sum(1)
        distance = np.linalg.norm(first + at[:, None] * edge, axis=1)
        return np.where((at >= 0) & (at <= 1), 2 * RADIUS - distance, 0)

    def squares(self, unknowns, part):
        """Return terms whose sum of squares is twice the energy: a row of seven for each element."""
        places, frames = self.nodes(unknowns)
        turned = (frames[:-1].inv() * frames[1:]).as_rotvec()
        middle = frames[:-1] * Rotation.from_rotvec(0.5 * turned)
        stretch = middle.inv().apply(np.diff(places, axis=0) / self.size) - [1, 0, 0]
        penalty = self.per_length * self.size if self.per_length else PENALTY
        pushed = np.sqrt(penalty) * np.maximum(self.penetrations(places, part), 0)
        strains = np.c_[stretch, turned / self.size] * np.sqrt(STIFFNESS * self.size)
        return np.c_[strains, pushed]

    def groups(self):
        """Return groups of unknowns that share no element: (nodes, number of the unknown)."""
        return [(np.arange(first, self.elements - 1, 3), k) for first in range(3) for k in range(6)]

    def jacobian(self, unknowns, part, step=1e-5):
        out = np.zeros((self.elements, 7, self.elements - 1, 6))
        for nodes, k in self.groups():
            move = np.zeros_like(unknowns)
            move[nodes, k] = step
            change = (self.squares(unknowns + move, part) - self.squares(unknowns - move, part)) / (2 * step)
            out[nodes, :, nodes, k], out[nodes + 1, :, nodes, k] = change[nodes], change[nodes + 1]
        return out.reshape(7 * self.elements, -1)

    def gradient(self, unknowns, part):
        return (self.jacobian(unknowns, part).T @ self.squares(unknowns, part).ravel()).reshape(-1, 6)

    def hessian(self, unknowns, part, step=1e-4):
        count = self.elements - 1
        out = np.zeros((count, 6, count, 6))
        for nodes, k in self.groups():
            move = np.zeros_like(unknowns)
            move[nodes, k] = step
            change = (self.gradient(unknowns + move, part) - self.gradient(unknowns - move, part)) / (2 * step)
            for shift in (-1, 0, 1):
                near = nodes[(nodes + shift >= 0) & (nodes + shift < count)]
                out[near + shift, :, near, k] = change[near + shift]
        out = out.reshape(6 * count, 6 * count)
        return 0.5 * (out + out.T)

    def relax(self, part):
        energy = lambda unknowns: 0.5 * (self.squares(unknowns, part) ** 2).sum()
        for iteration in range(60):
            gradient = self.gradient(self.unknowns, part)
            if np.abs(gradient).max() < 1e-3:
                return
            jacobian = self.jacobian(self.unknowns, part)
            matrix = self.hessian(self.unknowns, part) if iteration > 2 else jacobian.T @ jacobian
            update = -np.linalg.solve(matrix, gradient.ravel()).reshape(-1, 6)
            if (gradient * update).sum() > 0:
                update = -np.linalg.solve(jacobian.T @ jacobian, gradient.ravel()).reshape(-1, 6)
            scale, begin = 1.0, energy(self.unknowns)
            while energy(self.unknowns + scale * update) > begin * (1 + 1e-9) and scale > 1e-4:
                scale *= 0.5
            self.unknowns = self.unknowns + scale * update
        raise RuntimeError("no equilibrium")

    def displacement(self, steps):
        for part in np.linspace(0.3, 1, steps):
            self.relax(part)
        return self.unknowns[round(PLACE * self.elements) - 1, :3]


def test_the_mesh_of_the_example_gives_what_is_published():
    assert LowerBeam(19).displacement(15) == pytest.approx(PUBLISHED, abs=1e-4)


@pytest.mark.parametrize("per_length, depth, place", [(PENALTY / RADIUS, "kDeep = ", "kWhenDeep"),
                                                      (9.734e6, "kShallow = ", "kWhenShallow")])
def test_the_limit_for_finer_meshes(per_length, depth, place):
    beam = LowerBeam(76, per_length)
    source = "reference/crossing_beams_test.cpp"
    assert beam.displacement(10) == pytest.approx(stated_numbers(source, place + "(", 3), abs=2e-6)
    deepest = beam.penetrations(beam.nodes(beam.unknowns)[0], 1).max()
    assert deepest == pytest.approx(stated_numbers(source, depth, 1)[0], abs=5e-8)  # of the digits
