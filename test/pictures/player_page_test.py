"""The player's buttons, keys, tree and plots, used as a person does."""

import pytest
from page_maker import modes, swinging_arm


def clipboard(browser):
    return browser.run("return Player.copied")


def press(browser, *keys):
    from selenium.webdriver.common.action_chains import ActionChains
    ActionChains(browser.driver).send_keys(*keys).perform()


def test_page_opens_without_an_error_and_shows_its_title(browser, play):
    assert play(swinging_arm()) == []
    assert browser.run("return flexarm.errors") == []
    assert browser.text("#title") == "arm.urdf, 4 s"
    assert not browser.is_visible("#problems") and not browser.is_visible("#loading")


def test_page_loads_nothing_from_the_network(browser, play):
    play(swinging_arm())
    assert browser.run("""return performance.getEntriesByType("resource").map((entry) => entry.name)
        .filter((name) => !name.startsWith("data:"))""") == []


def test_plays_in_real_time_and_pauses(browser, play):
    play(swinging_arm())
    browser.click("#play")
    # Each picture shows the time passed since the last one, at most 1 s of it. The player is called before us in a
    # frame, as it asked first.
    frames = browser.wait("""new Promise((done) => {
        const frames = [];
        const note = (now) => {
          frames.push([now / 1000, flexarm.time]);
          if (frames.length === 3) done(frames); else requestAnimationFrame(note);
        };
        requestAnimationFrame(note);
      })""")
    for (before, shown_before), (now, shown) in zip(frames, frames[1:]):
        assert shown - shown_before == pytest.approx(min(now - before, 1), abs=1e-9)
    browser.click("#play")
    paused = browser.run("return flexarm.time")
    browser.frame()
    assert browser.run("return flexarm.time") == paused


def test_speed_scales_time_and_the_end_stops_it(browser, play):
    play(swinging_arm())
    browser.run("flexarm.speed = 10; flexarm.setTime(3.0); flexarm.play()")
    browser.until("document.querySelector('#play').getAttribute('aria-label') === 'Play'")
    assert browser.run("return flexarm.time") == 4.0
    assert browser.run("return document.getElementById('speed').value") == "10"


def test_loop_begins_anew(browser, play):
    play(swinging_arm())
    browser.click("#loop")
    browser.run("flexarm.speed = 5; flexarm.setTime(3.9); flexarm.play()")
    browser.until("flexarm.time < 3")
    browser.run("flexarm.pause()")


def test_slider_chooses_the_time(browser, play):
    play(swinging_arm())
    browser.click("#slider")  # in its middle
    assert browser.run("return flexarm.time") == pytest.approx(2.0, abs=0.05)
    assert float(browser.text("#time")) == pytest.approx(browser.run("return flexarm.time"), abs=6e-4)


def test_steps_go_from_instant_to_instant(browser, play):
    play(swinging_arm(frames=41))
    browser.click("#step-on")
    browser.click("#step-on")
    assert browser.run("return flexarm.time") == pytest.approx(0.2)
    browser.click("#step-back")
    assert browser.run("return flexarm.time") == pytest.approx(0.1)
    browser.run("flexarm.setTime(0.15)")
    browser.click("#step-back")
    assert browser.run("return flexarm.time") == pytest.approx(0.1)


def test_keys(browser, play):
    from selenium.webdriver.common.keys import Keys
    play(swinging_arm(frames=41))
    press(browser, Keys.END)
    assert browser.run("return flexarm.time") == 4.0
    press(browser, Keys.HOME, Keys.ARROW_RIGHT)
    assert browser.run("return flexarm.time") == pytest.approx(0.1)
    press(browser, Keys.ARROW_UP)
    assert browser.run("return flexarm.speed") == 2
    press(browser, "c")
    assert browser.run("return document.getElementById('color').value") == "axial"
    press(browser, "?")
    assert browser.is_visible("#help")
    press(browser, Keys.ESCAPE)
    assert not browser.is_visible("#help")
    press(browser, " ")
    browser.until("flexarm.time > 0.15")
    press(browser, " ")


def test_keys_typed_into_a_field_are_not_commands(browser, play):
    play(swinging_arm())
    browser.driver.find_element("id", "filter").send_keys("c arm")
    assert browser.run("return document.getElementById('color').value") == "strain"


def test_tree_has_links_and_joints_in_order(browser, play):
    play(swinging_arm())
    rows = browser.run("""return [...document.querySelectorAll("#tree .row")].map((row) =>
        [row.querySelector(".name").textContent, Number(row.getAttribute("aria-level"))])""")
    assert rows == [["world", 1], ["pan", 2], ["column", 2], ["shoulder", 3], ["upper arm", 3], ["elbow", 4],
                    ["forearm", 4], ["wrist", 5], ["gripper", 5], ["left finger", 6], ["right finger", 6],
                    ["payload", 6]]


