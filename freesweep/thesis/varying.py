"""Figures 2-14 to 2-17: actuators whose fiber angles or wall vary along the tube (section 2.5)."""

import numpy as np

from ..plot import style
from ..plot.curve import label_ends
from ..plot.tubes import shape_plot, size_of
from ..statics import inflate, lock
from .drawing import Drawing, Numbers, key, line, panels
from .locked import profile_rows, shapes
from .prototypes import ENERGIES, found_rotator, rotator, two_walls
from .rotating import ENERGY_LINES

PRESSURE = 0.14e6  # [Pa]
PRESSURES = np.linspace(0.0, PRESSURE, 57)
PROFILE_COLOURS = {"switch": style.SERIES[0], "line": style.SERIES[2]}
STEPS = (0.1e6, 0.15e6, 0.3e6)  # of Figure 2-17 [Pa]


def figure_2_14() -> Drawing:
    """The rotator before and after deformation, and its fiber angles along the tube."""
    tube, numbers = rotator("switch", "principal"), Numbers()
    state = inflate(tube, PRESSURE)
    width, height = size_of(tube, state)
    figure = style.new_figure(width, height + 60.0)
    with style.context():
        top, bottom = figure.subplots(2, 1, height_ratios=(height, 60.0))
        shape_plot(tube, state, titles=[f"{PRESSURE * 1e-3:.0f} kPa"], ax=top)
        share = np.linspace(0.0, 1.0, 201)
        for name, angles, colour in zip(("alpha", "beta"), tube.angles(share), style.FAMILIES):
            bottom.plot(200.0 * share, angles, color=colour, linewidth=style.THICK, gid=name)
        drawn = bottom.lines[-2:]
        style.dress(
            bottom, "distance from the fixed end before deformation [mm]", "fiber angle [degree]", "(b) fiber angles"
        )
        top.set_title("(a)", loc="left", fontsize=style.NORMAL + 1.0, fontweight="bold")
        bottom.margins(x=0.0)
        label_ends(bottom, drawn, [r"$\alpha$", r"$\beta$"])
    profile_rows(numbers, state, pressure=PRESSURE)
    for row, alpha, beta in zip(numbers.rows, *tube.angles(state["x"].values / tube.length)):
        row |= {"alpha": alpha, "beta": beta}
    note = (
        "The profile between the ends is not printed: a tanh of an eighth of the length. Strain energy as "
        "printed (principal). The caption's beta of +67.5 degrees is read as -67.5, as in the text."
    )
    return Drawing(figure, numbers, note)


def figure_2_15() -> Drawing:
    """Meridian of the rotator at 0.14 MPa with both strain energies."""
    figure, ax = panels(style.PAGE, 62.0)
    numbers = Numbers()
    with style.context():
        ax.plot([0.0, 200.0], [4.76, 4.76], color=style.BEFORE[0], linewidth=1.0, gid="undeformed")
        for energy in ENERGIES:
            state = inflate(rotator("switch", energy), PRESSURE)
            ax.plot(1e3 * state["axial_position"].values, 1e3 * state["deformed_radius"].values, color=style.AFTER[0],
                    linewidth=style.THICK, linestyle=style.ENERGY[energy], gid=energy)  # fmt: skip
            profile_rows(numbers, state, energy=energy, pressure=PRESSURE)
        style.dress(ax, "axial position [mm]", "radius [mm]", f"Purely rotating actuator at {PRESSURE * 1e-3:.0f} kPa")
        ax.set(ylim=(0.0, None), xlim=(0.0, 205.0))
    red = {"color": style.AFTER[0]}
    key(figure, [("undeformed", {"color": style.BEFORE[0], "linewidth": 1.0}),
                 *((words, {**how, **red}) for words, how in ENERGY_LINES)])  # fmt: skip
    return Drawing(figure, numbers, "One half swells and shortens, the other thins and lengthens.")


