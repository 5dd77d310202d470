"""Test that each example of docs/python.md and docs/linearise.md runs by itself."""

import os
import re
import shlex
import shutil

import pytest

from conftest import ROOT, command_line, example

DEMO = os.path.join(ROOT, "config", "demo_arm.urdf")


def text_of(name):
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return file.read()


def examples_of(name):
    """Yield the examples of a document, named by their headings. A heading without code is an entry without code."""
    heading, number = "", 0
    for title, code in re.findall(r"^## (.*?)$|^```python\n(.*?)^```", text_of(name), re.DOTALL | re.MULTILINE):
        if title:
            heading, number = title, 0
        else:
            number += 1
            yield pytest.param(code, id="%s %d" % (heading, number))


EXAMPLES = {name: list(examples_of(name)) for name in ("python.md", "linearise.md")}


@pytest.mark.parametrize("name, count", [("python.md", 14), ("linearise.md", 4)])
def test_there_is_an_example_for_each_job(name, count):
    assert len(EXAMPLES[name]) == text_of(name).count("```python\n") == count


@pytest.mark.parametrize("code", [code for examples in EXAMPLES.values() for code in examples])
@pytest.mark.filterwarnings("ignore:nothing holds link 'shoulder'")  # warning about the demo arm, which is in orbit
def test_example(code, tmp_path, monkeypatch, capsys):
    for path in (example("flexible_two_link_arm"), example("rigid_double_pendulum"), DEMO):
        shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "docs", "exec"), {"__name__": "example"})
    print(capsys.readouterr().out)


def test_command(tmp_path):
    """Run the `flexarm linearise ...` command of docs/linearise.md."""
    (text,) = re.findall(r"^```sh\nflexarm (.*?)\n```", text_of("linearise.md"), re.MULTILINE)
    shutil.copy(DEMO, tmp_path)
    status, said = command_line(*shlex.split(text), folder=tmp_path)
    assert status == 0, said
    assert (tmp_path / "bode.png").stat().st_size > 0 and (tmp_path / "bode.json").stat().st_size > 0
