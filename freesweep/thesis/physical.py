"""Figures 2-12 and 2-13 with the physical tube: thick wall, threads at its outer radius that cannot push (section 2.4.2).

Blocked torque is found as the torque under which the free end turns back: free states, which vectors solve in no time.
Beyond 105 kPa that torque turns back before the end does; there only ``freesweep.blocked_torque`` finds B held.
"""

import functools

import numpy as np

from .. import closed_form
from ..description.tube_model import MODELS
from ..holding import blocked_torque
from ..plot import style
from ..query import reference
from ..query.exact import Tubes, solve
from ..statics import inflate
from .claims.claim import Found, holds
from .drawing import Drawing, Numbers, key, panels
from .locked import profile_rows, shapes
from .prototypes import RADIUS, ROTATING, TABLE_1, WALL, physical_rotating, rotating
from .rotating import COLOURS

PRESSURES = np.linspace(5e3, 100e3, 20)  # [Pa]
HELD = 0.1e6  # of Figure 2-13 [Pa]
# secants at each pressure; the first, of the torque; degrees that are as good as none
STEPS, FIRST, CLOSE = 20, 0.01, 1e-5


def _free(name, pressure, torque):
    """Rotation [degree] and length [m] of the free end under a torque [N m]; NaN where vectors find no state."""
    alpha, beta, length = ROTATING[name]
    point = dict.fromkeys(reference.COLUMNS, 0.0) | {
        "alpha": alpha, "beta": beta, "length": length, "radius": RADIUS, "wall": WALL, "fiber_radius": RADIUS + WALL,
        "fiber_extension": 1.0, "c10": TABLE_1.c10, "c01": TABLE_1.c01, "pressure": pressure, "torque": torque,
    }  # fmt: skip
    points = np.array([list(point.values())])
    found = solve(reference.LOADED, points, Tubes("full", MODELS["physical"]), 1e-6, thorough=False)
    return found["rotation"].item(), found["deformed_length"].item()


@functools.cache
def held(name):
    """``(torque, length)`` along PRESSURES [N m, m] at which the free end of B or C has not turned; where both families
    pull, the closed form.
    """
    torque = closed_form.blocked_torque(*ROTATING[name][:2], RADIUS + WALL, PRESSURES, fibers="loose")
    length = np.full(len(PRESSURES), ROTATING[name][2])
    if np.all(np.isfinite(torque)):
        return torque, length
    length[:] = np.nan
    shares = [0.08, 0.08]  # of the pressure
    for k, pressure in enumerate(PRESSURES):
        scale = np.pi * (RADIUS + WALL) ** 3 * pressure
        share = 2.0 * shares[-1] - shares[-2]
        before, here = share * scale, (1.0 + FIRST) * share * scale
        turned, (rotation, long) = _free(name, pressure, before)[0], _free(name, pressure, here)
        for _ in range(STEPS):
            if abs(rotation) < CLOSE:
                torque[k], length[k] = here, long
                shares.append(here / scale)
                break
            if np.isfinite(rotation) and rotation != turned:
                new = here - rotation * (here - before) / (rotation - turned)
                before, turned, here = here, rotation, new
            else:  # too far: no state there
                here = 0.5 * (before + here)
            rotation, long = _free(name, pressure, here)
    return torque, length


def _ideal(name):
    return closed_form.blocked_torque(*ROTATING[name][:2], RADIUS, PRESSURES)


