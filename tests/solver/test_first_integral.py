"""The second method: quadrature of the first integral, held against the oracle, closed forms and stored atlases."""

import numpy as np
import pytest
from commands import refused, run
from grids import GRID, make, spec, store
from oracle import NoState
from oracle import first_integral as oracle

from freesweep import closed_form, open_atlas
from freesweep.first_integral import folded, held
from freesweep.first_integral.divided_differences import Divided
from freesweep.first_integral.roots import find_roots
from freesweep.first_integral.tube import NO_GUIDE, SOLVED, solve
from freesweep.first_integral.uniform import Tubes, density, follow, stretch
from freesweep.sweep.spec import parse
from freesweep.verification.cross_check import draw, resolve

WALL = 1.59 / 4.76


def tubes(
    alpha,
    beta,
    length,
    pressure,
    wall=WALL,
    ratio=0.5,
    gamma=1.0,
    force=0.0,
    torque=0.0,
    energy="full",
    yeoh=(0.0, 0.0),
):
    """Dimensionless tubes; infinite pressure is the locked shape."""
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    locked = np.isinf(pressure)
    columns = (
        0.5 * (ta + tb), 0.5 * (ta - tb), wall * (2.0 + wall), gamma, ratio, float(energy == "full"),
        np.where(locked, 1.0, pressure), force, torque, np.where(locked, 0.0, 1.0), 0.5 * np.asarray(length),
        *yeoh,
    )  # fmt: skip
    return Tubes(*(np.array(column, float) for column in np.broadcast_arrays(*map(np.atleast_1d, columns))))


def test_divided_differences_keep_every_digit():
    def f(q):
        return (q * q + q.inverse() * 3.0).root() * (q + (-0.25)) - (q * 2.0 + 1.0).inverse()

    far, near = f(Divided.of(1.5, 2.5)), f(Divided.of(1.5, 1.5))
    at = {q: np.sqrt(q * q + 3 / q) * (q - 0.25) - 1 / (2 * q + 1) for q in (1.5, 2.5)}
    assert far.here == pytest.approx(at[2.5], rel=1e-15)
    assert far.first == pytest.approx(at[2.5] - at[1.5], rel=1e-14)
    assert far.second == pytest.approx(far.first - far.slope, rel=1e-13)
    h = np.longdouble(1e-4)
    values = [np.sqrt(q * q + 3 / q) * (q - 0.25) - 1 / (2 * q + 1) for q in (1.5 - h, 1.5 + 0 * h, 1.5 + h)]
    assert near.slope == near.first == pytest.approx(float((values[2] - values[0]) / (2 * h)), rel=1e-7)
    assert near.second == pytest.approx(float((values[2] - 2 * values[1] + values[0]) / (2 * h * h)), rel=1e-6)
    beside = f(Divided.of(1.5, 1.5 + 1e-9))  # where subtracting would leave no digit
    assert beside.second == pytest.approx(near.second, rel=1e-8)


def test_many_roots_at_once():
    powers = np.array([1.0, 3.0, 9.0, 2.0])
    roots = find_roots(lambda x, which: x ** powers[which] - 0.3, np.zeros(4), np.array([1.0, 1.0, 1.0, 0.5]))
    assert roots[:3] == pytest.approx(0.3 ** (1 / powers[:3]), rel=1e-14)
    assert np.isnan(roots[3])  # no change of sign: no root


@pytest.mark.parametrize(("energy", "yeoh"), [("full", (0.0, 0.0)), ("principal", (0.0, 0.0)), ("full", (0.1, 0.02))])
def test_random_equilibria_agree_with_the_oracle(energy, yeoh):
    rng = np.random.default_rng(11)
    n = 24
    alpha, beta = rng.uniform(3, 80, n), -rng.uniform(3, 80, n) * rng.choice([1, -1], n)
    length, wall, p = np.exp(rng.uniform(np.log(4), np.log(200), n)), rng.uniform(0.1, 0.5, n), rng.uniform(0.05, 3, n)
    p[:4], gamma = np.inf, np.where(np.arange(n) % 3 == 0, 1.008, 1.0)
    force = np.where((np.arange(n) % 4 == 1) & (p < np.inf), rng.uniform(-0.03, 0.5, n), 0.0)
    loads = force, np.where(p < 1, 0.05, 0.0)
    found = solve(tubes(alpha, beta, length, p, wall, 0.4, gamma, *loads, energy, yeoh))
    judged = 0
    for i in range(n):
        given = (alpha[i], beta[i], length[i], wall[i] * (2 + wall[i]), (0.4, *yeoh), p[i], loads[0][i], loads[1][i])
        try:
            wanted = oracle(*given, gamma[i], energy)
        except NoState:
            assert found.reason[i] != SOLVED
            continue
        if found.reason[i] == NO_GUIDE:  # beyond the uniform tube's turning point
            continue
        values = np.array([wanted.length, wanted.volume, wanted.rotation, wanted.energy, wanted.middle])
        allowed = found.errors[i] + 10.0 * wanted.errors + 1e-12 * np.abs(values)
        assert np.all(np.abs(found.values[i] - values) < allowed), i
        assert np.all(found.errors[i] < 1e-9 * np.abs(values)), i
        judged += 1
    assert judged > 0.8 * n


