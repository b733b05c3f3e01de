"""One visual language for every plot: type, publication sizes, colours, colour maps; and how a plot becomes a file.

Importing this changes nothing: the settings hold inside ``with context():`` only. The colour maps are straight lines in
CIELAB, so equal steps of a value look equally large and keep their order in grey, for colour-blind eyes too.
"""

import contextlib
import functools
import io
import os
import textwrap
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from ..atlas.files import write_whole
from .suffixes import SUFFIXES

INCH = 25.4  # [mm]
RESOLUTION = 300.0  # of PNG files [dots per inch]
SCREEN = 100.0  # of figures in notebooks [dots per inch]
COLUMN, PAGE = 85.0, 170.0  # widths in print [mm]

INK = "#23272e"
QUIET = "#6b717b"
PAPER = "#ffffff"
BLANK = "#e9e9ea"  # where there is no value
LOCKED = "#1f4fe0"  # the locked manifold, blue as in the source
FAMILIES = ("#c2187f", "#1d2b3a")  # the alpha and the beta family of fibers
BEFORE = ("#0b3c7d", "#5590cf")  # alpha and beta family of the undeformed tube: blue, as in Figures 2-2 and 2-3
AFTER = ("#8f1513", "#e0746a")  # and of the deformed one: red
SERIES = ("#10664a", "#e09a1a", "#7c4fb0", "#5b2a12", "#3fb3cf", "#e07a5f")  # told apart by colour-blind eyes
ON_DARK = ("#2fae86", "#e6a52e", "#a37fdb", "#ecd9c6", "#56c5de")  # the first of them on dark paper
ENERGY = {"principal": "solid", "full": (0, (4.5, 1.8))}  # lines of the two strain energies
EXTENDED = (0, (1.0, 1.3))  # the line of fibers that extend: dotted, as in Figure 2-8
BAND = 0.25  # opacity of an error band
THICK, THIN = 1.4, 0.7  # lines of data; where a fiber family would have to push [points]
DESIGN = {"color": INK, "markerfacecolor": PAPER, "markersize": 3.4, "markeredgewidth": 0.8}  # the dot of a design

LIGHTEST_TYPE = 0.24  # relative luminance: a contrast of 3.6 to paper
SAMPLE = "length 192 mm, radius 4.76 mm, wall 1.59 mm, thin lines"
FEWEST = 20  # letters of a line, however narrow: more lines would leave no room for the axes
SMALL, NORMAL, LARGE = 7.0, 8.0, 10.0  # type [points]

SETTINGS = {
    "font.family": ["STIXGeneral"],  # comes with matplotlib: the same plot on every machine
    "mathtext.fontset": "stix",
    "font.size": NORMAL,
    "text.hinting": "none",  # letters keep their distances on the screen, too
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.titlesize": LARGE,
    "axes.labelsize": NORMAL + 1.0,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": NORMAL,
    "ytick.labelsize": NORMAL,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": NORMAL,
    "legend.frameon": False,
    "hatch.linewidth": 0.5,
    "figure.facecolor": PAPER,
    "savefig.facecolor": PAPER,
    "savefig.bbox": None,  # the width asked for is the width in print
    "pdf.fonttype": 42,
    "svg.hashsalt": "freesweep",  # equal plots are equal files
}


@contextlib.contextmanager
def context():
    """The settings, for a while, but for those that the user has changed: own styles pass through.

    What pyplot sets when it is first imported meanwhile stays: ``rc_context`` would take a notebook's ``interactive`` back,
    and later plots would not be seen.
    """
    before = {name: mpl.rcParams[name] for name in SETTINGS}
    own = {name for name, value in before.items() if value != mpl.rcParamsDefault[name]}
    mpl.rcParams.update({name: value for name, value in SETTINGS.items() if name not in own})
    try:
        yield
    finally:
        mpl.rcParams.update(before)


def new_axes(width: float, height: float) -> Axes:
    """Axes that fill a new figure of ``width`` and ``height`` [mm]."""
    from matplotlib import pyplot  # so that notebooks and plt.show() see the figure

    with context():
        return pyplot.figure(figsize=(width / INCH, height / INCH), layout="constrained").add_subplot()


