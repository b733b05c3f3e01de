"""Claims on the design space and the locked shape (sections 1.2, 2.1 and 2.2)."""

import functools

import numpy as np

from ... import closed_form
from ...statics import inflate, lock
from ..prototypes import RADIUS, RUBBER, WALL, rotating, source_tube
from ..space import FOUR
from .claim import NO, PARTLY, YES, Claim, Found, holds

GRID = np.arange(5.0, 86.0, 10.0)  # [degree]
LENGTH, LONG = 0.2, 0.3  # [m]
HIGH = 200.0 * RUBBER.c10  # a pressure at which the wall hardly matters [Pa]
STEPS = np.concatenate([[10e3], np.geomspace(20e3, HIGH, 12)])
ON_MANIFOLD = 2.0  # [degree] that count as on the locked manifold
RADII = (5.0, 10.0, 40.0)  # lengths over radius


def _tube(alpha, beta, energy="principal", length=LENGTH):
    return source_tube(alpha=alpha, beta=beta, length=length, radius=RADIUS, wall=WALL, material=RUBBER, energy=energy)


def _off_manifold(alpha, beta):
    """Distance [degree] in beta of a pair of angles from the locked manifold."""
    return np.abs(beta - closed_form.locked_manifold(alpha)) if alpha > 0.0 else np.abs(beta + 90.0)


@functools.cache
def _space(energy):
    """Region, early and locked change of length [m], and whether the angles reach the manifold, over the unique designs."""
    rows = []
    for alpha in GRID:
        for beta in np.arange(-alpha + 10.0, alpha, 10.0):
            tube = _tube(float(alpha), float(beta), energy, LONG)
            state = inflate(tube, STEPS, x=0.5 * LONG)
            last = state.isel(pressure=-1)
            middle = float(last["alpha_deformed"].item()), float(last["beta_deformed"].item())
            arrived = bool(np.isfinite(middle[0])) and _off_manifold(*middle) < ON_MANIFOLD
            early = float(state["deformed_length"][0]) - LONG
            locked = float(lock(tube, x=0.0)["deformed_length"]) - LONG
            rows.append((str(closed_form.region(alpha, beta)), early, locked, arrived, bool(state["limit_found"])))
    return rows


def muscles_turn(energy):
    """A muscle just below and one just above 54.7 degrees."""
    change = []
    for angle in (54.0, 55.5):
        state = inflate(_tube(angle, -angle, energy), 0.1e6, x=0.0)
        change.append((1e3 * (float(state["deformed_length"]) - LENGTH), 1e3 * (float(state["mid_radius"]) - RADIUS)))
    (short, swell), (long, thin) = change
    words = f"at 100 kPa 54.0°: {short:+.2f} mm long, {swell:+.3f} mm radius; 55.5°: {long:+.2f} mm, {thin:+.3f} mm"
    return Found(words, holds(short < 0.0 < swell and long > 0.0 > thin))


def converge(energy):
    """All unique designs of a 10 degree grid, raised to a very high pressure."""
    rows = _space(energy)
    limits, arrived = sum(row[4] for row in rows), sum(row[3] for row in rows)
    words = (
        f"{arrived} of {len(rows)} designs arrive within {ON_MANIFOLD:g}°; {limits} meet a limit pressure on the way"
    )
    return Found(words, YES if arrived == len(rows) else PARTLY if arrived > 0.5 * len(rows) else NO)


def region_two(energy):
    """Signs of the change of length in IIa and IIb."""
    shares = []
    for name, sign in (("IIa", -1.0), ("IIb", 1.0)):
        rows = [row for row in _space(energy) if row[0] == name]
        shares.append((name, sum(sign * row[1] > 0.0 and sign * row[2] > 0.0 for row in rows), len(rows)))
    words = "; ".join(f"{name}: {good} of {count}, at 10 kPa and locked" for name, good, count in shares)
    return Found(words, holds(all(good == count for _, good, count in shares)))


def region_one(energy):
    """Signs of the change of length in region I."""
    rows = [row for row in _space(energy) if row[0] == "I"]
    longer, shorter = sum(row[1] > 0.0 for row in rows), sum(row[2] < 0.0 for row in rows)
    words = f"at 10 kPa {longer} of {len(rows)} designs are longer; locked, {shorter} are shorter"
    return Found(words, YES if longer == 0 and shorter == len(rows) else PARTLY if shorter else NO)


