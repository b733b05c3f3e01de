"""The figures of the page, empty: what fills them arrives as data. The script under ``page/`` finds all by their names."""

from bokeh.core.properties import value
from bokeh.models import ColorBar, ColumnDataSource, CustomJS, LinearColorMapper, Range1d
from bokeh.plotting import figure

from .. import status
from ..plot import style
from .measures import COARSE_STATUS

FONT = "system-ui, -apple-system, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif"
SMALL, NORMAL = "11px", "12px"
BAR = 60  # [px]: the colour bar and numbers of five letters
DIAGONAL, BACK, CROSSED = "right_diagonal_line", "left_diagonal_line", "diagonal_cross"
SLACK_KIND = 100  # and the slack families
HATCHES = {  # by status of what failed, of COARSE_STATUS, and by slack families: pattern
    status.DEGENERATE: "dot", status.BEYOND_LIMIT: DIAGONAL, status.COMPRESSED: BACK, status.HELD_IMPOSSIBLE: CROSSED,
    status.NOT_CONVERGED: "cross", status.INVALID: "horizontal_line", status.OUTSIDE: "blank",
    status.NOT_INTERPOLABLE: "ring", COARSE_STATUS: "dot",
    SLACK_KIND + 1: DIAGONAL, SLACK_KIND + 2: BACK, SLACK_KIND + 3: CROSSED,
}  # fmt: skip


def figures() -> dict:
    """Name -> figure: ``map``, ``section``, ``space``, ``curve``, ``front``."""
    made = {"map": _map(), "section": _section(), "space": _space(), "curve": _curve(), "front": _front()}
    for one in made.values():
        for (
            renderer
        ) in one.renderers:  # nothing looks otherwise when selected or muted: no copies that are dressed anew
            renderer.selection_glyph = renderer.nonselection_glyph = renderer.muted_glyph = None
    return made


def _figure(name, tools="", events=(), **how):
    made = figure(name=name, tools=tools, toolbar_location=None, sizing_mode="stretch_both", min_border=4, **how)
    made.background_fill_color = made.border_fill_color = None
    made.outline_line_color = None
    for axis in (*made.xaxis, *made.yaxis):
        axis.axis_label_text_font = axis.major_label_text_font = FONT
        axis.axis_label_text_font_size = axis.major_label_text_font_size = SMALL
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_standoff, axis.minor_tick_line_color = 4, None
        axis.major_tick_in, axis.major_tick_out = 0, 4
        axis.ticker.desired_num_ticks = 5
    for event in events:
        made.js_on_event(event, CustomJS(code=f"window.freesweep.event('{name}', cb_obj)"))
    return made


def _source(name, **columns):
    return ColumnDataSource({key: [] for key in columns.pop("columns", "x y").split()}, name=name)


def _map():
    made = _figure(
        "map", "pan,wheel_zoom,reset", ("tap", "mousemove", "mouseleave", "doubletap"),
        x_range=Range1d(0, 1), y_range=Range1d(0, 1),
    )  # fmt: skip
    made.grid.visible = False
    made.toolbar.active_drag = None
    made.toolbar.active_scroll = None
    made.image_rgba("image", "x", "y", "dw", "dh", source=_source("map_image", columns="image x y dw dh"))
    for kind, pattern in HATCHES.items():  # one glyph for each: a column of patterns would cost a canvas for each cell
        made.quad(
            "left", "right", "bottom", "top", source=_source(f"hatch_{kind}", columns="left right bottom top"),
            fill_color=None, line_color=None, hatch_pattern=pattern, hatch_scale=8, hatch_weight=0.8,
        ).glyph.name = f"hatch_glyph_{kind}"  # fmt: skip
    thin = {"line_width": 1.0, "line_color": "ink", "line_alpha": 0.75}
    made.multi_line("xs", "ys", source=_source("map_lines", columns="xs ys ink dash"), line_dash="dash", **thin)
    made.line("x", "y", source=_source("map_manifold"), line_color="white", line_width=4, line_alpha=0.6)
    made.line("x", "y", source=_source("map_manifold_line"), line_color=style.LOCKED, line_width=2)
    made.text(
        "x", "y", "text", source=_source("map_labels", columns="x y text ink"), text_align="center",
        text_baseline="middle", text_font=value(FONT), text_font_size=NORMAL, text_color="ink", text_outline_color=None,
    )  # fmt: skip
    made.scatter("x", "y", source=_source("map_front", columns="x y"), size=4, fill_color="white", line_color=style.INK)
    made.scatter(
        "x", "y", source=_source("map_pins", columns="x y colour edge size"), size="size", fill_color="colour",
        line_color="edge", line_width=2,
    )  # fmt: skip
    made.scatter("x", "y", source=_source("map_cross"), marker="cross", size=16, line_width=1.2, name="map_cross_glyph")
    mapper = LinearColorMapper(palette=["#ffffff", "#000000"], low=0, high=1, name="map_colours")
    bar = ColorBar(
        color_mapper=mapper, name="map_bar", width=10, padding=6, margin=0, bar_line_color=None, background_fill_color=None,
        major_label_text_font=FONT, major_label_text_font_size=SMALL, major_tick_line_color=None, label_standoff=5,
    )  # fmt: skip
    made.add_layout(bar, "right")
    made.min_border_right = BAR  # ticks come later than the layout
    return made


