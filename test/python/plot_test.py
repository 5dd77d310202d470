"""Test runs in Python: reading them, their differences and spectra, and pictures of them."""

import subprocess
import sys

import numpy
import pytest

import flexarm
from conftest import bits, command_line, example
from flexarm.plotting import curves, terminal
from flexarm.result_files import matching, nearest, unit_of

TIMES = numpy.linspace(0, 10, 1001)


def run_of(columns, units=None, name="run"):
    """Return a run of arrays by name."""
    rows = numpy.transpose(list(columns.values()))
    return flexarm.Run(columns, [(units or {}).get(column, "") for column in columns], rows, name)


def write_csv(path, run):
    path.write_text("\n".join([",".join(run.names), *(",".join(map(repr, row)) for row in run.rows.tolist())]) + "\n")
    return str(path)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return a run of the example as CSV and as HDF5."""
    folder = tmp_path_factory.mktemp("runs")
    paths = [str(folder / name) for name in ("arm.csv", "arm.h5")]
    for path in paths:
        status, said = command_line("simulate", example("flexible_two_link_arm"), "--until", 0.1, "--output", path)
        assert status == 0, said
    return paths


# ---------------------------------------------------------------- reading

def test_csv_and_hdf5_have_the_same_bits(files):
    csv, hdf5 = map(flexarm.read_run, files)
    assert sorted(csv.names) == sorted(hdf5.names) and len(csv.rows) > 50
    for name in csv.names:
        assert bits(csv[name]) == bits(hdf5[name]), name
    assert bits(csv.times) == bits(csv["time"])


def test_units_follow_from_names_where_a_file_has_none(files):
    csv, hdf5 = map(flexarm.read_run, files)
    assert hdf5.unit("joint/elbow/velocity") == "rad/s" and csv.unit("joint/elbow/velocity") == "rad/s or m/s"
    for name in hdf5.names:
        assert hdf5.unit(name) in csv.unit(name).split(" or "), name


@pytest.mark.parametrize("scene", ["flexible_two_link_arm", "rigid_double_pendulum", "tower_crane"])
def test_units_are_those_of_the_simulation(scene):
    for name, unit in flexarm.Simulation(flexarm.read_scene(example(scene))).columns(["*", "probe/*/a[xyz]"]):
        assert unit in unit_of(name).split(" or "), name


def test_units_of_sensors_springs_and_contacts():
    units = {"sensor/s/fx": "N", "sensor/s/mz": "N m", "sensor/s/wx": "rad/s", "sensor/s/ay": "m/s^2",
             "sensor/s/strain": "1", "sensor/s/tension": "N", "tendon/t/last_tension": "N",
             "sensor/s/z": "m", "sensor/s/qw": "1", "spring/s/length": "m",
             "spring/s/tension": "N", "contact/a/b/fx": "N", "contact/a/b/points": "1", "contact/a/b/gap": "m",
             "momentum/x": "kg m/s", "angular_momentum/z": "kg m^2/s", "solver/error_estimate": "m", "other/x": ""}
    assert {name: unit_of(name) for name in units} == units


def test_only_chosen_columns_are_read(files):
    for path in files:
        run = flexarm.read_run(path, ["probe/*/[xz]", "joint/elbow/*"])
        assert run.names[0] == "time" and set(run.names[1:3]) == {"probe/payload/x", "probe/payload/z"}
        assert set(run.names[3:]) == {"joint/elbow/" + quantity for quantity in ("position", "velocity", "effort")}


def test_a_bag_has_the_joints(files, tmp_path):
    pytest.importorskip("rosbag")
    path = str(tmp_path / "arm.bag")
    assert command_line("simulate", example("flexible_two_link_arm"), "--until", 0.1, "--output", path)[0] == 0
    bag, csv = flexarm.read_run(path), flexarm.read_run(files[0])
    for name in ("joint/elbow/position", "joint/shoulder/velocity", "joint/elbow/effort"):
        assert bag[name] == pytest.approx(numpy.interp(bag.times, csv.times, csv[name]), abs=1e-6), name


def test_columns_of_text_and_gaps_can_be_in_a_file(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text('time,"a,b",note\n0,1,good\n\n1,,"not, so"\n2,nan,\n')
    run = flexarm.read_run(path, ["a,b"])
    assert run.times.tolist() == [0, 1, 2] and numpy.isnan(run["a,b"]).tolist() == [False, True, True]
    with pytest.raises(flexarm.ResultsError, match=r"run.csv:2: note: expected a number, got 'good'"):
        flexarm.read_run(path)


@pytest.mark.parametrize("text, error", [
    ("", ": expected columns, got an empty file"),
    ("x,y\n1,2\n", ": expected one column 'time', got the columns x, y"),
    ("time,a,a\n0,1,2\n", ": expected one column 'a', got 2"),
    ("time,a\n0,1\n1,2,3\n", ":3: expected 2 fields, got 3"),
    ("time,a\n0,1\n1\n", ":3: expected 2 fields, got 1"),
    ("time,a\n0,1\n\n1,one\n", ":4: a: expected a number, got 'one'"),
])
def test_errors_of_files_say_where(tmp_path, text, error):
    path = tmp_path / "run.csv"
    path.write_text(text)
    with pytest.raises(flexarm.ResultsError) as raised:
        flexarm.read_run(path)
    assert str(raised.value) == str(path) + error


@pytest.mark.parametrize("name", ["none.csv", "none.h5", "none.bag"])
def test_a_missing_file_is_an_error(tmp_path, name):
    with pytest.raises(flexarm.ResultsError, match=name + ": cannot be read: No such file or directory"):
        flexarm.read_run(tmp_path / name)


@pytest.mark.parametrize("name", ["run.h5", "run.bag"])
def test_a_file_of_another_format_is_an_error(tmp_path, name):
    (tmp_path / name).write_text("time,a\n0,1\n")
    with pytest.raises(flexarm.ResultsError, match=name + ": cannot be read"):
        flexarm.read_run(tmp_path / name)


def test_a_run_is_made_of_what_a_simulation_records(pendulum):
    record = ["joint/*/position", "energy/total"]
    rows = pendulum.run(20, record=record)
    run = flexarm.Run(*zip(*pendulum.columns(record)), rows)
    assert run.names[0] == "time" and run.unit("joint/elbow/position") == "rad"
    assert bits(run["energy/total"]) == bits(rows[:, run.names.index("energy/total")])
    assert repr(run) == "<flexarm.Run run: 20 rows of 4 columns>"
    with pytest.raises(KeyError, match="run has no column 'elbow'"):
        run["elbow"]


@pytest.mark.parametrize("names, units, shape, error", [
    (["time", "a"], ["s"], (3, 2), "expected a unit and a column of 'rows' for each of 2 names, got 1 units and rows"),
    (["time", "a"], ["s", "m"], (3, 3), r"of the shape \(3, 3\)"),
    (["time", "a"], ["s", "m"], (2,), r"of the shape \(2,\)"),
    (["a", "b"], ["m", "m"], (3, 2), "expected one column 'time', got 0"),
    (["time", "a", "a"], ["s", "m", "m"], (3, 3), "expected one column 'a', got 2"),
])
def test_arrays_that_do_not_fit_are_refused(names, units, shape, error):
    with pytest.raises(flexarm.ResultsError, match=error):
        flexarm.Run(names, units, numpy.zeros(shape))


def test_patterns_choose_in_their_order():
    names = ["time", "joint/b/position", "joint/a/position", "joint/a/velocity", "x[1]"]
    assert matching(names, ["joint/a/*", "joint/*/position"]) == [names[2], names[3], names[1]]
    assert matching(names, ["*"]) == names[1:] and matching(names, ["time"]) == ["time"]
    assert matching(names, ["x[1]"]) == ["x[1]"]  # a name is not taken for a pattern
    with pytest.raises(flexarm.ResultsError) as raised:
        matching(names, ["joint/a/positoin"])
    assert str(raised.value).startswith("no column is like 'joint/a/positoin'; there are joint/a/position, joint/b/")
    assert nearest("x7", ["x%d" % i for i in range(20)]).startswith("x7, ")
    assert nearest("x7", ["x%d" % i for i in range(20)]).endswith(" and 8 others")


def test_rows_between_two_times():
    run = run_of({"time": TIMES, "a": TIMES})
    part = run.between(0.1 + 0.2, 0.5)  # 0.1 + 0.2 > 0.3
    assert part.times[[0, -1]] == pytest.approx([0.3, 0.5]) and len(part.rows) == 21
    with pytest.raises(flexarm.ResultsError, match="no rows between 11 s and 12 s; the run has 0 s to 10 s"):
        run.between(11, 12)


# ---------------------------------------------------------------- differences

def test_the_difference_is_taken_at_the_times_of_the_reference():
    """Linear interpolation of sin(w t) in intervals h differs from it by (w h)^2 / 8 at most."""
    fine, coarse = numpy.linspace(0, 10, 401), numpy.linspace(0, 9, 91)
    reference = run_of({"time": fine, "a": numpy.sin(fine), "b": fine})
    other = run_of({"time": coarse, "a": 1.5 * numpy.sin(coarse), "c": coarse})
    difference = other.minus(reference)
    assert difference.names == ("time", "a") and bits(difference.times) == bits(fine)
    common = fine <= 9
    with_gap = run_of({"time": fine, "a": numpy.full(401, numpy.inf)})
    assert not numpy.isfinite(with_gap.minus(with_gap)["a"]).any()
    error = difference["a"][common] - 0.5 * numpy.sin(fine[common])
    assert abs(error).max() <= 1.5 * 0.1**2 / 8 and abs(error).max() > 0.5 * 1.5 * 0.1**2 / 8
    assert numpy.isnan(difference["a"][~common]).all()


def test_times_that_decrease_have_no_difference():
    run = run_of({"time": TIMES[::-1], "a": TIMES})
    with pytest.raises(flexarm.ResultsError, match="run: expected times that increase"):
        run.minus(run)


# ---------------------------------------------------------------- spectra

def scalloping(window, count):
    """Return how much lower a sine appears whose frequency is in the middle between two points of the spectrum."""
    import scipy.signal

    weights = scipy.signal.get_window(window, count)
    return 1 - abs(weights @ numpy.exp(1j * numpy.pi * numpy.arange(count) / count)) / weights.sum()


@pytest.mark.parametrize("window, bound", [("flattop", 2e-3), ("hann", 0.1512)])
@pytest.mark.parametrize("frequency", [7.0, 7.03, 7.0495])
def test_the_peak_of_a_sine_is_its_amplitude(window, bound, frequency):
    run = run_of({"time": TIMES, "a": 4 + 2.5 * numpy.sin(2 * numpy.pi * frequency * TIMES + 1)})
    frequencies, amplitudes = run.spectrum("a", window)
    peak = amplitudes.argmax()
    step = frequencies[1]
    assert step == pytest.approx(1 / (1001 * 0.01)) and abs(frequencies[peak] - frequency) <= step / 2 * (1 + 1e-9)
    lost = scalloping(window, 1001)
    assert lost <= bound
    # Besides, the sine's negative frequency, 140 points away, has side lobes here.
    assert -lost - 1e-4 <= amplitudes[peak] / 2.5 - 1 <= max(0, -lost) + 2e-4
    assert amplitudes[frequencies > 7 + 10 * step].max() < 2.5 * (2e-3 if window == "hann" else 1e-3)


def test_the_highest_frequency_has_its_amplitude():
    values = 3.0 * (-1) ** numpy.arange(1000)
    assert run_of({"time": TIMES[:1000], "a": values}).spectrum("a", "boxcar").amplitudes[-1] == pytest.approx(3)


def test_rows_need_not_be_evenly_spaced():
    times = numpy.sort(numpy.concatenate([TIMES, TIMES[200:400] + 0.003]))
    frequencies, amplitudes = run_of({"time": times, "a": numpy.sin(2 * numpy.pi * times)}).spectrum("a")
    assert frequencies[amplitudes.argmax()] == pytest.approx(1, abs=frequencies[1] / 2)
    assert amplitudes.max() == pytest.approx(1, rel=0.003)  # interpolation takes (w h)^2 / 8 = 0.0005 at most


@pytest.mark.parametrize("columns, window, error", [
    ({"time": TIMES[:7], "a": TIMES[:7]}, "hann", "run: expected at least 8 rows for a spectrum, got 7"),
    ({"time": TIMES, "a": numpy.where(TIMES == 5, numpy.nan, 1)}, "hann", "'a' has gaps"),
    ({"time": 0 * TIMES, "a": TIMES}, "hann", "expected times that increase"),
    ({"time": TIMES, "a": TIMES}, "round", "window 'round': "),
])
def test_what_has_no_spectrum(columns, window, error):
    with pytest.raises(flexarm.ResultsError, match=error):
        run_of(columns).spectrum("a", window)


# ---------------------------------------------------------------- plots

UNITS = {"time": "s", "joint/a/position": "rad", "joint/b/position": "rad", "probe/p/x": "m", "probe/p/z": "m"}


def motion(factor=1.0, name="run"):
    return run_of({"time": TIMES, "joint/a/position": factor * numpy.sin(TIMES), "joint/b/position": numpy.cos(TIMES),
                   "probe/p/x": TIMES**2, "probe/p/z": -TIMES}, UNITS, name)


def plot_of(*runs, columns=("*",), difference=False, spectrum=False, phase=(), log="", max_frequency=numpy.inf):
    return curves.choose(runs, columns, difference, spectrum, phase, log, "flattop", max_frequency, None)


def test_there_are_axes_for_each_unit():
    figure = motion().plot(title="A run", size=(600, 500))
    upper, lower = figure.axes
    assert upper.get_ylabel() == "position [rad]" and lower.get_ylabel() == "[m]"
    assert lower.get_xlabel() == "time [s]" and upper.get_shared_x_axes().joined(upper, lower)
    assert [text.get_text().strip() for text in upper.get_legend().get_texts()] == list(UNITS)[1:3]
    assert bits(upper.lines[0].get_ydata()) == bits(numpy.sin(TIMES))
    assert figure.get_size_inches() == pytest.approx([6, 5])


def test_legends_do_not_cover_curves():
    figure = motion().plot(others=[motion(2, "another run")])
    legends = [axes.get_legend() for axes in figure.axes]  # which matplotlib 3.3 forgets as it draws
    figure.canvas.draw()
    for axes, shown in zip(figure.axes, legends):
        frame, legend = axes.get_window_extent(), shown.get_window_extent(figure.canvas.get_renderer())
        assert legend.x0 >= frame.x1 and legend.x1 <= figure.bbox.x1


def test_runs_differ_in_style_and_columns_in_colour():
    axes = motion().plot(["joint/*"], others=[motion(2, "b"), motion(3, "c")]).axes[0]
    looks = [(line.get_color(), line.get_linestyle()) for line in axes.lines]
    assert len(set(looks[:2])) == 2 and looks[0][0] == looks[2][0] == looks[4][0]
    styles = [str(line._dash_pattern if hasattr(line, "_dash_pattern") else line._us_dashSeq) for line in axes.lines]
    assert len(set(styles[::2])) == 3
    one = motion().plot(["joint/a/*"], others=[motion(2, "b"), motion(3, "c")]).axes[0]
    assert len({line.get_color() for line in one.lines}) == 3
    assert [text.get_text().strip() for text in one.get_legend().get_texts()] == ["run", "b", "c"]


def test_a_difference_says_so():
    plot = plot_of(motion(1, "d/one.csv"), motion(3, "d/two.csv"), columns=["joint/a/*"], difference=True)
    assert plot.title == "two.csv: difference to one.csv, interpolated linearly to its times"
    assert plot.panels[0].y_label == "difference of joint/a/position [rad]"
    assert plot.panels[0].curves[0].y == pytest.approx(2 * numpy.sin(TIMES))
    with pytest.raises(flexarm.ResultsError, match="expected at least two runs for a difference"):
        plot_of(motion(), difference=True)


def test_runs_of_one_name_are_told_apart_by_their_folders():
    assert plot_of(motion(1, "a/x.csv"), motion(1, "b/x.csv")).runs == ["a/x.csv", "b/x.csv"]
    assert plot_of(motion(1, "a/x.csv"), motion(1, "b/y.csv")).runs == ["x.csv", "y.csv"]


def test_spectra_have_frequencies_and_units():
    panel, = plot_of(motion(), columns=["joint/a/*"], spectrum=True, max_frequency=5).panels
    assert (panel.x_label, panel.y_label) == ("frequency [Hz]", "amplitude of joint/a/position [rad]")
    assert 4.8 < panel.curves[0].x[-1] <= 5


def test_a_column_over_another_one():
    plot = plot_of(motion(), phase=[("joint/a/*", "joint/b/*"), ("probe/p/x", "probe/p/z")])
    circle, path = plot.panels
    assert (circle.x_label, circle.y_label) == ("joint/a/position [rad]", "joint/b/position [rad]")
    assert circle.curves[0].x**2 + circle.curves[0].y**2 == pytest.approx(1)
    assert path.is_path and not circle.is_path
    assert motion().plot(phase=[("probe/p/x", "probe/p/z")]).axes[0].get_aspect() in ("equal", 1)
    with pytest.raises(flexarm.ResultsError, match="expected as many columns like 'joint/.' as like 'probe/p/x'"):
        plot_of(motion(), phase=[("joint/*", "probe/p/x")])
    with pytest.raises(flexarm.ResultsError, match="either a spectrum or a phase plot"):
        plot_of(motion(), phase=[("joint/a/*", "joint/b/*")], spectrum=True)


def test_units_of_runs_must_agree():
    csv = run_of({"time": TIMES, "joint/a/position": TIMES}, {"joint/a/position": "rad or m"}, "x.csv")
    for runs in ((csv, motion()), (motion(), csv)):
        panel, = plot_of(*runs, columns=["joint/a/position"]).panels
        assert panel.y_label == "joint/a/position [rad]" and len(panel.curves) == 2
    slider = run_of({"time": TIMES, "joint/a/position": TIMES}, {"joint/a/position": "m"})
    with pytest.raises(flexarm.ResultsError, match="the unit rad in one run and m in another one"):
        plot_of(motion(), slider, columns=["joint/a/position"])


def test_values_that_are_not_finite_leave_gaps():
    values = numpy.where((TIMES > 3) & (TIMES < 5), numpy.nan, 1 + TIMES)
    values[800] = numpy.inf
    run = run_of({"time": TIMES, "a": values})
    drawn = run.plot().axes[0]
    assert numpy.isnan(drawn.lines[0].get_ydata()[[400, 800]]).all() and drawn.get_ylim()[1] < 12
    rows = [line for line in terminal.draw(plot_of(run), 80, 24).split("\n") if "*" in line]
    columns = {i for row in rows for i, c in enumerate(row) if c == "*"}
    assert set(range(36, 38)).isdisjoint(columns) and {20, 70} <= columns
    with pytest.raises(flexarm.ResultsError, match="nothing to draw: 'a' has no finite values"):
        run_of({"time": TIMES, "a": numpy.nan * TIMES}).plot()
    with pytest.raises(flexarm.ResultsError, match="greater than 0, which a logarithmic scale needs"):
        run_of({"time": TIMES, "a": -TIMES}).plot(log="y")


def test_many_points_in_the_terminal_keep_their_extremes():
    times = numpy.linspace(0, 1, 200001)
    values = numpy.zeros(200001)
    values[77777] = 50.0
    text = terminal.draw(plot_of(run_of({"time": times, "a": values})), 80, 24)
    lines = [line for line in text.split("\n") if "*" in line]
    assert len(lines) > 15 and "50" in lines[0] + lines[1] and lines[-1].count("*") > 60, text


def test_each_curve_in_the_terminal_has_the_character_of_its_legend():
    run = run_of({"time": TIMES, **{"a%d" % i: 0 * TIMES - i for i in range(8)}})
    lines = terminal.draw(plot_of(run), 80, 40).split("\n")
    drawn = [max(set(line), key=line.count) for line in lines if any(20 * c in line for c in "*#$%@&=")]
    legend = [line.split() for line in lines if line.startswith("  ") and line[-2:-1] == "a"]
    assert legend == [[3 * character, "a%d" % i] for i, character in enumerate(drawn)] and len(legend) == 8


def test_without_a_display_no_window_is_needed(monkeypatch):
    """Check it in a process of its own, as matplotlib keeps its first backend."""
    code = ("import os, sys, flexarm, numpy; assert 'matplotlib' not in sys.modules; "
            "flexarm.Run(['time', 'a'], ['s', 'm'], numpy.eye(2)).plot().savefig(os.devnull, format='png'); "
            "import matplotlib; assert matplotlib.get_backend().lower() == 'agg'")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    for backend in ("TkAgg", "Agg"):
        monkeypatch.setenv("MPLBACKEND", backend)
        subprocess.run([sys.executable, "-c", code], check=True)


def test_the_package_does_not_import_matplotlib_to_read(files):
    code = "import sys, flexarm; flexarm.read_run(sys.argv[1]); sys.exit('matplotlib' in sys.modules)"
    subprocess.run([sys.executable, "-c", code, files[0]], check=True)