def figure_2_16() -> Drawing:
    """Rotation of the rotator under pressure, for two courses of its angles and both strain energies."""
    figure, ax = panels(style.PAGE * 0.75, 85.0)
    numbers, drawn = Numbers(), []
    with style.context():
        for profile, colour in PROFILE_COLOURS.items():
            for energy in ENERGIES:
                state = inflate(rotator(profile, energy), PRESSURES, x=0.0)
                of = {"profile": profile, "energy": energy}
                drawn.append(line(ax, numbers, state, "rotation", of=of, color=colour, linestyle=style.ENERGY[energy]))
                for row, length in zip(numbers.rows[-len(PRESSURES) :], state["deformed_length"].values):
                    row["deformed_length"] = length
        style.dress(ax, "pressure [kPa]", "rotation of the free end [degree]", "Purely rotating actuator")
        ax.margins(x=0.0)
        label_ends(ax, drawn[::2], ["angles switch\nhalf way", "angles change\nevenly"])
    key(figure, ENERGY_LINES)
    note = "The course of the angles between the ends is not printed; it decides the rotation."
    return Drawing(figure, numbers, note)


def figure_2_16_found() -> Drawing:
    """A rotator that was searched for and keeps its length at every pressure, beside the source's switch of angles."""
    figure, axes = panels(style.PAGE, 85.0, 1, 3)
    numbers, share = Numbers(), np.linspace(0.0, 1.0, 201)
    tubes = {"found": (found_rotator(), style.SERIES[1]), "switch": (rotator("switch", "full"), style.SERIES[0])}
    with style.context():
        for name, (tube, colour) in tubes.items():
            state = inflate(tube, PRESSURES, x=0.0)
            state["length_change"] = state["deformed_length"] - tube.length
            state["length_change_error"] = state["deformed_length_error"]
            numbers.add(pressure=PRESSURES, tube=name, **{
                one: state[one].values for of in ("rotation", "length_change") for one in (of, f"{of}_error")
            }, status=state["status"].values)  # fmt: skip
            how = {"color": colour, "linewidth": style.THICK}
            axes[0].plot(1e-3 * PRESSURES, state["rotation"].values, gid=f"{name} rotation", **how)
            axes[1].plot(1e-3 * PRESSURES, 1e3 * state["length_change"].values, gid=f"{name} length_change", **how)
            for family, angles, dashes in zip(("alpha", "beta"), tube.angles(share), ("-", "--")):
                axes[2].plot(1e3 * tube.length * share, angles, linestyle=dashes, gid=f"{name} {family}", **how)
        style.dress(axes[0], "pressure [kPa]", "rotation of the free end [degree]", "Rotation")
        style.dress(axes[1], "pressure [kPa]", "change of length [mm]", "Length")
        style.dress(
            axes[2], "distance from the fixed end [mm]", "fiber angle [degree]", r"$\alpha$ (full), $\beta$ (dashed)"
        )
        for ax in axes:
            ax.margins(x=0.0)
    key(
        figure,
        [
            ("found by freesweep design", {"color": style.SERIES[1]}),
            ("the source's switch", {"color": style.SERIES[0]}),
        ],
    )
    note = (
        "Asked for: as much rotation as can be at 0.14 MPa with no more than 0.1 mm of length change on the way, for the"
        " strain energy of the whole tensor; angles linear between four places, from sweeps/wishes/pure-rotator.toml."
    )
    return Drawing(figure, numbers, note)


def figure_2_17() -> Drawing:
    """The muscle of 20 degrees whose far half has twice the wall: intermediate shapes and the locked one."""
    tube, numbers = two_walls("principal"), Numbers()
    states = [inflate(tube, pressure) for pressure in STEPS] + [lock(tube)]
    titles = [*(f"{pressure * 1e-3:.0f} kPa" for pressure in STEPS), "locked"]
    for title, state in zip(titles, states):
        profile_rows(numbers, state, load=title)
    figure = shapes(tube, states, titles)
    note = (
        "Wall 1.59 mm in the left half, twice that in the right; length and rubber, not printed, are those of "
        "the 30 degree muscle. The locked shape does not see the wall."
    )
    return Drawing(figure, numbers, note)