def eigenvalues(energy):
    """Angle between the principal directions of stretch and the meridian, middle of prototype B at 0.1 MPa."""
    tube = rotating("B", energy)
    y = float(inflate(tube, 0.1e6, x=0.0)["mid_radius"]) / RADIUS
    axial, twist = (float(value) for value in closed_form.uniform_state(tube.alpha, tube.beta, y)[:2])
    angle = 0.5 * np.degrees(np.arctan2(2.0 * y**2 * twist, axial**2 + (y * twist) ** 2 - y**2))
    angle = abs((angle + 45.0) % 90.0 - 45.0)
    return Found(f"prototype B at 100 kPa: principal directions {angle:.0f}° off the meridian", holds(angle < 1.0))


def most_energy(energy):
    """Strain energy of prototype B along pressure against that of its locked shape."""
    tube = rotating("B", energy)
    along = inflate(tube, np.geomspace(1e3, HIGH, 40), x=0.0)["strain_energy"].values
    locked = float(lock(tube, x=0.0)["strain_energy"])
    words = f"prototype B: {along[-1]:.2f} J at {HIGH * 1e-6:.0f} MPa, {locked:.2f} J locked; rising all along"
    return Found(words, holds(np.all(np.diff(along) > 0.0) and along[-1] < locked))


def on_manifold(energy):
    """Largest distance of the four locked designs of Figure 2-4 from the manifold, and how much of each lies on it."""
    worst, least = 0.0, 1.0
    for alpha, beta in FOUR:
        state = lock(_tube(alpha, beta, energy), x=np.linspace(0.0, LENGTH, 401))
        off = np.array(
            [_off_manifold(a, b) for a, b in zip(state["alpha_deformed"].values, state["beta_deformed"].values)]
        )
        worst, least = max(worst, off[200]), min(least, float(np.mean(off < ON_MANIFOLD)))
    within = f"{100.0 * least:.0f} % of the length or more within {ON_MANIFOLD:g}°"
    words = f"four designs: {worst:.1e}° off in the middle; {within}"
    return Found(words, holds(worst < 0.1))


def uniform_turns_further(energy):
    """Rotation of the uniform tube over that of the curvilinear one, 0/30 degrees."""
    y = closed_form.locked_stretch(0.0, 30.0)
    per_radius = float(np.degrees(closed_form.uniform_state(0.0, 30.0, y)[1]))
    excess = []
    for radii in RADII:
        exact = float(lock(_tube(0.0, 30.0, energy, radii * RADIUS), x=0.0)["rotation"])
        excess.append(100.0 * (per_radius * radii / exact - 1.0))
    words = ", ".join(f"{extra:.1f} %" for extra in excess)
    return Found(f"{words} more at lengths of 5, 10, 40 radii", PARTLY if min(excess) < 15.0 < max(excess) else NO)


CLAIMS = (
    Claim("1.2", ("1-2",), "Muscles below 54.7° shorten and swell, those above lengthen and thin.", muscles_turn),
    Claim("1.2", ("1-2",), "Starting at any point in regions I and II, the fiber angles converge to the locked manifold.",
          converge, "With the strain energy as printed, a part of region I ends in a limit pressure before."),
    Claim("1.2", ("1-2",), "Region IIa rotates and contracts, IIb rotates and extends.", region_two),
    Claim("1.2", ("1-2",), "Region I rotates and contracts.", region_one,
          "Every design of region I lengthens first; those that end shorter pass their undeformed length on the way."),
    Claim("2.1.1", (), "The stretch ratios of Eq. 2.1 are eigenvalues of the strain tensor.", eigenvalues,
          "True without twist only; the full strain energy takes the shear into account."),
    Claim("2.1.1", (), "The strain energy is largest in the locked configuration.", most_energy),
    Claim("2.2", ("2-4",), "The deformed fiber angles lie on the locked manifold, also for the curvilinear shape.",
          on_manifold, "In the middle of the tube; toward the clamped ends they return to the undeformed angles. The four "
          "designs of the source are not printed."),
    Claim("2.2", ("2-3",), "The uniform cylinder turns 15 % further than the curvilinear locked shape of 0°/30°.",
          uniform_turns_further, "It depends on the length, which is not printed: 15 % belongs to 10 radii."),
)  # fmt: skip
