#!/usr/bin/python3
"""Plots the frequency responses of `flexarm linearise --frequencies`: a line for each pair of output and input.

plot_bode.py DATA.json PICTURE
"""

import json

import numpy
from headless_pyplot import pyplot, run

# With more lines, the legend would hide the curves.
MOST_NAMES = 20


def pole_frequencies(model):
    """Frequencies of the oscillating poles, as far as they are within the plotted range [Hz]."""
    frequencies = numpy.array([imaginary for _, imaginary in model["poles"]]) / (2 * numpy.pi)
    return frequencies[(frequencies >= min(model["frequencies"])) & (frequencies <= max(model["frequencies"]))]


def main(data, picture):
    with open(data, encoding="utf-8") as file:
        model = json.load(file)
    frequencies = numpy.array(model["frequencies"])
    gains = numpy.array(model["gains"]) @ [1, 1j]
    figure, (size, phase) = pyplot.subplots(2, sharex=True, figsize=(8, 7), gridspec_kw={"height_ratios": (3, 2)})
    for k, output in enumerate(model["outputs"]):
        for j, entry in enumerate(model["inputs"]):
            gain = gains[:, k, j]
            seen = gain != 0  # zero gain cannot be shown in decibels
            size.plot(frequencies[seen], 20 * numpy.log10(abs(gain[seen])), label=f"{output} / {entry}")
            phase.plot(frequencies[seen], numpy.degrees(numpy.unwrap(numpy.angle(gain[seen]))))
    for axes in (size, phase):
        for frequency in pole_frequencies(model):
            axes.axvline(frequency, color="grey", linestyle=":", linewidth=0.8)
        axes.grid(True, which="major", alpha=0.3)
    size.set_xscale("log")
    size.set_ylabel("gain [dB of SI units]")
    phase.set_ylabel("phase [deg]")
    phase.set_xlabel("frequency [Hz]; dotted: poles")
    size.set_title(model["scene"])
    if len(model["outputs"]) * len(model["inputs"]) <= MOST_NAMES:
        size.legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(picture, dpi=90, metadata={"Software": None})


if __name__ == "__main__":
    run(main, __doc__)