def test_a_tube_too_long_for_rounding_approaches_the_uniform_one():
    lengths = np.array([30.0, 300.0, 3000.0, 30000.0])
    tube = tubes(20.0, -50.0, lengths, 1.0)
    found = solve(tube)
    assert np.all(found.reason == SOLVED)
    u, carried = stretch(tube)
    assert np.all(carried)
    assert found.values[:, 4] == pytest.approx(np.sqrt(u), rel=1e-10)
    per_length = np.diff(found.values, axis=0)[:, :4] / np.diff(lengths)[:, None]
    assert per_length[1] == pytest.approx(per_length[0], rel=1e-11)  # each further radius of length adds the same
    assert per_length[2] == pytest.approx(per_length[0], rel=1e-11)


def test_a_hardly_strained_tube_keeps_its_digits():
    """Strains of 1e-7, against extended precision."""
    p = np.array([2e-7, 1e-6])
    found = solve(tubes(30.0, -40.0, 20.0, p))
    for values, pressure in zip(found.values, p):
        wanted = oracle(30.0, -40.0, 20.0, WALL * (2 + WALL), 0.5, pressure)
        assert values[2] == pytest.approx(wanted.rotation, rel=1e-8)
        assert values[3] == pytest.approx(wanted.energy, rel=1e-7)
        assert values[0] - 20.0 == pytest.approx(wanted.length - 20.0, rel=1e-7)


def test_the_locked_manifold_stands_still():
    beta = closed_form.locked_manifold(35.0)
    found = solve(tubes(35.0, beta, 20.0, np.array([1.0, np.inf])))
    assert found.values == pytest.approx(np.tile([20.0, 20.0, 0.0, 0.0, 1.0], (2, 1)), abs=1e-12)


def turning(tube, pressure):
    """q and pressure at which uniform tubes turn back on the way to ``pressure``."""
    rest = tube._replace(pressure=0.0 * tube.pressure)
    beyond = tube._replace(pressure=pressure + 0.0 * tube.pressure)
    u, t = follow(np.ones(len(tube.H)), rest, beyond)
    assert np.all(t < 1.0)
    return u, rest.toward(beyond, t).pressure


def test_limit_pressure_of_the_theory():
    """60/55 degrees, Lambda 40, Eq. 2.5 as printed: 1.217827, of the uniform tube 1.217766."""
    tube = tubes(60.0, 55.0, 40.0, 1.2, energy="principal")
    u, p = turning(tube, 2.0)
    assert p == pytest.approx([1.217766], abs=1e-6)
    near = np.array([1.2178])
    assert folded.limit_pressures(tube, u, p, near) == pytest.approx([1.217827], abs=1e-6)


def test_a_shape_past_the_uniform_tubes_turn_is_found_from_its_middle():
    tube = tubes(60.0, 55.0, 40.0, 1.2178, energy="principal")
    assert solve(tube).reason.tolist() == [NO_GUIDE]
    found = folded.solve_near(tube, np.array([1.3678]))
    assert found.reason.tolist() == [SOLVED]
    wanted = oracle(60.0, 55.0, 40.0, WALL * (2 + WALL), 0.5, 1.2178, energy="principal")
    values = [wanted.length, wanted.volume, wanted.rotation, wanted.energy, wanted.middle]
    assert found.values[0] == pytest.approx(values, rel=1e-8)


def test_blocked_loads_of_inextensible_fibers_are_the_closed_forms():
    alpha, beta = np.array([30.0, 20.0, 60.0]), np.array([-30.0, -70.0, -20.0])
    tube = tubes(alpha, beta, 30.0, 0.7)
    force, error = held.blocked(tube, 0, np.full(3, 30.0), np.ones(3))
    assert np.all(np.abs(force - closed_form.blocked_force(alpha, beta, 1.0, 0.7) / np.pi) <= error)
    tube = tubes(np.array([0.0, 20.0]), np.array([30.0, -70.0]), 30.0, 0.7)
    torque, error = held.blocked(tube, 1, np.zeros(2), np.ones(2))
    assert np.all(
        np.abs(torque - closed_form.blocked_torque([0.0, 20.0], [30.0, -70.0], 1.0, 0.7) / np.pi) <= error + 1e-14
    )


