"""Evaluates the samples of scripts/soak: verdict, table, text."""

import csv
import math
import os
from dataclasses import asdict, dataclass, fields

WARM_UP = 0.1  # fraction of the run in which caches fill, and rviz and the bag connect
LARGEST_GROWTH = 3.0  # MiB after the warm-up; a leak of 64 bytes per message at 100 Hz makes more in ten minutes


@dataclass
class Sample:
    """The state of the node at a second of wall time."""

    wall: float  # since the start [s]
    memory: float  # resident [MiB]
    simulated: float  # time of all steps since the start, including those before resets [s]
    real_time_factor: float
    paused: bool
    overruns: int
    iterations: int  # of the last step
    halvings: int  # since the start
    other_guesses: int  # sub-steps that converged from another initial guess than the first one, since the start
    energy: float  # kinetic and strain [J]
    work: float  # since the last reset [J]
    dissipated: float  # since the last reset [J]
    defect: float  # largest change of total - work + dissipated since the last reset, within this second [J]
    error: str  # of the last step; empty if the step succeeded


class EnergyAccount:
    """Tracks the change of total - work + dissipated since the start or the last reset."""

    def __init__(self):
        self.time = math.inf
        self.start = 0.0
        self.largest = 0.0

    def add(self, status):
        account = status.total_energy - status.work + status.dissipated
        if status.time < self.time:  # the first status, or a reset
            self.start = account
        self.time = status.time
        self.largest = max(self.largest, abs(account - self.start))

    def take_largest(self):
        """The largest change since the last call of this function."""
        largest, self.largest = self.largest, 0.0
        return largest


def is_finite(value):
    """Whether all numbers of a message are finite."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, (list, tuple)):
        return all(map(is_finite, value))
    return all(is_finite(getattr(value, name)) for name in getattr(value, "__slots__", ()))


def after_warm_up(samples):
    return [sample for sample in samples if sample.wall >= WARM_UP * samples[-1].wall]


def growth(samples):
    """Growth of the memory after the warm-up [MiB]."""
    steady = after_warm_up(samples)
    return max(sample.memory for sample in steady) - steady[0].memory


def trend(samples):
    """Trend of the memory after the warm-up, by least squares [MiB/h]."""
    steady = after_warm_up(samples)
    wall = sum(sample.wall for sample in steady) / len(steady)
    spread = sum((sample.wall - wall) ** 2 for sample in steady)
    return 3600 * sum((sample.wall - wall) * sample.memory for sample in steady) / spread if spread else 0.0


def find_faults(samples, not_finite, failures, died):
    """A list of everything that happened and must not happen."""
    faults = [f"{count} messages on {topic} with numbers that are not finite" for topic, count in not_finite.items()]
    faults += [f"a step failed: {message}" for message in failures]
    if died:
        faults.append("the node died")
    if samples and growth(samples) > LARGEST_GROWTH:
        faults.append(f"memory grew by {growth(samples):.1f} MiB after the warm-up, more than {LARGEST_GROWTH:g}")
    if not samples:
        faults.append("nothing was seen")
    return faults


def rows(samples, counts, conditions):
    """Yields the rows of the table as pairs."""
    steady, last = after_warm_up(samples), samples[-1]
    # The factor is 0 while the simulation is paused, and until it is measured again.
    running = [sample.real_time_factor for sample in steady if sample.real_time_factor > 0] or [0.0]
    largest_energy = max(sample.energy for sample in samples)
    defect = max(sample.defect for sample in samples)
    yield "wall time [s]", f"{last.wall:.0f}"
    yield "simulated time [s]", f"{last.simulated:.1f}"
    yield from conditions.items()
    for name, count in counts.items():
        yield name, count
    yield f"resident memory after {steady[0].wall:.0f} s and at the end [MiB]", (
        f"{steady[0].memory:.1f}, {last.memory:.1f}")
    yield "its growth: largest [MiB], trend [MiB/h]", f"{growth(samples):.2f}, {trend(samples):.2f}"
    yield "real-time factor while it runs: mean, least", f"{sum(running) / len(running):.3f}, {min(running):.3f}"
    yield "overruns [steps]", last.overruns
    yield "iterations of the steps seen: mean, most", (
        f"{sum(sample.iterations for sample in samples) / len(samples):.2f}, "
        f"{max(sample.iterations for sample in samples)}")
    yield "halvings, sub-steps from another initial guess", f"{last.halvings}, {last.other_guesses}"
    yield "largest kinetic and strain energy [J]", f"{largest_energy:.4g}"
    yield "largest work since a reset [J]", f"{max(abs(sample.work) for sample in samples):.4g}"
    yield "largest change of total - work + dissipated [J]", f"{defect:.1e}"
    yield "the same beside the largest energy", f"{defect / largest_energy:.1e}" if largest_energy > 0 else "–"


INTRODUCTION = """# The demo under random commands

Written by `scripts/soak`: the demo's arm at real time for {minutes:.3g} minutes of wall time, while efforts up to each
joint's limit come at random, about four commands a second, and now and then nonsense, pauses, single steps, resets and
emergency stops; beside it, a bag records all topics. Each second the node's memory and status are noted. Every number
of its joint states, frames, beam states and status, and one message of markers a second, must be finite; memory must
not grow by more than {largest_growth:g} MiB after the warm-up, the first {warm_up:.0f} % of the time.

"""


def write_report(path, samples, counts, observer, died, conditions):
    """Writes PATH.csv and PATH.md. Returns the faults."""
    faults = find_faults(samples, observer.not_finite, observer.failures, died)
    with open(path + ".csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, [field.name for field in fields(Sample)])
        table.writeheader()
        table.writerows(map(asdict, samples))
    with open(path + ".md", "w", encoding="utf-8") as file:
        wall = samples[-1].wall if samples else 0
        file.write(INTRODUCTION.format(minutes=wall / 60, largest_growth=LARGEST_GROWTH, warm_up=100 * WARM_UP))
        file.write("".join(f"**{fault}**\n\n" for fault in faults) or "Nothing went wrong.\n\n")
        if samples:
            file.write("| what | |\n|---|--:|\n")
            file.writelines(f"| {name} | {value} |\n" for name, value in rows(samples, counts, conditions))
        file.write(f"\n![Memory, speed and energy over time]({os.path.basename(path)}.png)\n")
    return faults