def figure_2_12() -> Drawing:
    """Blocked torque of B and C once threads cannot push: Eq. 2.20, the source's tube, and the physical one."""
    figure, axes = panels(style.PAGE, 85.0, 1, 2)
    numbers = Numbers()
    with style.context():
        for ax, letter, name in zip(axes, "ab", "BC"):
            torque, length = held(name)
            ax.plot(1e-3 * PRESSURES, 1e3 * _ideal(name), color=style.INK, linewidth=0.6,
                    gid=f"{name} Eq. 2.20")  # fmt: skip
            ax.plot(1e-3 * PRESSURES, 1e3 * torque, color=COLOURS[name], linewidth=2.2,
                    gid=f"{name} physical")  # fmt: skip
            numbers.add(prototype=name, curve="Eq. 2.20", pressure=PRESSURES, torque=_ideal(name))
            numbers.add(
                prototype=name, curve="physical", pressure=PRESSURES, torque=torque,
                deformed_length=length,
            )  # fmt: skip
            alpha, beta, _ = ROTATING[name]
            words = f"({letter}) prototype {name}: {alpha:g}°/{beta:g}°"
            style.dress(ax, "pressure [kPa]", "blocked torque [mN m]", words)
            ax.set(xlim=(0.0, 1e-3 * PRESSURES[-1]), ylim=(0.0, None))
    key(figure, [
        ("Eq. 2.20: the source's tube, up to its critical pressure", {"linewidth": 0.6}),
        ("physical tube: thick wall, loose threads outside", {"linewidth": 2.2}),
    ], 2)  # fmt: skip
    note = (
        "Rubber of Table 1 (C10 0.11, C01 0.06 MPa). The straight family of B is slack at first and the tube shortens: "
        "little torque, then more than Eq. 2.20, without fiber extension and without superposition. Both families of C "
        "pull: Eq. 2.20 at the radius of the threads, 2.37 times that at the inner radius."
    )
    return Drawing(figure, numbers, note)


def figure_2_13() -> Drawing:
    """Prototype B with its rotation held at 0.1 MPa: the source's tube stays as it is, the physical one contracts."""
    tube, numbers = physical_rotating("B"), Numbers()
    torque = np.interp(HELD, PRESSURES, held("B")[0])
    states = [blocked_torque(rotating("B", "full"), HELD), inflate(tube, HELD, torque=float(torque), accuracy=1e-4)]
    torques = float(states[0]["torque"]), float(torque)
    titles = []
    for model, state, turned in zip(("source", "physical"), states, torques):
        titles.append(f"{model}, {HELD * 1e-3:.0f} kPa, {turned * 1e3:.0f} mN m")
        profile_rows(numbers, state, model=model, pressure=HELD, torque=turned)
    note = (
        "Strain energy full; physical: the rubber of Table 1. Drawn are the surfaces of the fibers: the source's "
        "lie inside the wall, the physical tube's outside. Held, the straight family slackens and B shortens."
    )
    return Drawing(shapes(tube, states, titles), numbers, note)


def _ratios(name, pressures=(30e3, 50e3, 100e3)):
    return np.interp(pressures, PRESSURES, held(name)[0] / _ideal(name))


def _words(ratios):
    return ", ".join(f"{ratio:.2f}" for ratio in ratios) + " times Eq. 2.20"


def equation_2_20():
    """Whether Eq. 2.20 holds, at 30, 50, 100 kPa."""
    words = f"B {_words(_ratios('B'))} at 30, 50, 100 kPa; C {_words(_ratios('C')[:1])}, as its threads lie outside"
    return Found(words, holds(np.allclose(_ratios("B"), 1.0)))


def blocked_deformation():
    """Whether B shortens and exceeds Eq. 2.20."""
    torque, length = held("B")
    ratio = torque / _ideal("B")
    above = PRESSURES[np.flatnonzero(ratio > 1.0)[0]] if np.any(ratio > 1.0) else np.nan
    less = 100.0 * (1.0 - np.interp(HELD, PRESSURES, length) / ROTATING["B"][2])
    words = f"{less:.1f} % shorter at 100 kPa, more torque than Eq. 2.20 from {1e-3 * above:.0f} kPa on"
    return Found(words, holds(less > 0.0 and np.isfinite(above)))


def no_torque_at_first():
    """Whether B has nearly no torque at 0.03 MPa, fibers not extended."""
    share = float(_ratios("B")[0])
    return Found(f"{share:.2f} times Eq. 2.20 at 30 kPa without any extension: threads are slack", holds(share < 0.3))


def seen_in_c():
    """Whether the torque of C exceeds Eq. 2.20."""
    ratios = _ratios("C")
    return Found(f"{_words(ratios)} at 30, 50, 100 kPa", holds(np.all(ratios > 1.0)))
