"""Curves draw the data: values in shown units, bounds as bands, flags as marks; labels do not cover each other."""

import matplotlib
import numpy as np
import pytest
import xarray as xr

matplotlib.use("Agg")

from commands import refused, run
from grids import completed, store
from matplotlib import pyplot
from matplotlib.colors import to_rgb

from freesweep import example_atlas, status
from freesweep.atlas import schema
from freesweep.plot import style
from freesweep.plot.curve import MOST, curve, spread

ANGLES, PRESSURES = np.linspace(10.0, 80.0, 8), np.linspace(0.0, 2e5, 11)


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def data():
    """A made-up tube of 100 mm whose numbers are known at every node; 80 degrees fails beyond 100 kPa."""
    a, p = np.meshgrid(ANGLES, PRESSURES, indexing="ij")
    dims = ("alpha", "pressure")
    code = np.where((a == 80.0) & (p > 1e5), status.BEYOND_LIMIT, status.OK).astype(np.int8)
    length = np.where(code == status.OK, 0.1 - 1e-4 * a - 1e-7 * p, np.nan)
    made = xr.Dataset(
        {
            "deformed_length": (dims, length),
            "deformed_length_error": (dims, np.full(a.shape, 2e-4)),
            "rotation": (dims, np.where(code == status.OK, a * p * 1e-5, np.nan)),
            "status": (dims, code),
            "slack_fiber": (dims, np.where((a == 20.0) & (p < 9e4), 2, 0).astype(np.int8)),
            "stable": (dims, np.where((a == 30.0) & (p > 1.5e5), 0, 1).astype(np.int8)),
        },
        {"alpha": ANGLES, "pressure": PRESSURES, "beta": -30.0, "length": 0.1, "force": 0.0},
    )
    for name in made.variables:
        made[name].attrs.update(schema.attributes(name))
    return made


def lines(ax, gid="deformed_length"):
    return [line for line in ax.lines if line.get_gid() == gid]


def test_one_line_for_each_node_in_shown_units(data):
    ax = curve(data, each="alpha")
    drawn = lines(ax)
    assert len(drawn) == len(ANGLES)
    for line, values in zip(drawn, data["deformed_length"].values):
        np.testing.assert_allclose(line.get_xdata(), PRESSURES * 1e-3)
        np.testing.assert_allclose(line.get_ydata(), values * 1e3)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("pressure [kPa]", "length [mm]")
    assert {text.get_text() for text in ax.texts if text.get_gid() == "end"} == {f"{angle:g}" for angle in ANGLES}


def test_the_bound_is_a_band(data):
    ax = curve(data, alpha=50.0)
    (band,) = [artist for artist in ax.collections if artist.get_gid() == "error"]
    values = data["deformed_length"].sel(alpha=50.0).values * 1e3
    vertices = band.get_paths()[0].vertices
    for x, y in zip(PRESSURES * 1e-3, values):
        here = vertices[np.isclose(vertices[:, 0], x), 1]
        np.testing.assert_allclose([here.min(), here.max()], [y - 0.2, y + 0.2])


def test_chosen_nodes_are_named_and_lines_end_where_there_is_no_result(data):
    with pytest.warns(UserWarning, match="alpha 80 degree for alpha 77 degree"):
        ax = curve(data, "rotation", along="pressure", alpha=77.0)
    (line,) = lines(ax, "rotation")
    np.testing.assert_array_equal(np.isfinite(line.get_ydata()), PRESSURES <= 1e5)
    (words,) = [text.get_text() for text in ax.texts if text.get_gid() == "chosen"]
    assert words.replace("\u00a0", " ").startswith(
        "alpha 80 degree (nearest to 77 degree), beta -30 degree, length 100 mm"
    )
    assert ax.get_ylabel() == "rotation of the free end [degree]"
    assert words.replace("\n", " ").replace("\u00a0", " ").endswith("no result: beyond limit pressure")


