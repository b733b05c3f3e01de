"""Claims on the rotating prototypes and their torque (section 2.4)."""

import functools

import numpy as np

from ... import closed_form
from ...holding import blocked_torque, corrected_torque
from ...statics import inflate
from .. import physical
from ..prototypes import RADIUS, ROTATING, rotating
from ..torque import critical
from .claim import NO, PARTLY, UNKNOWN, YES, Claim, Found, holds

FINE = np.linspace(0.0, 0.2e6, 401)  # [Pa]
PRESSURES = np.array([0.03e6, 0.05e6, 0.10e6])
BEYOND = 1.1  # times the critical pressure


@functools.cache
def _inflated(name, energy):
    return inflate(rotating(name, energy), FINE, x=0.0)


def _change(name, energy):
    """Change of length along FINE [m]."""
    return _inflated(name, energy)["deformed_length"].values - ROTATING[name][2]


def extends_first(energy):
    """Prototype A: its longest state."""
    change = _change("A", energy)
    at = int(np.argmax(change))
    words = f"longest at {1e-3 * FINE[at]:.0f} kPa: {1e3 * change[at]:+.2f} mm; {1e3 * change[-1]:+.1f} mm at 200 kPa"
    return Found(words, holds(0 < at < FINE.size - 1 and change[-1] < 0.0))


def shorten(energy):
    """Prototypes B and C shorten and rotate at every pressure."""
    steady = all(np.all(np.diff(_change(name, energy)[1:]) < 0.0) for name in "BC")
    turns = ", ".join(f"{name} {float(_inflated(name, energy)['rotation'][-1]):.0f}°" for name in "BC")
    return Found(f"shorter with every step of pressure: {'yes' if steady else 'no'}; at 200 kPa {turns}", holds(steady))


def _contraction(name, limit):
    def check(energy):
        share = -100.0 * _change(name, energy)[limit * (1.0 + 1e-9) >= FINE].min() / ROTATING[name][2]
        return Found(f"{share:.1f} % at {limit * 1e-3:.0f} kPa", holds(share < 5.0))

    return check


def caption(energy):
    """Prototype A at the pressures of Figure 2-11."""
    change = 1e3 * np.interp([0.0927e6, 0.138e6], FINE, _change("A", energy))
    words = f"{change[0]:+.2f} mm at 92.7 kPa, {change[1]:+.2f} mm at 138 kPa"
    return Found(words, YES if change[0] > 0.0 > change[1] else PARTLY if change[1] < change[0] else NO)


def rotations(energy):
    """Rotation of the three prototypes at 0.2 MPa."""
    words = ", ".join(f"{name} {float(_inflated(name, energy)['rotation'][-1]):.0f}°" for name in ROTATING)
    return Found(f"at 200 kPa {words}", UNKNOWN)


def pushed_fibers(energy):
    """Pressures at which a fiber family of prototype A would have to push."""
    data = _inflated("A", energy)
    slack = FINE[data["slack_fiber"].values > 0]
    words = (
        f"prototype A: {1e-3 * slack.min():.1f} to {1e-3 * slack.max():.0f} kPa"
        if slack.size
        else "prototype A: nowhere"
    )
    return Found(words, NO if slack.size else YES)


def equation_2_20(energy):
    """Exact held torque of B and C against Eq. 2.20."""
    gap = 0.0
    for name in "BC":
        alpha, beta, _ = ROTATING[name]
        exact = blocked_torque(rotating(name, energy), PRESSURES, x=0.0)["torque"].values
        gap = max(gap, float(np.max(np.abs(exact / closed_form.blocked_torque(alpha, beta, RADIUS, PRESSURES) - 1.0))))
    return Found(f"exact and Eq. 2.20 agree within {gap:.0e}, B and C up to 100 kPa", holds(gap < 1e-6))


def blocked_deformation(energy):
    """Where prototype B leaves the held cylinder, and what it does then."""
    edge = critical("B", energy)
    beyond = blocked_torque(rotating("B", energy), BEYOND * edge, buckled=True, x=0.0)
    ideal = closed_form.blocked_torque(*ROTATING["B"][:2], RADIUS, BEYOND * edge)
    more = 100.0 * (float(beyond["torque"]) / ideal - 1.0)
    less = 100.0 * (1.0 - float(beyond["deformed_length"]) / ROTATING["B"][2])
    words = f"none up to {1e-3 * edge:.0f} kPa; 10 % beyond, {less:.1f} % shorter and {more:.1f} % more torque"
    return Found(words, PARTLY if more > 0.0 and less > 0.0 else NO)


