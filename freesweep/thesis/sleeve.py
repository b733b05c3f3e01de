"""Figures 3-6 to 3-9, 3-11 and 3-13: the muscle of the sleeve and what it presses with (chapter 3)."""

import numpy as np
import xarray as xr

from .. import closed_form
from ..holding import blocked_force
from ..plot import style
from ..plot.curve import label_ends
from ..sleeve import Helix, constriction
from ..statics import inflate
from .drawing import Drawing, Numbers, key, line, panels
from .prototypes import PSI, SHELL_HEIGHT, SHELL_RADIUS, SLEEVE_LENGTH, sleeve_muscle

PRESSURES = (0.05e6, 0.10e6, 0.15e6)  # "three different actuation pressures" [Pa]
MEASURED = np.linspace(5.0 * PSI, 30.0 * PSI, 51)  # the range of section 3.5 [Pa]
ANGLES = np.linspace(20.0, 60.0, 61)  # [degree]
LENGTHS = np.linspace(0.05, 0.7, 27)  # [m]
RADII = np.linspace(2.5e-3, 10e-3, 26)  # [m]
LINES = [("inextensible fibers", {"linestyle": "solid"}), ("fibers extended by 0.75 %", {"linestyle": style.EXTENDED})]
COLOUR = style.SERIES[0]  # the muscle of 30 degrees


def winding() -> Helix:
    """The muscle around the shell of the experiment, as the source takes it: on the shell's outer radius."""
    return Helix.around(SHELL_RADIUS, SLEEVE_LENGTH, SHELL_HEIGHT)


def _scan(name, nodes, label, scale, heading, reach) -> Drawing:
    """Blocked force against one property of the sleeve's muscle, at three pressures."""
    figure, ax = panels(style.PAGE * 0.75, 85.0)
    numbers, drawn = Numbers(), []
    with style.context():
        found = {
            extended: xr.concat(
                [blocked_force(sleeve_muscle(extended, **{name: float(node)}), np.array(PRESSURES), x=0.0)[
                    ["force", "force_error", "status"]] for node in nodes], "node")
            for extended in (False, True)
        }  # fmt: skip
        for k, (pressure, colour) in enumerate(zip(PRESSURES, style.ramp(len(PRESSURES)))):
            for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
                state = found[extended].isel(pressure=k)
                force = state["force"].values
                (one,) = ax.plot(scale * nodes, force, color=colour, linestyle=dashes, linewidth=style.THICK,
                                 gid=f"{pressure:g} {extended}")  # fmt: skip
                rows = {("fiber_angle" if name == "angle" else name): nodes}
                numbers.add(pressure=pressure, fiber_extension=sleeve_muscle(extended).fiber_extension, **rows, force=force,
                            force_error=state["force_error"].values, status=state["status"].values)  # fmt: skip
                drawn.append(one)
        style.dress(ax, label, "blocked force [N]", heading)
        ax.margins(x=0.0)
        ax.set_ylim(*reach)
        if reach[0] < 0.0:
            ax.axhline(0.0, color=style.INK, linewidth=0.6)
            ax.axvline(closed_form.locked_angles(30, -30)[0], color=style.LOCKED, linewidth=0.9, gid="LM")
            ax.annotate(
                "54.7°",
                (54.7356, 1.0),
                xycoords=ax.get_xaxis_transform(),
                xytext=(3, -3),
                va="top",
                textcoords="offset points",
                color=style.LOCKED,
            )
        label_ends(ax, drawn[::2], [f"{pressure * 1e-3:.0f} kPa" for pressure in PRESSURES])
    key(figure, LINES)
    note = "The muscle of the sleeve, one property varied; the source does not print its pressures."
    return Drawing(figure, numbers, note)


def figure_3_6() -> Drawing:
    """Blocked force against fiber angle."""
    return _scan("angle", ANGLES, "fiber angle [degree]", 1.0, "Blocked force and fiber angle", (-20.0, None))


def figure_3_7() -> Drawing:
    """Blocked force against length."""
    return _scan("length", LENGTHS, "actuator length [mm]", 1e3, "Blocked force and length", (0.0, None))


def figure_3_8() -> Drawing:
    """Blocked force against radius."""
    return _scan("radius", RADII, "inner radius [mm]", 1e3, "Blocked force and radius", (0.0, None))


def _along_pressure(solve, variable, label, heading, reach=(None, None), lines=LINES):
    figure, ax = panels(style.PAGE * 0.75, 85.0)
    numbers = Numbers()
    with style.context():
        for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
            tube = sleeve_muscle(extended)
            of = {"fiber_extension": tube.fiber_extension}
            line(ax, numbers, solve(tube), variable, of=of, color=COLOUR, linestyle=dashes)
        style.dress(ax, "pressure [kPa]", label, heading)
        ax.margins(x=0.0)
        ax.set_ylim(*reach)
    key(figure, lines)
    return figure, numbers


def figure_3_9() -> Drawing:
    """Length of the sleeve's muscle under 5 to 30 psi."""
    figure, numbers = _along_pressure(
        lambda tube: inflate(tube, MEASURED, x=0.0), "deformed_length", "length [mm]", "Muscle of the sleeve, 640 mm"
    )
    note = "Rubber, not printed, is that of the 30 degree muscle in Table 1."
    return Drawing(figure, numbers, note)


def figure_3_11() -> Drawing:
    """Blocked force of the sleeve's muscle."""
    figure, numbers = _along_pressure(
        lambda tube: blocked_force(tube, MEASURED, x=0.0), "force", "blocked force [N]", "Muscle of the sleeve, length held",
        (0.0, None),
    )  # fmt: skip
    return Drawing(figure, numbers, "5 to 30 psi; the extension of 0.75 % is the source's.")


def figure_3_13() -> Drawing:
    """Load of the sleeve on its shell, per length of hoop (Eq. 3.4) and of the muscle."""
    figure, ax = panels(style.PAGE * 0.75, 90.0)
    numbers, drawn, helix = Numbers(), [], winding()
    with style.context():
        for extended, dashes in ((False, "solid"), (True, style.EXTENDED)):
            state = constriction(sleeve_muscle(extended), helix, MEASURED)
            for variable, colour, width in (("hoop_load", style.SERIES[0], 2.4), ("line_load", style.SERIES[4], 1.0)):
                values, extension = state[variable].values, sleeve_muscle(extended).fiber_extension
                (one,) = ax.plot(1e-3 * MEASURED, values, color=colour, linestyle=dashes, linewidth=width,
                                 gid=f"{variable} {extension:g}")  # fmt: skip
                drawn.append(one)
                numbers.add(quantity=variable, fiber_extension=extension, pressure=MEASURED, line_load=values,
                            line_load_error=state[f"{variable}_error"].values)  # fmt: skip
        style.dress(
            ax,
            "pressure [kPa]",
            "normal force per length of hoop or muscle [N/m]",
            f"Sleeve: {helix.turns:.2f} turns at {helix.angle:.1f}°",
        )
        ax.margins(x=0.0)
        ax.set_ylim(0.0, None)
        label_ends(ax, drawn[:2], ["hoop (Eq. 3.4)", "muscle"])
    key(figure, LINES)
    note = (
        "The string model. The source measured loads lower by almost half: a side load reduces what a blocked "
        "muscle pulls with, and no model here knows it."
    )
    return Drawing(figure, numbers, note)
