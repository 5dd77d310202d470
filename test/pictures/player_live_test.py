"""A page that shows a run while it happens."""

import pytest
from live_server import LiveServer, instant_bytes, picture_text
from page_maker import marker, swinging_arm


@pytest.fixture
def server(browser):
    server = LiveServer(swinging_arm())
    assert browser.open(server.url) == []
    browser.until("flexarm.runs.length")
    yield server
    server.close()
    browser.driver.get("about:blank")  # or it goes on trying to connect


def newest(browser, time):
    browser.until(f"Math.abs(flexarm.time - {time}) < 1e-9")


def test_newest_instant_is_shown_until_it_is_paused(browser, server):
    server.send_instants(range(51))
    newest(browser, 1.0)
    assert browser.text("#live-text") == "live"
    browser.until("Player.plots.clock.end === 1")
    browser.frame()
    shown = browser.run("return [...flexarm.runs[0].values]")
    assert shown == pytest.approx([track[50] for track in server.run.tracks], abs=1e-5)
    browser.click("#play")
    assert browser.text("#live-text") == "paused"
    server.send_instants(range(51, 101))
    browser.until("flexarm.runs[0].duration > 1.99")
    assert browser.run("return flexarm.time") == 1.0
    browser.click("#live")
    newest(browser, 2.0)
    assert browser.text("#live-text") == "live"


def test_it_can_be_rewound(browser, server):
    server.send_instants(range(101))
    newest(browser, 2.0)
    browser.click("#slider")
    assert browser.run("return flexarm.time") == pytest.approx(1.0, abs=0.05)
    assert browser.text("#live-text") == "paused"
    browser.run("flexarm.speed = 5")
    browser.click("#play")
    newest(browser, 2.0)
    browser.until("document.getElementById('live-text').textContent === 'live'")


def test_only_the_last_minute_is_kept(browser, server):
    server.run.times = server.run.times * 50  # 200 s
    server.send_instants(range(201))
    newest(browser, 200.0)
    assert browser.run("return flexarm.runs[0].store.time(0)") == 140.0
    assert browser.run("return flexarm.runs[0].store.count") == 61


def test_it_connects_again_and_shows_what_is_sent_then(browser, server):
    server.send_instants(range(11))
    newest(browser, 0.2)
    server.run = marker([[0, 0, 0], [0.3, 0, 0]])
    server.disconnect()
    browser.until("document.documentElement.dataset.connection === 'lost'")
    browser.until("flexarm.runs[0].picture.name === 'marker'")
    server.send_instants([0, 1])
    newest(browser, 1.0)
    assert browser.text("#connection") == ""
    assert browser.run("return flexarm.errors") == []


def test_a_run_that_begins_anew_replaces_the_old_one(browser, server):
    server.send_instants(range(101))
    newest(browser, 2.0)
    server.send_instants([0, 1])
    newest(browser, float(server.run.times[1]))
    assert browser.run("return flexarm.runs[0].store.count") == 2


def test_meshes_come_with_the_picture(browser, server):
    assert browser.run("return flexarm.runs[0].meshes[0].positions.length") == 54


def test_damaged_messages_are_told_and_left_out(browser, server):
    server.send(2, instant_bytes(server.run, 0)[:-8])
    browser.until("flexarm.errors.length")
    assert "cannot be read" in browser.run("return flexarm.errors[0]")
    server.send(1, b'{"nonsense')
    server.send_instants([3])
    newest(browser, float(server.run.times[3]))
    server.send(1, picture_text(marker([[0, 0, 0]])).encode())
    browser.until("flexarm.runs[0].picture.name === 'marker'")
