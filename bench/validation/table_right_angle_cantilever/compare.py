"""The right-angle cantilever of Simo and Vu-Quoc: largest ways of its tip and elbow."""

import time

from flexarm import Simulation, read_scene_text
from flexarm.validation import Row

SCENE = "../../../config/speed/right_angle_cantilever.urdf"
UNTIL = 30  # s


def run(case, elements, step):
    """Rows time, elbow, tip, and processor time [s]."""
    with open(case.path(SCENE), encoding="utf-8") as file:
        text = file.read().replace('elements="8"', 'elements="%d"' % elements)
    simulation = Simulation(read_scene_text(text, "right_angle_cantilever"), step=step)
    start = time.process_time()
    rows = simulation.run(round(UNTIL / step), record=["probe/elbow/z", "probe/tip/z"])
    return rows, time.process_time() - start


def compare(case):
    rows, seconds = run(case, 12, 0.01)
    published = case.table("numbers.csv")
    note = "twelve elements, steps of 0.01 s, %.1g s of processor time" % seconds
    for row in published:
        way = rows[:, ("elbow", "tip").index(row["point"]) + 1]
        at = way.argmax() if row["extremum"] == "largest" else way.argmin()
        yield Row("%s z of the %s" % (row["extremum"], row["point"]), row["z_m"], way[at], row["uncertainty_m"], "m",
                  "calculated", note)
        yield Row("its time", row["time_s"], rows[at, 0], row["uncertainty_s"], "s", "calculated", note)

    def draw(axes):
        coarse, _ = run(case, 8, 0.1)  # those of the scene
        for column, name in ((1, "elbow"), (2, "tip")):
            line, = axes.plot(rows[:, 0], rows[:, column], label=name)
            axes.plot(coarse[:, 0], coarse[:, column], ":", color=line.get_color())
        axes.plot([row["time_s"] for row in published], [row["z_m"] for row in published], "ko", mfc="none",
                  label="published")
        axes.set(xlabel="time [s]", ylabel="z [m]")
        axes.legend(fontsize="small")

    case.draw(draw)
