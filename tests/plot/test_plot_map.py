"""The map of the design space draws the data: values in shown units, failures where the status says so, exact lines."""

import subprocess
import sys

import matplotlib
import numpy as np
import pytest
import xarray as xr

matplotlib.use("Agg")

from matplotlib import pyplot
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.text import Text

from freesweep import closed_form, example_atlas, status
from freesweep.atlas import schema
from freesweep.plot import display, plane, regions, style
from freesweep.plot.map import design_map
from freesweep.plot.section import section_map
from freesweep.plot.slack import flag
from freesweep.plot.validity import validity_map

LENGTHS, RADII, PRESSURES = [0.1, 0.15, 0.2], [4e-3, 5e-3], [2e4, 1e5]
BEYOND = (slice(10, 13), slice(22, 26))  # of alpha, beta
COMPRESSED = (slice(2, 5), slice(8, 12))


def atlas(step=5.0, alpha_from=0.0, beta_from=-85.0):
    """A uniform tube locked half way at the largest pressure, with two patches of failures."""
    alpha, beta = np.arange(alpha_from, 85.1, step), np.arange(beta_from, 85.1, step)
    a, b = np.meshgrid(alpha, beta, indexing="ij")
    locked = closed_form.locked_stretch(a, b)
    stretch = 1.0 + (locked - 1.0)[..., None] * (np.array(PRESSURES) / 2e5)
    axial, twist = closed_form.uniform_state(a[..., None], b[..., None], stretch)[:2]
    why = np.where(np.isnan(stretch), status.DEGENERATE, status.OK).astype(np.int8)
    if step == 5.0:
        why[BEYOND][..., -1], why[COMPRESSED] = status.BEYOND_LIMIT, status.COMPRESSED
    dims = ("alpha", "beta", "length", "radius", "pressure")
    shape = (alpha.size, beta.size, len(LENGTHS), len(RADII), len(PRESSURES))
    length, radius = np.array(LENGTHS)[:, None, None], np.array(RADII)[:, None]
    why = np.broadcast_to(why[:, :, None, None, :], shape)
    names = {
        "deformed_length": axial[:, :, None, None, :] * length,
        "rotation": np.degrees(twist[:, :, None, None, :] * length / radius),
        "mid_radius": stretch[:, :, None, None, :] * radius,
        "volume": (stretch**2 * axial)[:, :, None, None, :] * np.pi * radius**2 * length,
    }
    data = {name: (dims, np.where(np.isin(why, status.VALUED), value, np.nan)) for name, value in names.items()}
    limit = np.where(why[..., -1] == status.BEYOND_LIMIT, 6e4, np.nan)
    torque = closed_form.blocked_torque(a[..., None, None], b[..., None, None], radius, np.array(PRESSURES))
    torque_why = np.where(np.isnan(torque), status.HELD_IMPOSSIBLE, status.OK).astype(np.int8)
    data |= {
        "status": (dims, why),
        "limit_pressure": (dims[:4], limit),
        "ideal_blocked_torque": (("alpha", "beta", "radius", "pressure"), torque),
        "ideal_blocked_torque_status": (("alpha", "beta", "radius", "pressure"), torque_why),
        "blocked_torque": (("alpha", "beta", "radius", "pressure"), 0.9 * torque),
        "blocked_torque_status": (("alpha", "beta", "radius", "pressure"), torque_why),
    }
    coords = {"alpha": alpha, "beta": beta, "length": LENGTHS, "radius": RADII, "pressure": PRESSURES, "torque": 0.0}
    dataset = xr.Dataset(data, coords)
    for name in dataset.variables:
        dataset[name].attrs.update(schema.attributes(name))
    return dataset


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def whole():
    return atlas()


def mesh_of(ax):
    (mesh,) = [artist for artist in ax.collections if isinstance(artist, QuadMesh)]
    return mesh.get_array()


def drawn(ax, gid):
    return [artist for artist in ax.get_children() if artist.get_gid() == gid]


SHOWN = {
    "rotation": lambda value: value,
    "deformed_length": lambda value: 100.0 * (value / 0.15 - 1.0),
    "mid_radius": lambda value: value / 5e-3,
    "volume": lambda value: 1e6 * value,
}