def test_tree_by_keys_and_by_name(browser, play):
    from selenium.webdriver.common.keys import Keys
    play(swinging_arm())
    visible = """return [...document.querySelectorAll("#tree .row")].filter((row) => row.offsetParent)
        .map((row) => row.querySelector(".name").textContent)"""
    browser.run("document.querySelector('#tree .row').focus()")
    press(browser, *3 * [Keys.ARROW_DOWN], Keys.ENTER)
    assert browser.text("#details-name") == "shoulder"
    press(browser, Keys.ARROW_DOWN, Keys.ARROW_LEFT)
    assert browser.run(visible) == ["world", "pan", "column", "shoulder", "upper arm"]
    press(browser, Keys.ARROW_RIGHT)
    assert len(browser.run(visible)) == 12
    assert browser.run("return flexarm.time") == 0
    browser.driver.find_element("id", "filter").send_keys("FINGER")
    assert browser.run(visible) == ["left finger", "right finger"]


def test_click_in_the_tree_selects_and_shows_numbers(browser, play):
    run = swinging_arm()
    play(run)
    browser.run("flexarm.setTime(1)")
    browser.click("#tree .row", 3)
    browser.frame()
    assert browser.text("#details-name") == "shoulder" and browser.text("#details-kind") == "revolute joint"
    numbers = browser.text("#details-rows").replace("−", "-")
    assert numbers.startswith("position-0.5") and "rad/s" in numbers and "N m" in numbers
    browser.click("#tree .row", 4)
    assert browser.text("#details-name") == "upper arm" and "largest edge strain" in browser.text("#details-rows")


def test_click_in_the_picture_selects_what_is_there(browser, play):
    from selenium.webdriver.common.action_chains import ActionChains
    play(swinging_arm())
    x, y = browser.run("return flexarm.project([0, 0, 0.1])")
    canvas = browser.driver.find_element("id", "canvas")
    size = canvas.size
    actions = ActionChains(browser.driver)
    # Offsets are from the middle, but from the corner before selenium 4.3; so the page's middle is clicked by itself.
    actions.move_to_element(canvas).move_by_offset(int(x - size["width"] / 2), int(y - size["height"] / 2))
    actions.click().perform()
    assert browser.text("#details-name") == "world"
    assert browser.run("return document.querySelector('#tree [aria-selected=true] .name').textContent") == "world"


def test_pointer_over_a_beam_shows_its_numbers_there(browser, play):
    run = swinging_arm()
    play(run)
    middle = run.tracks[8 * 7 + 19 * 5:][:3]  # section 5 of the upper arm, at 0.4 m
    browser.run("""const [x, y] = flexarm.project(arguments[0]), canvas = document.getElementById("canvas");
        const box = canvas.getBoundingClientRect();
        canvas.dispatchEvent(new PointerEvent("pointermove", {clientX: box.left + x, clientY: box.top + y}))""",
                [float(track[0]) for track in middle])
    rows = browser.run("""const cells = [...document.querySelectorAll("#tip-rows > *")].map((cell) => cell.textContent);
        return Object.fromEntries(cells.map((cell, k) => [cell, cells[k + 1]]).filter((_, k) => k % 2 === 0))""")
    assert browser.text("#tip-name") == "upper arm"
    assert float(rows["arc length"].split()[0]) == pytest.approx(0.4, abs=0.03)
    curvature = run.tracks[8 * 7 + 19 * 5 + 7 + 4][0]
    assert float(rows["curvature y"].replace("−", "-").split()[0]) == pytest.approx(curvature, rel=0.1)
    assert float(rows["bending moment y"].replace("−", "-").split()[0]) == pytest.approx(40 * curvature, rel=0.1)


def test_links_can_be_hidden_and_shown_alone(browser, play):
    play(swinging_arm())
    visible = "return Player.stage.views[0].arm.links.map((link) => link.visible)"
    browser.click("#tree .row", 4)
    browser.click("#hide")
    browser.frame()
    assert browser.run(visible) == [True, True, False] + 5 * [True]
    browser.click("#isolate")
    browser.frame()
    assert browser.run(visible) == [False, False, True] + 5 * [False]
    browser.click("#show-all")
    browser.frame()
    assert browser.run(visible) == 8 * [True] and not browser.is_visible("#show-all")


def test_plots_have_a_curve_for_each_chosen_column_and_one_plot_for_each_unit(browser, play):
    play(swinging_arm())
    names = "return [...document.querySelectorAll('.curve .name')].map((name) => name.textContent)"
    assert browser.run(names) == ["joint/pan/position", "joint/shoulder/position", "joint/elbow/position"]
    browser.click("#add-curve")
    browser.driver.find_element("id", "column-search").send_keys("energy")
    browser.click("#column-options input")
    assert browser.run(names)[-1] == "energy/total"
    assert len(browser.driver.find_elements("class name", "plot")) == 2
    browser.driver.find_element("id", "column-search").clear()
    browser.driver.find_element("id", "column-search").send_keys("nothing of that name")
    assert "No column" in browser.text("#column-options")


