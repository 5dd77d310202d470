"""Numbers on demand: of joints and beams under the pointer, as CSV, and in the plots that a page has at first."""

import pytest
from page_maker import swinging_arm
from player_page_test import clipboard


def table(text):
    import csv
    import io
    return list(csv.DictReader(io.StringIO(text)))


def click_at(browser, place):
    from selenium.webdriver.common.action_chains import ActionChains
    x, y = browser.run("return flexarm.project(arguments[0])", place)
    canvas = browser.driver.find_element("id", "canvas")
    size = canvas.size
    actions = ActionChains(browser.driver).move_to_element(canvas)
    actions.move_by_offset(int(x - size["width"] / 2), int(y - size["height"] / 2)).click().perform()


def hover_at(browser, place, beside=(0, 0)):
    browser.run("""const [x, y] = flexarm.project(arguments[0]), canvas = document.getElementById("canvas");
        const box = canvas.getBoundingClientRect(), [right, down] = arguments[1];
        canvas.dispatchEvent(new PointerEvent("pointermove", {clientX: box.left + x + right,
          clientY: box.top + y + down}))""", place, list(beside))


SECTION_COLUMNS = ["x [m]", "y [m]", "z [m]", "qx [1]", "qy [1]", "qz [1]", "qw [1]", "ex [1]", "ey [1]", "ez [1]",
                   "kx [1/m]", "ky [1/m]", "kz [1/m]", "fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]"]


def test_csv_of_a_beam_has_a_row_for_each_section(browser, play):
    run = swinging_arm(frames=41)
    play(run)
    browser.run("flexarm.setTime(1.5)")
    browser.frame()
    browser.click("#tree .row", 4)
    browser.click("#copy")
    rows = table(clipboard(browser))
    assert [row["place"] for row in rows] == ["section %d" % k for k in range(11)]
    for k, row in enumerate(rows):
        assert row["name"] == "upper arm" and float(row["time [s]"]) == pytest.approx(1.5)
        assert float(row["arc_length [m]"]) == pytest.approx(0.08 * k)
        for name, track in zip(SECTION_COLUMNS, run.tracks[8 * 7 + 19 * k:]):
            assert float(row[name]) == pytest.approx(track[15], abs=2e-5 * max(1, abs(track).max())), name


def test_csv_of_a_beam_has_the_place_that_was_clicked(browser, play):
    run = swinging_arm()
    play(run)
    click_at(browser, [float(track[0]) for track in run.tracks[8 * 7 + 19 * 5:][:3]])
    assert browser.text("#details-name") == "upper arm" and "bending moment y" in browser.text("#details-rows")
    browser.click("#copy")
    clicked, *sections = table(clipboard(browser))
    assert clicked["place"] == "clicked" and len(sections) == 11
    assert float(clicked["arc_length [m]"]) == pytest.approx(0.4, abs=0.03)
    assert float(clicked["my [N m]"]) == pytest.approx(float(sections[5]["my [N m]"]), rel=0.1)


def test_pointer_near_a_joint_shows_its_numbers(browser, play):
    run = swinging_arm()
    play(run)
    assert not browser.run("return flexarm.shown.includes('axes')")
    elbow = [float(track[0]) for track in run.tracks[3 * 7:][:3]]  # between two flexible links
    hover_at(browser, elbow, beside=(4, -5))
    assert browser.text("#tip-name") == "elbow" and browser.text("#tip-kind") == "revolute joint"
    numbers = browser.text("#tip-rows").replace("−", "-")
    assert numbers.startswith("position1.6") and "velocity" in numbers and "effort" in numbers  # 1.1 + 0.5 rad
    click_at(browser, elbow)
    assert browser.text("#details-name") == "elbow"


def test_joints_at_one_place_are_shown_together(browser, play):
    run = swinging_arm()
    run.picture["joints"][0]["link"] = 2  # beside the shoulder
    play(run)
    hover_at(browser, [float(track[0]) for track in run.tracks[2 * 7:][:3]])
    assert browser.text("#tip-name") == "pan, shoulder"
    assert "pan position" in browser.text("#tip-rows") and "shoulder effort" in browser.text("#tip-rows")


def test_a_link_alone_has_no_probes_of_others(browser, play):
    play(swinging_arm())
    probes = "return Player.stage.views[0].marks.probes.map(({mesh, trail}) => [mesh.visible, trail.line.visible])"
    assert browser.run(probes) == [[True, True]]
    browser.click("#tree .row", 4)
    browser.click("#isolate")
    browser.frame()
    assert browser.run(probes) == [[False, False]]
    browser.click("#show-all")
    browser.frame()
    assert browser.run(probes) == [[True, True]]


def test_curves_at_the_start_are_positions_that_change(browser, play):
    run = swinging_arm(frames=41)
    for joint, part in zip(run.picture["joints"], (0, 3, 6)):
        joint["columns"] = [part + 2, part, part + 1]  # as in files that have the columns by name
    run.tracks[-10] = 0 * run.tracks[-10]  # pan
    play(run)
    names = "return [...document.querySelectorAll('.curve .name')].map((name) => name.textContent)"
    assert browser.run(names) == ["joint/shoulder/position", "joint/elbow/position"]
    for k in (3, 6):
        run.tracks[-10 + k] = 0 * run.tracks[-10 + k] + 0.5
    run.picture["columns"][-1]["name"] = "probe/tip/z"
    play(run)
    assert browser.run(names) == ["probe/tip/z"]
