"""Maps over any two axes, small multiples, validity: cells are the data, colours are shared, images swap families back."""

import matplotlib
import numpy as np
import pytest
import xarray as xr

matplotlib.use("Agg")

from commands import refused, run
from grids import completed, store
from matplotlib import pyplot
from matplotlib.collections import QuadMesh

from freesweep import status
from freesweep.atlas import schema
from freesweep.plot import fill, style
from freesweep.plot.plane import section
from freesweep.plot.section import multiples, section_map
from freesweep.plot.validity import WORDS, validity_map, validity_maps

ALPHA, BETA = np.arange(0.0, 81.0, 20.0), np.arange(-80.0, 81.0, 20.0)
LENGTHS, PRESSURES = [0.2, 0.1, 0.4], np.linspace(0.0, 1e5, 13)  # lengths in no order


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def data():
    """Made-up results, known at every node; degenerate on the diagonal, compressed at 100 kPa above 70 degrees."""
    a, b, l, p = np.meshgrid(ALPHA, BETA, LENGTHS, PRESSURES, indexing="ij")
    dims = ("alpha", "beta", "length", "pressure")
    why = np.where(a == b, status.DEGENERATE, status.OK)
    why = np.where((p == 1e5) & (a > 70.0) & (why == status.OK), status.COMPRESSED, why).astype(np.int8)
    value = np.where(why == status.OK, 1.0 + 1e-3 * a + 2e-3 * b + 1e-6 * p, np.nan)
    slack = np.select([a > np.abs(b), a < np.abs(b)], [1, 2], 0)
    made = xr.Dataset(
        {
            "deformed_length": (dims, l * value),
            "rotation": (dims, value * (a + b)),
            "status": (dims, why),
            "stable": (dims, np.where(p > 5e4, 0, 1).astype(np.int8)),
            "slack_fiber": (dims, slack.astype(np.int8)),
        },
        {"alpha": ALPHA, "beta": BETA, "length": LENGTHS, "pressure": PRESSURES, "radius": 5e-3, "force": 0.0},
        {"energy": "full"},
    )
    for name in made.variables:
        made[name].attrs.update(schema.attributes(name))
    return made


def mesh(ax, gid=None):
    found = [artist for artist in ax.collections if isinstance(artist, QuadMesh) and artist.get_gid() == gid]
    return found[0]


def patches(ax, gid):
    return [patch for patch in ax.patches if patch.get_gid() == gid]


def test_cells_are_the_data_over_any_two_axes(data):
    ax = section_map(data, "deformed_length", "length", "pressure", alpha=40.0, beta=-20.0)
    drawn = mesh(ax)
    stored = data["deformed_length"].sel(alpha=40.0, beta=-20.0).sortby("length")
    shown = 100.0 * (stored / stored["length"] - 1.0)  # scaled by an axis of the map
    np.testing.assert_allclose(
        drawn.get_array().filled(np.nan), shown.transpose("pressure", "length").values, rtol=1e-9
    )
    corners = drawn.get_coordinates()
    np.testing.assert_allclose(corners[0, :, 0], [100.0, 150.0, 300.0, 400.0])
    np.testing.assert_allclose([corners[0, 0, 1], corners[-1, 0, 1]], [0.0, 100.0])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("length [mm]", "pressure [kPa]")
    (words,) = [text.get_text().replace("\u00a0", " ") for text in ax.texts if text.get_gid() == "chosen"]
    assert words == "alpha 40 degree, beta -20 degree, radius 5 mm"


def test_failures_are_hatched_in_shown_units(data):
    ax = section_map(data, "rotation", "pressure", "alpha", beta=-20.0, length=0.2)
    (patch,) = patches(ax, f"reason {status.COMPRESSED}")
    path = patch.get_path()
    assert path.contains_point((98.0, 78.0))
    assert not path.contains_point((50.0, 78.0))
    assert not patches(ax, f"reason {status.DEGENERATE}")