@pytest.mark.parametrize("variable", SHOWN)
def test_mesh_is_the_data_in_shown_units(whole, variable):
    ax = design_map(whole, variable, paths=False, examples=False)
    stored = whole[variable].sel(length=0.15, radius=5e-3, pressure=1e5).transpose("beta", "alpha").values
    np.testing.assert_allclose(mesh_of(ax).filled(np.nan), SHOWN[variable](stored), rtol=1e-12)


def test_nearest_grid_values_are_taken_and_named(whole):
    says = "nearest values that the file holds: length 200 mm for length 190 mm, radius 5 mm for radius 1000 mm, pressure 20"
    with pytest.warns(UserWarning, match=says):
        ax = design_map(whole, "rotation", paths=False, examples=False, length=0.19, radius=1.0, pressure=3e4)
    stored = whole["rotation"].sel(length=0.2, radius=5e-3, pressure=2e4).transpose("beta", "alpha").values
    np.testing.assert_array_equal(mesh_of(ax).filled(np.nan), stored)
    words = "length 200 mm (nearest to 190 mm), radius 5 mm (nearest to 1000 mm), pressure 20 kPa (nearest to 30 kPa)"
    assert drawn(ax, "chosen")[0].get_text().replace("\u00a0", " ").replace("\n", " ") == words
    assert ax.get_title(loc="left") == "Rotation of the free end under pressure"


@pytest.mark.parametrize("draw", [design_map, section_map, validity_map])
def test_what_was_missed_is_said_once(draw):
    """Of values, of hatches and of flags at once."""
    with (
        example_atlas() as atlas,
        pytest.warns(UserWarning, match="nearest values .* length 200 mm for length 1000") as told,
    ):
        draw(atlas.data, length="1 m")
    assert len(told) == 1


def test_locked_manifold_and_lines(whole):
    ax = design_map(whole)
    alpha, beta = drawn(ax, "LM")[0].get_data()
    inner = slice(1, -1)  # the ends are the poles 0 and 90 degrees
    product = np.tan(np.radians(alpha[inner])) * np.tan(np.radians(beta[inner]))
    np.testing.assert_allclose(product, -2.0, rtol=1e-10)
    np.testing.assert_allclose([alpha[0], beta[0], alpha[-1], beta[-1]], [0.0, -90.0, 90.0, 0.0], atol=1e-12)
    assert set(closed_form.region(*drawn(ax, "AF")[0].get_data())) <= {"AF", "DF"}
    assert set(closed_form.region(*drawn(ax, "DF")[0].get_data())) == {"DF"}
    assert ax.get_xlim() == (0.0, 90.0)
    assert ax.get_ylim() == (-90.0, 90.0)


def test_names_stand_in_their_regions():
    for name, alpha, beta in regions.NAMES:
        assert closed_form.region(alpha, beta) == name.strip("()")
        assert (abs(beta) > alpha) == name.startswith("(")


def test_labels_stay_dark_over_light_maps_whatever_the_style(whole):
    with pyplot.style.context("dark_background"):
        texts = design_map(whole).texts
    names = [text for text in texts if text.get_text() in ("I", "IIa", "IIb")]
    assert len(names) == 3
    assert all(sum(to_rgb(text.get_color())) < 1.0 for text in names)


def test_paths_start_at_designs_and_end_locked(whole):
    paths = drawn(design_map(whole), "path")
    assert len(paths) == len(regions.STARTS)
    for line, start in zip(paths, regions.STARTS, strict=True):
        alpha, beta = line.get_data()
        np.testing.assert_allclose([alpha[0], beta[0]], start, atol=1e-9)
        np.testing.assert_allclose(np.tan(np.radians(alpha[-1])) * np.tan(np.radians(beta[-1])), -2.0, rtol=1e-9)
        assert np.all((alpha >= 0.0) & (alpha <= 90.0) & (np.abs(beta) <= 90.0))
    assert not drawn(design_map(whole, paths=False), "path")


