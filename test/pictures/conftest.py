"""One browser for all tests of the player, and a folder for their pages."""

import os
import sys

import pytest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from browser import HEIGHT, WIDTH, Browser  # noqa: E402
from page_maker import THREE, write_page  # noqa: E402


@pytest.fixture(scope="session")
def one_browser():
    pytest.importorskip("selenium", reason="python3-selenium is not installed")
    if not os.path.exists(os.path.join(THREE, "three.min.js")):
        pytest.skip("three.js is not installed (Debian package libjs-three)")
    browser = Browser()
    try:
        browser.skip_unless_it_draws()
        yield browser
    finally:
        browser.quit()


@pytest.fixture
def browser(one_browser):
    one_browser.resize(WIDTH, HEIGHT)
    return one_browser


@pytest.fixture
def play(browser, tmp_path):
    """Return a function that opens a page with runs and returns the messages of the console. It shows the start."""
    def open_page(*runs, **settings):
        path = str(tmp_path / "page.html")
        write_page(path, *runs, **settings)
        return browser.open(path)
    return open_page