def _section():
    made = _figure("section", match_aspect=True, x_range=Range1d(0, 1), y_range=Range1d(0, 1))
    made.yaxis.visible = False
    made.ygrid.visible = False
    made.multi_line("xs", "ys", source=_source("section_rest", columns="xs ys ink"), line_color="ink", line_width=1.2)
    made.patches(
        "xs", "ys", source=_source("section_wall", columns="xs ys colour alpha"), fill_color="colour", fill_alpha="alpha",
        line_color="colour", line_width=1,
    )  # fmt: skip
    made.text(
        "x", "y", "text", source=_source("section_text", columns="x y text ink"), text_font=value(FONT),
        text_font_size=SMALL, text_color="ink", text_baseline="middle",
    )  # fmt: skip
    return made


def _space():
    made = _figure("space", events=("panstart", "pan"), x_range=Range1d(0, 1), y_range=Range1d(0, 1))
    made.axis.visible = False
    made.grid.visible = False
    made.patches(
        "xs", "ys", source=_source("space_wall", columns="xs ys colour"), fill_color="colour", line_color="colour",
        line_width=0.6,
    )  # fmt: skip
    made.multi_line(
        "xs", "ys", source=_source("space_threads", columns="xs ys colour alpha width"), line_color="colour",
        line_alpha="alpha", line_width="width", line_cap="round", line_join="round",
    )  # fmt: skip
    return made


def _curve():
    made = _figure("curve", events=("tap",), x_range=Range1d(0, 1), y_range=Range1d(0, 1))
    made.patches("xs", "ys", source=_source("curve_band", columns="xs ys colour"), fill_color="colour", fill_alpha=0.25,
                 line_color=None)  # fmt: skip
    made.multi_line("xs", "ys", source=_source("curve_locked", columns="xs ys colour"), line_color="colour", line_width=1,
                    line_dash=[2, 3])  # fmt: skip
    made.multi_line("xs", "ys", source=_source("curve_lines", columns="xs ys colour width"), line_color="colour",
                    line_width="width")  # fmt: skip
    made.multi_line("xs", "ys", source=_source("curve_now", columns="xs ys ink"), line_color="ink", line_width=1,
                    line_alpha=0.5)  # fmt: skip
    made.scatter(
        "x", "y", source=_source("curve_dots", columns="x y colour"), size=7, fill_color="colour", line_color=None
    )
    return made


def _front():
    made = _figure("front", "box_select", ("tap", "selectiongeometry"), x_range=Range1d(0, 1), y_range=Range1d(0, 1))
    made.scatter("x", "y", source=_source("front_dim"), size=3, fill_color="#8d949d", fill_alpha=0.35, line_color=None)
    made.scatter("x", "y", source=_source("front_lit"), size=4, fill_color=style.SERIES[0], fill_alpha=0.75,
                 line_color=None, name="front_lit_glyph")  # fmt: skip
    made.line("x", "y", source=_source("front_line"), line_color=style.SERIES[1], line_width=2, name="front_line_glyph")
    made.scatter("x", "y", source=_source("front_pins", columns="x y colour edge"), size=10, fill_color="colour",
                 line_color="edge", line_width=2)  # fmt: skip
    return made
