"""Test the command `flexarm plot`, and the commands and examples of docs/plot.md."""

import os
import re
import shutil
import subprocess

import numpy
import pytest

from conftest import ROOT, example

WITHOUT_DISPLAY = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
TIMES = [i / 10 for i in range(41)]
NAMES = "joint/a/position", "joint/b/position", "probe/tip/x"


@pytest.fixture
def folder(tmp_path):
    """Return a folder with two runs, in which the second one is the double of the first one."""
    for name, factor in (("one.csv", 1), ("two.csv", 2)):
        rows = [[t, factor * t, factor * (4 - t), factor * t * t] for t in TIMES]
        (tmp_path / name).write_text("\n".join(",".join(map(str, row)) for row in [("time", *NAMES), *rows]) + "\n")
    return tmp_path


def plot(folder, *arguments, status=0, **options):
    """Run `flexarm plot ...` in the folder. Return its output, or its error output if it fails."""
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", *arguments], cwd=folder, check=False, timeout=1000,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**WITHOUT_DISPLAY, "COLUMNS": "70",
                                                                                  "LINES": "20"}, **options)
    assert result.returncode == status, result.stderr
    assert (result.stderr == b"") == (status == 0), result.stderr
    return (result.stderr if status else result.stdout).decode()


def labels(path):
    """Return the texts of an SVG file."""
    return [re.sub(r"<.*?>", "", text) for text in re.findall(r"<text.*?</text>", path.read_text(), re.DOTALL)]


def test_a_picture_has_labels_with_units(folder):
    plot(folder, "one.csv", "two.csv", "joint/*/position", "probe/tip/x", "--output", "a.svg", "--title", "Two runs")
    found = [text.strip() for text in labels(folder / "a.svg")]
    for expected in ("Two runs", "time [s]", "position [rad or m]", "probe/tip/x [m]", "joint/a/position", "one.csv",
                     "two.csv", "0", "4"):
        assert expected in found or expected + ".0" in found, (expected, found)


@pytest.mark.parametrize("extension, begin", [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF"),
                                              ("PNG", b"\x89PNG")])
def test_formats_of_pictures(folder, extension, begin):
    plot(folder, "one.csv", "probe/*", "--output", "a." + extension, "--size", "300x200")
    assert (folder / ("a." + extension)).read_bytes().startswith(begin)


def test_a_picture_has_its_size(folder):
    plot(folder, "one.csv", "*", "--output", "a.png", "--size", "640x350")
    assert numpy.frombuffer((folder / "a.png").read_bytes()[16:24], ">u4").tolist() == [640, 350]


def test_without_a_display_the_terminal_is_used(folder):
    lines = plot(folder, "one.csv", "joint/*/position", "--title", "A run").splitlines()
    text = "\n".join(lines)
    assert lines[0].strip() == "A run" and lines[1].strip() == "position [rad or m]" and len(lines) <= 20
    assert max(map(len, lines)) <= 70 and "time [s]" in text
    assert lines[-2:] == ["  *** joint/a/position", "  ### joint/b/position"]
    assert re.search(r"^ +0 +0\.5 +1 +1\.5 +2 +2\.5 +3 +3\.5 +4$", text, re.MULTILINE)
    assert re.search(r"^ +4 \|#", text, re.MULTILINE) and re.search(r"^ +0 \|\*", text, re.MULTILINE)
    assert "Two" in plot(folder, "one.csv", "joint/*", "--terminal", "--title", "Two", "--size", "100x40")


def test_an_unreachable_display_is_none(folder):
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", "one.csv", "probe/tip/x"], cwd=folder, check=True,
                            env={**WITHOUT_DISPLAY, "DISPLAY": ":4711"}, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, timeout=1000)
    assert b"probe/tip/x [m]" in result.stdout
    assert result.stderr.startswith(b"flexarm: plot: no window could be opened on the display")


def test_without_columns_they_are_listed(folder):
    assert plot(folder, "one.csv").splitlines() == [
        "one.csv: 41 rows, 0 s to 4 s", "  time [s]", "  joint/a/position [rad or m]", "  joint/b/position [rad or m]",
        "  probe/tip/x [m]"]


def test_a_run_comes_from_the_standard_input(folder):
    text = plot(folder, "-", "probe/tip/x", input=(folder / "one.csv").read_bytes())
    assert text.splitlines()[0].strip() == "standard input"
    assert "-: expected columns, got an empty file" in plot(folder, "-", "x", status=2, input=b"")


def test_words_may_be_in_any_order(folder):
    first = plot(folder, "one.csv", "two.csv", "joint/a/position", "probe/tip/x", "--difference")
    assert plot(folder, "joint/a/position,probe/tip/x", "--difference", "one.csv", "two.csv") == first
    assert "two.csv: difference to one.csv, interpolated linearly to its times" in " ".join(first.split())
    assert "difference of joint/a/position [rad or m]" in first


