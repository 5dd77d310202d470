"""What is in the player's picture, and where."""

import struct

import numpy as np
import pytest
from page_maker import about, marker, modes, net, swinging_arm, turned

PATH = [[-0.5, 0.3, 0.2], [0.4, 0.2, -0.3], [0.1, -0.5, 0.6]]


def projected(camera, up, point, width, height):
    """Return where a camera sees a point, in pixels from the upper left corner."""
    position, target = np.array(camera["position"]), np.array(camera["target"])
    ahead = (target - position) / np.linalg.norm(target - position)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    above, way = np.cross(right, ahead), np.asarray(point) - position
    focus = height / 2 / np.tan(np.radians(camera["fov"]) / 2)
    return [width / 2 + focus * way @ right / (way @ ahead), height / 2 - focus * way @ above / (way @ ahead)]


def size_of(browser):
    return browser.run("const e = document.getElementById('canvas'); return [e.clientWidth, e.clientHeight]")


def centre_of(pixels, is_color):
    """Return the centre of the pixels of a colour, and how many there are."""
    rows, columns = np.nonzero(is_color(pixels[:, :, 0], pixels[:, :, 1], pixels[:, :, 2]))
    assert len(rows), "no pixel has that colour"
    return [columns.mean() + 0.5, rows.mean() + 0.5], len(rows)


def magenta(red, green, blue):
    return (red > 90) & (abs(red - blue) < 40) & (green < 0.5 * red)


@pytest.mark.parametrize("up", [(0, 0, 1), (0, 1, 0)])
def test_things_are_where_project_says(browser, play, up):
    play(marker(PATH, gravity=[-9.81 * component for component in up]))
    width, height = size_of(browser)
    for time, place in ((0.0, PATH[0]), (0.25, np.mean(PATH[:2], axis=0)), (1.0, PATH[2])):
        browser.run("flexarm.setTime(arguments[0])", time)
        browser.frame()
        told = browser.run("return flexarm.project(arguments[0])", [float(x) for x in place])
        assert told == pytest.approx(projected(browser.run("return flexarm.camera"), up, place, width, height), abs=0.5)
        assert centre_of(browser.screen(), magenta)[0] == pytest.approx(told, abs=2)


def test_camera_can_be_set(browser, play):
    play(marker(PATH))
    browser.run("flexarm.camera = {position: [2, 1, 1.5], target: [0.1, 0, 0.1]}")
    camera = browser.run("return flexarm.camera")
    assert camera["position"] == pytest.approx([2, 1, 1.5]) and camera["target"] == pytest.approx([0.1, 0, 0.1])
    told = browser.run("return flexarm.project(arguments[0])", PATH[0])
    assert told == pytest.approx(projected(camera, (0, 0, 1), PATH[0], *size_of(browser)), abs=0.5)


def test_start_shows_all_that_the_scene_can_reach(browser, play):
    for size in ((1280, 800), (390, 844)):
        browser.resize(*size)
        play(marker(PATH))
        width, height = size_of(browser)
        for angle in np.linspace(0, 2 * np.pi, 24):
            c, s = np.cos(angle), np.sin(angle)
            for point in ((c, s, 0), (c, 0, s), (0, c, s)):
                x, y = browser.run("return flexarm.project(arguments[0])", [float(c) for c in point])
                assert 0 <= x <= width and 0 <= y <= height


@pytest.mark.parametrize("button,axis", [("#view-x", 0), ("#view-y", 1), ("#view-z", 2)])
def test_views_along_axes(browser, play, button, axis):
    play(marker(PATH))
    browser.click(button)
    unit = [0.0, 0.0, 0.0]
    unit[axis] = 0.5
    ends = [browser.run("return flexarm.project(arguments[0])", [sign * x for x in unit]) for sign in (-1, 1)]
    assert ends[0] == pytest.approx(ends[1], abs=1)


def test_camera_follows_a_link(browser, play):
    play(marker(PATH))
    browser.run("flexarm.setTime(0)")
    browser.frame()
    browser.click("#tree .row")
    browser.click("#follow")
    before = browser.run("return flexarm.project(arguments[0])", PATH[0])
    browser.run("flexarm.setTime(1)")
    browser.frame()
    assert browser.run("return flexarm.project(arguments[0])", PATH[2]) == pytest.approx(before, abs=1)