@pytest.mark.parametrize(("width", "each"), [(45.0, None), (55.0, None), (55.0, "alpha"), (70.0, "alpha")])
def test_words_below_the_heading_are_as_wide_as_narrow_axes(width, each):
    """They end before the figure does, and before the name of what lines differ in."""
    ax = curve(example_atlas().data, "rotation", each=each, ax=style.new_axes(width, width), beta=-60)
    ax.figure.draw_without_rendering()
    boxes = {text.get_gid(): text.get_window_extent() for text in ax.texts}
    assert boxes["chosen"].x1 < (boxes["each"].x0 if each else ax.figure.bbox.x1)


def test_slack_parts_are_thin_and_unstable_nodes_are_circles(data):
    ax = curve(data, alpha=20.0)
    (firm,) = lines(ax, "firm")
    np.testing.assert_array_equal(np.isfinite(firm.get_ydata()), PRESSURES >= 8e4)  # up to the last thin node
    assert firm.get_linewidth() > lines(ax)[0].get_linewidth()
    ax = curve(data, alpha=30.0)
    (circles,) = lines(ax, "unstable")
    np.testing.assert_allclose(circles.get_xdata(), PRESSURES[PRESSURES > 1.5e5] * 1e-3)
    words = [text.get_text().replace("\n", " ") for text in ax.texts if text.get_gid() == "chosen"]
    assert "open circles: unstable" in words[0]


def test_type_is_dark_enough_to_read():
    for colour in (*style.SERIES, *style.ramp(9)):
        rgb = np.array(to_rgb(style.legible(colour)))
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        assert 1.05 / (linear @ [0.2126, 0.7152, 0.0722] + 0.05) > 3.5  # contrast to white
    assert style.legible(style.INK) == style.INK


def test_many_nodes_give_a_few_lines_first_and_last_among_them(data):
    fine = data.interp(alpha=np.linspace(10.0, 70.0, 50), kwargs={"fill_value": None}).assign(
        status=xr.zeros_like(data["status"].isel(alpha=0)), slack_fiber=xr.zeros_like(data["status"].isel(alpha=0))
    )
    ax = curve(fine, "rotation", each="alpha")
    drawn = lines(ax, "rotation")
    assert len(drawn) == MOST
    np.testing.assert_allclose([drawn[0].get_ydata()[-1], drawn[-1].get_ydata()[-1]], [20.0, 140.0])


def test_labels_keep_their_distance_and_their_order():
    places = spread(np.array([0.0, 0.1, 0.15, 5.0, 5.2]), 1.0)
    assert np.all(np.diff(places) >= 1.0 - 1e-9)
    np.testing.assert_allclose(places[:3].mean(), np.mean([0.0, 0.1, 0.15]))
    np.testing.assert_array_equal(spread(np.array([0.0, 2.0]), 1.0), [0.0, 2.0])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"variable": "lenght"}, "no variable 'lenght'"),
        ({"along": "radius"}, "no numeric dimension of deformed_length 'radius'"),
        ({"each": "pressure"}, "no further dimension of deformed_length 'pressure'.*available: alpha"),
        ({"alpha": "ten"}, "alpha: expects an angle"),
        ({"wall": 1e-3}, "no dimension 'wall'"),
    ],
)
def test_wrong_names_and_values(data, arguments, message):
    with pytest.raises(ValueError, match=message):
        curve(data, **arguments)


def test_named_designs_are_told_apart_by_name():
    made = xr.Dataset(
        {"rotation": (("design", "pressure"), [[0.0, 1.0], [0.0, 2.0]]),
         "status": (("design", "pressure"), np.zeros((2, 2), np.int8))},
        {"design": ["A", "B"], "pressure": [0.0, 1e5], "length": ("design", [0.1, 0.2])},
    )  # fmt: skip
    ax = curve(made, "rotation", each="design")
    assert [text.get_text() for text in ax.texts if text.get_gid() == "end"] == ["A", "B"]
    assert len({line.get_color() for line in lines(ax, "rotation")}) == 2
    (line,) = lines(curve(made, "rotation", design="B"), "rotation")
    assert line.get_ydata().tolist() == [0.0, 2.0]
    with pytest.raises(ValueError, match="no design 'C'"):
        curve(made, "rotation", design="C")


