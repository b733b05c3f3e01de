"""A wall with thickness: its energy against high-precision quadrature, the uniform tube, and the limit of a membrane."""

import warnings

import mpmath
import numpy as np
import pytest

from freesweep import Actuator, NeoHookean, inflate
from freesweep.solver.load import Load
from freesweep.solver.physics import membrane, physical, wall

PARTS = ("w", "y", "G", "psi", "yy", "yG", "ypsi", "GG", "Gpsi", "psipsi")


def exact(y, G, psi, inner, outer, rubber):
    """W by 30-digit quadrature over rho^2."""
    c, c2, c3 = (*rubber, 0.0, 0.0)[:3]
    with mpmath.workdps(30):
        y, G, psi = map(mpmath.mpf, (y, G, psi))

        def w(square):
            q = y**2 + (square - 1) / mpmath.sqrt(G)
            i = G + q / square + q * psi**2 + square / (G * q) - 3
            second = G * q / square + (G + q / square + q * psi**2) * square / (G * q) - 3
            return i + c2 * i**2 + c3 * i**3 + c * second

        return mpmath.quad(w, [mpmath.mpf(inner) ** 2, mpmath.mpf(outer) ** 2])


@pytest.mark.parametrize("thickness", [0.05, 1 / 3, 0.5, 1.0])
@pytest.mark.parametrize("fibers", ["inside", "outside"])
def test_gauss_points_are_as_many_as_the_wall_asks_for(thickness, fibers):
    inner, outer = (1.0, 1 + thickness) if fibers == "inside" else (1 / (1 + thickness), 1.0)
    for y, G, psi in ((1.2, 0.8, -0.3), (1.6, 0.5, 0.0), (0.93, 1.1, 0.5)):
        W = wall.energy(y, G - 1.0, psi, outer**2 - inner**2, (0.5, 0.1, 0.02), (1.0, inner**2, 1.0))[0]
        known = float(exact(y, G, psi, inner, outer, (0.5, 0.1, 0.02)))
        assert pytest.approx(known, rel=1e-6) == W
    assert 2 <= wall.points(inner**2, outer**2 - inner**2) <= 20


@pytest.mark.parametrize("rubber", [(0.5,), (0.0,), (0.5, 0.0, 0.0), (0.5, 0.1, 0.02)])
def test_a_wall_whose_hole_all_but_closes_keeps_its_energy(rubber):
    """A tube that is pulled and turned is thick where it is thin: r_i falls to a tenth of r_o. Meshes take any rubber by
    three constants.
    """
    for inner, y, G, psi in (
        (0.94, 0.3, 25.0, 1.0),
        (0.6, 0.72, 1.55, 2.0),
        (0.38, 0.94, 0.98, 0.0),
        (0.99, 0.11, 9.0, 3.0),
    ):
        assert y * y + (inner**2 - 1.0) / np.sqrt(G) > 0.0
        W = wall.energy(y, G - 1.0, psi, 1.0 - inner**2, rubber, (1.0, inner**2, 1.0))[0]
        assert pytest.approx(float(exact(y, G, psi, inner, 1.0, rubber)), rel=2e-10) == W


def test_energy_of_a_wall_that_is_hardly_strained_has_all_its_digits():
    draw = np.random.default_rng(3)
    for size in (1e-3, 1e-5, 1e-7):
        y, G, psi = 1.0 + size * draw.normal(), 1.0 + size * draw.normal(), size * draw.normal()
        W = wall.energy(y, G - 1.0, psi, 1.0 - 0.7**2, (0.5,), (1.0, 0.7**2, 1.0))[0]
        assert pytest.approx(float(exact(y, G, psi, 0.7, 1.0, (0.5,))), rel=3e-15 / size) == W


def test_partial_derivatives_of_the_wall():
    draw, d = np.random.default_rng(0), 1e-5
    for _ in range(200):
        inner = draw.uniform(0.5, 1.0) ** 2
        area, k = draw.uniform(0.02, 1.0), float(draw.integers(2))
        rubber, thick = (draw.uniform(0, 1), draw.uniform(0, 0.3), draw.uniform(0, 0.05)), (k, inner, 1.0)
        at = np.array([draw.uniform(0.9, 1.8), draw.uniform(0.5, 1.5), draw.uniform(-0.7, 0.7)])
        W = dict(zip(PARTS, wall.energy(at[0], at[1] - 1, at[2], area, rubber, thick)))
        for i, one in enumerate(("y", "G", "psi")):
            low, high = at.copy(), at.copy()
            low[i], high[i] = low[i] - d, high[i] + d
            below, above = (
                dict(zip(PARTS, wall.energy(q[0], q[1] - 1, q[2], area, rubber, thick))) for q in (low, high)
            )
            assert (above["w"] - below["w"]) / (2 * d) == pytest.approx(W[one], rel=1e-6, abs=1e-6)
            for j, two in enumerate(("y", "G", "psi")):
                both = W[one + two] if i <= j else W[two + one]
                assert (above[two] - below[two]) / (2 * d) == pytest.approx(both, rel=1e-5, abs=1e-5)


