"""The force at which the right-angle frame buckles sideways."""

import time

import numpy
from scipy.optimize import brentq

from flexarm import Simulation
from flexarm.validation import Row


def stiffness(case, load, **parameters):
    """Square of the lowest frequency in equilibrium [1/s^2]; negative if the frame in its plane is not stable."""
    simulation = Simulation(case.scene("frame.urdf", {"load": load, **parameters}))
    simulation.solve_static(stable=False)
    mode = simulation.natural_modes(1)[0]
    return -mode.rate ** 2 if mode.rate > 0 else (2 * numpy.pi * mode.frequency) ** 2


def critical(case, **parameters):
    return brentq(lambda load: stiffness(case, load, **parameters), 0.9, 1.2, xtol=1e-9)


def compare(case):
    row, = case.table("numbers.csv")
    start = time.process_time()
    force = critical(case)
    seconds = time.process_time() - start
    exact_torsion = critical(case, torsion=0.03 * 0.0006 ** 3 / 3 * (1 - 0.63 * 0.02))
    yield Row("buckling force", row["force_n"], force, row["uncertainty_n"], "N", "calculated",
              "J of a thin strip; %.4f N with Saint-Venant's J; %.1g s of processor time" % (exact_torsion, seconds))

    def draw(axes):
        loads = numpy.linspace(0, 1.2, 25)
        axes.plot(loads, [stiffness(case, load) for load in loads], label="flexarm")
        axes.axvline(row["force_n"], color="0.5", ls="--", label="published buckling force")
        axes.axhline(0, color="0.8", lw=0.8)
        axes.set(xlabel="force [N]", ylabel="square of the lowest frequency [1/s$^2$]")
        axes.legend(fontsize="small")

    case.draw(draw)
