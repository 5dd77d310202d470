"""Runs a notebook that shows a run, and looks at it in a browser."""

import json
import os
import shutil
import subprocess
import sys

import pytest

flexarm = pytest.importorskip("flexarm")

from show_test import ARM  # noqa: E402

CELL = """import flexarm
recording = flexarm.Recording(flexarm.Simulation("arm.urdf"))
recording.run(until=1.0)
flexarm.show(recording)"""


@pytest.fixture
def notebook(tmp_path):
    """Return the path of an executed notebook, as an HTML file."""
    pytest.importorskip("nbconvert", reason="jupyter-nbconvert is not installed")
    pytest.importorskip("ipykernel", reason="python3-ipykernel is not installed")
    shutil.copy(ARM, tmp_path / "arm.urdf")
    cell = {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": CELL}
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    (tmp_path / "arm.ipynb").write_text(json.dumps(
        {"cells": [cell], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 2}))
    subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", "--execute", "arm.ipynb"], cwd=tmp_path,
                   check=True, timeout=1000, env={**os.environ, "JUPYTER_PLATFORM_DIRS": "1"})
    return tmp_path / "arm.html"


def test_a_notebook_shows_the_run_in_a_frame(browser, notebook):
    browser.driver.get("file://%s" % notebook)
    frame, = browser.driver.find_elements("css selector", "iframe[srcdoc]")
    browser.driver.switch_to.frame(frame)
    try:
        browser.wait("flexarm.ready")
        assert browser.run("return flexarm.errors") == []
        assert browser.run("return flexarm.runs[0].end") == pytest.approx(1)
        browser.frame()
        pixels = browser.screen()
        assert pixels.shape[0] > 100 and len(set(map(tuple, pixels[::7, ::7].reshape(-1, 3)))) > 20
    finally:
        browser.driver.switch_to.default_content()
