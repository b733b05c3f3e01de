"""Derivatives of bodies of revolution: the solver's own density at a point, the body's values where a parameter moves, and
symmetries of Maxwell's.
"""

from functools import cache

import numpy as np
import pytest
from plain import by_what_there_is

from freesweep import Actuator, MooneyRivlin, Profile, blocked_force, blocked_torque, inflate, interpret, lock
from freesweep.derivative import attach
from freesweep.derivative.asked import Asked
from freesweep.derivative.dual import Dual
from freesweep.derivative.extremes import EXTREMES
from freesweep.derivative.physics import BY_V, BY_Y, OWN
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian as kernels
from freesweep.statics import read_course
from freesweep.status import OK

TUBE = {"alpha": 20, "beta": -40, "length": 0.06, "wall": 1e-3, "c10": 0.17e6, "c01": 0.08e6}
CONE = {"radius": [(0, 8e-3), (1, 5e-3)]}
SMOOTH = {"radius": Profile([(0, 6e-3), (0.5, 9e-3), (1, 6e-3)], smooth=True)}
RULES = {"alpha": "geodesic 25.0 deg", "wall": "constant volume 1.2e-3 m", "fiber_radius": "outer"}
PHYSICAL = {"model": "physical"}
SHAPED = {"taper": 0.1, "bulge": 0.2}
LOADS = ("pressure", "force", "torque", "deformed_length", "rotation")
STEPS = {
    "alpha": 0.1, "beta": 0.1, "length": 5e-5, "radius": 3e-5, "wall": 1e-5, "c10": 1e3, "c01": 1e3, "pressure": 500.0,
    "force": 0.05, "torque": 1e-4, "fiber_extension": 1e-4, "taper": 2e-3, "bulge": 2e-3,
    "deformed_length": 5e-5, "rotation": 0.5,
}  # fmt: skip
NEARBY = 2e-3  # of a step
lagrangian = interpret._Twins(kernels)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    """States without the compiler, but for what it has made already: free states of bodies, before the whole suite."""
    monkeypatch.setattr(interpret, "_clock", interpret._Clock())

    def at_once(_, __, entry, *arguments):
        return by_what_there_is(entry, arguments)

    monkeypatch.setattr(interpret, "at_once", at_once)


def bulb(share):
    return 6e-3 + 3e-3 * np.sin(np.pi * share) ** 2


def body(state):
    design = {name: value for name, value in (TUBE | state).items() if name not in LOADS}
    return Actuator(material=MooneyRivlin(design.pop("c10"), design.pop("c01")), **design)


def moved(value, by):
    """What is given, by so much more all along."""
    if isinstance(value, str):
        rule, number, unit = value.rsplit(" ", 2)
        return f"{rule} {float(number) + by!r} {unit}"
    if isinstance(value, Profile):
        return Profile(moved(list(value.knots), by), smooth=value.smooth)
    if callable(value):
        return lambda share: value(share) + by
    return [(x, number + by) for x, number in value] if isinstance(value, list) else value + by


# --- at one point


@pytest.mark.parametrize("more", [{}, RULES, PHYSICAL], ids=["source", "rules", "physical"])
def test_a_body_s_density_is_that_of_the_kernels(more):
    """Its first derivatives, and the second ones as parts of the dual numbers."""
    tube = body(SMOOTH | more)
    course, error = read_course(tube, 1e-6)
    loads = {"pressure": 5e4, "force": 0.5, "torque": 1e-3}
    physics = Asked(tube, (), 1e-6, course, error)._physics(loads, ())
    share, y, v = np.array([0.2, 0.45, 0.8]), np.array([1.1, 1.15, 1.05]), np.array([0.1, -0.05, -0.2])
    seeds = np.zeros((2, OWN, 1))
    seeds[0, BY_Y] = seeds[1, BY_V] = 1.0
    _, L_y, L_v = physics.local(Dual(y, seeds[0]), Dual(v, seeds[1]), share)
    integrals = physics.integrands(Dual(y, seeds[0]), Dual(v, seeds[1]), share)
    found = [L_y.value, L_v.value, L_y.parts[BY_Y], L_y.parts[BY_V], L_v.parts[BY_V], *(q.value for q in integrals)]
    found = np.array([np.broadcast_to(row, 3) for row in found])
    parts, r = physics.course.parts, tube.fiber_surface
    c10 = tube.material.c10
    wall = (1.0, 1.0, 1.0) if tube.is_loose else (1.0,)
    rubber = (tube.material.c01 / c10, 0.0, 0.0) if tube.is_loose else (tube.material.c01 / c10,)
    load = Load(1.0, rubber, wall, 5e4 / c10, 0.5 / (np.pi * r**2 * c10), 1e-3 / (np.pi * r**3 * c10), 1.0)
    for k in range(3):
        place = 0 if share[k] < 0.5 else 1  # the spline's pieces
        cell = tuple(parts.numbers(0.5 * place, 0.5 * place + 0.5, 2.0 * share[k] - place).tolist())
        own = lagrangian.density(y[k], v[k], cell, load)[1:]
        expected = [*own, *lagrangian.integrands(y[k], v[k], cell, load)[:4]]
        assert found[:, k] == pytest.approx(expected, rel=1e-10, abs=1e-13)