@pytest.mark.parametrize("reason", [status.DEGENERATE, status.BEYOND_LIMIT, status.COMPRESSED])
def test_hatched_just_where_the_status_says_so(whole, reason):
    ax = design_map(whole, "rotation", paths=False, examples=False)
    (patch,) = drawn(ax, f"reason {reason}")
    why = whole["status"].isel(length=0, radius=0, pressure=-1).transpose("beta", "alpha").values
    alpha, beta = np.meshgrid(whole["alpha"], whole["beta"])
    inward = np.stack([np.clip(alpha, 0.1, 84.9), np.clip(beta, -84.9, 84.9)], axis=-1).reshape(-1, 2)
    np.testing.assert_array_equal(patch.get_path().contains_points(inward).reshape(why.shape), why == reason)
    assert patch.get_hatch()
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    words = status.STATUSES[reason].meaning.replace("_", " ")
    assert any(label.startswith(words) for label in labels)


def test_contours_keep_off_failed_nodes(whole):
    ax = design_map(whole, "rotation", paths=False, examples=False)
    contours = [artist for artist in ax.collections if isinstance(artist, ContourSet)]
    assert contours
    failed = np.argwhere(whole["status"].isel(length=0, radius=0, pressure=-1).values != status.OK)
    points = np.stack([whole["alpha"].values[failed[:, 0]], whole["beta"].values[failed[:, 1]]], axis=1)
    for path in (path for artist in contours for path in artist.get_paths() if len(path.vertices)):
        assert not path.contains_points(points, radius=-1e-6).any()


@pytest.mark.parametrize(("step", "contours"), [(10.0, True), (15.0, False)])
def test_coarse_grids_are_drawn_node_by_node(step, contours):
    ax = design_map(atlas(step=step, alpha_from=5.0), "rotation", paths=False, examples=False)
    assert any(isinstance(artist, ContourSet) for artist in ax.collections) == contours


def test_colours_are_centred_at_zero(whole):
    mesh = next(a for a in design_map(whole, "deformed_length").collections if isinstance(a, QuadMesh))
    levels, colours = mesh.norm.boundaries, mesh.cmap
    assert np.isclose(levels, 0.0, atol=1e-12).any()
    step = levels[1] - levels[0]
    around = np.array([colours(mesh.norm(0.5 * side * step))[:3] for side in (-1, 1)])
    np.testing.assert_allclose(np.array(style.DIVERGING(0.5)[:3]) - around, 0.0, atol=0.12)


@pytest.mark.parametrize("value", [0.0, 1e-300, -3.0, 4.0, np.nan])
@pytest.mark.parametrize("variable", ["rotation", "volume"])
def test_maps_of_one_value_or_none(whole, variable, value):
    flat = whole.assign({variable: whole[variable] * 0.0 + value})
    ax = design_map(flat, variable, paths=False, examples=False)
    np.testing.assert_allclose(mesh_of(ax).compressed(), display.display(variable).convert(value, {}))
    assert ("no value" in [text.get_text() for text in ax.get_legend().get_texts()]) == np.isnan(value)


def test_limit_pressure_tells_none_from_failed(whole):
    ax = design_map(whole, "limit_pressure", paths=False, examples=False)
    values = mesh_of(ax)
    np.testing.assert_allclose(values.compressed(), 60.0)
    expected = whole["status"].isel(length=0, radius=0, pressure=-1).transpose("beta", "alpha").values
    np.testing.assert_array_equal(~np.ma.getmaskarray(values), expected == status.BEYOND_LIMIT)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "no limit up to pressure\u00a0100\u00a0kPa" in labels
    assert "beyond limit pressure" not in labels
    assert "meridional compression" in labels


@pytest.mark.parametrize("variable", ["rotation", "volume", "ideal_blocked_torque", "blocked_torque"])
@pytest.mark.parametrize("stored", ["alpha<=0", "beta<=0 both signs of alpha", "swapped"])
def test_symmetry_completes_the_two_quadrants(variable, stored):
    full = atlas(step=10.0, alpha_from=-85.0)
    part = {
        "alpha<=0": full.sel(alpha=slice(-85.0, 0.0)),
        "beta<=0 both signs of alpha": full.sel(beta=slice(-85.0, 0.0)),
        "swapped": full.sel(beta=slice(0.0, 85.0)),
    }[stored]
    want, got = plane.plane(full, variable, {}), plane.plane(part, variable, {})
    np.testing.assert_array_equal(got.x, want.x)
    np.testing.assert_array_equal(got.y, want.y)
    np.testing.assert_array_equal(got.reason, want.reason)
    np.testing.assert_allclose(got.values.filled(np.nan), want.values.filled(np.nan), rtol=1e-9, atol=1e-12)