def test_slack_fibers_are_hatched_over_any_two_axes(data):
    """The alpha family where alpha is the larger in size, the beta family where it is the smaller; at 20 degrees neither."""
    ax = section_map(data, "rotation", "pressure", "alpha", beta=-20.0, length=0.2)
    (patch,) = patches(ax, "slack")
    inside = [patch.get_path().contains_point((50.0, alpha)) for alpha in (2.0, 20.0, 39.0, 78.0)]
    assert inside == [True, False, True, True]
    assert "fibers would have to push" in [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert not patches(section_map(data, "rotation", "pressure", "alpha", beta=-20.0, slack=False), "slack")
    figure = multiples(data, "rotation", over="pressure")
    assert sum(len(patches(ax, "slack")) for ax in figure.axes) == 4


def test_degenerate_designs_say_why(data):
    ax = section_map(data, "rotation", pressure=0.0, length=0.2)
    assert "degenerate: fibers of one angle" in [text.get_text() for text in ax.figure.legends[0].get_texts()]


def test_small_multiples_share_colours(data):
    figure = multiples(data, "rotation", over=("pressure", "length"))
    axes = [ax for ax in figure.axes if any(isinstance(artist, QuadMesh) for artist in ax.collections)]
    maps = [ax for ax in axes if ax.get_gid() is None and ax.lines]
    assert len(maps) == 4 * 3
    norms = {tuple(mesh(ax).norm.boundaries) for ax in maps}
    assert len(norms) == 1
    pressures = PRESSURES[np.linspace(0, 12, 5).round().astype(int)][1:]  # without pressure there is nothing to see
    for k, ax in enumerate(maps):
        length, pressure = LENGTHS[k // 4], pressures[k % 4]
        stored = data["rotation"].sel(pressure=pressure, length=length).transpose("beta", "alpha").values
        np.testing.assert_allclose(mesh(ax).get_array().filled(np.nan), stored)
    assert [ax.get_title("left").replace("\u00a0", " ") for ax in maps[:4]] == [
        f"pressure {1e-3 * pressure:.4g} kPa" for pressure in pressures
    ]
    assert len(multiples(data, "rotation", "pressure", "alpha", over="length").axes) == 3 + 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"x": "pressure", "y": "pressure"}, "two different axes"),
        ({"x": "radius", "y": "alpha"}, "no axis of rotation with two nodes or more 'radius'"),
        ({"variable": "volume", "x": "pressure"}, "no variable 'volume'"),
        ({"x": "pressure", "wall": 1.0}, "no dimension 'wall'"),
    ],
)
def test_wrong_names(data, arguments, message):
    with pytest.raises(ValueError, match=message):
        section_map(data, **arguments)


def test_multiples_need_other_axes(data):
    with pytest.raises(ValueError, match="one or two axes other than alpha and beta"):
        multiples(data, over="alpha")
    with pytest.raises(ValueError, match="no axis to run over 'radius'"):
        multiples(data, over="radius")


def test_validity_shows_slack_families_and_swaps_images_back(data):
    """Half of the plane is stored; at the other half the families have changed places."""
    half = data.sel(beta=slice(-80.0, 0.0))
    for stored in (data, half):
        ax, keys, sheet = validity_map(stored, length=0.2, pressure=0.0)
        kind = mesh(ax, "kind").get_array()
        alpha, beta = np.meshgrid(sheet.x, sheet.y)
        expected = np.select([np.abs(alpha) > np.abs(beta), np.abs(alpha) < np.abs(beta)], [1, 2], 0)
        there = ~np.ma.getmaskarray(kind)
        assert there.sum() > 20
        np.testing.assert_array_equal(kind.filled(-1)[there], expected[there])
        assert WORDS["bonded"][1] in keys
        _, keys, _ = validity_map(stored.assign_attrs(fibers="loose"), length=0.2, pressure=0.0)
        assert WORDS["loose"][1] in keys
        assert "unstable" not in keys
    swapped = data.rename(alpha="beta", beta="alpha").sel(beta=slice(0.0, 80.0))  # only images are seen
    swapped["slack_fiber"] = swapped["slack_fiber"].copy(data=np.array([0, 2, 1, 3])[swapped["slack_fiber"].values])
    ax, _, sheet = validity_map(swapped.sel(alpha=slice(-80.0, -20.0)), length=0.2, pressure=0.0)
    kind = mesh(ax, "kind").get_array()
    alpha, beta = np.meshgrid(sheet.x, sheet.y)
    there = ~np.ma.getmaskarray(kind) & (np.abs(alpha) != np.abs(beta))
    assert there.sum() > 8
    np.testing.assert_array_equal(kind.filled(-1)[there], np.where(np.abs(alpha) > np.abs(beta), 1, 2)[there])


