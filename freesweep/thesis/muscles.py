"""Figures 2-5 and 2-7 to 2-9 with Table 1: McKibben muscles (section 2.3)."""

import numpy as np

from ..description.elastomer import NeoHookean
from ..holding import blocked_force
from ..plot import style
from ..plot.curve import label_ends
from ..statics import inflate
from .drawing import Drawing, Numbers, key, line, panels
from .prototypes import MUSCLES, RADIUS, TABLE_1, WALL, muscle, source_tube

COLOURS = dict(zip(MUSCLES, style.SERIES))
PRESSURES = np.linspace(0.0, 0.14e6, 57)  # [Pa]
BLOCKED = np.linspace(2e3, 0.14e6, 70)
HELD = (0.03e6, 0.05e6, 0.075e6, 0.10e6)
STROKE_PRESSURE = 0.1e6  # [Pa] of Figure 2-5
LINES = [("inextensible fibers", {"linestyle": "solid"}), ("with fiber extension", {"linestyle": style.EXTENDED})]


def matched_profiles(angle):
    """Two muscles of one angle at one stroke: (name, pressure [Pa], state), the rubber of Table 1 and one without C01."""
    sizes = {"alpha": angle, "beta": -angle, "length": 0.192, "radius": RADIUS, "wall": WALL}
    first = source_tube(**sizes, material=TABLE_1)
    other = source_tube(**sizes, material=NeoHookean(TABLE_1.c10 + TABLE_1.c01))
    state = inflate(first, STROKE_PRESSURE)
    wanted = float(state["deformed_length"])
    low, high = 0.0, 2.0 * STROKE_PRESSURE
    for _ in range(40):  # the length falls steadily with pressure
        pressures = np.linspace(low, high, 9)
        lengths = inflate(other, pressures, x=0.0)["deformed_length"].values
        k = min(int(np.searchsorted(-lengths, -wanted)), 8)
        low, high = pressures[max(k - 1, 0)], pressures[k]
        if high - low < 1e-6 * STROKE_PRESSURE:
            break
    pressure = 0.5 * (low + high)
    return [("Mooney-Rivlin of Table 1", STROKE_PRESSURE, state), ("neo-Hookean", pressure, inflate(other, pressure))]


def figure_2_5() -> Drawing:
    """Half profiles of muscles of 15 and 25 degrees at one stroke, for two rubbers."""
    figure, axes = panels(style.PAGE, 62.0, 1, 2, sharey=True)
    numbers = Numbers()
    with style.context():
        for ax, angle in zip(axes, (15, 25)):
            for (name, pressure, state), dashes, width in zip(
                matched_profiles(angle), ("solid", (0, (1.0, 1.3))), (3.0, 1.2)
            ):
                half = state["x"].values <= 0.5 * 0.192
                z, r = state["axial_position"].values[half] * 1e3, state["deformed_radius"].values[half] * 1e3
                colour = style.AFTER[1] if width > 2.0 else style.AFTER[0]
                ax.plot(z, r, color=colour, linestyle=dashes, linewidth=width, gid=f"{angle} {name}",
                        label=f"{name}, {pressure * 1e-3:.1f} kPa")  # fmt: skip
                numbers.add(
                    fiber_angle=angle, rubber=name, pressure=pressure, axial_position=z * 1e-3, deformed_radius=r * 1e-3
                )
            ax.plot([0.0, 96.0], [4.76, 4.76], color=style.BEFORE[0], linewidth=style.THIN, label="undeformed")
            stroke = 192.0 - 2.0 * z[-1]
            style.dress(
                ax,
                "axial position, to half length [mm]",
                "radius [mm]",
                f"({'ab'[angle == 25]}) ±{angle}°, {stroke:.1f} mm shorter",
            )
            ax.legend(loc="lower right", bbox_to_anchor=(1.0, 0.12))
            ax.set(ylim=(0.0, None), xlim=(0.0, 96.0))
        axes[1].set_ylabel("")
    note = (
        "The muscles and the profiles of Shan et al. are not printed in the source. Shown: the prototypes' "
        "section, 192 mm long, at the stroke of 0.1 MPa, reached with two rubbers: the profile hardly knows "
        "the rubber, the pressure does."
    )
    return Drawing(figure, numbers, note)