def test_what_symmetry_cannot_give_stays_outside(whole):
    part = plane.plane(whole.sel(beta=slice(-85.0, 0.0)), "rotation", {})
    assert np.all(part.reason[np.ix_(part.y > 0.0, part.x > 0.0)] == status.OUTSIDE)
    pulled = whole.assign_coords(torque=0.1)  # the mirror of an applied torque is another design
    mirrored = pulled.assign_coords(alpha=-whole["alpha"].values).sel(beta=slice(-85.0, 0.0))
    with pytest.raises(ValueError, match="fewer than two nodes"):
        plane.plane(mirrored, "volume", {})
    assert plane.plane(mirrored.assign_coords(torque=0.0), "volume", {}).values.count() > 0


def test_axes_in_axes_out(whole):
    figure = Figure(layout="constrained")
    ax = figure.add_subplot()
    before = dict(matplotlib.rcParams)
    assert design_map(whole, "volume", ax=ax) is ax
    assert dict(matplotlib.rcParams) == before
    assert not pyplot.get_fignums()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"variable": "rotaton"}, "did you mean 'rotation'.*available: .*volume"),
        ({"variable": "locked_rotation"}, "no variable 'locked_rotation'"),
        ({"lenght": 0.1}, "no dimension 'lenght'; did you mean 'length'.*pressure"),
        ({"alpha": 30.0}, "no dimension 'alpha'"),
        ({"length": "10 kPa"}, "length: expects a length"),
        ({"pressure": np.nan}, r"pressure must be one finite number \[Pa\]"),
    ],
)
def test_wrong_names_and_values(whole, arguments, message):
    with pytest.raises(ValueError, match=message):
        design_map(whole, **arguments)


def test_a_dataset_without_a_plane(whole):
    with pytest.raises(ValueError, match=r"beta is not \(dimensions: alpha \(18\)"):
        design_map(whole.isel(beta=3))
    with pytest.raises(ValueError, match="no status variable 'status'"):
        design_map(whole.drop_vars("status"))


@pytest.mark.parametrize("suffix", style.SUFFIXES)
def test_save(whole, tmp_path, suffix):
    ax = design_map(whole.isel(alpha=slice(0, 4), beta=slice(0, 4)), examples=False)
    path = style.save(ax, tmp_path / f"map{suffix}")
    start = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[suffix]
    assert path.read_bytes().startswith(start)
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


def test_save_refuses_other_suffixes(tmp_path):
    with pytest.raises(ValueError, match=r"'map\.bmp'.*\.png, \.svg, \.pdf"):
        style.save(Figure(), tmp_path / "map.bmp")
    assert not list(tmp_path.iterdir())


def test_colour_maps_keep_their_order_in_grey():
    def grey(colours):
        return np.array([to_rgb(colour) for colour in colours]) @ [0.2126, 0.7152, 0.0722]

    half = np.linspace(0.0, 0.5, 100)
    assert np.all(np.diff(grey(style.DIVERGING(half))) >= 0.0)
    assert np.all(np.diff(grey(style.DIVERGING(1.0 - half))) >= 0.0)
    assert np.all(np.diff(grey(style.SEQUENTIAL(2.0 * half))) <= 0.0)


def test_every_variable_can_be_shown():
    for name in schema.VARIABLES:
        assert display.title(name)
        assert display.display(name).axis_label


def test_no_solver_is_loaded():
    code = "import sys, freesweep.plot.map; sys.exit(bool({'freesweep.solver', 'numba'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_what_is_chosen_is_read_with_its_unit(whole):
    """As everywhere in Python: texts, and a fault by its name."""
    plain, text = (design_map(whole, length=value, paths=False, examples=False) for value in (0.2, "200 mm"))
    assert np.array_equal(mesh_of(plain).filled(0.0), mesh_of(text).filled(0.0))


