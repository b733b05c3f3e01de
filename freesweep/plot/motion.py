"""An actuator in motion: its shape along pressure as an animated GIF, over the outline it had without pressure."""

from __future__ import annotations

import io
import os
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from ..atlas.files import write_whole
from ..description.actuator import Actuator
from ..status import STATUSES, VALUED
from . import style
from .shape import draw_outline, draw_shape, project, shape_of
from .tubes import DASHED, MARGIN

if TYPE_CHECKING:
    import xarray as xr

WIDTH = 150.0  # [mm]
RESOLUTION = 110.0  # for the screen [dots per inch]
PAUSE = 60  # of a frame [ms]
REST = 900  # of the first and the last [ms]
COLOURS = 128
MOST = 240  # frames


def frames(tube: Actuator, states):
    """Yields one Axes for each node of ``pressure`` in a Dataset of ``inflate``, all in one window.

    Nodes without a result are left out. Raises ValueError where none is left, or where there are other dimensions.
    """
    free = [name for name in states["deformed_radius"].dims if name not in ("x", "pressure")]
    if free or "pressure" not in states["deformed_radius"].dims:
        raise ValueError(f"motion runs along pressure, and needs it as the only dimension (found {free or 'none'})")
    valued = np.flatnonzero(np.isin(states["status"].values, VALUED))
    if valued.size == 0:
        raise ValueError("no pressure has a result: there is no shape to draw")
    if valued.size > MOST:
        raise ValueError(f"{valued.size} pressures are too many frames; give {MOST} at most")
    rest = shape_of(tube)
    shapes = [shape_of(tube, states.isel(pressure=k)) for k in valued]
    everyone = [rest, *shapes]
    left = min(float(np.min(project(shape, 0.0)[0])) for shape in everyone)
    right = max(float(np.max(project(shape, np.pi)[0])) for shape in everyone)
    reach = max(shape.radius.max() for shape in everyone)
    margin = MARGIN * (right - left)
    span = right - left + 2.0 * margin
    height = 2.4 * reach / span * WIDTH + 22.0
    for k, shape in zip(valued, shapes):
        with style.context():
            ax = style.new_figure(WIDTH, height).add_subplot()
            draw_outline(ax, rest, style.BEFORE[1], zorder=1)
            draw_shape(ax, shape)
            ax.set(xlim=(left - margin, right + margin), ylim=(-1.2 * reach, 1.2 * reach), aspect="equal")
            ax.set_xlabel("axial position [mm], radii to the same scale")
            ax.yaxis.set_visible(False)
            ax.spines[["left", "top", "right"]].set_visible(False)
            ax.set_title(_words(states.isel(pressure=k), shape), loc="left", fontsize=style.points(style.NORMAL + 1.0))
        yield ax


def _words(state, shape):
    turned = f"{np.round(np.degrees(shape.twist[-1])) + 0.0:.0f}°".replace("-", "\N{MINUS SIGN}")  # no -0
    slack = f"    dashed: {DASHED[state.attrs.get('fibers', 'bonded')]}" if np.any(shape.slack) else ""
    return f"{float(state['pressure']) * 1e-3:.1f} kPa    {shape.position[-1]:.1f} mm long    turned by {turned}{slack}"


def save_motion(
    tube: Actuator, states: xr.Dataset, path: str | os.PathLike[str], resolution: float = RESOLUTION
) -> Path:
    """Writes the motion as a GIF that runs forth and back, with ``resolution`` in dots per inch, and returns its path.

    The file is whole or not there. Raises ValueError as :func:`frames` does and for another suffix, OSError where the path
    cannot be written.
    """
    from PIL import Image

    path = Path(path)
    if path.suffix.lower() != ".gif":
        raise ValueError(f"cannot save motion as {path.name!r}: the suffix must be .gif")
    pictures = []
    for ax in frames(tube, states):
        canvas = FigureCanvasAgg(ax.figure)
        with style.context():
            ax.figure.set_dpi(resolution)
            canvas.draw()
        pictures.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy()))
    _warn_of_gaps(states["status"].values)
    palette = _palette([pictures[0], pictures[len(pictures) // 2], pictures[-1]])
    flat = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    there_and_back = flat + flat[-2:0:-1]
    pauses = [REST if k in (0, len(flat) - 1) else PAUSE for k in range(len(there_and_back))]
    content = io.BytesIO()
    there_and_back[0].save(content, "GIF", save_all=True, append_images=there_and_back[1:], duration=pauses, loop=0)
    write_whole(path, content.getvalue())
    return path


def _warn_of_gaps(status):
    """What is left out, and why, in one sentence."""
    why = sorted({STATUSES[code].meaning for code in status.tolist() if code not in VALUED})
    if why:
        lost = int(np.sum(~np.isin(status, VALUED)))
        warnings.warn(f"{lost} of {status.size} pressures have no frame: {', '.join(why)}", stacklevel=3)


def _palette(pictures):
    """One palette for all, lest colours flicker: it covers the farthest colours, thin lines and type among them."""
    from PIL import Image

    width, height = pictures[0].size
    below = Image.new("RGB", (width, height * len(pictures)))
    for k, picture in enumerate(pictures):
        below.paste(picture, (0, k * height))
    return below.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