def test_blocked_force_of_stretched_fibers_is_that_of_figure_2_8():
    """30 degrees, gamma 1.005: 6.99, 14.02, 31.61 N; a wrong guess is no matter."""
    area, c10 = np.pi * 4.76e-3**2, 0.11e6
    tube = tubes(30.0, -30.0, 192 / 4.76, np.array([0.03, 0.05, 0.10]) * 1e6 / c10, ratio=6 / 11, gamma=1.005)
    force, error = held.blocked(tube, 0, 2.0 * tube.half, np.array([7.5, 13.0, 31.0]) / (area * c10))
    assert force * area * c10 == pytest.approx([6.99, 14.02, 31.61], abs=0.005)
    assert np.all(error < 1e-9)


def test_density_is_stationary_where_the_tube_does_not_move():
    tube = tubes(20.0, -50.0, 10.0, 0.0)
    U = density(tube, np.ones(1), np.ones(1))
    assert U.slope == pytest.approx(0.0, abs=1e-14)  # no load, no strain: w' = 0
    assert U.second[0] < 0.0


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    """An atlas with loads, fibers that lie in the wall or stretch, and blocked states."""
    path = tmp_path_factory.mktemp("resolve") / "atlas.nc"
    axes = {name: GRID[name] for name in ("alpha", "beta", "fiber_radius", "force", "pressure")}
    axes |= {"alpha": [-25.0, 30.0], "torque": [0.0, 8e-3], "fiber_extension": [1.0, 1.004]}
    make(path, parse(spec(axes) + "\n[solver]\nblocked = true"))
    return path


def test_stored_points_lie_within_their_bounds(atlas, capsys):
    with open_atlas(atlas) as opened:
        comparisons, notes = resolve(draw(opened.data, 200, seed=3))
        names = {compared.name for compared in comparisons}
        assert names >= {"rotation", "volume", "locked_strain_energy", "blocked_force", "ideal_blocked_torque"}
        assert all(note.startswith("not judged: shapes that turn back") for note in notes)
        for compared in comparisons:
            assert not compared.broken.any(), compared.name
            # blocked states that wave about the straight cylinder are unstable, and not judged
            assert compared.unjudged == 0 or compared.name.startswith("blocked")
            assert len(compared.difference) > 50
    assert run("verify", str(atlas), "--resolve", "40") == 0
    out = capsys.readouterr().out
    assert "every bit" in out
    assert "locked_mid_radius" in out


def test_a_number_outside_its_bound_is_found(atlas, tmp_path, capsys):
    with open_atlas(atlas) as opened:
        data = opened.data.load()
    where = tuple(axis[0] for axis in np.nonzero(np.abs(data["rotation"].values) > 1.0))
    data["rotation"].values[where] *= 1.0 + 1e-4
    comparisons, _ = resolve(draw(data, data["status"].size))
    assert {compared.name: int(compared.broken.sum()) for compared in comparisons if compared.broken.any()} == {
        "rotation": 1
    }
    store(data, tmp_path / "wrong.nc")
    for name in ("rotation", "locked_volume", "blocked_force"):  # within its bound, but beyond a hundredth of it
        bound = data[f"{name}_error"]
        moved = data.assign({name: data[name] + 0.5 * bound, f"{name}_error": bound * np.float32(1e-2)})
        judged = {compared.name: compared.broken for compared in resolve(draw(moved, 100))[0]}
        assert judged[name].any()
    assert run("verify", str(tmp_path / "wrong.nc"), "--resolve", "100000") == 2
    assert "1 stored numbers lie farther" in capsys.readouterr().err


def test_atlases_of_one_point_and_of_none(atlas):
    with open_atlas(atlas) as opened:
        one = opened.data.isel({name: -1 for name in opened.data["status"].dims})
        comparisons, _ = resolve(draw(one, 5))
        assert {len(compared.difference) for compared in comparisons if compared.name == "rotation"} == {1}
        none = opened.data.isel(alpha=[1], beta=[1])  # alpha = beta: degenerate
        assert resolve(draw(none, 5)) == ([], ["no point of this atlas has a result"])


def test_what_cannot_be_solved_anew_is_refused(atlas, capsys):
    with open_atlas(atlas) as opened, pytest.raises(ValueError, match="alpha is no number in this atlas"):
        draw(opened.data.isel(alpha=0).drop_vars("alpha"), 5)
    assert "give 1 or more" in refused(capsys, "verify", str(atlas), "--resolve", "0")