@pytest.mark.parametrize(("fibers", "words"), [("bonded", "would have to push"), ("loose", "slack")])
def test_states_whose_fibers_are_slack_are_hatched_and_named(fibers, words):
    data = atlas()
    data = data.assign(slack_fiber=xr.where(data["beta"] > 0.0, 1, 0) + 0 * data["status"].astype(np.int8))
    ax = design_map(data.assign_attrs(fibers=fibers))
    (patch,) = (each for each in ax.patches if each.get_gid() == "slack")
    assert patch.get_path().vertices[:, 1].min() >= 0.0  # cells of positive beta only, and their images
    assert any(words in text.get_text() for text in ax.get_legend().get_texts())
    for other in ("limit_pressure", "blocked_torque"):
        assert not [each for each in design_map(data, other).patches if each.get_gid() == "slack"]
    assert not [each for each in design_map(data, slack=False).patches if each.get_gid() == "slack"]
    pyplot.close("all")


def test_where_the_families_change_places_a_slack_share_is_the_other_family_s():
    """Quadrants that the atlas does not hold: by exchange the one below the diagonal, by the mirror the rest."""
    data = atlas(alpha_from=30.0, beta_from=-20.0)
    shares = {"slack_alpha": 0.01 * (data["alpha"] - 30.0), "slack_beta": 0.5 + 0.004 * (data["beta"] + 20.0)}
    data = data.assign({name: share + 0.0 * data["rotation"] for name, share in shares.items()})
    data = data.assign(
        {f"{name}_error": 0.0 * data[name] for name in shares} | {"slack_fiber": xr.ones_like(data["status"])}
    )
    sheet = plane.plane(data, "slack_alpha", {})

    def shown(alpha, beta):
        return sheet.values[np.flatnonzero(sheet.y == beta)[0], np.flatnonzero(sheet.x == alpha)[0]]

    assert shown(50.0, -10.0) == pytest.approx(0.2)
    assert shown(10.0, 50.0) == pytest.approx(0.5 + 0.004 * 30.0)  # held as (50, 10)
    assert shown(10.0, -50.0) == pytest.approx(0.5 + 0.004 * 10.0)  # held as (50, -10)
    texts = design_map(data, "slack_alpha").figure.findobj(Text)
    assert any("family alpha is slack" in artist.get_text() for artist in texts)


def test_the_half_that_symmetry_gives_has_no_comb_where_its_steps_are_wider():
    """Beyond the nodes of beta the images stand ten degrees apart, the map's nodes five."""
    data = atlas(step=5.0)
    data = data.isel(beta=slice(1, None, 2))  # -80 to 80 in steps of ten; alpha to 85 in steps of five
    sheet = plane.plane(data, "deformed_length", {"pressure": 2e4})
    corners = np.isin(np.abs(sheet.y), 85.0)[:, None] & (sheet.x > 80.0)
    np.testing.assert_array_equal(sheet.reason == status.OUTSIDE, corners)
    top = sheet.values[sheet.y == 85.0].ravel()
    held = data["deformed_length"].sel(alpha=85.0, length=0.15, radius=5e-3, pressure=2e4)
    between = np.interp(sheet.x, held["beta"], held)
    assert np.abs(top[:-1] - between[:-1]).max() < 1e-12
    failed = data.copy(deep=True)
    failed["status"].loc[{"alpha": 85.0, "beta": 40.0}] = status.BEYOND_LIMIT
    beyond = plane.plane(failed, "deformed_length", {"pressure": 2e4})
    assert (sheet.x[beyond.reason[sheet.y == 85.0].ravel() == status.BEYOND_LIMIT] == [35.0, 40.0, 45.0]).all()


def test_flags_between_nodes_are_one_of_their_nodes():
    data = atlas(step=5.0).isel(beta=slice(1, None, 2))
    kind = xr.where(data["beta"] > 32.0, 3, xr.where(data["beta"] > 22.0, 1, 0)) + 0 * data["status"]
    found = flag(data.assign(kind=kind), "rotation", "kind", "alpha", "beta", {"pressure": 2e4})
    assert set(np.unique(found[np.isfinite(found)])) == {0.0, 1.0, 3.0}


@pytest.mark.parametrize(("fibers", "parts"), [("loose", 1), ("bonded", 2)])
def test_contours_cross_the_diagonal_where_threads_may_be_slack(fibers, parts):
    data = atlas().assign_attrs(fibers=fibers)
    assert len(plane.plane(data, "rotation", {}).parts) == parts
    share = data["rotation"] * 0.0
    data = data.assign(slack_alpha=share, slack_beta=share, slack_fiber=data["status"] * 0)
    assert len(plane.plane(data, "slack_alpha", {}).parts) == 2  # what the families exchange jumps there
