"""What the player reads: all kinds of tracks, damaged data, hostile names."""

import base64
import json

import numpy as np
import pytest
from page_maker import Run, marker, swinging_arm, wedge

NAMES = ['</script><script>window.harmed = 1</script>', '<img src=x onerror="window.harmed = 2">',
         "'\"`${window.harmed = 3}", "рычаг 🤖 \u202eبازو", "__proto__", "constructor", "", " ", "a\nb,\"c\"",
         "x" * 3000, "\udd16 &lt;b&gt;"]  # the last one begins with half a character


def bare_picture(**members):
    picture = marker([[0, 0, 0]]).copy(**members).picture
    return picture


def values_of(browser):
    """Return the values of all tracks as the player decoded them, NaN where there is none."""
    values = browser.run("""const run = flexarm.runs[0], rows = [];
        for (let track = 0; track < run.layout.count; ++track) {
          const row = [];
          for (let k = 0; k < run.store.count; ++k) {
            const value = run.store.value(track, k);
            row.push(Number.isNaN(value) ? null : value);
          }
          rows.push(row);
        }
        return rows""")
    return np.array([[np.nan if value is None else value for value in row] for row in values], dtype=float)


def test_numbers_are_what_was_encoded(browser, play):
    """Random tracks with all sizes, constants and gaps: right to half a step of 16 bits."""
    generator, frames = np.random.default_rng(7), 150
    columns = [{"name": f"c{k}", "unit": ""} for k in range(150)]  # more than one block of the decoder
    tracks = [np.zeros(frames)] * 6 + [np.ones(frames)]
    for k in range(len(columns)):
        track = 10.0 ** generator.integers(-8, 9) * generator.normal(size=frames) + generator.normal()
        if k % 7 == 1:
            track = np.full(frames, generator.normal())
        if k % 7 == 2:
            track[generator.random(frames) < 0.3] = np.nan
        if k % 7 == 3:
            track[:] = np.nan
        tracks.append(track)
    times = np.cumsum(generator.random(frames))
    play(Run(bare_picture(frames=frames, columns=columns), times, tracks))
    assert browser.run("return flexarm.errors") == []
    assert browser.run("return [...flexarm.runs[0].store.times]") == pytest.approx(times, rel=1e-15)
    assert browser.run("return flexarm.runs[0].duration") == pytest.approx(times[-1] - times[0])
    read = values_of(browser)
    for track, got in zip(tracks, read):
        assert (np.isnan(track) == np.isnan(got)).all()
        known = track[~np.isnan(track)]
        if known.size:
            assert np.abs(got[~np.isnan(got)] - known).max() <= 0.501 * np.ptp(known) / 65534


def test_values_between_instants_are_interpolated(browser, play):
    run = swinging_arm(frames=9, duration=4.0)
    play(run)
    browser.run("flexarm.setTime(0.625)")  # a quarter of the way from the instant 1 to 2
    browser.frame()
    shown = np.array(browser.run("return [...flexarm.runs[0].values]"))
    for track, value in zip(run.tracks, shown):
        assert value == pytest.approx(0.75 * track[1] + 0.25 * track[2], abs=1e-4 * max(np.ptp(track), 1e-3))


def test_meshes_are_what_was_encoded(browser, play):
    play(swinging_arm(frames=2))
    vertices, triangles = browser.run("""const [mesh] = flexarm.runs[0].meshes;
        return [[...mesh.positions], [...mesh.triangles]]""")
    expected, corners = wedge()
    assert np.reshape(vertices, (-1, 3)) == pytest.approx(np.array(expected), abs=1e-6)
    assert np.reshape(triangles, (-1, 3)).tolist() == [list(corner) for corner in corners]


def test_hostile_names_are_only_text(browser, play):
    count = len(NAMES)
    links = [{"name": name, "parent": k - 1, "beam": -1, "stick": [[0.1, 0, 0]], "shapes": []}
             for k, name in enumerate(NAMES)]
    joints = [{"name": name, "link": k, "kind": name, "axis": [0, 0, 1], "columns": [k]}
              for k, name in enumerate(NAMES)]
    picture = bare_picture(
        name=NAMES[0], title=NAMES[1], notes=NAMES, links=links, joints=joints, frames=2,
        columns=[{"name": f"{name}/position", "unit": name} for name in NAMES],
        clips=[{"name": name, "first": 0, "count": 2} for name in NAMES],
        arrows=[{"kind": NAMES[0], "count": 0}, {"kind": "constructor", "count": 1}])
    tracks = ([[0, 1]] + [[0, 0]] * 5 + [[1, 1]]) * count + [[0, 0]] * 9 + [[0, 1]] * count
    assert play(Run(picture, [0, 1], tracks), Run(picture, [0, 1], tracks)) == []
    assert browser.run("return flexarm.errors") == []
    # As JSON, since the browser's driver does not send half a character.
    shown = browser.run("""return JSON.stringify([...document.querySelectorAll('#tree .row .name')]
        .map((name) => name.textContent))""")
    assert json.loads(shown) == [name for name in NAMES for _ in range(2)] * 2
    browser.click("#tree .row", 1)
    assert browser.text("#details-name") == NAMES[0]
    browser.run("flexarm.play()")
    browser.frame()
    browser.run("flexarm.pause()")
    browser.click("#add-curve")
    browser.capture(300, 200, NAMES[0])
    assert browser.run("return window.harmed") is None
    assert browser.run("return document.querySelectorAll('img, b:not(#tip-name)').length") == 0
    assert browser.run("return document.documentElement.scrollWidth <= innerWidth")


