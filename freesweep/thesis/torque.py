"""Figures 2-12 and 2-13: blocked torque of prototypes B and C, and what holding the rotation does to B (section 2.4.2)."""

import numpy as np
import xarray as xr

from .. import closed_form
from ..holding import blocked_torque, corrected_torque
from ..plot import style
from .drawing import Drawing, Numbers, key, line, panels
from .locked import profile_rows, shapes
from .prototypes import ENERGIES, RADIUS, ROTATING, RUBBER, WALL, rotating
from .rotating import COLOURS

PRESSURES = np.linspace(5e3, 0.35e6, 70)  # [Pa]
CORRECTED = np.linspace(5e3, 0.14e6, 28)
TO = {"B": 0.35e6, "C": 0.14e6}  # largest pressure drawn [Pa]
HELD, BUCKLED = 0.1e6, 0.25e6  # pressures of Figure 2-13 [Pa]


def critical(name, energy):
    """Pressure [Pa] from which the held cylinder is unstable."""
    alpha, beta, length = ROTATING[name]
    return float(closed_form.critical_pressure(alpha, beta, length, RADIUS, WALL, RUBBER.c10, RUBBER.c01, energy))


def figure_2_12() -> Drawing:
    """Blocked torque of B and C: Eq. 2.20, the source's correction, and the exact held states."""
    figure, axes = panels(style.PAGE, 85.0, 1, 2)
    numbers = Numbers()
    with style.context():
        for ax, letter, name in zip(axes, "ab", TO):
            inside = TO[name] >= PRESSURES
            alpha, beta, _ = ROTATING[name]
            ideal = closed_form.blocked_torque(alpha, beta, RADIUS, PRESSURES[inside])
            ax.plot(
                1e-3 * PRESSURES[inside], 1e3 * ideal, color=style.INK, linewidth=0.6, zorder=3, gid=f"{name} Eq. 2.20"
            )
            numbers.add(prototype=name, curve="Eq. 2.20", pressure=PRESSURES[inside], torque=ideal)
            corrected = corrected_torque(rotating(name), CORRECTED)
            ax.plot(1e-3 * CORRECTED, 1e3 * corrected, color=style.INK, linestyle=(0, (5, 1.2, 1, 1.2)), linewidth=1.2,
                    gid=f"{name} corrected")  # fmt: skip
            numbers.add(prototype=name, curve="corrected", pressure=CORRECTED, torque=corrected)
            for energy in ENERGIES:
                edge = critical(name, energy)
                state = _branch(name, energy, PRESSURES[inside], edge)
                of = {"prototype": name, "curve": "exact", "energy": energy}
                how = {"color": COLOURS[name], "linestyle": style.ENERGY[energy], "linewidth": 2.2}
                line(ax, numbers, state, "torque", of=of, **how)
                if edge < TO[name]:
                    ax.axvline(1e-3 * edge, color=COLOURS[name], linewidth=0.5, linestyle=style.ENERGY[energy])
            style.dress(
                ax, "pressure [kPa]", "blocked torque [mN m]", f"({letter}) prototype {name}: {alpha:g}°/{beta:g}°"
            )
            ax.set(xlim=(0.0, 1e-3 * TO[name]), ylim=(0.0, None))
    key(figure, [
        ("Eq. 2.20", {"linewidth": 0.6}),
        ("corrected, Eqs. 2.21 and 2.22", {"linestyle": (0, (5, 1.2, 1, 1.2)), "linewidth": 1.2}),
        ("exact stable state, principal", {"linestyle": style.ENERGY["principal"], "linewidth": 2.2}),
        ("exact stable state, full", {"linestyle": style.ENERGY["full"], "linewidth": 2.2}),
        ("critical pressure", {"marker": "|", "linestyle": "none", "markersize": 9.0, "markeredgewidth": 0.5}),
    ], 3)  # fmt: skip
    note = (
        "The held cylinder follows Eq. 2.20 exactly up to the critical pressure (vertical lines); beyond it "
        "the stable tube is shorter and turns stronger."
    )
    return Drawing(figure, numbers, note)


def _branch(name, energy, pressures, edge):
    """The stable held state at each pressure: the cylinder up to the critical pressure, the buckled tube beyond."""
    tube = rotating(name, energy)
    parts = [blocked_torque(tube, pressures[pressures <= edge], x=0.0)] if np.any(pressures <= edge) else []
    if np.any(pressures > edge):
        parts.append(blocked_torque(tube, pressures[pressures > edge], buckled=True, x=0.0))
    return xr.concat(
        parts, "pressure", combine_attrs="drop", data_vars="all", coords="minimal", compat="equals", join="outer"
    )


def figure_2_13() -> Drawing:
    """Prototype B with its rotation held: straight at 0.1 MPa, shorter beyond the critical pressure."""
    tube, numbers = rotating("B", "full"), Numbers()
    states = [blocked_torque(tube, HELD), blocked_torque(tube, BUCKLED, buckled=True)]
    titles = []
    for pressure, state in zip((HELD, BUCKLED), states):
        titles.append(f"held, {pressure * 1e-3:.0f} kPa, {float(state['torque']) * 1e3:.0f} mN m")
        profile_rows(numbers, state, pressure=pressure, torque=float(state["torque"]))
    figure = shapes(tube, states, titles)
    note = (
        "Strain energy full. Two families that are both taut leave a held cylinder as it is up to 222 kPa; "
        "the contraction that the source shows at lower pressures needs a family that slips or slackens."
    )
    return Drawing(figure, numbers, note)
