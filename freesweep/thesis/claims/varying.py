"""Claims on actuators whose angles or wall vary (section 2.5)."""

import functools

import numpy as np

from ...description.actuator import ActuatorError
from ...statics import inflate, lock
from ..prototypes import RADIUS, ROTATOR_RUBBER, TABLE_1, WALL, rotator, source_tube, two_walls
from .claim import NO, YES, Claim, Found, holds

PRESSURES = np.linspace(0.0, 0.14e6, 57)
LENGTH = 0.2
ALONG = np.linspace(0.0, 0.192, 193)


@functools.cache
def _turned(profile, energy):
    return inflate(rotator(profile, energy), PRESSURES, x=0.5 * LENGTH)


def rotation(energy):
    """Rotation of the rotator at 0.14 MPa for two courses of its angles."""
    turned = {profile: float(_turned(profile, energy)["rotation"][-1]) for profile in ("switch", "line")}
    words = f"{turned['switch']:.1f}° (angles switch half way), {turned['line']:.1f}° (they change evenly)"
    return Found(words, holds(max(turned.values()) > 0.85 * 220.0))


def length_change(energy):
    """Largest change of length of the rotator up to 0.14 MPa."""
    change = {p: _turned(p, energy)["deformed_length"].values - LENGTH for p in ("switch", "line")}
    largest = {p: 1e3 * values[np.argmax(np.abs(values))] for p, values in change.items()}
    words = f"{largest['switch']:+.2f} mm (switch), {largest['line']:+.1f} mm (even)"
    return Found(words, holds(abs(largest["switch"]) <= 1.5))


def half_percent(energy):
    """The sentence's own arithmetic."""
    return Found("1.5 mm of 200 mm are 0.75 %", NO)


def halves(energy):
    """Change of length and rotation of the two halves of the rotator."""
    state = _turned("switch", energy).isel(pressure=-1)
    middle = float(state["axial_position"].item())
    near, far = 1e3 * (middle - 0.5 * LENGTH), 1e3 * (float(state["deformed_length"]) - middle - 0.5 * LENGTH)
    turn = float(state["twist"].item())
    rest = float(state["rotation"]) - turn
    words = f"{near:+.2f} mm, {turn:.0f}° in the first half; {far:+.2f} mm, {rest:.0f}° in the second"
    return Found(words, holds(near < 0.0 < far and abs(turn) > abs(rest)))


def caption(energy):
    """The caption of Figure 2-14 taken at its word: beta up to +67.5 degrees."""
    try:
        source_tube(alpha=[(0, 0.0), (1, 67.5)], beta=[(0, -30.0), (1, 67.5)], length=LENGTH, radius=RADIUS, wall=WALL,
                 material=ROTATOR_RUBBER, energy=energy)  # fmt: skip
    except ActuatorError:
        return Found("refused: alpha = beta = 67.5° at the far end is a single fiber family", NO)
    return Found("accepted", YES)


def thin_half_first(energy):
    """Radius in the middle of either half along pressure, and the pressures at which each is half way to locking."""
    pressures = np.linspace(10e3, 1.2e6, 120)
    radius = inflate(two_walls(energy), pressures, x=[0.048, 0.144])["deformed_radius"].values
    locked = lock(two_walls(energy), x=[0.048])["deformed_radius"].item()
    half = [1e-3 * float(np.interp(0.5 * (RADIUS + locked), radius[:, k], pressures)) for k in (0, 1)]
    words = f"half way to the locked radius at {half[0]:.0f} kPa (thin half) and {half[1]:.0f} kPa (thick half)"
    return Found(words, holds(half[0] < half[1]))


def wall_unseen(energy):
    """Locked radius with the varying wall against that with a constant one."""
    same = source_tube(alpha=20, beta=-20, length=0.192, radius=RADIUS, wall=WALL, material=TABLE_1, energy=energy)
    one, other = (lock(tube, x=ALONG)["deformed_radius"].values for tube in (two_walls(energy), same))
    gap = float(np.max(np.abs(one - other))) / RADIUS
    return Found(f"radii differ by {gap:.0e} of the undeformed one at most", holds(gap < 1e-6))


def proportional(energy):
    """Cross section of the doubled wall over that of the single one."""
    ratio = ((RADIUS + 2.0 * WALL) ** 2 - RADIUS**2) / ((RADIUS + WALL) ** 2 - RADIUS**2)
    return Found(f"twice the wall stores {ratio:.2f} times the energy", holds(abs(ratio - 2.0) < 0.02))


CLAIMS = (
    Claim("2.5.1", ("2-14", "2-16"), "The rotator turns by 220° at 0.14 MPa (measured).", rotation,
          "The course of the angles between the ends is not printed, and it decides: no claim on the source's own curve."),
    Claim("2.5.1", ("2-14",), "Its length changes by 1.5 mm at most.", length_change,
          "With the switch of angles; when they change evenly the tube shortens by several millimetres."),
    Claim("2.5.1", ("2-14",), "1.5 mm is less than 0.5 % of its length.", half_percent),
    Claim("2.5.1", ("2-14",), "One half rotates and contracts, the other extends.", halves),
    Claim("2.5.1", ("2-14",), "Caption: beta varies from -30° to 67.5°.", caption, "The text's -67.5° is meant."),
    Claim("2.5.2", ("2-17",), "The half with the thinner wall deforms first.", thin_half_first),
    Claim("2.5.2", ("2-17",), "The locked profile is a function of kinematics alone.", wall_unseen),
    Claim("2.5.2", ("2-17",), "The strain energy is proportional to the thickness.", proportional,
          "To the cross section: the outer part of a wall has more of it. For thin walls the two agree."),
)  # fmt: skip
