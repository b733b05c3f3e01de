"""Shapes draw the solution: meridians, fibers that keep their length and angle, the rotation of the end."""

from dataclasses import replace

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

from commands import refused, run
from matplotlib import pyplot
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb, to_rgba
from PIL import Image

import freesweep as fs
from freesweep.plot import style
from freesweep.plot.motion import frames, save_motion
from freesweep.plot.shape import SLANT, project, seen, shape_of
from freesweep.plot.tubes import shape_plot

RUBBER = fs.MooneyRivlin(0.17e6, 0.08e6)
SIZES = {"length": 0.06, "radius": 4.76e-3, "wall": 1.59e-3, "material": RUBBER}
WORDS = [
    "--length",
    "60mm",
    "--radius",
    "4.76mm",
    "--wall",
    "1.59mm",
    "--c10",
    "0.17MPa",
    "--alpha",
    "0",
    "--beta",
    "30",
]


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def tube():
    return fs.Actuator(alpha=0.0, beta=30.0, **SIZES)


@pytest.fixture(scope="module")
def states(tube):
    return fs.inflate(tube, [0.0, 1e5, 2e5])


def length_of(shape, turn):
    """Length of a fiber in space [mm]."""
    points = np.stack([shape.radius * np.cos(turn), shape.radius * np.sin(turn), shape.position])
    return np.linalg.norm(np.diff(points, axis=1), axis=0).sum()


@pytest.mark.parametrize("angles", [(0.0, 30.0), (30.0, -30.0), ([(0, 0), (1, 67.5)], [(0, -30), (1, -67.5)])])
def test_fibers_keep_their_length(angles):
    tube = fs.Actuator(alpha=angles[0], beta=angles[1], **SIZES)
    rest, locked = shape_of(tube), shape_of(tube, fs.lock(tube, x=np.linspace(0.0, 0.06, 1201)))
    for before, after in zip(rest.fibers, locked.fibers):
        assert length_of(locked, after) == pytest.approx(length_of(rest, before), rel=1e-4)
    for family, angle in zip(rest.fibers, angles):
        if np.ndim(angle) == 0:
            assert family[-1] == pytest.approx(np.tan(np.radians(angle)) * 60.0 / 4.76)


def test_meridian_and_rotation_are_those_of_the_solution(tube, states):
    state = states.isel(pressure=2)
    shape = shape_of(tube, state)
    assert shape.position[-1] == pytest.approx(float(state["deformed_length"]) * 1e3)
    assert shape.radius.max() == pytest.approx(float(state["mid_radius"]) * 1e3, rel=1e-6)
    assert np.degrees(shape.twist[-1]) == pytest.approx(float(state["rotation"]))
    assert shape.fibers[0][-1] == pytest.approx(np.radians(float(state["rotation"])))  # a fiber that was straight


def test_only_what_faces_the_onlooker_is_drawn(tube, states):
    """A point of the surface is hidden just where its ray to the onlooker runs back into the body."""
    shape = shape_of(tube, states.isel(pressure=2))
    inside = slice(100, -100, 50)
    for theta in np.linspace(-np.pi, np.pi, 24, endpoint=False) + 0.05:
        step = 1e-3  # [mm] along the ray, whose direction is (1, 0, SLANT)
        depth = shape.radius * np.cos(theta) + step
        ahead = np.interp(shape.position + SLANT * step, shape.position, shape.radius)
        out = np.hypot(depth, shape.radius * np.sin(theta)) > ahead
        np.testing.assert_array_equal(seen(shape, theta)[inside], out[inside])


def families(ax):
    return [artist for artist in ax.collections if isinstance(artist, LineCollection) and artist.get_gid() == "fibers"]


def test_blue_before_red_after_and_every_fiber_on_the_surface(tube, states):
    ax = shape_plot(tube, states.isel(pressure=1), titles=["100 kPa"])
    drawn = families(ax)
    assert [tuple(line.get_colors()[0]) for line in drawn] == [to_rgba(c) for c in (*style.BEFORE, *style.AFTER)]
    wall = [artist for artist in ax.collections if artist.get_gid() == "wall"]
    assert len(wall) == 2
    for k, shape in enumerate((shape_of(tube), shape_of(tube, states.isel(pressure=1)))):
        top = wall[k].get_coordinates()[..., 1].max()
        for line in drawn[2 * k : 2 * k + 2]:
            points = np.concatenate(line.get_segments())
            height = points[:, 1] - (top - shape.radius.max())
            assert np.all(np.abs(height) <= shape.radius.max() * (1.0 + 1e-9))
            # back from the paper to the surface: v = r sin, u = z - SLANT r cos
            radius = np.interp(points[:, 0] + SLANT * shape.radius.max(), shape.position, shape.radius)
            assert np.all(np.abs(height) <= radius.max() * (1.0 + 1e-9))
    texts = {text.get_gid(): text.get_text() for text in ax.texts}
    assert texts["name"] == "100 kPa"
    assert f"{float(states['deformed_length'][1]) * 1e3:.1f} mm long" in texts["size"]
    assert ax.get_xlim()[0] < -SLANT * 4.76
    assert ax.get_aspect() == 1.0


def lengths_of(ax, gid, colour):
    """Length along the axis of the drawn fibers of one colour [mm]."""
    lines = [artist for artist in ax.collections if isinstance(artist, LineCollection) and artist.get_gid() == gid]
    own = [line for line in lines if tuple(line.get_colors()[0]) == to_rgba(colour)]
    return sum(np.abs(np.diff(piece[:, 0])).sum() for line in own for piece in line.get_segments())


