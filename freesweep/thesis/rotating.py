"""Figures 2-10 and 2-11: the rotating prototypes A, B and C under pressure (section 2.4.1)."""

import numpy as np

from ..plot import style
from ..plot.curve import label_ends
from ..statics import inflate
from .drawing import Drawing, Numbers, key, line, panels
from .locked import profile_rows, shapes
from .prototypes import ENERGIES, ROTATING, rotating

COLOURS = dict(zip(ROTATING, style.SERIES[3:]))
PRESSURES = np.linspace(0.0, 0.2e6, 81)  # [Pa]
SHOWN = (0.0927e6, 0.138e6)  # of Figure 2-11 [Pa]: its caption says 0.927 MPa, read as 0.0927
ENERGY_LINES = [(f"strain energy: {name}", {"linestyle": style.ENERGY[name]}) for name in ENERGIES]


def figure_2_10() -> Drawing:
    """Length and rotation of the three prototypes under pressure, with both strain energies."""
    figure, axes = panels(style.PAGE, 85.0, 1, 2)
    numbers = Numbers()
    with style.context():
        drawn = {"deformed_length": [], "rotation": []}
        for name, colour in COLOURS.items():
            for energy in ENERGIES:
                state = inflate(rotating(name, energy), PRESSURES, x=0.0)
                of = {"prototype": name, "energy": energy}
                how = {"color": colour, "linestyle": style.ENERGY[energy]}
                for ax, variable in zip(axes, drawn):
                    rows = numbers if variable == "deformed_length" else Numbers()
                    drawn[variable].append(line(ax, rows, state, variable, of=of, **how))
                for row, rotation in zip(numbers.rows[-len(PRESSURES) :], state["rotation"].values):
                    row["rotation"] = rotation
        style.dress(axes[0], "pressure [kPa]", "length [mm]", "(a) length")
        style.dress(axes[1], "pressure [kPa]", "rotation of the free end [degree]", "(b) rotation")
        for ax, lines in zip(axes, drawn.values()):
            ax.margins(x=0.0)
            label_ends(ax, lines[1::2], list(COLOURS))
    words = ", ".join(f"{name} {a:g}°/{b:g}° {1e3 * length:.0f} mm" for name, (a, b, length) in ROTATING.items())
    key(figure, ENERGY_LINES)
    note = f"{words}. Rubber: C10 0.17, C01 0.08 MPa, which the source prints for the rotator only."
    return Drawing(figure, numbers, note)


def figure_2_11() -> Drawing:
    """Prototype A undeformed, near its largest length, and shorter again."""
    tube, numbers = rotating("A", "principal"), Numbers()
    states = [inflate(tube, pressure) for pressure in SHOWN]
    for pressure, state in zip(SHOWN, states):
        profile_rows(numbers, state, pressure=pressure)
    figure = shapes(tube, states, [f"{pressure * 1e-3:.1f} kPa" for pressure in SHOWN])
    note = "Strain energy as printed (principal). The caption's 0.927 MPa is read as 0.0927 MPa."
    return Drawing(figure, numbers, note)