def figure_2_7() -> Drawing:
    """Length of the three muscles under pressure, and Table 1."""
    figure, (ax, side) = panels(style.PAGE, 85.0, 1, 2, width_ratios=(2.6, 1.0))
    numbers, drawn = Numbers(), []
    with style.context():
        for angle, colour in COLOURS.items():
            for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
                # as the pressure falls to 0, extended fibers leave a swollen tube; at 0 it is undeformed
                state = inflate(muscle(angle, extended), PRESSURES[1:] if extended else PRESSURES, x=0.0)
                of = {"fiber_angle": angle, "fiber_extension": muscle(angle, extended).fiber_extension}
                drawn.append(line(ax, numbers, state, "deformed_length", of=of, color=colour, linestyle=dashes))
        style.dress(ax, "pressure [kPa]", "length [mm]", "McKibben muscles")
        ax.margins(x=0.0)
        label_ends(ax, drawn[::2], [f"±{angle}°" for angle in COLOURS])
        _table_1(side)
    key(figure, LINES)
    note = "Rubber and fiber extension as the source fitted them to each prototype."
    return Drawing(figure, numbers, note)


def _table_1(ax):
    """The constants, as a table in the colours of the lines."""
    ax.set_axis_off()
    ax.set_title("Table 1", loc="left", fontsize=style.NORMAL + 1.0, fontweight="bold")
    heads = ("fiber\nangle", "$C_{10}$\n[MPa]", "$C_{01}$\n[MPa]", "exten-\nsion")
    for k, head in enumerate(heads):
        ax.text(0.08 + 0.3 * k, 0.93, head, ha="center", va="top", color=style.QUIET, transform=ax.transAxes)
    for row, (angle, (_, c10, c01, extension)) in enumerate(MUSCLES.items()):
        words = (f"±{angle}°", f"{c10 * 1e-6:.2f}", f"{c01 * 1e-6:.2f}", f"{100.0 * (extension - 1.0):.2f} %")
        for k, word in enumerate(words):
            ax.text(
                0.08 + 0.3 * k,
                0.72 - 0.1 * row,
                word,
                ha="center",
                color=style.legible(COLOURS[angle]),
                transform=ax.transAxes,
            )


def table_1_rows() -> Numbers:
    """Table 1 with the fiber extension of section 2.3.4."""
    numbers = Numbers()
    for angle, (_, c10, c01, extension) in MUSCLES.items():
        numbers.add(fiber_angle=float(angle), c10=c10, c01=c01, fiber_extension=extension)
    return numbers


def figure_2_8() -> Drawing:
    """Blocked force of the three muscles, with and without fiber extension."""
    figure, ax = panels(style.PAGE * 0.75, 90.0)
    numbers, drawn = Numbers(), []
    with style.context():
        for angle, colour in COLOURS.items():
            for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
                state = blocked_force(muscle(angle, extended), BLOCKED, x=0.0)
                of = {"fiber_angle": angle, "fiber_extension": muscle(angle, extended).fiber_extension}
                drawn.append(line(ax, numbers, state, "force", of=of, color=colour, linestyle=dashes))
        style.dress(ax, "pressure [kPa]", "blocked force [N]", "Force that holds the undeformed length")
        ax.set(xlim=(0.0, 140.0), ylim=(0.0, None))
        label_ends(ax, drawn[::2], [f"±{angle}°" for angle in COLOURS])
    key(figure, LINES)
    note = "Dotted lines begin where the muscle, lengthened by its slack fibers, pulls at all."
    return Drawing(figure, numbers, note)


def figure_2_9() -> Drawing:
    """Force against length of the three muscles at four pressures."""
    figure, axes = panels(style.PAGE, 75.0, 1, 3, sharey=True)
    numbers = Numbers()
    with style.context():
        for ax, letter, angle in zip(axes, "abc", MUSCLES):
            drawn = []
            for pressure, colour in zip(HELD, style.ramp(len(HELD))):
                for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
                    tube = muscle(angle, extended)
                    free = float(inflate(tube, pressure, x=0.0)["deformed_length"])
                    state = blocked_force(tube, pressure, np.linspace(free, max(tube.length, free + 1e-4), 25), x=0.0)
                    of = {"fiber_angle": angle, "fiber_extension": tube.fiber_extension, "pressure": pressure}
                    how = {"color": colour, "linestyle": dashes}
                    drawn.append(line(ax, numbers, state, "force", "deformed_length", of=of, **how))
            style.dress(ax, "length [mm]", "force [N]" if ax is axes[0] else "", f"({letter}) ±{angle}°")
            ax.set_ylim(0.0, 37.0)
            ax.set_xlim(None, 1e3 * muscle(angle).length)
        label_ends(axes[2], drawn[::2], [f"{pressure * 1e-3:g} kPa" for pressure in HELD])
    key(figure, LINES)
    note = "Lines begin at the free length and end at the undeformed one: the blocked force."
    return Drawing(figure, numbers, note)