def test_times_are_chosen(folder):
    text = plot(folder, "one.csv", "probe/tip/x", "--from", "1", "--until", "2")
    assert re.search(r"^ +1 +1\.2 +1\.4 +1\.6 +1\.8 +2$", text, re.MULTILINE), text


def test_spectra_and_phase_plots(folder):
    text = plot(folder, "one.csv", "probe/tip/x", "--spectrum", "--max-frequency", "2", "--log", "y")
    assert "amplitude of probe/tip/x [m]" in text and re.search(r"frequency \[Hz\]", text)
    text = plot(folder, "one.csv", "two.csv", "--phase", "joint/a/position", "joint/b/position")
    assert "joint/a/position [rad or m]" in text and "### joint/b/position, two.csv" in text


@pytest.mark.parametrize("arguments, said", [
    ([], "usage: flexarm plot [OPTIONS] RUN... COLUMN..."),
    (["none.csv", "a"], "flexarm: plot: none.csv: cannot be read: No such file or directory"),
    (["none", "a"], "there is no file 'none'; expected a file of results first"),
    (["one.csv", "joint/a/positoin"],
     "flexarm: plot: one.csv: no column is like 'joint/a/positoin'; there are joint/a/position, joint/b/position, "),
    (["one.csv", "two.csv", "probe/tip/x,time,z"], "no column is like 'z'; there are "),
    (["one.csv", "time", "--difference"], "expected at least two runs for a difference, got one"),
    (["one.csv", "time", "--output", "a.gif"],
     "--output: expected a name that ends in .png, .svg or .pdf, got 'a.gif'"),
    (["one.csv", "time", "--from", "2", "--until", "1"], "expected --from before --until, got 2 and 1"),
    (["one.csv", "time", "--from", "9"], "there are no rows between 9 s and inf s; the run has 0 s to 4 s"),
    (["one.csv", "time", "--size", "9"], "--size: expected WIDTHxHEIGHT in whole numbers up to 10000, got '9'"),
    (["one.csv", "time", "--max-frequency", "-1"], "--max-frequency: expected a number > 0, got '-1'"),
    (["one.csv", "time", "--spectrum", "--window", "x"], "flexarm: plot: window 'x': "),
    (["one.csv", "time", "--phase", "time", "time"], "expected no columns beside those of --phase, got 'time'"),
])
def test_errors_are_clear(folder, arguments, said):
    assert said in plot(folder, *arguments, status=2)


def test_what_is_left_of_a_file_is_drawn_with_a_warning(tmp_path):
    for name in ("run.h5", "run.csv"):
        subprocess.run([os.environ["FLEXARM_PROGRAM"], "simulate", example("flexible_two_link_arm"), "--until", "2.2",
                        "--output", tmp_path / name], check=True, stdout=subprocess.DEVNULL)
        data = (tmp_path / name).read_bytes()
        (tmp_path / ("cut_" + name)).write_bytes(data[:int(0.6 * len(data))])
        (tmp_path / ("no_" + name)).write_bytes(data[:100])
    for name, said in (("cut_run.h5", "cut_run.h5 has only "), ("cut_run.csv", "cut_run.csv: the last line has no ")):
        result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", name, "joint/*/position", "--output", "a.svg"],
                                cwd=tmp_path, check=False, timeout=1000, stderr=subprocess.PIPE, env=WITHOUT_DISPLAY)
        assert result.returncode == 0 and result.stderr.decode().startswith("flexarm: plot: warning: " + said)
        assert "joint/elbow/position" in [text.strip() for text in labels(tmp_path / "a.svg")]
    said = plot(tmp_path, "no_run.h5", "joint/*/position", status=2)
    assert "in which there are no rows" in said and "eof" not in said and "addr" not in said


@pytest.mark.parametrize("content, said", [(b"", "it is empty"), (b"hello", "it is not an HDF5 file")])
def test_hdf5_errors_are_sentences(tmp_path, content, said):
    (tmp_path / "run.h5").write_bytes(content)
    assert "run.h5: cannot be read: " + said in plot(tmp_path, "run.h5", "a", status=2)


def test_a_picture_that_cannot_be_written_is_an_error(folder):
    said = plot(folder, "one.csv", "time", "--output", "none/a.png", status=1)
    assert said == "flexarm: plot: cannot write 'none/a.png': No such file or directory\n"