# --- whole bodies

WAYS = {"inflate": inflate, "lock": lock, "blocked_force": blocked_force, "blocked_torque": blocked_torque}
STATES = {
    "geodesic": ("inflate", CONE | RULES | SHAPED | {"pressure": 3e4, "force": 0.5, "torque": 1e-3}),
}
INSIDE = ("inflate", CONE | {"wall_model": "thick", "pressure": 4e4})
LONG = STATES | {
    "fibers inside": INSIDE,
    "held length": ("blocked_force", CONE | {"pressure": 4e4, "deformed_length": 0.0605}),
    "bulb": ("inflate", {"radius": bulb, "pressure": 4e4, "force": 0.5, "torque": 1e-3}),
    "bend": ("inflate", {"radius": [(0, 6e-3), (0.4, 8e-3), (1, 8e-3)], "wall": [(0, 1e-3), (1, 1.5e-3)], "pressure": 4e4}),
    "extension": ("inflate", SMOOTH | {"fiber_extension": 1.01, "fiber_radius": "middle", "pressure": 4e4}),
    "locked": ("lock", CONE),
    "held rotation": ("blocked_torque", CONE | {"pressure": 4e4, "rotation": 5.0}),
    "thick": ("inflate", CONE | {"wall_model": "thick", "fiber_radius": "outer", "pressure": 4e4}),
    "physical": ("inflate", SMOOTH | PHYSICAL | RULES | {"pressure": 4e4}),
    "slack": ("inflate", CONE | PHYSICAL | {"alpha": 5, "beta": 30, "pressure": 5e4}),
}  # fmt: skip


def judge(way, state, monkeypatch, names="all"):
    """Derivatives against differences of the same body's values, which are those of the solver within both bounds."""
    seen, shapes = {}, attach.shapes_of

    def spied(asked, solve, finer):
        seen["asked"], seen["y"] = asked, cache(lambda finer: shapes(asked, solve, finer))
        return seen["y"](finer)

    monkeypatch.setattr(attach, "shapes_of", spied)
    loads = {name: state[name] for name in LOADS if name in state}
    found = WAYS[way](body(state), **loads, x=[0.0], derivatives=names)
    assert found["status"] == OK
    asked, stretches = seen["asked"], seen["y"]
    own = {name: state.get(name, np.inf if way == "lock" and name == "pressure" else 0.0) for name in LOADS[:3]}
    if asked.unknown:
        own[asked.unknown] = found[asked.unknown].item()

    def values(name, by):
        at = (TUBE | dict.fromkeys(("force", "torque", "taper", "bulge"), 0.0) | {"fiber_extension": 1.0} | state)[name]
        changed = state | {name: moved(at, by)}
        tube = body(changed)
        other = Asked(tube, (), 1e-8, *read_course(tube, 1e-8), asked.held, asked.unknown)
        other.x = asked.x
        loads = own | ({name: own[name] + by} if name in own else {})
        return other.state(loads, changed.get(asked.held), lambda finer: stretches(finer).ravel())[0][:, 0]

    def difference(name, h):
        """Its derivatives, and how close they are."""
        if name == "fiber_extension" and name not in state:  # 1 is the least
            zero, half, one = (values(name, 0.1 * by * h) for by in (0.0, 0.5, 1.0))
            return (4.0 * half - 3.0 * zero - one) / (0.1 * h), 3e-5
        near, far = values(name, h / 2) - values(name, -h / 2), values(name, h) - values(name, -h)
        return (8.0 * near - far) / (6.0 * h), 1e-6

    for name in asked.parameters:
        h = STEPS[name]
        told, close = difference(name, h)
        nearby = difference(name, NEARBY * h)[0] if set(EXTREMES) & set(asked.outputs) else told
        for k, output in enumerate(asked.outputs):
            exact, bound = (found[f"d_{output}_d_{name}{end}"].item() for end in ("", "_error"))
            size = max(abs(exact), 1e-4 * abs(found[output].item()) / h)
            if output in EXTREMES:  # their place moves far within a step, or to the other end
                assert abs(exact - nearby[k]) <= max(1e-5 * size, bound), (output, name)
                continue
            assert abs(exact - told[k]) <= max(close * size, bound), (output, name)
            assert bound <= 1e-5 * size or exact == bound == 0.0, (output, name)
    return found