def test_a_thin_wall_is_a_membrane():
    """Fibers in the middle of the wall: the difference falls with the square of the thickness."""
    cell, H, D = (0.3, 0.6), 0.3, 0.6
    missed = []
    for thickness in (0.02, 0.01):
        inner, outer = 1 - thickness / 2, 1 + thickness / 2
        area = outer**2 - inner**2
        thick, thin = (Load(1.0, (0.5,), w, 2.0, 0.1, 0.2, 1.0) for w in ((1.0, inner**2, 0.0), (1.0,)))
        one = np.array(physical.density(1.2, 0.3, (*cell, area), thick))
        other = np.array(membrane.density(1.2, 0.3, (H, D, area), thin))
        missed.append(np.max(np.abs(one - other)) / area)
    assert missed[1] < missed[0] < 1e-2
    assert missed[1] == pytest.approx(missed[0] / 2, rel=0.6)  # of the energy, whose weight is the area


def stretch(cell, load):
    """Circumferential stretch of the uniform tube: the root of L_y."""
    low, high = 1.0 + 1e-9, 3.0
    for _ in range(200):
        y = 0.5 * (low + high)
        room, L_y, *_ = physical.density(y, 0.0, cell, load)
        low, high = (y, high) if room > 0.0 and L_y > 0.0 else (low, y)
    return y


@pytest.mark.parametrize(("fibers", "thick", "thin"), [("inside", 0.1108, 0.0774), ("outside", 0.1013, 0.1402)])
def test_contraction_of_the_source_s_section_at_half_a_bar(fibers, thick, thin):
    """30 degrees, neo-Hookean 0.1 MPa, 0.5 bar, the source's section: theory, section 11; and 30-digit quadrature."""
    inner, outer = np.array([4.76, 6.35]) / (4.76 if fibers == "inside" else 6.35)
    area, t = outer**2 - inner**2, np.tan(np.radians(30))
    cell = (0.0, t, area)
    for square, contraction, known in ((inner**2, thick, 5e-5), (0.0, thin, 1e-3)):  # thin: of a tube with ends
        load = Load(1.0, (0.0,), (1.0, square, 0.0), 0.5, 0.0, 0.0, 1.0)
        y = stretch(cell, load)
        assert 1 - physical.uniform_tube(y, cell, load)[0] == pytest.approx(contraction, abs=known)

    load = Load(1.0, (0.0,), (1.0, inner**2, 0.0), 0.5, 0.0, 0.0, 1.0)
    with mpmath.workdps(30):
        tt = mpmath.tan(mpmath.radians(30)) ** 2

        def work(y):
            G = 1 + tt - tt * y**2
            return mpmath.mpf("0.5") * y**2 * mpmath.sqrt(G) - exact(y, G, 0, inner, outer, (0.0,))

        step = mpmath.mpf(10) ** -9
        slope = lambda y: (work(y + step) - work(y - step)) / (2 * step)  # noqa: E731
        y = mpmath.findroot(slope, (mpmath.mpf("1.05"), mpmath.mpf("1.3")), solver="illinois", tol=1e-24)
        length = mpmath.sqrt(1 + tt - tt * y**2)
    assert physical.uniform_tube(stretch(cell, load), cell, load)[0] == pytest.approx(float(length), abs=1e-7)


def test_a_body_whose_hole_all_but_closes_is_that_of_eighty_layers():
    """Finite elements of degree 4, with 24, 40 and 80 Gauss points through the wall, agree in these numbers."""
    body = Actuator(
        alpha=-62.1, beta=-69.2, length=0.025426, radius=0.00618, wall=0.002065, taper=0.456, bulge=0.088,
        material=NeoHookean(86982.0), model="physical",
    )  # fmt: skip
    with warnings.catch_warnings(action="ignore"):
        found = inflate(body, 83703.0, force=1.018, torque=0.15223)
    assert found["status"] == 0
    known = {
        "deformed_length": 0.0356574247,
        "rotation": 889.994392,
        "volume": 2.37971075e-07,
        "strain_energy": 0.934872388,
    }
    for name, value in known.items():
        assert found[name].item() == pytest.approx(value, rel=1e-5)