def test_click_in_a_plot_goes_to_that_time_and_values_follow(browser, play):
    run = swinging_arm()
    play(run)
    browser.click(".plot-area")
    time = browser.run("return flexarm.time")
    assert 1.8 < time < 2.2
    browser.frame()
    shown = float(browser.text(".curve .value").replace("−", "-"))
    assert shown == pytest.approx(float(run.tracks[-10][int(round(time * 50))]), abs=0.03)


def test_csv_of_the_selection_and_of_plots(browser, play):
    import csv
    import io
    run = swinging_arm(frames=9)
    play(run)
    browser.click("#tree .row", 1)
    browser.click("#copy")
    rows = list(csv.reader(io.StringIO(clipboard(browser))))
    assert rows[0] == ["name", "quantity", "value", "unit"]
    assert [row[1] for row in rows[1:]] == ["time", "position", "velocity", "effort"]
    browser.click("#copy-plots")
    rows = list(csv.reader(io.StringIO(clipboard(browser))))
    assert rows[0] == ["time", "joint/pan/position", "joint/shoulder/position", "joint/elbow/position"]
    assert len(rows) == 10
    for k, row in enumerate(rows[1:]):
        expected = [run.times[k], *(run.tracks[-10 + 3 * j][k] for j in range(3))]
        assert [float(value) for value in row] == pytest.approx(expected, abs=1e-4)


def test_theme_follows_the_system_and_the_button(browser, play):
    play(swinging_arm())
    theme = "return document.documentElement.dataset.theme"
    assert browser.run(theme) == "light"
    browser.click("#theme")
    assert browser.run(theme) == "dark"
    browser.frame()
    assert browser.screen()[5, 5].max() < 60


def test_phone(browser, play):
    browser.resize(390, 844, is_mobile=True)
    assert play(swinging_arm()) == []
    assert browser.run("return document.documentElement.scrollWidth") <= 390
    assert browser.run("""return [...document.querySelectorAll("button, select, input")].filter((e) => e.offsetParent)
        .filter((e) => e.getBoundingClientRect().right > 390.5 || e.getBoundingClientRect().left < 0)
        .map((e) => e.id)""") == []
    assert not browser.is_visible("#side") and not browser.is_visible("#plots")
    browser.click("#side-button")
    browser.click("#tree .row", 4)
    assert browser.is_visible("#details")
    browser.click("#side-button")
    browser.click("#plots-button")
    assert browser.is_visible("#plots") and not browser.is_visible("#side")
    assert browser.run("return document.documentElement.scrollWidth") <= 390


def test_tap_shows_numbers_on_a_phone(browser, play):
    browser.resize(390, 844, is_mobile=True)
    play(swinging_arm())
    x, y = browser.run("""const [x, y] = flexarm.project([0, 0, 0.1]);
        const box = document.getElementById("canvas").getBoundingClientRect();
        return [box.left + x, box.top + y]""")
    browser.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
    try:
        for kind, points in (("touchStart", [{"x": x, "y": y}]), ("touchEnd", [])):
            browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        browser.until("!document.getElementById('tip').hidden")
        assert browser.text("#tip-name") == "world"
        box = browser.run("return document.getElementById('tip').getBoundingClientRect().toJSON()")
        assert box["left"] >= 0 and box["right"] <= 390
    finally:
        browser.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})


@pytest.mark.parametrize("frames", [1, 2])
def test_plots_of_one_or_two_instants(browser, play, frames):
    assert play(swinging_arm(frames=frames)) == []
    assert browser.run("return flexarm.errors") == []
    assert browser.run("return document.querySelector('.curve .name').textContent") == "joint/shoulder/position"
    assert float(browser.text(".curve .value").replace("−", "-")) == -0.5


def test_every_button_has_a_name_for_screen_readers(browser, play):
    play(swinging_arm())
    assert browser.run("""return [...document.querySelectorAll("button, select, input, [role=treeitem]")].filter((e) =>
        !(e.getAttribute("aria-label") || e.textContent.trim() || e.closest("label"))).map((e) => e.outerHTML)""") == []


def test_switches_show_what_the_scene_has(browser, play):
    play(swinging_arm())
    keys = "return [...document.querySelectorAll('#switches input')].map((box) => box.dataset.key)"
    assert browser.run(keys) == ["grid", "world", "axes", "effort", "load", "reaction", "probes", "trails"]
    browser.click("#show-button")
    browser.click("[data-key=effort]")
    browser.frame()
    groups = browser.run("return Player.stage.views[0].marks.arrows.map(({arrows}) => arrows.group.visible)")
    assert groups == [True, True, False]
    play(modes())
    assert browser.run(keys) == ["grid", "world", "still"]