def test_validity_marks_unstable_and_failed(data):
    ax, keys, _ = validity_map(data, x="pressure", y="alpha", beta=-20.0, length=0.2)
    (patch,) = patches(ax, "unstable")
    assert patch.get_path().contains_point((80.0, 40.0))
    assert not patch.get_path().contains_point((20.0, 40.0))
    assert {"unstable", "meridional compression"} <= set(keys)
    figure = validity_maps([data, data.assign_attrs(energy="principal")], length=0.2)
    assert [ax.get_title("left") for ax in figure.axes] == ["strain energy: full", "strain energy: principal"]
    with pytest.raises(ValueError, match="no state 'blocked_force'"):
        validity_map(data, "blocked_force")


def test_commands(data, tmp_path, capsys):
    atlas = tmp_path / "made.nc"
    store(completed(data), atlas)
    for words in (
        ["map", "--axes", "pressure", "alpha", "--at", "beta=-20 deg"],
        ["map", "--over", "length", "--at", "pressure=50 kPa"],
        ["validity", str(atlas), "--axes", "pressure", "alpha"],
    ):
        out = tmp_path / f"{words[0]}{len(words)}.png"
        assert run("plot", words[0], str(atlas), *words[1:], "-o", str(out)) == 0
        assert out.stat().st_size > 10_000
    capsys.readouterr()
    assert "no axis of rotation" in refused(capsys, "plot", "map", str(atlas), "--axes", "wall", "alpha")
    assert "no state 'blocked_force'" in refused(capsys, "plot", "validity", str(atlas), "--of", "blocked_force")


def test_every_small_multiple_shows_something(data):
    """One of the pressures turns the tubes a hundredth as far: equal steps left its map a single colour."""
    faint = data.assign(rotation=data["rotation"] * xr.where(data["pressure"] < PRESSURES[4], 0.01, 1.0))
    faint["rotation"].attrs = data["rotation"].attrs
    figure = multiples(faint, "rotation", over="pressure")
    maps = [ax for ax in figure.axes if ax.lines and any(isinstance(one, QuadMesh) for one in ax.collections)]
    norm = mesh(maps[0]).norm
    assert np.all(np.diff(norm.boundaries) > 0.0)
    for ax in maps:
        assert len(set(np.asarray(norm(mesh(ax).get_array().compressed())).tolist())) >= 3


def test_the_line_of_equal_angles_makes_no_stairs(data):
    strip = fill.seam(section(data, "rotation", "alpha", "beta", {"pressure": 1e5, "length": 0.2}))
    count = len(strip) // 2
    for edge in (strip[:count], strip[count:]):
        inner = edge[np.abs(edge[:, 1]) < 80.0][1:-1]
        assert len(set(np.round(inner[:, 1] - inner[:, 0], 6))) == 1  # parallel to beta = alpha


def test_own_styles_pass_through(data):
    own = {"font.family": ["DejaVu Sans"], "font.size": 16.0, "axes.labelcolor": "#ff0000"}
    with matplotlib.rc_context(own):
        ax = section_map(data, "rotation", "pressure", "alpha", beta=-20.0, length=0.2)
    assert ax.xaxis.label.get_fontfamily() == ["DejaVu Sans"]
    assert ax.xaxis.label.get_color() == "#ff0000"
    (chosen,) = [text for text in ax.texts if text.get_gid() == "chosen"]
    assert chosen.get_fontfamily() == ["DejaVu Sans"]
    assert chosen.get_fontsize() == 2.0 * style.SMALL
    plain = section_map(data, "rotation", "pressure", "alpha", beta=-20.0, length=0.2)
    assert plain.xaxis.label.get_fontfamily() == ["STIXGeneral"]


def test_values_of_one_sign_far_from_zero_have_steps_of_their_own_in_the_hue_of_their_sign():
    """60 to 72 degrees: steps from zero on would leave two colours, in the same one."""
    values = np.linspace(60.0, 72.0, 50)
    for sign in (1.0, -1.0):
        shade = fill.shades(sign * values, 0.0)
        assert np.count_nonzero((sign * shade.levels > 60.0) & (sign * shade.levels < 72.0)) >= 8
        rgb = np.array(
            [shade.colours(k) for k in range(shade.colours.N)] + [*map(shade.colours, (-1, shade.colours.N))]
        )
        warmer = rgb[:, 0] - rgb[:, 2]
        assert np.all(warmer > 0.0) or np.all(warmer < 0.0)