def test_command(data, tmp_path, capsys):
    atlas, out = tmp_path / "made.nc", tmp_path / "curve.svg"
    store(completed(data), atlas)
    assert run("plot", "curve", str(atlas), "--each", "alpha", "-o", str(out)) == 0
    assert capsys.readouterr().out == f"{out}\n"
    first = out.read_bytes()
    assert run("plot", "curve", str(atlas), "--each", "alpha", "-o", str(out)) == 0
    assert out.read_bytes() == first
    capsys.readouterr()
    assert "NAME=VALUE" in refused(capsys, "plot", "curve", str(atlas), "--at", "alpha", "-o", str(out))
    assert "an angle" in refused(capsys, "plot", "curve", str(atlas), "--at", "alpha=3 mm", "-o", str(out))
    # a second --at adds to the first
    assert "an angle" in refused(capsys, "plot", "curve", str(atlas), "--at", "alpha=3 mm", "--at", "alpha=20")
    assert "must be one of .png" in refused(capsys, "plot", "curve", str(atlas), "-o", "curve.bmp")
    assert "no freesweep atlas" in refused(capsys, "plot", "curve", _foreign(tmp_path))


def test_what_the_shell_keeps_of_one_actuator_becomes_a_curve(tmp_path, capsys, monkeypatch):
    """The force that holds a length, unless another variable is named; one state alone is none."""
    monkeypatch.chdir(tmp_path)
    tube = (
        "--alpha",
        "30",
        "--beta",
        "-30",
        "--length",
        "192 mm",
        "--radius",
        "4.76 mm",
        "--wall",
        "1 mm",
        "--c10",
        "0.1 MPa",
    )
    pressures = ("--pressure", "50 kPa", "100 kPa")
    assert run("block", "--hold", "length", *tube, *pressures, "-o", "kept.nc") == 0
    assert run("plot", "curve", "kept.nc") == 0
    assert capsys.readouterr().out.endswith("kept-force.png\n")
    assert run("inflate", *tube, *pressures[:2], "-o", "one.nc") == 0
    capsys.readouterr()
    assert "a single state here; a curve needs several" in refused(capsys, "plot", "curve", "one.nc")


def test_a_variable_without_any_value_says_so_on_axes_of_its_range():
    with example_atlas() as atlas:
        ax = curve(atlas.data, "limit_pressure", along="alpha", beta=-40.0)
    assert ax.get_xlim() == (0.0, 80.0)
    (words,) = [text.get_text() for text in ax.texts if text.get_gid() == "chosen"]
    assert words.replace("\n", " ").endswith("no line: no limit up to the largest pressure")


def _foreign(tmp_path):
    path = tmp_path / "foreign.nc"
    xr.Dataset({"t": 1.0}).to_netcdf(path, engine="netcdf4")
    return str(path)


def test_what_pyplot_sets_when_it_is_first_imported_within_a_plot_stays():
    """In a notebook that is `interactive`: taken back, later plots of others would not be seen."""
    before, font = matplotlib.is_interactive(), matplotlib.rcParams["font.family"]
    with style.context():
        matplotlib.interactive(not before)
        assert matplotlib.rcParams["font.family"] == ["STIXGeneral"]
    after = matplotlib.is_interactive()
    matplotlib.interactive(before)
    assert after is not before
    assert matplotlib.rcParams["font.family"] == font


def test_long_names_fit_the_axes_of_xarray():
    """It breaks them after 30 characters, the unit among them; what else is to say stands in a comment."""
    for name in (*schema.PARAMETERS, *schema.VARIABLES, *schema.PROFILES, "x"):
        about = schema.attributes(name)
        units = about["units"].replace("1", "")
        assert len(f"{about['long_name']} [{units}]" if units else about["long_name"]) <= 30, name
    assert "positive in tension" in schema.attributes("force")["comment"]
