"""The examples of docs/python.md, each by itself."""

import os
import re
import shutil

import pytest

from conftest import ROOT, example

with open(os.path.join(ROOT, "docs", "python.md"), encoding="utf-8") as file:
    TEXT = file.read()
EXAMPLES = re.findall(r"^## (.*?)$|^```python\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)


def named_examples():
    """Named by their headings, which are entries without code."""
    heading, number = "", 0
    for title, code in EXAMPLES:
        if title:
            heading, number = title, 0
        else:
            number += 1
            yield pytest.param(code, id="%s %d" % (heading, number))


def test_there_is_an_example_for_each_job():
    assert len([code for _, code in EXAMPLES if code]) == TEXT.count("```python\n") == 10


@pytest.mark.parametrize("code", named_examples())
def test_example(code, tmp_path, monkeypatch, capsys):
    for name in ("flexible_two_link_arm", "rigid_double_pendulum"):
        shutil.copy(example(name), tmp_path)
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "docs/python.md", "exec"), {"__name__": "example"})
    print(capsys.readouterr().out)
