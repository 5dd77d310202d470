"""Two equal strands wound around each other: the closed form of docs/notes/contact.md 6, and its tests, for pytest.

The form is the uniform ply of Thompson, van der Heijden and Neukirch (2002), without friction. Both centrelines are
helices of radius r [m], opposite each other; b is the angle of their tangents with the axis. Strands may also stretch
and shear by a linear law. Then the section's angle is beta, the line is longer by the factor `stretch`, and the helix
turns about the axis by `turn` per length of the undeformed line [1/m]. Forces are in N, moments in N m, of one strand.
"""

import numpy as np
from scipy.linalg import expm

from reference_beam import hat

STIFF = 1e12  # stiffness of strands that neither stretch nor shear, relative to B / r^2


def ply(r, b, twist, axial, bending, torsion, stretching=None, shearing=None):
    """Return a dict of the results. axial: force along the axis. twist: twist of the section per length [1/m]."""
    stretching = stretching or STIFF * bending / r**2
    shearing = shearing or STIFF * bending / r**2
    stretch, beta = 1.0, b
    for _ in range(100):
        turn = stretch * np.sin(b) / r
        bend = bending * turn * np.sin(beta)
        around = torsion * twist * np.sin(beta) - bend * np.cos(beta)  # moment along the circle
        across = np.tan(b) * (axial - around / r)  # force along the circle
        tension = across * np.sin(beta) + axial * np.cos(beta)
        shear = axial * np.sin(beta) - across * np.cos(beta)
        beta = b + np.arctan2(shear / shearing, 1 + tension / stretching)
        stretch = np.hypot(shear / shearing, 1 + tension / stretching)
    return {
        "contact": turn * across,  # per undeformed length
        "bending": bend,
        "tension": tension,
        "shear": shear,
        "moment": bend * np.sin(beta) + torsion * twist * np.cos(beta) + r * across,  # about the axis, with the arm r
        "beta": beta,
        "stretch": stretch,
        "turn": turn,
    }


def error_of_virtual_work(random):
    """Compare derivatives of a ply's energy per length by b and r: the moment works on the rotation, the contact force
    on r."""
    r, bending, torsion, axial = random.uniform(0.5, 2, 4)
    b, more = random.uniform(0.1, 0.7), random.uniform(-0.3, 0.3)  # twist in excess of sections that follow the helix

    def potential(r, b, moment):
        curvature, twist = np.sin(b) ** 2 / r, np.sin(b) * np.cos(b) / r + more
        work = axial * np.cos(b) + moment * np.sin(b) / r
        return 0.5 * bending * curvature**2 + 0.5 * torsion * twist**2 - work

    h = 1e-5
    by_b = (potential(r, b + h, 0) - potential(r, b - h, 0)) / (2 * h)
    moment = by_b * r / np.cos(b)  # such that the potential is stationary in b
    contact = (potential(r + h, b, moment) - potential(r - h, b, moment)) / (2 * h)
    form = ply(r, b, np.sin(b) * np.cos(b) / r + more, axial, bending, torsion)
    return max(abs(moment / form["moment"] - 1), abs(contact / form["contact"] - 1))


def error_of_balance(random):
    """Check the balances of a strand that is built step by step with its own strains: return the largest residual."""
    r, bending, torsion, axial = random.uniform(0.5, 2, 4)
    stretching, shearing = random.uniform(10, 50, 2)
    b, twist = random.uniform(0.1, 0.7), random.uniform(-0.3, 0.3)
    form = ply(r, b, twist, axial, bending, torsion, stretching, shearing)
    beta = form["beta"]
    turn, pitch = form["turn"], form["stretch"] * np.cos(b)
    more = twist - turn * np.cos(beta)  # rotation of sections relative to the helix

    def pose(s):
        radial, around, along = expm(hat([0, 0, turn * s])).T
        section = np.cos(beta) * along + np.sin(beta) * around
        frame = np.column_stack([radial, np.cross(section, radial), section])
        return r * radial + [0, 0, pitch * s], frame @ expm(hat([0, 0, more * s]))

    def derivative(function, s, h=2e-3):
        return (8 * (function(s + h) - function(s - h)) - function(s + 2 * h) + function(s - 2 * h)) / (12 * h)

    def force_and_moment(s):
        frame = pose(s)[1]
        gamma = frame.T @ derivative(lambda t: pose(t)[0], s) - [0, 0, 1]
        turned = frame.T @ derivative(lambda t: pose(t)[1], s)
        kappa = np.array([turned[2, 1], turned[0, 2], turned[1, 0]])
        return np.r_[frame @ (np.array([shearing, shearing, stretching]) * gamma),
                     frame @ (np.array([bending, bending, torsion]) * kappa)]

    s = random.uniform(0, 3)
    change, radial = derivative(force_and_moment, s), pose(s)[0] * [1, 1, 0] / r
    force, moment = np.split(force_and_moment(s), 2)
    residual = np.r_[change[:3] + form["contact"] * radial,
                     change[3:] + np.cross(derivative(lambda t: pose(t)[0], s), force)]
    arm = np.cross(pose(s)[0], force)[2]
    return max(np.abs(residual).max(), abs(force[2] - axial), abs(moment[2] + arm - form["moment"]))


def test_ply():
    random = np.random.default_rng(5)
    assert max(error_of_virtual_work(random) for _ in range(20)) < 1e-8
    assert max(error_of_balance(random) for _ in range(5)) < 1e-8