def test_runs_are_side_by_side_with_one_clock(browser, play):
    assert play(marker(PATH, name="first"), marker(PATH[::-1], color=(0.9, 0.9, 0, 1), name="second")) == []
    names = browser.run("return [...document.querySelectorAll('.cell-name')].map((name) => name.textContent)")
    assert names == ["first", "second"]
    browser.run("flexarm.setTime(1)")
    browser.frame()
    width, _ = size_of(browser)
    told = [browser.run("return flexarm.project(arguments[0], arguments[1])", PATH[2 - 2 * run], run) for run in (0, 1)]
    assert told[0][0] < width / 2 < told[1][0]
    screen = browser.screen()
    assert centre_of(screen, magenta)[0] == pytest.approx(told[0], abs=2)
    yellow = centre_of(screen, lambda red, green, blue: (red > 90) & (abs(red - green) < 20) & (blue < 60))
    assert yellow[0] == pytest.approx(told[1], abs=2)


@pytest.mark.parametrize("count,columns", [(1, 1), (2, 2), (3, 2), (4, 2), (6, 3)])
def test_runs_are_in_a_grid(browser, play, count, columns):
    play(*[marker(PATH, name=f"run {k}") for k in range(count)])
    assert browser.run("return Player.stage.columns") == columns


def test_clips_loop_one_by_one_beside_the_arm_at_rest(browser, play):
    run = modes()
    play(run)
    first = run.times[25]
    clips = browser.run("return [...document.querySelectorAll('#clips option')].map((option) => option.textContent)")
    assert clips == ["All, one after the other"] + [clip["name"] for clip in run.picture["clips"]]
    browser.run("const e = document.getElementById('clips'); e.selectedIndex = 2; e.onchange({target: e})")
    assert browser.run("return flexarm.time") == pytest.approx(first)
    browser.run("flexarm.setTime(arguments[0]); flexarm.speed = 1; flexarm.play()", run.times[48])
    browser.until(f"flexarm.time < {run.times[46]}")
    assert browser.run("return flexarm.time") >= first
    browser.run("flexarm.setTime(arguments[0])", run.times[60])  # in the third clip
    assert browser.run("return document.getElementById('clips').selectedIndex") == 3
    browser.frame()
    assert browser.run("return Player.stage.views[0].ghost.root.visible")


