"""Tests what a page shows when it opens: what moves, masses, grounds, the most strained instant, readable names."""

import numpy as np
import pytest
from page_maker import marker, modes, swinging_arm


def size_of(browser):
    return browser.run("const e = document.getElementById('picture'); return [e.clientWidth, e.clientHeight]")


def corners(extent):
    return [[float(c + s * h) for c, s, h in zip(extent["center"], signs, extent["half"])]
            for signs in np.ndindex(2, 2, 2) for signs in [2 * np.array(signs) - 1]]


@pytest.mark.parametrize("half", [(1.5, 0.2, 0.4), (0.1, 0.1, 2), (300, 200, 5), (0.01, 0.004, 0.002)])
@pytest.mark.parametrize("size", [(1280, 800), (390, 844)])
def test_the_box_around_what_moves_fills_the_picture(browser, play, half, size):
    """No corner is outside, and on two opposite sides there is little room left."""
    browser.resize(*size)
    run = marker([[0, 0, 0], [0.1, 0, 0]])
    run.picture["extent"] = {"center": [5 * half[0], 0, 2 * half[2]], "radius": float(np.linalg.norm(half)),
                             "half": list(half)}
    play(run)
    for view in ([0.55, -0.75, 0.36], [1, 0, 0], [0, -1, 0], [-2, 1, 1]):
        browser.run("flexarm.lookFrom(arguments[0])", view)
        browser.frame()
        part = np.array([browser.run("return flexarm.project(arguments[0])", corner)
                         for corner in corners(run.picture["extent"])]) / size_of(browser)
        assert (0.04 < part).all() and (part < 0.96).all()  # marks at the edge need room, too
        assert np.max(part.max(axis=0) - part.min(axis=0)) > 0.6


def strains(run):
    """Return the largest strain at the edge of a section, for each instant."""
    at, largest = 7 * len(run.picture["links"]), 0
    for beam in run.picture["beams"]:
        for _ in beam["sections"]:
            strain = np.array(run.tracks[at + 7:at + 13])
            normal = np.abs(strain[0]) + beam["radius"] * np.hypot(strain[4], strain[5])
            shear = np.hypot(strain[1], strain[2]) + beam["radius"] * np.abs(strain[3])
            largest = np.maximum(largest, np.hypot(normal, shear / np.sqrt(3)))
            at += 19
    return largest


def test_a_page_opens_paused_at_the_instant_of_the_largest_strain(browser, play):
    run = swinging_arm()
    play(run, first_time=None)
    assert browser.run("return flexarm.time") == pytest.approx(run.times[np.argmax(strains(run))], abs=1e-9)
    assert browser.run("return document.getElementById('play').getAttribute('aria-label')") == "Play"
    slider = browser.run("const s = document.getElementById('slider'); return s.value / s.max")
    assert slider == pytest.approx(browser.run("return flexarm.time / flexarm.runs[0].duration"), abs=1e-6)


def test_of_several_runs_the_most_strained_one_counts(browser, play):
    runs = [swinging_arm(), swinging_arm(phase=0.8)]
    play(*runs, first_time=None)
    strained = max(runs, key=lambda run: strains(run).max())
    assert browser.run("return flexarm.time") == pytest.approx(
        strained.times[np.argmax(strains(strained))], abs=1e-9)


@pytest.mark.parametrize("wanted,shown", [(0, 0), (1.5, 1.5), (-3, 0), (99, 4)])
def test_a_page_opens_at_the_time_that_is_wanted(browser, play, wanted, shown):
    play(swinging_arm(), first_time=wanted)
    assert browser.run("return flexarm.time") == pytest.approx(shown, abs=1e-12)


def test_runs_without_strains_and_clips_open_at_the_start(browser, play):
    play(marker([[0, 0, 0], [1, 0, 0]]), first_time=None)
    assert browser.run("return flexarm.time") == 0
    play(modes(), first_time=None)
    assert browser.run("return flexarm.time") == 0


