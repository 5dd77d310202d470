"""Several runs in one page, modes, and beams of which not all is known."""

import numpy as np
import pytest
from page_maker import modes, swinging_arm


def test_modes_are_played_one_after_the_other(browser, play):
    run = modes()
    play(run)
    assert browser.run("return document.getElementById('clips').value") == "all"
    shown = browser.wait("""new Promise((done) => {
        const names = [];
        const note = () => {
          const name = document.getElementById("clip-name").textContent;
          if (name !== names[names.length - 1]) names.push(name);
          if (names.length === 4) done(names); else setTimeout(note, 50);
        };
        note();
        flexarm.play();
      })""")
    browser.run("flexarm.pause()")
    names = [clip["name"] for clip in run.picture["clips"]]
    assert shown == names + names[:1]


def test_each_mode_has_its_own_scale(browser, play):
    run = modes()
    play(run)
    largest = []
    for clip in range(3):
        browser.run("flexarm.setTime(arguments[0])", run.times[25 * clip + 6])
        browser.frame()
        largest.append(browser.run("return Player.stage.largest.amounts.bending"))
    assert largest == pytest.approx([24, 12, 8], rel=1e-3)  # N m, as the curvatures of the modes


def make_unknown(run, beam, first):
    """Make strains and stress resultants of a beam unknown. @param first  its first track"""
    for k in range(len(run.picture["beams"][beam]["sections"])):
        for track in range(first + 19 * k + 7, first + 19 * (k + 1)):
            run.tracks[track] = np.nan * run.tracks[track]


def are_plain(browser):
    return browser.run("return Player.stage.views.map(({arm}) => arm.parts.filter((part) => part.bend)"
                       ".map((part) => part.isPlain))")


def test_beams_of_unknown_strain_are_plain_and_have_no_legend(browser, play):
    run, beside = swinging_arm(), swinging_arm(name="other")
    make_unknown(run, 0, 8 * 7)
    make_unknown(run, 1, 8 * 7 + 19 * 11)
    assert play(run) == []
    browser.run("flexarm.shown = []")
    assert set(are_plain(browser)[0]) == {True} and not browser.is_visible("#legend")
    browser.run("flexarm.color = 'velocity'; flexarm.setTime(1)")  # follows from the motion
    browser.frame()
    assert set(are_plain(browser)[0]) == {False} and browser.is_visible("#legend")
    play(run, beside)
    browser.run("flexarm.shown = []; flexarm.setTime(1)")
    browser.frame()
    plain = are_plain(browser)
    assert set(plain[0]) == {True} and set(plain[1]) == {False} and "Edge strain" in browser.text("#legend")


LONG = "run 6: payload = 1.25, stiffness = 3.5e4, damping = 0.02, length = 0.75"


def runs_of_a_sweep(count):
    runs = [swinging_arm(frames=11) for _ in range(count)]
    for run in runs:
        run.picture["title"] = LONG
    return runs


def test_names_of_runs_can_be_read_beside_the_legend(browser, play):
    play(*runs_of_a_sweep(6))
    browser.frame()
    legend, *names = browser.run("""return [...document.querySelectorAll("#legend, .cell-name")]
        .sort((a, b) => (a.id ? -1 : b.id ? 1 : 0)).map((element) => element.getBoundingClientRect().toJSON())""")
    cells = browser.run("return [0, 1, 2, 3, 4, 5].map((k) => Player.stage.cell(k))")
    for name, cell in zip(names, cells):
        assert name["right"] <= legend["left"] and name["width"] <= cell["width"] + 1
    spans = browser.run("""return [...document.querySelectorAll(".cell-name span")].map((span) =>
        [span.textContent, span.scrollWidth - span.clientWidth, span.scrollHeight - span.clientHeight])""")
    assert [text for text, _, _ in spans] == 6 * [LONG] and all(x <= 0 and y <= 1 for _, x, y in spans), spans
    right = max(cell["x"] + cell["width"] for cell in cells)
    assert right <= browser.run("return document.getElementById('legend').offsetLeft")


def test_names_in_captured_pictures_are_wrapped_not_squeezed(browser, play):
    play(*runs_of_a_sweep(4))
    browser.run("""window.drawn = [];
        const {fillText} = CanvasRenderingContext2D.prototype;
        window.restoreOfTest = () => { CanvasRenderingContext2D.prototype.fillText = fillText; };
        CanvasRenderingContext2D.prototype.fillText = function (text, x, y, width) {
          if (this.canvas.width === 640)
            window.drawn.push([text, x, y, this.measureText(text).width, width === undefined ? null : width]);
          fillText.call(this, text, x, y, width);
        }""")
    browser.capture(640, 480, "A caption that is much longer than the picture is wide, and so has two lines or more")
    drawn = browser.run("window.restoreOfTest(); return window.drawn")
    assert all(limit is None or width <= limit for _, _, _, width, limit in drawn), drawn
    bar = min(x for text, x, *_ in drawn if text == "0")  # the colour bar's numbers
    for text, x, y, width, _ in drawn:
        assert text[-1] == "]" or (x >= 0 and x + width <= 640 and (y < 240 or x + width < bar or x >= bar)), text
    text = " ".join(entry[0] for entry in drawn)
    assert "A caption that is" in text and "or more" in text and text.count("payload = 1.25") == 4
