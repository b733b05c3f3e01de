"""Claims on McKibben muscles (section 2.3)."""

import numpy as np

from ...description.actuator import MooneyRivlin
from ...holding import blocked_force
from ...statics import inflate
from ...status import OK
from ..muscles import matched_profiles
from ..prototypes import MUSCLES, RADIUS, WALL, muscle, source_tube
from .claim import PARTLY, UNKNOWN, Claim, Found, holds

PRESSURES = np.array([0.03e6, 0.05e6, 0.10e6])  # [Pa]
LOW, HIGH, NARROW = 4e3, 20e3, 50.0  # between which the fibers become taut, and how finely that is found [Pa]


def profiles(energy):
    """Largest difference of radius between two rubbers at one stroke (the two energies agree for muscles)."""
    words = []
    for angle in (15, 25):
        (_, _, first), (_, pressure, other) = matched_profiles(angle)
        gap = np.max(np.abs(first["deformed_radius"].values / other["deformed_radius"].values - 1.0))
        more = 1e-3 * pressure - 100.0
        words.append(
            f"±{angle}°: radii of two rubbers differ by {100.0 * gap:.2f} % at most, pressures by {more:.1f} %"
        )
    return Found("; ".join(words), UNKNOWN)


def lengths(energy):
    """Lengths of the three muscles at 0.1 MPa."""
    words = [
        f"±{a}°: {1e3 * float(inflate(muscle(a, False, energy), 0.1e6, x=0.0)['deformed_length']):.1f} mm"
        for a in MUSCLES
    ]
    return Found("at 100 kPa " + ", ".join(words), UNKNOWN)


def table_1(energy):
    """Small-strain modulus 6 (C10 + C01) of each muscle."""
    moduli = {angle: 6e-6 * (c10 + c01) for angle, (_, c10, c01, _) in MUSCLES.items()}
    words = ", ".join(f"±{angle}°: {modulus:.2f} MPa" for angle, modulus in moduli.items())
    return Found(f"6 (C10 + C01): {words}; C01 of ±35° and ±40°: 0.12 and 0.10", PARTLY)


def no_material(energy):
    """Blocked force of the 30 degree muscle with two rubbers, ten times apart."""
    force = []
    for factor in (1.0, 10.0):
        rubber = MooneyRivlin(0.11e6 * factor, 0.06e6 * factor)
        tube = source_tube(alpha=30, beta=-30, length=0.192, radius=RADIUS, wall=WALL, material=rubber, energy=energy)
        force.append(blocked_force(tube, PRESSURES, x=0.0)["force"].values)
    gap = np.max(np.abs(force[1] / force[0] - 1.0))
    return Found(f"ten times stiffer rubber changes the force by {gap:.0e} of it", holds(gap < 1e-6))


def offset(energy):
    """What fiber extension takes from the blocked force of the 30 degree muscle."""
    plain, extended = (
        blocked_force(muscle(30, is_so, energy), PRESSURES, x=0.0)["force"].values for is_so in (False, True)
    )
    with_, without = (", ".join(f"{value:.2f}" for value in force) for force in (extended, plain))
    words = f"±30° at 30, 50, 100 kPa: {with_} N with, {without} N without"
    taken = plain - extended
    return Found(words, PARTLY if np.ptp(taken) < 0.2 * taken.mean() else UNKNOWN)


def taut(energy):
    """Pressure from which the muscles with extended fibers have a blocked state."""
    edges = []
    for angle in MUSCLES:
        low, high = LOW, HIGH
        while high - low > NARROW:
            middle = 0.5 * (low + high)
            taut_there = int(blocked_force(muscle(angle, True, energy), middle, x=0.0)["status"]) == OK
            low, high = (low, middle) if taut_there else (middle, high)
        edges.append(1e-3 * high)
    return Found(
        "from " + ", ".join(f"{edge:.1f}" for edge in edges) + " kPa for ±30°, ±35°, ±40°", holds(min(edges) > 5.0)
    )


def force_and_length(energy):
    """Held length against given force, 30 degree muscle with fiber extension at 0.1 MPa."""
    tube = muscle(30, True, energy)
    forces = np.linspace(0.0, 30.0, 7)
    free = inflate(tube, 0.1e6, force=forces, x=0.0)["deformed_length"].values
    held = blocked_force(tube, 0.1e6, free, x=0.0)["force"].values
    gap = np.max(np.abs(held - forces))
    return Found(f"forces agree within {gap:.0e} N from 0 to 30 N", holds(gap < 1e-3))


def better_match(energy):
    """Length under 10 N at 0.1 MPa, with and without extension."""
    length = [
        1e3 * float(inflate(muscle(30, e, energy), 0.1e6, force=10.0, x=0.0)["deformed_length"]) for e in (False, True)
    ]
    return Found(f"±30° under 10 N at 100 kPa: {length[0]:.1f} mm inextensible, {length[1]:.1f} mm extended", UNKNOWN)


NO_MARKERS = "The measured values are not printed."
CLAIMS = (
    Claim("2.3.1", ("2-5",), "Profiles of 15° and 25° muscles match Shan et al. within 5 %, pressures within 10 %.",
          profiles, "Neither Shan's muscles nor their material are printed. Shown instead: at one stroke the profile hardly "
          "knows the rubber; the pressure does."),
    Claim("2.3.3", ("2-7",), "The analytical pressure-length curves have the nature of the measured ones.", lengths,
          NO_MARKERS),
    Claim("2.3.3", ("2-7",), "The constants of Table 1 are the same for 35° and 40° and differ considerably for 30°.",
          table_1, "C10 is the same, C01 is not; 30° is softer by 40 %. The table's unit is MPa."),
    Claim("2.3.4", ("2-8",), "At the instant deformation begins, the blocked force does not depend on the material.",
          no_material, "For inextensible fibers; with fiber extension it does."),
    Claim("2.3.4", ("2-8",), "Fiber extension of 0.5 % reduces the offset of the blocked force to almost zero.", offset,
          "The extension does act as an offset, nearly the same at every pressure. " + NO_MARKERS),
    Claim("2.3.4", ("2-8",), "Some pressure is needed until the fibers are taut.", taut,
          "Below, the wall would have to be pushed to reach the taut fibers."),
    Claim("2.3.5", ("2-9",), "Force against length follows from a given force as from a locked length.", force_and_length),
    Claim("2.3.5", ("2-9",), "Fiber extension matches the measured force against length better at higher pressures.",
          better_match, NO_MARKERS),
)  # fmt: skip