def test_without_a_package_it_is_told_which_one(folder):
    (folder / "sitecustomize.py").write_text("import sys\nsys.modules['matplotlib'] = sys.modules['h5py'] = None\n")
    shutil.copy(folder / "one.csv", folder / "one.h5")
    for arguments, package in ((["one.csv", "time", "--output", "a.png"], "python3-matplotlib"),
                               (["one.h5", "time"], "python3-h5py")):
        result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", *arguments], cwd=folder, check=False,
                                stderr=subprocess.PIPE, env={**WITHOUT_DISPLAY, "PYTHONPATH": str(folder)})
        assert result.returncode == 2 and ("Debian's package %s, which is missing" % package).encode() in result.stderr
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", "one.csv", "time"], cwd=folder, check=False,
                            stderr=subprocess.PIPE, env={**WITHOUT_DISPLAY, "PATH": str(folder)})
    assert result.returncode == 2 and b"Debian's package gnuplot-nox, which is missing" in result.stderr


@pytest.mark.parametrize("name", [b"a$b$_{x.csv", b"it's `id` \"$(id)\".csv", b"_x.csv", b"\x1b[31m\nred.csv",
                                  b"\xff.csv", b"'; set output 'gone'; '.csv", b"EN\nEND\n.csv"])
def test_hostile_names_of_files(folder, name):
    path = os.path.join(os.fsencode(folder), name)
    shutil.copy(folder / "one.csv", path)
    text = plot(folder, path, "two.csv", "joint/*")
    assert "\x1b" not in text and "### joint/b/position" in text
    plot(folder, path, "two.csv", "joint/*", "--output", "a.svg")
    shown = "".join(c if c.isprintable() else "?" for c in os.fsdecode(name))
    found = [label.strip() for label in labels(folder / "a.svg")]
    assert shown.replace("\"", "&quot;") in found or shown in found, found
    assert sorted(os.listdir(folder)) == sorted([os.fsdecode(name), "a.svg", "one.csv", "two.csv"])


def test_long_names_leave_room_for_curves(folder):
    """The legend has at most 40 letters of a name. (It would squeeze the axes to nothing, which is a warning.)"""
    name = 20 * "long_name_" + ".csv"
    shutil.copy(folder / "one.csv", folder / name)
    plot(folder, name, "two.csv", "joint/*", "--output", "a.svg")
    assert max(map(len, labels(folder / "a.svg"))) < 50


def test_hostile_names_of_columns(folder):
    (folder / "bad.csv").write_text("time,$x^{,\"it's\x1b[31m\",_a\n0,1,2,3\n1,2,3,4\n")
    text = plot(folder, "bad.csv", "*")
    assert "$x^{" in text and "it's?[31m" in text and "\x1b" not in text
    plot(folder, "bad.csv", "*", "--output", "a.svg")
    assert "$x^{" in [label.strip() for label in labels(folder / "a.svg")]


def test_help_lists_the_command():
    program = os.environ["FLEXARM_PROGRAM"]
    text = subprocess.run([program, "--help"], check=True, stdout=subprocess.PIPE).stdout.decode()
    assert re.search(r"^ +plot +Draws columns of results", text, re.MULTILINE)
    offered = subprocess.run([program, "--complete", "pl"], check=True, stdout=subprocess.PIPE).stdout.decode()
    assert offered.split("\t")[0] == "plot"
    assert "usage: flexarm plot" in subprocess.run([program, "plot", "--help"], check=True,
                                                   stdout=subprocess.PIPE).stdout.decode()


def test_the_page_is_true(tmp_path, monkeypatch, capsys):
    """Run commands and examples of docs/plot.md, in this order."""
    with open(os.path.join(ROOT, "docs", "plot.md"), encoding="utf-8") as file:
        text = file.read()
    shutil.copy(example("flexible_two_link_arm"), tmp_path / "arm.urdf")
    commands = re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    program, = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    assert len(commands) == 6
    path = os.path.dirname(os.environ["FLEXARM_PROGRAM"]) + ":" + os.environ["PATH"]
    said = subprocess.run(["bash", "-euo", "pipefail", "-c", "\n".join(commands)], cwd=tmp_path, check=True,
                          env={**WITHOUT_DISPLAY, "PATH": path}, stdout=subprocess.PIPE).stdout.decode()
    assert "energy/total [J]" in said and "fine.h5: 2001 rows" in said and "probe/payload/z [m]" in said
    assert {"arm.png", "error.svg", "spectrum.pdf", "phase.png", "path.png"} <= set(os.listdir(tmp_path))
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "docs/plot.md", "exec"), {"__name__": "example"})
    assert "largest difference" in capsys.readouterr().out and (tmp_path / "positions.png").stat().st_size > 5000
    told = subprocess.run([os.environ["FLEXARM_PROGRAM"], "plot", "--help"], check=True, stdout=subprocess.PIPE).stdout
    for option in set(re.findall(r"--[a-z-]+", told.decode())) - {"--help"}:
        assert "`%s" % option in text, option