def _corrected(name):
    """Corrected torque over Eq. 2.20."""

    def check(energy):
        alpha, beta, _ = ROTATING[name]
        ideal = closed_form.blocked_torque(alpha, beta, RADIUS, PRESSURES)
        ratio = corrected_torque(rotating(name, energy), PRESSURES) / ideal
        words = "at 30, 50, 100 kPa " + ", ".join(f"{value:.3f}" for value in ratio) + " times Eq. 2.20"
        return Found(words, holds(np.all(ratio > 1.0) and np.all(np.diff(ratio) > 0.0)))

    return check


def no_torque_at_first(energy):
    """Held torque of B with extended fibers at 0.03 MPa."""
    words, small = [], []
    for extension in (1.005, 1.0075):
        state = blocked_torque(rotating("B", energy, extension), 0.03e6, x=0.0)
        share = float(state["torque"]) / closed_form.blocked_torque(*ROTATING["B"][:2], RADIUS, 0.03e6)
        small.append(not share > 0.25)
        words.append(
            f"{100.0 * (extension - 1.0):.2f} %: "
            + (f"{share:.2f} times Eq. 2.20" if share == share else "no taut state")
        )
    return Found(", ".join(words) + " at 30 kPa", YES if all(small) else PARTLY if any(small) else NO)


def pure_rotation(energy):
    """Where prototype A has its undeformed length again."""
    change = _change("A", energy)
    past = np.flatnonzero((change[1:-1] > 0.0) & (change[2:] <= 0.0))
    if not past.size:
        return Found("prototype A stays longer up to 200 kPa", YES)
    at = np.interp(0.0, change[past[0] + 1 : past[0] + 3][::-1], FINE[past[0] + 1 : past[0] + 3][::-1])
    turn = np.interp(at, FINE, _inflated("A", energy)["rotation"].values)
    return Found(f"prototype A: undeformed length again at {1e-3 * at:.0f} kPa, turned by {turn:.0f}°", PARTLY)


CLAIMS = (
    Claim("2.4.1", ("2-10",), "Prototype A first extends, then contracts beyond a certain pressure.", extends_first),
    Claim("2.4.1", ("2-10",), "Prototypes B and C contract and rotate.", shorten),
    Claim("2.4.1", ("2-10",), "Prototype B contracts by less than 5 % up to 0.1 MPa.", _contraction("B", 0.1e6)),
    Claim("2.4.1", ("2-10",), "Prototype C contracts by less than 5 % up to 0.2 MPa.", _contraction("C", 0.2e6),
          "The shear of the wall, which Eq. 2.5 as printed leaves out, is what keeps C long."),
    Claim("2.4.1", ("2-11",), "Figure 2-11 shows A longer at \"0.927 MPa\" and shorter at 0.138 MPa.", caption,
          "0.927 MPa is read as 0.0927 MPa."),
    Claim("2.4.1", ("2-10",), "Rotation matches up to two full turns, then deviates by at most 15 %.", rotations,
          "The measured values are not printed. A alone comes near two turns."),
    Claim("2.4", ("2-10",), "Assumed: both fiber families stay taut (Eqs. 2.3 and 2.4 hold as equalities).",
          pushed_fibers, "The model keeps both families taut; there, one of them would have to push, which a fiber cannot."),
    Claim("2.4.2", ("2-12", "2-12-physical"), "The blocked torque is 2 pi r^3 P / tan(beta) (Eq. 2.20).", equation_2_20,
          "For inextensible fibers, below the critical pressure.", physical.equation_2_20),
    Claim("2.4.2", ("2-12", "2-12-physical", "2-13", "2-13-physical"),
          "Blocked deformation lets the torque of B exceed Eq. 2.20 at higher pressures.", blocked_deformation,
          "The exact model has it without any superposition, but only beyond a critical pressure; where threads cannot push,"
          " at all pressures.", physical.blocked_deformation),
    Claim("2.4.2", ("2-12",), "The corrected torque of B exceeds Eq. 2.20, the more so at higher pressure.",
          _corrected("B")),
    Claim("2.4.2", ("2-12", "2-12-physical"), "The effect is also seen in C: slightly larger than Eq. 2.20.",
          _corrected("C"), "The source's own formula gives slightly less for C, whose 60° muscle lengthens.",
          physical.seen_in_c),
    Claim("2.4.2", ("2-12", "2-12-physical"), "Fiber extension accounts for nearly no torque of B at 0.03 MPa.",
          no_torque_at_first, "The extension assumed for B is not printed; 0.5 % and 0.75 % are those of the muscles.",
          physical.no_torque_at_first),
    Claim("2.5.1", ("2-14",), "With constant fiber angles there is no purely rotating actuator.", pure_rotation,
          "True along the whole way; but region I passes its undeformed length once, turned."),
)  # fmt: skip