def test_a_mass_without_shape_is_a_ball(browser, play):
    run = marker([[0, 0, 0], [0, 0, 0]])
    run.picture["links"][0].update(shapes=[], stick=[[0.5, 0, 0]], mass={"at": [0.5, 0, 0], "radius": 0.05})
    play(run)
    reach = browser.run("""const {array} = Player.stage.views[0].arm.parts[0].mesh.geometry.attributes.position;
        const far = [0, 0, 0];
        for (let k = 0; k < array.length; ++k) far[k % 3] = Math.max(far[k % 3], array[k]);
        return far""")
    assert reach == pytest.approx([0.55, 0.05, 0.05], abs=1e-3)


def test_grounds_are_the_floors_of_the_run(browser, play):
    run = marker([[0, 0, 0], [1, 0, 0]])
    run.picture["floors"] = [{"pose": [1, 2, -0.5, 0, 0, 0, 1], "size": [3, 1], "cell": 0.5, "ground": True}]
    play(run)
    lines, planes = browser.run("""const bounds = (object) => {
          object.updateWorldMatrix(true, false);
          const box = new THREE.Box3().setFromObject(object);
          return [...box.min.toArray(), ...box.max.toArray()];
        };
        const floor = Player.stage.views[0].marks.grid.children[0].children;
        return [floor.filter((o) => o.isLineSegments).map((o) => [o.geometry.attributes.position.count / 2,
                                                                  ...bounds(o)]),
                floor.filter((o) => o.isMesh).map(bounds)]""")
    edges = [-0.5, 1.5, -0.5, 2.5, 2.5, -0.5]
    assert lines == [[pytest.approx(7 + 3), *map(pytest.approx, edges)]]
    assert planes == [list(map(pytest.approx, edges))]


def test_colours_are_those_of_the_settings(browser, play):
    play(swinging_arm(), colors={"amounts": ["#102030", "#ffffff"], "signed": ["#000000", "#ffffff"]})
    assert browser.run("return [...Player.mapOf(Player.quantities[0]).table.slice(0, 3)]") == [0x10, 0x20, 0x30]
    assert "rgb(16, 32, 48)" in browser.run("return document.querySelector('.scale').style.background")


def test_the_legend_is_smaller_than_what_moves(browser, play):
    for size in ((1280, 800), (390, 844), (900, 500)):
        browser.resize(*size)
        run = swinging_arm()
        run.picture["extent"] = {"center": [0.5, 0, 0.35], "radius": 1.1, "half": [0.9, 0.5, 0.4]}
        play(run)
        legend = browser.run("const e = document.getElementById('legend'); return [e.offsetWidth, e.offsetHeight]")
        points = np.array([browser.run("return flexarm.project(arguments[0])", corner)
                           for corner in corners(run.picture["extent"])])
        assert np.prod(legend) < 0.5 * np.prod(points.max(axis=0) - points.min(axis=0))


def test_long_names_can_be_read(browser, play):
    """Nothing of a name is cut off, in the tree, in the list of columns, beside plots and over the details."""
    run = swinging_arm()
    name = "left_front_upper_suspension_arm_with_a_very_long_name_link"
    run.picture["links"][1]["name"] = name
    run.picture["columns"][0]["name"] = f"joint/{name}_joint/position"
    run.picture["title"] = name * 2
    play(run)
    browser.click(".row:nth-child(3)")
    browser.click("#add-curve")
    browser.frame()
    cut = browser.run("""return [...document.querySelectorAll(
          "#tree .name, #column-list .name, .curve .name, #details-name")]
        .filter((e) => e.textContent.includes("suspension"))
        .map((e) => [e.textContent, e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0,
                     e.scrollHeight > e.clientHeight + 1 && e.clientHeight > 0])""")
    assert len(cut) >= 4
    assert all(not (wide or high) for _, wide, high in cut), cut
    assert {text for text, *_ in cut} == {name, f"joint/{name}_joint/position"}
