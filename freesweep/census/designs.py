"""The designs of a census: drawn over the whole domain, and solved by the second method where that is asked."""

from typing import NamedTuple

import numpy as np

from ..description.tube_model import MODELS, SHARES

BLOCK = 256  # designs that are drawn together
PRESSURES = 4  # of each design, beside its locked shape
COLUMNS = (
    "alpha", "beta", "length/radius", "wall/radius", "fiber_extension", "c01/c10", "force", "torque", "pressure", "full",
)  # fmt: skip


class Drawn(NamedTuple):
    """Designs (n, 10): COLUMNS but pressure, angles in degrees, loads in pi r^2 C10 and pi r^3 C10; ``pressures`` (n, m)."""

    designs: np.ndarray
    pressures: np.ndarray

    def problems(self, model=MODELS["source"]):
        """As the kernels take them (n, 11), of physical tubes (n, 13); the fibers lie at the radius 1."""
        alpha, beta, length, wall, gamma, ratio, force, torque, full = self.designs.T
        ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
        inner = 1.0 / (1.0 + SHARES[model.fiber_radius] * wall)
        area, zero = wall * (2.0 + wall) * inner**2, 0.0 * alpha
        columns = (0.5 * (ta + tb), 0.5 * (ta - tb), area, gamma, ratio, full, force, torque, length, zero, zero)
        if model.is_physical:
            columns += inner**2 * model.is_thick, zero + model.is_loose
        return np.column_stack(columns)


def draw(count, seed, block, model=MODELS["source"]) -> Drawn:
    """Random designs of one block: angles 2..85 degrees of both signs and half a degree apart, length/radius 2..200,
    wall/radius 0.03..1, fiber extension 1 (half of them) to 1.02, C01/C10 0..2, force -1..3, torque -1.5..1.5 (each 0 in two
    of five), both strain energies where the ``model`` has them, P/C10 0.003..10. Lengths and loads count by the fibers'
    radius, the wall by the inner one.
    """
    rng = np.random.default_rng([seed, block])
    signs = rng.choice([-1.0, 1.0], (2, BLOCK))
    alpha, beta = signs * rng.uniform(2.0, 85.0, (2, BLOCK))
    beta = np.where(np.abs(alpha - beta) < 0.5, -beta, beta)
    columns = [
        alpha, beta, _spread(rng, 2.0, 200.0), _spread(rng, 0.03, 1.0),
        np.where(rng.random(BLOCK) < 0.5, 1.0, rng.uniform(1.0, 1.02, BLOCK)),
        np.where(rng.random(BLOCK) < 0.25, 0.0, rng.uniform(0.0, 2.0, BLOCK)),
        np.where(rng.random(BLOCK) < 0.4, 0.0, rng.uniform(-1.0, 3.0, BLOCK)),
        np.where(rng.random(BLOCK) < 0.4, 0.0, rng.uniform(-1.5, 1.5, BLOCK)),
        np.where(rng.random(BLOCK) < 0.5, 1.0, float(model.is_loose)),
    ]  # fmt: skip
    pressures = np.sort(_spread(rng, 0.003, 10.0, (BLOCK, PRESSURES)), axis=1)
    return Drawn(np.column_stack(columns)[:count], pressures[:count])


def together(several) -> Drawn:
    """All that was drawn, in this order."""
    return Drawn(*(np.concatenate(arrays) for arrays in zip(*several)))


def _spread(rng, low, high, shape=BLOCK):
    """Numbers of evenly spread size."""
    return np.exp(rng.uniform(np.log(low), np.log(high), shape))


def with_pressures(designs, pressures):
    """Designs with each of their pressures (n, m, 10), in the order of COLUMNS."""
    repeated = np.broadcast_to(designs[:, None, :], (*pressures.shape, designs.shape[1]))
    return np.concatenate([repeated[..., :8], pressures[..., None], repeated[..., 8:]], axis=2)


def words(row):
    """A design in full."""
    return ", ".join(f"{name} {value!r}" for name, value in zip(COLUMNS, row.tolist()))


def quadrature(designs, mid_radius):
    """Values and errors (n, 5) of ``designs`` (n, 10) by the second method, as the kernels give them; NaN: not judged."""
    from ..first_integral.folded import solve_near
    from ..first_integral.tube import SOLVED, solve

    tubes = _tubes(designs)
    found = solve(tubes)
    if (lost := np.flatnonzero(found.reason != SOLVED)).size:
        again = solve_near(tubes.at(lost), mid_radius[lost])
        found.values[lost], found.errors[lost] = again.values, again.errors
    of_half = np.array([0.5, 0.5, 0.5, 0.5, 1.0])
    return found.values * of_half, found.errors * of_half


def quadrature_held(kind, designs, near):
    """Force or torque (n,) that holds the undeformed length or rotation, and its error, by the second method; ``near`` (n,)
    is where it is looked for. NaN: not judged.
    """
    from ..first_integral.held import blocked

    length = designs[:, COLUMNS.index("length/radius")]
    return blocked(
        _tubes(designs), int(kind == "blocked_torque"), length if kind == "blocked_force" else 0.0 * length, near
    )


def _tubes(designs):
    """As the second method takes them; without pressure, what is locked."""
    from ..first_integral.uniform import Tubes

    alpha, beta, length, wall, gamma, ratio, force, torque, pressure, full = designs.T
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    loaded = np.isfinite(pressure)
    loads = np.where(loaded, pressure, 1.0), np.where(loaded, force, 0.0), np.where(loaded, torque, 0.0)
    area, half, zero = wall * (2.0 + wall), 0.5 * length, 0.0 * alpha
    weight = loaded.astype(float)
    return Tubes(0.5 * (ta + tb), 0.5 * (ta - tb), area, gamma, ratio, full, *loads, weight, half, zero, zero)
