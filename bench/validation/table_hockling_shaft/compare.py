"""The torque at which a clamped shaft buckles into a screw line."""

import time

import numpy
from scipy.optimize import brentq

from flexarm import Simulation
from flexarm.validation import Row

STIFFNESS, LENGTH = 71240 * 0.0833, 240


def equilibrium(case, torque, elements=10):
    simulation = Simulation(case.scene("shaft.urdf", {"torque": torque, "elements": elements}))
    simulation.solve_static(stable=False)
    return simulation


def stiffness(case, torque, elements=10):
    """Square of the lowest frequency of the straight, twisted shaft; negative if it is not stable."""
    mode = equilibrium(case, torque, elements).natural_modes(1)[0]
    return -mode.rate ** 2 if mode.rate > 0 else (2 * numpy.pi * mode.frequency) ** 2


def factor(case, elements):
    """lambda of the torque at which the shaft buckles."""
    torque = brentq(lambda value: stiffness(case, value, elements), 200, 240, xtol=1e-8)
    return torque * LENGTH / (2 * STIFFNESS)


def compare(case):
    row, = case.table("numbers.csv")
    start = time.process_time()
    found = factor(case, 20)
    yield Row("torque over 2 EI/L", row["factor"], found, row["uncertainty"], "-", "closed form",
              "five digits; %.1g s of processor time" % (time.process_time() - start))

    def draw(axes):
        counts = [4, 6, 8, 12, 16]
        axes.loglog(counts, [abs(factor(case, count) - 4.493409457909064) for count in counts], "o-", label="order 3")
        axes.set(xlabel="elements", ylabel="error of the factor")
        axes.legend(fontsize="small")

    case.draw(draw)
