"""Claims on the sleeve (chapter 3)."""

import numpy as np

from ...holding import blocked_force
from ...sleeve import constriction
from ...statics import inflate
from ..prototypes import PSI, SLEEVE_LENGTH, sleeve_muscle
from ..sleeve import winding
from .claim import PARTLY, UNKNOWN, Claim, Found, holds

HELD = 0.1e6  # [Pa]
RANGE = np.array([5.0, 30.0]) * PSI  # [Pa]


def _force(energy, extended=False, pressure=HELD, **what):
    return float(blocked_force(sleeve_muscle(extended, energy=energy, **what), pressure, x=0.0)["force"])


def zero(energy):
    """Fiber angle at which the blocked force vanishes."""
    angles = np.array([54.0, 54.5, 55.0, 55.5])
    force = [_force(energy, angle=float(angle)) for angle in angles]
    at = float(np.interp(0.0, force[::-1], angles[::-1]))
    return Found(f"zero at {at:.1f}°", holds(abs(at - 54.7356) < 0.05))


def exponential(energy):
    """Factor by which the force falls over 5 degrees, at both ends of the range."""
    first, last = (_force(energy, angle=a + 5.0) / _force(energy, angle=a) for a in (20.0, 45.0))
    words = f"times {first:.2f} from 20° to 25°, times {last:.2f} from 45° to 50°"
    return Found(words, holds(abs(first - last) < 0.05))


def length(energy):
    """Blocked force at two lengths, with and without fiber extension."""
    gaps = [
        100.0 * (_force(energy, e, length=0.1) / _force(energy, e, length=SLEEVE_LENGTH) - 1.0) for e in (False, True)
    ]
    words = f"100 mm against 640 mm: {abs(gaps[0]):.1g} % different, with fiber extension {abs(gaps[1]):.1f} %"
    return Found(words, holds(abs(gaps[0]) < 1e-3 and abs(gaps[1]) < 3.0))


def radius(energy):
    """Exponent of the force in the radius."""
    exponents = [
        np.log(_force(energy, e, radius=6e-3) / _force(energy, e, radius=4e-3)) / np.log(1.5) for e in (False, True)
    ]
    words = f"as radius to the power {exponents[0]:.2f}, with fiber extension {exponents[1]:.2f}"
    return Found(words, holds(min(exponents) > 0.0))


def lengths(energy):
    """Length of the muscle at both ends of the range."""
    found = inflate(sleeve_muscle(energy=energy), RANGE, x=0.0)["deformed_length"].values
    return Found(f"{1e3 * found[0]:.0f} mm at 5 psi, {1e3 * found[1]:.0f} mm at 30 psi", UNKNOWN)


def extension(energy):
    """What an extension of 0.75 % takes from the blocked force."""
    taken = [_force(energy, False, float(p)) - _force(energy, True, float(p)) for p in RANGE]
    words = f"{taken[0]:.1f} N less at 5 psi, {taken[1]:.1f} N at 30 psi"
    return Found(words, PARTLY if abs(taken[1] - taken[0]) < 0.25 * taken[0] else UNKNOWN)


def diameter(energy):
    """Radius of the winding once its muscle shortens freely at 30 psi."""
    free = float(inflate(sleeve_muscle(energy=energy), RANGE[1], x=0.0)["deformed_length"])
    after = winding().shortened(free).radius
    words = f"without an arm, {1e3 * winding().radius:.1f} mm would become {1e3 * after:.1f} mm at 30 psi"
    return Found(words, holds(after < winding().radius))


def equation_3_4(energy):
    """Eq. 3.4 against the load per length of the muscle."""
    load = constriction(sleeve_muscle(energy=energy), winding(), float(RANGE[1]))
    hoop, line = float(load["hoop_load"]), float(load["line_load"])
    words = f"{hoop:.0f} N/m per hoop length (Eq. 3.4), {line:.0f} N/m per length of the muscle"
    return Found(f"{words}: {100.0 * (hoop / line - 1.0):.1f} % less", PARTLY)


def measured(energy):
    """Eq. 3.4 with fiber extension at both ends of the range."""
    load = constriction(sleeve_muscle(True, energy=energy), winding(), RANGE)["hoop_load"].values
    return Found(f"string model: {load[0]:.0f} N/m at 5 psi, {load[1]:.0f} N/m at 30 psi", UNKNOWN)


NO_MARKERS = "The measured values are not printed."
CLAIMS = (
    Claim("3.4", ("3-6",), "The blocked force becomes zero at 54.7°.", zero),
    Claim("3.4", ("3-6",), "The blocked force falls exponentially with the fiber angle.", exponential,
          "It falls as 2 cot² - 1: an exponential would fall by one factor everywhere, and never reach zero."),
    Claim("3.4", ("3-7",), "The blocked force is independent of the length.", length),
    Claim("3.4", ("3-8",), "The blocked force increases with the radius.", radius, "With its square."),
    Claim("3.5", ("3-9",), "Measured lengths match within 10 % from 5 to 30 psi.", lengths, NO_MARKERS),
    Claim("3.5", ("3-11",), "Fiber extension of 0.75 % corrects an offset of the blocked force.", extension,
          "It does act as an offset. " + NO_MARKERS),
    Claim("3.2", (), "Contraction with fixed ends and coils reduces the diameter of the winding: it constricts.", diameter),
    Claim("3.3", ("3-13",), "The normal force per length of the actuator is T sin(alpha)/r (Eq. 3.4).", equation_3_4,
          "That is the load per length of hoop; the curvature of a helix is sin²(alpha)/r."),
    Claim("3.5", ("3-13",), "The string model predicts almost 50 % more than is measured.", measured,
          NO_MARKERS + " The source's reason: a load on its side reduces the blocked force; no model here knows it."),
)  # fmt: skip