def cut(run, part):
    """Return the elements of a run of whose motion only a part has arrived."""
    picture, motion = run.elements().split("\n", 1)
    text = motion[len('<script type="text/plain" class="flexarm-motion">'):-len("</script>")]
    return f'{picture}\n<script type="text/plain" class="flexarm-motion">{text[:int(part * len(text))]}</script>'


def test_truncated_motion_is_told_and_the_rest_is_shown(browser, play):
    play(cut(swinging_arm(), 0.7))
    errors = browser.run("return flexarm.errors")
    assert len(errors) == 1 and "“swinging arm” is incomplete" in errors[0]
    assert browser.text("#problems").strip() == errors[0]
    browser.run("flexarm.setTime(1)")
    browser.frame()
    links = browser.run("return Player.stage.views[0].arm.links.map((link) => link.visible)")
    assert all(links)
    browser.run("flexarm.play()")
    browser.frame()
    assert browser.run("return flexarm.errors.length") == 1


@pytest.mark.parametrize("motion", ["", "!!! not Base64 !!!", base64.b64encode(b"not a zlib stream").decode(),
                                    "AAAA" * 1000])
def test_missing_or_garbled_motion_is_told_and_the_picture_is_shown(browser, play, motion):
    picture = swinging_arm().elements().split("\n", 1)[0]
    play(f'{picture}\n<script type="text/plain" class="flexarm-motion">{motion}</script>')
    errors = browser.run("return flexarm.errors")
    assert len(errors) == 1 and "missing or damaged" in errors[0]
    assert len(browser.driver.find_elements("css selector", "#tree .row")) == 12
    browser.frame()
    assert browser.run("return Player.stage.views[0].arm.links.every((link) => link.visible)")
    assert browser.run("return document.getElementById('play').disabled")


@pytest.mark.parametrize("times", [[0, 2, 1], [0, np.nan, 1], [np.inf, np.inf, np.inf]])
def test_times_that_do_not_increase_are_told(browser, play, times):
    run = swinging_arm(frames=3)
    run.times = np.array(times, dtype=float)
    play(run)
    assert browser.run("return flexarm.errors") == [
        "The times of “swinging arm” do not increase. Its instants are shown a second after one another."]
    assert browser.run("return [flexarm.runs[0].start, flexarm.runs[0].duration]") == [0, 2]


def test_instants_may_have_the_same_time(browser, play):
    """An impact has an instant before and one after it."""
    run = marker([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    run.times = np.array([0, 1, 1, 2.0])
    play(run)
    shown = []
    for time in (0, 0.5, 1, 1.5, 2):
        browser.run("flexarm.setTime(arguments[0])", time)
        browser.frame()
        shown.append(browser.run("return flexarm.runs[0].values[0]"))
    assert shown == pytest.approx([0, 0.5, 2, 2.5, 3], abs=1e-4)


def test_garbled_picture_is_told_and_other_runs_are_shown(browser, play):
    play('<script type="application/json" class="flexarm-picture">{"name": nonsense}</script>\n'
         '<script type="text/plain" class="flexarm-motion"></script>', swinging_arm())
    errors = browser.run("return flexarm.errors")
    assert len(errors) == 1 and errors[0].startswith("The picture of run 1 cannot be read")
    assert browser.run("return flexarm.runs.map((run) => run.picture.name)") == ["swinging arm"]


@pytest.mark.parametrize("picture", [
    {}, {"links": 3, "beams": None, "frames": "many"}, {"links": [{}], "beams": [{}], "frames": 2},
    {"links": [{"name": "a", "parent": 0}, {"parent": 2}, {"parent": 1}], "frames": 1},
    {"links": [None, 1], "joints": [None], "columns": ["a"], "meshes": [None], "notes": [{}], "extent": 3}])
def test_pictures_with_wrong_members_do_no_harm(browser, play, picture):
    play(f'<script type="application/json" class="flexarm-picture">{json.dumps(picture)}</script>\n'
         '<script type="text/plain" class="flexarm-motion"></script>')
    browser.frame()
    assert all("failed" not in error for error in browser.run("return flexarm.errors"))
    assert browser.run("return flexarm.runs.length") == 1


def test_page_without_runs_says_so(browser, play):
    play()
    assert browser.run("return flexarm.errors") == ["This page contains no run."]


def test_number_without_a_value_hides_what_it_places(browser, play):
    run = swinging_arm(frames=3)
    run.tracks[4 * 7] = np.array([0.1, np.nan, 0.3])  # x of the gripper
    play(run)
    visible = "return Player.stage.views[0].arm.links[4].visible"
    for time, expected in ((0, True), (2, False), (4, True)):
        browser.run("flexarm.setTime(arguments[0])", time)
        browser.frame()
        assert browser.run(visible) is expected
    assert browser.run("return flexarm.errors") == []