@pytest.mark.parametrize("size", [(640, 480), (1921, 301), (200, 700)])
def test_capture_has_exactly_that_size(browser, play, size):
    play(marker(PATH))
    before = size_of(browser)
    png = browser.capture(*size, caption="Caption <b>&\"")
    assert struct.unpack(">II", png[16:24]) == size
    pixels = browser.pixels(png)
    text = np.abs(pixels[:size[1] // 8] - pixels[-1, -1]).sum(axis=2) > 150
    assert text[:, :size[0] // 2].any() and centre_of(pixels, magenta)[1] > 0
    browser.until(f"Player.stage.usedSize === '{before[0]} {before[1]} 1'")
    assert size_of(browser) == before
    told = browser.run("return flexarm.project(arguments[0])", PATH[0])
    assert centre_of(browser.screen(), magenta)[0] == pytest.approx(told, abs=2)


def test_capture_shows_the_time_that_was_set(browser, play):
    play(marker(PATH))
    places = []
    for time in (0, 1):
        browser.run("flexarm.setTime(arguments[0])", time)
        places.append(centre_of(browser.pixels(browser.capture(400, 300)), magenta)[0])
    assert np.linalg.norm(np.subtract(*places)) > 15


@pytest.mark.parametrize("frames", [0, 1])
def test_runs_without_motion_are_pictures(browser, play, frames):
    run = marker(PATH[:1])
    if not frames:
        run.picture["frames"], run.times = 0, run.times[:0]
    assert play(run) == []
    assert browser.run("return flexarm.errors") == []
    assert browser.run("return document.getElementById('play').disabled && document.getElementById('slider').disabled")
    told = browser.run("return flexarm.project(arguments[0])", PATH[0])
    assert centre_of(browser.screen(), magenta)[0] == pytest.approx(told, abs=2)


def test_browser_without_webgl_is_told_and_plots_work(browser, play):
    script = browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
        const getContext = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
          return kind === "2d" ? getContext.call(this, kind, ...rest) : null;
        };"""})
    try:
        play(swinging_arm())
    finally:
        browser.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
    errors = browser.run("return flexarm.errors")
    assert len(errors) == 1 and "WebGL is missing" in errors[0]
    browser.click(".plot-area")
    assert browser.run("return flexarm.time") > 1
    assert browser.run("return flexarm.camera") is None and browser.run("return flexarm.project([0, 0, 0])") is None


def test_programs_choose_what_is_shown(browser, play):
    play(swinging_arm())
    browser.run("flexarm.color = 'torsion'; flexarm.theme = 'dark'; flexarm.shown = ['axes', 'effort']")
    browser.frame()
    chosen = browser.run("return [flexarm.color, flexarm.theme, flexarm.shown]")
    assert chosen == ["torsion", "dark", ["axes", "effort"]]
    assert browser.screen()[5, 5].max() < 60
    marks = browser.run("""const {marks} = Player.stage.views[0];
        return [marks.grid.visible, marks.axes.every((axis) => axis.visible),
          marks.arrows.map(({arrows}) => arrows.group.visible)]""")
    assert marks == [False, True, [True, False, False]]


# ---------------------------------------------------------------- bending

def test_line_between_sections_is_smooth(browser, play):
    """Five sections on a third of a circle: the line between them stays on the circle."""
    play(marker(PATH))
    angles = np.linspace(0, 2 * np.pi / 3, 5)
    poses = [[np.sin(a), 0, np.cos(a) - 1, *about([0, 1, 0], np.array([a]))[0]] for a in angles]
    frames = np.array(browser.run("""const line = new Player.Line(5, 8);
        line.follow(Float64Array.from(arguments[0]), 0, 7);
        return [...line.frames]""", np.ravel(poses).tolist())).reshape(-1, 12)
    assert len(frames) == 33
    assert np.hypot(frames[:, 0], frames[:, 2] + 1) == pytest.approx(1, abs=3e-4)
    for k, angle in enumerate(np.linspace(0, 2 * np.pi / 3, 33)):
        assert frames[k, 3:6] == pytest.approx(turned(about([0, 1, 0], np.array([angle]))[0], [1, 0, 0]), abs=5e-3)


def test_shapes_bend_with_their_beam(browser, play):
    """The box around a beam becomes a part of a ring: its edges stay as far from the circle as they were."""
    run = swinging_arm(frames=2)
    play(run)
    vertices, triangles = browser.run("""const {parts, beams} = Player.stage.views[0].arm;
        const part = parts.find((part) => part.bend), line = new Player.Line(11, beams[0].rest.parts), poses = [];
        for (let k = 0; k < 11; ++k) {
          const angle = 0.08 * k;
          poses.push(Math.sin(angle), 0, Math.cos(angle) - 1, 0, Math.sin(angle / 2), 0, Math.cos(angle / 2));
        }
        line.follow(Float64Array.from(poses), 0, 7);
        part.follow(line);
        const {geometry} = part.mesh;
        return [[...geometry.attributes.position.array], [...geometry.index.array]]""")
    vertices, triangles = np.reshape(vertices, (-1, 3)), np.reshape(triangles, (-1, 3))
    # The box is 0.05 wide and 0.02 high, the cylinder in it has a radius of 0.016.
    radii = np.hypot(vertices[:, 0], vertices[:, 2] + 1)
    assert np.abs(radii - 1).max() == pytest.approx(0.016, abs=4e-4)
    assert np.abs(vertices[:, 1]).max() == pytest.approx(0.025, abs=1e-6)
    angles = np.arctan2(vertices[:, 0], vertices[:, 2] + 1)
    assert np.ptp(angles[triangles], axis=1).max() <= 2.2 * 0.08 * 10 / 80
    assert len(np.unique(np.round(angles, 3))) > 15


def test_far_tubes_have_fewer_triangles_and_look_the_same(browser, play):
    play(net(beams=40))
    browser.run("flexarm.shown = []; flexarm.setTime(0.3)")
    count = "return Player.stage.views[0].arm.parts[7].mesh.geometry.index.count / 3"
    browser.frame()
    coarse, picture = browser.run(count), browser.screen()
    browser.run("""Player.finest = Player.coarseness; Player.coarseness = () => [1, 1];
        flexarm.camera = flexarm.camera""")
    browser.frame()
    fine, expected = browser.run(count), browser.screen()
    assert coarse <= fine / 3
    is_beam = np.abs(expected - expected[0, -1]).max(axis=2) > 60
    differs = np.abs(picture - expected).max(axis=2) > 60
    assert is_beam.sum() > 2000 and differs.sum() < 0.1 * is_beam.sum()
    browser.run("""Player.coarseness = Player.finest;
        flexarm.camera = {position: [0.2, -0.3, 0.5], target: [0.2, 0, 0.5]}""")
    browser.frame()
    assert browser.run(count.replace("[7]", "[0]")) == fine  # near


def test_colours_and_legend_are_of_the_whole_run(browser, play):
    run = swinging_arm()
    play(run)
    start, largest = 8 * 7, 0
    for beam in run.picture["beams"]:
        for _ in beam["sections"]:
            strain = run.tracks[start + 7:start + 13]
            normal = np.abs(strain[0]) + beam["radius"] * np.hypot(strain[4], strain[5])
            shear = np.hypot(strain[1], strain[2]) + beam["radius"] * np.abs(strain[3])
            largest = max(largest, np.hypot(normal, shear / np.sqrt(3)).max())
            start += 19
    assert browser.run("return Player.stage.largest.amounts.strain") == pytest.approx(largest, rel=1e-3)
    assert browser.text(".legend-title") == "Edge strain [%]"
    titles = set()
    for key in ("axial", "shear", "torsion", "bending", "velocity"):
        browser.run("const e = document.getElementById('color'); e.value = arguments[0]; e.onchange()", key)
        titles.add(browser.text(".legend-title"))
    assert titles == {"Axial force [N]", "Shear force [N]", "Torsion moment [N m]", "Bending moment [N m]",
                      "Velocity [m/s]"}
    browser.run("const e = document.getElementById('color'); e.value = 'plain'; e.onchange()")
    assert not browser.run("return document.querySelector('.legend-title')")


# ---------------------------------------------------------------- arrows and trails

def instances(browser, kind, mesh):
    """Return the matrices of a kind of arrows, as they are drawn."""
    values = browser.run("""const [kind, name] = arguments, {marks} = Player.stage.views[0];
        const mesh = marks.arrows.find((arrow) => arrow.kind === kind).arrows[name];
        return [...mesh.instanceMatrix.array.slice(0, 16 * mesh.count)]""", kind, mesh)
    return np.reshape(values, (-1, 4, 4)).swapaxes(1, 2)


def test_arrows_have_the_length_of_their_part_of_the_largest(browser, play):
    run = swinging_arm()
    play(run)
    browser.run("flexarm.shown = ['load', 'effort', 'reaction']; flexarm.setTime(1.4)")
    browser.frame()
    radius, first = run.picture["extent"]["radius"], len(run.tracks) - 10 - 27
    effort, load = (np.array([track[70] for track in run.tracks[first + k:first + k + 9]]) for k in (0, 9))
    largest = max(np.abs(run.tracks[first + 9 + 5]).max(), 25)  # the reaction has 25 N
    [shaft], [head] = instances(browser, "load", "shafts"), instances(browser, "load", "heads")
    assert shaft[:3, 3] == pytest.approx(load[:3], abs=1e-3)
    tip = (head @ [0, 1, 0, 1])[:3]
    assert tip - load[:3] == pytest.approx(0.35 * radius * load[3:6] / largest, abs=2e-3)
    [circle] = instances(browser, "effort", "circles")
    size = 0.15 * radius * abs(effort[7]) / 12
    assert circle[:3, :3] @ [0, 0, 1] == pytest.approx([0, size * np.sign(effort[7]), 0], abs=1e-3)


def test_arrows_that_are_not_in_use_are_not_drawn(browser, play):
    run = swinging_arm(frames=3)
    first = len(run.tracks) - 10 - 18
    for k in range(3, 9):
        run.tracks[first + k] = np.zeros(3)
    play(run)
    assert len(instances(browser, "load", "shafts")) == len(instances(browser, "load", "circles")) == 0


def test_arrow_that_begins_is_where_it_acts_then(browser, play):
    """Before the first contact, the arrow's place has no position: the numbers are zero."""
    run = swinging_arm(frames=3)
    first = len(run.tracks) - 10 - 18
    for k in range(9):
        run.tracks[first + k] = run.tracks[first + k] * [0, 1, -0.7]  # so zero is not a step of the tracks
    play(run)
    browser.run("flexarm.setTime(1)")  # in the middle between two instants
    browser.frame()
    [shaft] = instances(browser, "load", "shafts")
    assert shaft[:3, 3] == pytest.approx([track[1] for track in run.tracks[first:first + 3]], abs=1e-3)


def test_trail_is_the_way_of_the_probe_until_now(browser, play):
    run = swinging_arm()
    play(run)
    browser.run("flexarm.setTime(2.1)")
    browser.frame()
    points = np.reshape(browser.run("""const {trail} = Player.stage.views[0].marks.probes[0];
        return [...trail.positions]"""), (-1, 3))
    first = len(run.tracks) - 10 - 27 - 3
    way = np.transpose(run.tracks[first:first + 3])
    for part, point in zip(np.linspace(2.1 - 0.15 * 4, 2.1, len(points)), points):
        expected = [np.interp(part, run.times, way[:, axis]) for axis in range(3)]
        assert point == pytest.approx(expected, abs=2e-3)
