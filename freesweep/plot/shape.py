"""Shapes of actuators in space: wall and both fiber families, undeformed in blue, deformed in red (Figures 2-2, 2-3). Where
a family hangs loose, or would have to push, its fibers are dashed.

The drawing is a parallel projection along a slant: what lies in the plane through the axis keeps its true length, so axial
positions and radii can be read from the axes; circles around the axis look as ellipses. With the axis along z, u = z - SLANT
r cos(theta) and v = r sin(theta); theta = 0 faces the onlooker.
"""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from ..description.actuator import Actuator
from ..description.families import BITS, FAMILIES
from . import style

SLANT = 0.34  # half width of an ellipse over its half height
AROUND = 61  # directions around the axis between the edges of what is seen
ALONG = 181  # stations of the wall
FINE = 1201  # stations of a fiber
FIBERS = 14  # of a family of long pitch; steeper ones have fewer, in proportion to the cosine
MM = 1e3
END = "#d8d5ce"
TAUT = {"gid": "fibers", "linewidths": 0.8}
DASHED = {"gid": "slack", "linewidths": 0.5, "linestyles": [(0, (2.5, 3.0))]}
LIGHT = np.array([0.55, 0.75, 0.25]) / np.linalg.norm([0.55, 0.75, 0.25])  # from where it comes: depth, up, along


class Shape(NamedTuple):
    """A surface of revolution with fibers, at stations (n,): its radius and axial position [mm], its rotation from the fixed
    end, and the angular position of the fiber of each family that starts at theta = 0 [radian].
    """

    radius: np.ndarray
    position: np.ndarray
    twist: np.ndarray
    fibers: tuple
    counts: tuple  # fibers of each family that are drawn
    slack: tuple  # where each family does not pull


def shape_of(tube: Actuator, state=None) -> Shape:
    """The shape of ``tube`` undeformed, or in a ``state``: a Dataset of one load from ``lock``, ``inflate`` or the like.

    Raises ValueError for a state with dimensions other than ``x``, without a result, or not of this tube.
    """
    share = np.linspace(0.0, 1.0, FINE)
    turns, surface = [], tube.fiber_surface_at(share)
    along = np.hypot(tube.length, np.gradient(surface, share)) if tube.is_body else tube.length
    drawn = [np.nan_to_num(angles) for angles in tube.angles(share)]
    for angles in drawn:
        slope = np.tan(np.radians(angles)) * along / surface
        turns.append(np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(share))]))
    counts = tuple(
        max(2, round(FIBERS * np.cos(np.radians(np.abs(angles)).mean()))) if getattr(tube, family) is not None else 0
        for family, angles in zip(FAMILIES, drawn)
    )
    if state is None:
        taut = (np.zeros(FINE, bool),) * len(FAMILIES)
        return Shape(
            np.broadcast_to(surface * MM, FINE), share * tube.length * MM, np.zeros(FINE), tuple(turns), counts, taut
        )
    free = [name for name in state["deformed_radius"].dims if name != "x"]
    if free:
        raise ValueError(f"a shape is drawn of one load; choose one of {', '.join(free)} with .sel or .isel")
    x = state["x"].values / tube.length
    if len(x) < 2 or abs(x[0]) > 1e-9 or abs(x[-1] - 1.0) > 1e-6:
        raise ValueError(f"stations run from {x[0]:g} to {x[-1]:g} lengths of this tube; a shape needs 0 to 1")
    radius, position, twist = (
        np.interp(share, x, state[name].values) for name in ("deformed_radius", "axial_position", "twist")
    )
    if not np.all(np.isfinite(radius)):
        raise ValueError(f"this state has no result (status {int(state['status'])}): there is no shape to draw")
    twist = np.radians(twist)
    slack = tuple(
        np.full(FINE, (int(state["slack_fiber"]) & bit) > 0)
        & (np.interp(share, x, state[f"fiber_tension_{family}"].values) <= 0.0)
        for family, bit in BITS.items()
    )
    return Shape(radius * MM, position * MM, twist, tuple(turn + twist for turn in turns), counts, slack)


def project(shape: Shape, theta):
    """Points of the paper ``(u, v)`` [mm] of the surface at angular positions ``theta``, which broadcast with stations."""
    return shape.position - SLANT * shape.radius * np.cos(theta), shape.radius * np.sin(theta)


def seen(shape: Shape, theta):
    """Whether the surface at ``theta`` faces the onlooker."""
    return np.cos(theta) - SLANT * _slope(shape) > 0.0


def _reach(shape):
    """The angular position at which the surface turns away, at each station."""
    return np.arccos(np.clip(SLANT * _slope(shape), -1.0, 1.0))