@pytest.mark.parametrize("kind", STATES)
def test_derivatives_of_bodies_are_what_their_differences_tell(kind, monkeypatch):
    found = judge(*STATES[kind], monkeypatch, ["alpha", "radius", "taper", "bulge", "force", "torque", "pressure"])
    if kind == "geodesic":  # Maxwell's symmetries
        by_torque, by_pressure = (found[f"d_deformed_length_d_{name}"].item() for name in ("torque", "pressure"))
        assert found["d_rotation_d_force"].item() == pytest.approx(np.degrees(by_torque), rel=1e-8)
        assert found["d_volume_d_force"].item() == pytest.approx(by_pressure, rel=1e-8)


def test_a_thick_body_whose_fibers_lie_inside_has_derivatives(monkeypatch):
    """Rounding puts them a little outside the inner radius, here and there, which no kernel branches by."""
    judge(*INSIDE, monkeypatch, ["radius"])


def test_a_locked_body_whose_threads_are_slack_in_places_has_derivatives():
    """Nothing but the taut family tells the twist there: derivatives were lost."""
    slack = TUBE | CONE | PHYSICAL | {"alpha": 10, "beta": 31}
    found = lock(body(slack), x=[0.0], derivatives=["alpha"])
    assert found["slack_beta"] > 0.01
    ends = [lock(body(slack | {"alpha": 10 + by}), x=[0.0], accuracy=1e-9) for by in (0.02, -0.02)]
    for output in ("deformed_length", "rotation", "mid_radius", "volume"):
        told = (ends[0][output].item() - ends[1][output].item()) / 0.04
        assert found[f"d_{output}_d_alpha"].item() == pytest.approx(told, rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize("kind", LONG)
def test_derivatives_of_more_bodies_are_what_their_differences_tell(kind, monkeypatch):
    judge(*LONG[kind], monkeypatch)


def test_an_undeformed_body_has_derivatives_by_its_sizes_and_none_by_loads():
    found = inflate(body(CONE), 0.0, x=[0.0], derivatives=["length", "radius", "pressure"])
    assert found["d_deformed_length_d_length"] == 1.0
    assert found["d_mid_radius_d_radius"] == 1.0
    assert found["d_volume_d_radius"].item() == pytest.approx(np.pi * 0.06 * 13e-3, rel=1e-12)  # 2 pi l times the mean
    assert np.isnan(found["d_volume_d_pressure"])


def test_an_undeformed_tube_with_a_taper_is_as_wide_as_its_parameters_say():
    """radius (1 - taper/2)(1 + bulge) in the middle."""
    tube = body({"radius": 8e-3} | SHAPED)
    found = inflate(tube, 0.0, x=[0.0], derivatives=["radius", "taper", "bulge"])
    slopes = [found[f"d_mid_radius_d_{name}"].item() for name in ("radius", "taper", "bulge")]
    assert slopes == pytest.approx([0.95 * 1.2, -0.5 * 1.2 * 8e-3, 0.95 * 8e-3], rel=1e-12)
    assert found["d_mid_radius_d_taper"].attrs["units"] == "m"


@pytest.mark.long  # compiles the derivatives of physical bodies
def test_a_body_whose_thick_wall_takes_several_rules_keeps_its_derivatives():
    """Five Gauss points across the wall at one end, six at the other: the force differs by 1.6e-6 from that of six all
    along, which is no other state. Maxwell's symmetry, and a bound that says so.
    """
    design = {"alpha": 38.7064, "beta": -40.24, "length": 0.21361, "radius": 3.65445e-3, "wall": 1.2089e-3}
    loads = {"pressure": 30358.55, "deformed_length": 0.234807, "torque": -4.391e-5}
    state = design | loads | PHYSICAL | {"taper": 0.27111, "bulge": 0.075234, "c10": 88138.0, "c01": 73198.85}
    tube = body(state)
    found = blocked_force(tube, **loads, x=[0.0], derivatives=["torque", "deformed_length"])
    by_length = found["d_rotation_d_deformed_length"].item()
    assert found["d_force_d_torque"].item() == pytest.approx(-np.radians(by_length), rel=1e-8)
    assert found["d_force_d_torque_error"] < 1e-4 * abs(found["d_force_d_torque"])