class _Shown(Figure):
    """A figure that a notebook shows, whether pyplot was loaded or not."""

    def _repr_png_(self):
        return drawn(self, "figure.png", SCREEN)


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of ``width`` and ``height`` [mm] that no window shows, but a notebook does at the end of a cell."""
    with context():
        return _Shown(figsize=(width / INCH, height / INCH), layout="constrained")


def ramp(count: int) -> list[str]:
    """``count`` colours of a growing quantity, such as pressure, from light to dark; none too light for a line."""
    return [to_hex(colour) for colour in SEQUENTIAL(np.linspace(1.0, 0.38, count)[::-1])]


def points(size: float) -> float:
    """A size of type, SMALL, NORMAL or LARGE, to the scale of the font size that holds [points]."""
    return size * mpl.rcParams["font.size"] / NORMAL


@functools.lru_cache(maxsize=8)
def _mean_letter(family):
    """Mean width of letters of a font, in sizes of type."""
    return TextPath((0, 0), SAMPLE, size=100.0, prop=FontProperties(family=list(family))).get_extents().width / len(
        SAMPLE
    )


def wider() -> float:
    """By how much the type that holds is wider than SETTINGS' own, size included: for words that are broken to a width."""
    own, plain = tuple(mpl.rcParams["font.family"]), tuple(SETTINGS["font.family"])
    scale = mpl.rcParams["font.size"] / SETTINGS["font.size"]
    return scale * (1.0 if own == plain else _mean_letter(own) / _mean_letter(plain))


def broken(words, width: float, letter: float) -> list[str]:
    """Lines of ``words``, one after the other, for a ``width`` and letters of such a width in SETTINGS' own type [mm]."""
    most = max(int(width / (letter * wider())), FEWEST)
    return textwrap.wrap(", ".join(words), most, break_on_hyphens=False)


def legible(colour: str) -> str:
    """The colour of type beside a line of ``colour``: darker where that is too light to read on paper."""
    rgb = np.array(to_rgb(colour))
    while _luminance(rgb) > LIGHTEST_TYPE:
        rgb = 0.95 * rgb
    return to_hex(rgb)


def _luminance(rgb):
    """Relative luminance, 0 to 1, of sRGB."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def dress(ax: Axes, xlabel: str, ylabel: str, heading: str = "") -> Axes:
    """Labels with units, a heading at the left, open axes with faint lines to read values from."""
    ax.set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    ax.set_title(heading, loc="left", fontsize=points(NORMAL + 1.0), fontweight="bold")
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color=BLANK, linewidth=0.5)
    ax.set_axisbelow(True)
    return ax


def _rgb(lab):
    """SRGB in 0..1, shape (n, 3), of CIELAB under D65, shape (n, 3)."""
    light = (lab[:, 0] + 16.0) / 116.0
    f = np.stack([light + lab[:, 1] / 500.0, light, light - lab[:, 2] / 200.0], axis=1)
    xyz = np.where(f > 6.0 / 29.0, f**3, (f - 4.0 / 29.0) * 3.0 * (6.0 / 29.0) ** 2) * [0.95047, 1.0, 1.08883]
    to_rgb = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
    linear = np.clip(xyz @ np.transpose(to_rgb), 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)


def _colour_map(name, anchors):
    at = np.linspace(0.0, 1.0, len(anchors))
    fine = np.linspace(0.0, 1.0, 257)  # odd: the middle of a diverging map is one of them
    lab = np.stack([np.interp(fine, at, channel) for channel in np.transpose(anchors)], axis=1)
    return LinearSegmentedColormap.from_list(name, _rgb(lab), N=257)


# lightness, green-red, blue-yellow; ends that print and leave black type legible
DIVERGING = _colour_map("rust_teal", [(46.0, 38.0, 46.0), (97.0, 0.0, 1.0), (46.0, -34.0, -8.0)])
SEQUENTIAL = _colour_map("sand_pine", [(96.0, -2.0, 14.0), (66.0, -24.0, 8.0), (36.0, -14.0, -12.0)])


def save(drawing: Axes | Figure, path: str | os.PathLike[str], resolution: float = RESOLUTION) -> Path:
    """Writes the figure of ``drawing`` as PNG, SVG or PDF, by the suffix of ``path``; returns the path.

    ``resolution`` is that of a PNG, and of shaded surfaces and map cells in the others [dots per inch].
    The file is complete or not there. Raises ValueError for any other suffix, OSError where the path cannot be written.
    """
    write_whole(path, drawn(drawing, path, resolution))
    return Path(path)


def drawn(drawing: Axes | Figure, path: str | os.PathLike[str], resolution: float = RESOLUTION) -> bytes:
    """What :func:`save` writes."""
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"cannot save a plot as {path.name!r}: the suffix must be one of {', '.join(SUFFIXES)}")
    figure = drawing.figure if isinstance(drawing, Axes) else drawing
    if not isinstance(figure, Figure):  # a subfigure: the file shows all of it
        figure = figure.figure
    undated = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}[suffix]
    content = io.BytesIO()
    with context():
        figure.savefig(content, format=suffix[1:], dpi=resolution, metadata=undated)
    return content.getvalue()