def _slope(shape):
    """dr/dz along the meridian; large where the wall stands across the axis."""
    step = np.gradient(shape.position)
    return np.gradient(shape.radius) / np.where(np.abs(step) < 1e-9, 1e-9, step)


def draw_shape(ax: Axes, shape: Shape, colours=style.AFTER, lift: float = 0.0) -> list[LineCollection]:
    """Draws a shape, its axis at the height ``lift`` [mm]; returns the lines of the alpha and the beta family that pull."""
    _draw_wall(ax, shape, colours, lift)
    lines = []
    for turn, count, colour, slack in zip(shape.fibers, shape.counts, colours, shape.slack):
        lines.append(_draw_family(ax, shape, turn, count, colour, lift, ~slack, TAUT))
        if slack.any():
            _draw_family(ax, shape, turn, count, colour, lift, slack, DASHED)
    _draw_end(ax, shape, lift)
    return lines


def draw_outline(ax: Axes, shape: Shape, colour, lift: float = 0.0, zorder: float = 3.0) -> list:
    """The two edges of a shape and its fixed end, as thin lines."""
    how = {"color": colour, "linewidth": 0.6, "zorder": zorder, "gid": "edge"}
    reach = _reach(shape)
    lines = []
    for theta in (-reach, reach):
        u, v = project(shape, theta)
        lines += ax.plot(u, v + lift, **how)
    theta = np.linspace(-reach[0], reach[0], 61)
    z, r = shape.position[0], shape.radius[0]
    return lines + ax.plot(z - SLANT * r * np.cos(theta), r * np.sin(theta) + lift, **how)


def _draw_wall(ax, shape, colours, lift):
    """Front half of the surface, lit from above, between the two edges where it turns away."""
    coarse = np.linspace(0, len(shape.radius) - 1, ALONG).round().astype(int)
    slope = _slope(shape)[coarse]
    theta = _reach(shape)[coarse, None] * np.linspace(-1.0, 1.0, AROUND)
    radius, position = shape.radius[coarse, None], shape.position[coarse, None]
    u, v = position - SLANT * radius * np.cos(theta), radius * np.sin(theta) + lift
    normal = np.stack([np.cos(theta), np.sin(theta), np.broadcast_to(-slope[:, None], theta.shape)])
    normal /= np.linalg.norm(normal, axis=0)
    bright = np.clip(np.tensordot(LIGHT, normal, 1), 0.0, 1.0)
    gloss = LinearSegmentedColormap.from_list("wall", [_mixed(colours[1], 0.45), _mixed(colours[1], 0.86), style.PAPER])
    ax.pcolormesh(u, v, 0.15 + 0.75 * bright**1.5, cmap=gloss, vmin=0.0, vmax=1.0, shading="gouraud", rasterized=True,
                  zorder=2, gid="wall")  # fmt: skip
    draw_outline(ax, shape, colours[0], lift)


def _mixed(colour, white):
    """The colour with a share of white."""
    rgb = np.array([int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)])
    return tuple(white + (1.0 - white) * rgb)


def _draw_family(ax, shape, turn, count, colour, lift, there, how):
    """What is seen of the fibers of one family, evenly around the tube, at the stations that are ``there``."""
    pieces = []
    for start in 2.0 * np.pi * (np.arange(count) + 0.5) / count:
        u, v = project(shape, turn + start)
        front = seen(shape, turn + start) & there
        for piece in np.split(np.arange(u.size), np.flatnonzero(np.diff(front)) + 1):
            if front[piece[0]] and piece.size > 1:
                pieces.append(np.stack([u[piece], v[piece] + lift], axis=1))
    lines = LineCollection(pieces, colors=colour, capstyle="butt", zorder=2.5, **how)
    return ax.add_collection(lines, autolim=False)


def _draw_end(ax, shape, lift):
    """The free end as a disc, with a notch that shows how far it has turned: upright before deformation."""
    theta = np.linspace(0.0, 2.0 * np.pi, 121)
    z, r = shape.position[-1], shape.radius[-1]
    disc = np.stack([z - SLANT * r * np.cos(theta), r * np.sin(theta) + lift], axis=1)
    ax.add_patch(PathPatch(Path(disc, closed=True), facecolor=END, edgecolor=style.INK, linewidth=0.5, zorder=4))
    turned, inner = 0.5 * np.pi + shape.twist[-1], np.array([0.25, 1.0]) * r
    u, v = z - SLANT * inner * np.cos(turned), inner * np.sin(turned)
    ax.plot(u, v + lift, color=style.INK, linewidth=1.0, zorder=5, solid_capstyle="butt", gid="notch")