@pytest.mark.parametrize(("fibers", "words"), [("loose", "slack threads"), ("bonded", "fibers that would push")])
def test_what_does_not_pull_is_dashed(fibers, words):
    """Prototype B of the source at a low pressure: of the straight family all but the ends."""
    rubber = fs.MooneyRivlin(0.17e6, 0.08e6)
    b = fs.Actuator(alpha=0, beta=30, length=0.131, radius=4.76e-3, wall=1.59e-3, material=rubber, fibers=fibers)
    state = fs.inflate(b, 30e3)
    ax = shape_plot(b, state)
    straight, wound = style.AFTER
    dashed, drawn = lengths_of(ax, "slack", straight), lengths_of(ax, "fibers", straight)
    assert dashed / (dashed + drawn) == pytest.approx(float(state.slack_alpha), abs=0.02)
    assert lengths_of(ax, "slack", wound) < 0.02 * lengths_of(ax, "fibers", wound)
    assert [words in text.get_text() for text in ax.texts if text.get_gid() == "size"] == [False, True]
    (frame,) = frames(b, fs.inflate(b, [30e3]))
    assert frame.get_title("left").endswith(f"dashed: {words}")
    other = replace(b, fibers="loose" if fibers == "bonded" else "bonded")  # whose state this is not
    assert [words in text.get_text() for text in shape_plot(other, state).texts if text.get_gid() == "size"] == [
        False,
        True,
    ]
    taut = shape_plot(b, fs.inflate(b, 4e5 if fibers == "bonded" else 1e6))
    assert lengths_of(taut, "slack", straight) == 0.0


def test_projection_keeps_lengths_along_and_across(tube):
    shape = shape_of(tube)
    u, v = project(shape, 0.5 * np.pi)
    np.testing.assert_allclose(u, shape.position, atol=1e-12)
    np.testing.assert_allclose(v, shape.radius)


def test_states_that_have_no_shape(tube, states):
    with pytest.raises(ValueError, match="choose one of pressure"):
        shape_of(tube, states)
    with pytest.raises(ValueError, match=r"no result \(status 3\)"):
        shape_of(tube, fs.inflate(tube, 1e3, force=-10.0))
    with pytest.raises(ValueError, match="a shape needs 0 to 1"):
        shape_of(tube, fs.lock(tube, x=[0.0, 0.03]))


def test_motion_has_a_frame_for_each_pressure_there_and_back(tube, states, tmp_path):
    axes = list(frames(tube, states))
    assert len({(ax.get_xlim(), ax.get_ylim()) for ax in axes}) == 1
    for ax, pressure in zip(axes, states["pressure"].values):
        assert ax.get_title("left").startswith(f"{pressure * 1e-3:.1f} kPa")
    path = save_motion(tube, states, tmp_path / "tube.gif")
    first = path.read_bytes()
    with Image.open(path) as picture:
        assert picture.n_frames == 4
        shown = []
        for k in range(picture.n_frames):
            picture.seek(k)
            shown.append(np.asarray(picture.convert("RGB")).astype(int))
    assert np.abs(shown[1] - shown[3]).max() == 0  # 1e5 Pa on the way there and back
    assert np.abs(shown[0] - shown[2]).max() > 50
    save_motion(tube, states, path)
    assert path.read_bytes() == first
    with pytest.raises(ValueError, match=r"suffix must be \.gif"):
        save_motion(tube, states, tmp_path / "tube.png")
    with pytest.raises(ValueError, match="only dimension"):
        save_motion(tube, states.isel(pressure=1), path)


def test_motion_keeps_its_ink_and_says_what_it_leaves_out(tmp_path):
    """A balloon is all one colour but for the words above it; one that bursts has no frames beyond its limit pressure."""
    balloon = fs.Actuator(alpha=None, beta=None, length=0.05, radius=5e-3, wall=1e-3, material=fs.NeoHookean(1e5))
    states = fs.inflate(balloon, np.linspace(0.0, 6e4, 3))
    assert states.status.values.tolist() == [0, 0, 2]
    with pytest.warns(UserWarning, match="1 of 3 pressures have no frame: beyond_limit_pressure"):
        path = save_motion(balloon, states, tmp_path / "balloon.gif")
    with Image.open(path) as picture:
        colours = np.asarray(picture.convert("RGB")).reshape(-1, 3).astype(int)
    for colour in (style.INK, style.PAPER):
        assert np.abs(colours - np.round(255 * np.array(to_rgb(colour)))).max(axis=1).min() < 8


def test_commands(tmp_path, capsys):
    out = tmp_path / "tube.svg"
    assert run("plot", "shape", *WORDS, "-o", str(out)) == 0
    first = out.read_bytes()
    assert run("plot", "shape", *WORDS, "-o", str(out)) == 0
    assert out.read_bytes() == first
    named = [*WORDS[:6], *WORDS[8:], "--material", "dragon-skin-30"]  # a rubber by name, in place of its constant
    assert run("plot", "shape", *named, "--pressure", "20kPa", "-o", str(out)) == 0
    assert run("plot", "shape", *WORDS, "--pressure", "0", "0.1MPa", "--steps", "2", "-o", str(tmp_path / "t.gif")) == 0
    capsys.readouterr()
    assert "give --pressure" in refused(capsys, "plot", "shape", *WORDS, "-o", "tube.gif")
    assert "the rubber counts" in refused(capsys, "plot", "shape", *WORDS[:6], *WORDS[8:], "--pressure", "1")
    assert ".png, .svg, .pdf, .gif" in refused(capsys, "plot", "shape", *WORDS, "-o", "tube.jpg")
