"""The physics at one point, against SymPy, high precision and the closed forms of the source."""

from decimal import Decimal, getcontext
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
import sympy as sp
from oracle import PARAMETERS, V, Y, expressions, half_sum_and_difference

from freesweep import closed_form
from freesweep.solver.load import Load
from freesweep.solver.physics import lagrangian

rng = np.random.default_rng


def random_point(draw, energy=None):
    """An admissible point: (y, v, cell, load, the same as SymPy's values)."""
    while True:
        alpha, beta = draw.uniform(2, 85), draw.uniform(-85, 85)
        if abs(alpha - beta) < 1.0:
            continue
        H, D = half_sum_and_difference(alpha, beta)
        gamma, c, a = draw.uniform(1, 1.02), draw.uniform(0, 1), draw.uniform(0.04, 3)
        k = float(draw.integers(2)) if energy is None else float(energy)
        p, f, m = draw.uniform(0.01, 50), draw.uniform(-3, 3), draw.uniform(-3, 3)
        e = float(draw.integers(2))
        c2, c3 = (draw.uniform(-0.2, 0.5), draw.uniform(-0.05, 0.1)) if draw.integers(2) else (0.0, 0.0)  # Yeoh's
        y = draw.uniform(0.5, 2.0)
        G = gamma**2 * (1 + H**2 + D**2) - (D * y) ** 2 - gamma**4 * (H / y) ** 2
        if G < 0.05:
            continue
        v = draw.uniform(-0.95, 0.95) * np.sqrt(G)
        cell, load = (H, D, a), Load(gamma, (c, c2, c3), (k,), p, f, m, e)
        return y, v, cell, load, (H, D, a, gamma, c, k, p, f, m, e, c2, c3)


@pytest.fixture(scope="module")
def symbolic():
    have = expressions()
    L, w, psi, s = have["L"], have["w"], have["psi"], have["s"]
    dp, df, dm = sp.symbols("dp df dm")
    p, f, m = PARAMETERS[6], PARAMETERS[7], PARAMETERS[8]
    c = dp * sp.diff(L, p) + df * sp.diff(L, f) + dm * sp.diff(L, m)

    def function(*what):
        return sp.lambdify((Y, V, PARAMETERS, (dp, df, dm)), what, "numpy", cse=True)

    return {
        "density": function(*(sp.diff(L, *d) for d in ((Y,), (V,), (Y, Y), (Y, V), (V, V)))),
        "first": function(w.subs({q: 0 for q in (PARAMETERS[4], *PARAMETERS[10:])})),
        "energy": function(w, sp.diff(w, Y), sp.diff(w, Y, 2)),
        "kinematics": function(
            psi, sp.diff(psi, Y), sp.diff(psi, Y, 2), have["G"] - 1, sp.diff(have["G"], Y), sp.diff(have["G"], Y, 2)
        ),
        "conjugate": function(c, sp.diff(c, Y), sp.diff(c, V)),
        "integrands": function(s, Y**2 * s, psi, PARAMETERS[2] * w),
        "room": function(have["G"] - V**2, have["T"]),
    }


def agree(ours, theirs, size=1.0, tolerance=1e-12):
    """Relative to the value, or to the size of the terms that it is the small difference of."""
    ours, theirs = np.array(ours, float), np.array(theirs, float)
    assert np.all(np.abs(ours - theirs) <= tolerance * np.maximum(np.abs(theirs), size)), (ours, theirs)


@pytest.mark.parametrize("seed", range(200))
def test_partial_derivatives_against_sympy(symbolic, seed):
    y, v, cell, load, values = random_point(rng(seed))
    exact = [np.longdouble(q) for q in values]
    args = (np.longdouble(y), np.longdouble(v), exact, [np.longdouble(q) for q in (0.3, -0.7, 1.9)])
    H, D, a, _, c, _, p, f, m, _, c2, c3 = values
    G = 1 + lagrangian.kinematics(y, cell, load)[3]
    # the terms that cancel: stiff angles and a nearly exhausted axial stretch make them large
    stiff = (1 + H * H / min(y, 1) ** 4 + D * D) ** 2 * (1 + 1 / min(G, 1)) ** 3 * (1 + 1 / min(y, 1)) ** 4
    first = symbolic["first"](*args)[0]
    raised = stiff * (1 + (abs(c2) + abs(c3) * (first + stiff)) * (first + stiff))
    agree(lagrangian.kinematics(y, cell, load), symbolic["kinematics"](*args), 1 + H * H / y**4 + D * D)
    agree(lagrangian.strain_energy(y, cell, load), symbolic["energy"](*args), raised)
    near = G - v * v
    size = (abs(p) * y * y + abs(f) + abs(m) + a * (c + raised / stiff)) * stiff / min(near, 1) ** 1.5
    room, *partials = lagrangian.density(y, v, cell, load)
    agree(partials, symbolic["density"](*args), size, 1e-13)
    agree(room, min(symbolic["room"](*args)), 1 + H * H / y**4 + D * D + p * y * y + abs(f))
    agree(
        lagrangian.conjugate(y, v, cell, load, Load(0, 0, 0, 0.3, -0.7, 1.9, 0))[:3],
        symbolic["conjugate"](*args),
        size,
    )
    agree(lagrangian.integrands(y, v, cell, load)[:4], symbolic["integrands"](*args), raised)


@pytest.mark.parametrize("seed", range(20))
def test_partial_derivatives_against_complex_step(seed):
    """The Python source itself, differentiated without SymPy: L_y, L_v of the density that the outputs integrate."""
    y, v, cell, load, _ = random_point(rng(1000 + seed))
    gamma, (c, c2, c3), (k,), p, f, m, e = load
    H, D, a = cell
    h = 1e-30j

    def density(y, v):
        psi = H * (gamma**2 / y**2 - 1)
        G = gamma**2 * (1 + H**2 + D**2) - (D * y) ** 2 - gamma**4 * (H / y) ** 2
        q = 1 + k * psi * psi
        i = G + y**2 * q + 1 / (G * y**2) - 3
        w = i + c2 * i**2 + c3 * i**3 + c * (G * y**2 + 1 / y**2 + q / G - 3)
        return (p * y**2 + f) * np.sqrt(G - v * v) - e * a * w + m * psi

    _, L_y, L_v, *_ = lagrangian.density(y, v, cell, load)
    assert L_y == pytest.approx(density(y + h, v).imag / 1e-30, rel=1e-11, abs=1e-11 * (1 + H * H + D * D) ** 2)
    assert L_v == pytest.approx(density(y, v + h).imag / 1e-30, rel=1e-11)


@pytest.mark.parametrize("shear", [0.0, 1.0])
@pytest.mark.parametrize("strain", [1e-12, 1e-10, 1e-8, -1e-8, 1e-6, 1e-4])
def test_strain_energy_keeps_its_digits_near_the_undeformed_state(strain, shear):
    """Sixty decimal digits against doubles: w is a square of the strain, of which a plain formula keeps nothing."""
    getcontext().prec = 60
    for alpha, beta in [(30, -30), (0, 30), (10, 50), (60, 55), (80, -20), (5, -85)]:
        H, D = half_sum_and_difference(alpha, beta)
        y, c = 1.0 + strain, 0.4
        h, d, t, ratio = Decimal(float(H)), Decimal(float(D)), Decimal(y) ** 2, Decimal(c)
        psi = h * (1 / t - 1)
        G = 1 + h * h + d * d - d * d * t - h * h / t
        q = 1 + Decimal(shear) * psi * psi
        first = G + t * q + 1 / (G * t) - 3
        exact = first + ratio * (G * t + 1 / t + q / G - 3) + first**2 / 2 + first**3 / 4
        exact_slope = float(exact) * 2 / strain  # of a quadratic, to first order
        load = Load(1.0, (c, 0.5, 0.25), (shear,), 0.0, 0.0, 0.0, 1.0)
        w, w_y, w_yy = lagrangian.strain_energy(y, np.array([H, D, 1.0]), load)
        rounding = 1e-11 + shear * 1e-15 / abs(strain)  # psi carries the rounding of 1/y^2, as any computed y does
        assert w == pytest.approx(float(exact), rel=rounding, abs=0)
        if abs(strain) < 1e-6:
            assert w_yy == pytest.approx(2 * float(exact) / strain**2, rel=1e-3)
            assert w_y == pytest.approx(exact_slope, rel=1e-3, abs=1e-12 * w_yy)


def test_energy_curvature_of_the_undeformed_wall():
    """w_yy = 8 (1 + c)(1 + q + q^2 [+ H^2]) at y = 1, q = tan(alpha) tan(beta) (theory, section 5)."""
    for alpha, beta in [(30, -30), (0, 30), (10, 50), (70, 20)]:
        H, D = half_sum_and_difference(alpha, beta)
        q = tan(radians(alpha)) * tan(radians(beta))
        for shear in (0.0, 1.0):
            load = Load(1.0, (0.3, 0.7, -0.2), (shear,), 0, 0, 0, 1.0)
            _, w_y, w_yy = lagrangian.strain_energy(1.0, np.array([H, D, 1.0]), load)
            assert w_y == pytest.approx(0, abs=1e-13 * w_yy)
            assert w_yy == pytest.approx(8 * 1.3 * (1 + q + q * q + shear * H * H), rel=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_both_energies_agree_for_mckibben_muscles(seed):
    draw = rng(50 + seed)
    alpha, y = draw.uniform(20, 80), draw.uniform(0.9, 1.02)
    cell = (0.0, tan(radians(alpha)), 0.7)
    principal, full = (Load(1.01, (0.4, 0.3, 0.1), (shear,), 1.5, 0.2, 0.0, 1.0) for shear in (0.0, 1.0))
    assert lagrangian.strain_energy(y, cell, principal) == lagrangian.strain_energy(y, cell, full)
    assert lagrangian.density(y, 0.1, cell, principal) == lagrangian.density(y, 0.1, cell, full)


def test_energies_differ_where_the_tube_twists():
    H, D = half_sum_and_difference(0, 30)
    loads = [Load(1.0, (0.0, 0.0, 0.0), (k,), 0, 0, 0, 1.0) for k in (0.0, 1.0)]
    both = [lagrangian.strain_energy(1.2, np.array([H, D, 1.0]), load)[0] for load in loads]
    psi = H * (1 / 1.44 - 1)
    assert both[1] - both[0] == pytest.approx(1.44 * psi**2, rel=1e-12)  # C01 = 0: y^2 psi^2 in I1


def fiber_tensions(alpha, beta, tau):
    """Tension of each whole family, in pi r0^2 C10 (gamma = 1)."""
    return 2 * tau[0] / cos(radians(alpha)), 2 * tau[1] / cos(radians(beta))


@pytest.mark.parametrize("alpha", [10, 30, 54.7356, 75])
def test_fiber_tension_of_a_blocked_mckibben_muscle(alpha):
    """pi r0^2 P cos/sin^2 in each family: hoop and axial balance of a netting, worked out by hand."""
    p = 2.5
    q = -(tan(radians(alpha)) ** 2)
    f = -p * (1 + 2 / q)  # Eq. 2.16
    cell, load = np.array([0.0, tan(radians(alpha)), 0.8]), Load(1.0, (0.3, 0.5, 0.1), (1.0,), p, f, 0.0, 1.0)
    for tension in fiber_tensions(alpha, -alpha, lagrangian.fiber_multipliers(1.0, 1.0, cell, load)):
        assert tension == pytest.approx(p * cos(radians(alpha)) / sin(radians(alpha)) ** 2, rel=1e-12)


@pytest.mark.parametrize(("alpha", "beta"), [(30, -45), (10, -70), (60, -5), (80, -81)])
def test_fiber_tensions_balance_the_blocked_tube(alpha, beta):
    """Netting statics of the cylinder y = 1 under pressure and blocked force, independent of the Lagrangian.

    Tension T_i at angle i: axial sum T cos = pi r0^2 (P + F), torque sum T sin = 0, hoop sum T sin^2/cos = 2 pi r0^2 P.
    """
    p = 1.7
    f = closed_form.blocked_force(alpha, beta, 1.0, p) / pi
    H, D = half_sum_and_difference(alpha, beta)
    load = Load(1.0, (0.2, 0.5, 0.1), (1.0,), p, float(f), 0.0, 1.0)
    tension = fiber_tensions(alpha, beta, lagrangian.fiber_multipliers(1.0, 1.0, np.array([H, D, 0.5]), load))
    sines, cosines = np.sin(np.radians([alpha, beta])), np.cos(np.radians([alpha, beta]))
    assert np.dot(tension, cosines) == pytest.approx(p + f, rel=1e-11)
    assert np.dot(tension, sines) == pytest.approx(0, abs=1e-11 * max(map(abs, tension)))
    assert np.dot(tension, sines**2 / cosines) == pytest.approx(2 * p, rel=1e-11)


@pytest.mark.parametrize(
    ("alpha", "beta", "expected"),
    [
        (0, 30, (-2.5, 3.0)),
        (0, 45, (-0.5, 1.0)),
        (10, -40, (-0.96, 1.46)),
        (10, 50, (-0.21, 0.71)),
        (0, 60, (1 / 6, 1 / 3)),
    ],
)
def test_blocked_torque_can_need_fibers_that_push(alpha, beta, expected):
    """The table of theory, section 3, at y = 1 with the rotation held."""
    p = 0.8
    m = float(closed_form.blocked_torque(alpha, beta, 1.0, p)) / pi
    H, D = half_sum_and_difference(alpha, beta)
    load = Load(1.0, (0.3, 0.5, 0.1), (1.0,), p, 0.0, m, 1.0)
    tau = lagrangian.fiber_multipliers(1.0, 1.0, np.array([H, D, 0.6]), load)
    assert np.array(tau) / p == pytest.approx(expected, abs=0.0051)


@pytest.mark.parametrize("seed", range(30))
def test_fiber_multipliers_solve_the_constrained_problem(seed):
    """With the constraints of Eqs. 2.3 and 2.4 priced by the multipliers, nothing is gained by changing G or psi."""
    y, v, cell, load, _ = random_point(rng(2000 + seed))
    _, (c, c2, c3), (k,), p, f, m, e = load
    H, D, a = cell
    psi, _, _, G_1, _, _ = lagrangian.kinematics(y, cell, load)
    tau_a, tau_b = lagrangian.fiber_multipliers(y, np.sqrt(1 + G_1 - v * v), cell, load)

    def priced(G, psi):
        q = 1 + k * psi * psi
        i = G + y**2 * q + 1 / (G * y**2) - 3
        w = i + c2 * i**2 + c3 * i**3 + c * (G * y**2 + 1 / y**2 + q / G - 3)
        cost = tau_a * (G + y**2 * (H + D + psi) ** 2) + tau_b * (G + y**2 * (H - D + psi) ** 2)
        return (p * y**2 + f) * np.sqrt(G - v * v) - e * a * w + m * psi - cost

    h = 1e-30
    size = 1 + abs(tau_a) + abs(tau_b) + a + (p * y * y + abs(f)) / (1 + G_1 - v * v) ** 0.5
    assert priced(1 + G_1 + 1j * h, psi).imag / h == pytest.approx(0, abs=1e-10 * size / (1 + G_1) ** 2)
    assert priced(1 + G_1, psi + 1j * h).imag / h == pytest.approx(0, abs=1e-10 * size * (1 + H * H + D * D))


@pytest.mark.parametrize("seed", range(30))
def test_locked_uniform_tube_lies_on_the_locked_manifold(seed):
    """1 + 2 cot(alpha') cot(beta') = 0, and no uniform stretch encloses more volume (Eq. 2.12)."""
    _, _, cell, load, _ = random_point(rng(3000 + seed))
    u = lagrangian.locked_stretch(cell, load[0])
    H, D = cell[0], cell[1]
    psi, _, _, G_1, _, _ = lagrangian.kinematics(u, cell, load)
    product = u * u * (H + D + psi) * (H - D + psi) / (1 + G_1)
    assert product == pytest.approx(-2, rel=1e-9)
    volumes = [t * t * np.sqrt(1 + lagrangian.kinematics(t, cell, load)[3]) for t in (0.999 * u, u, 1.001 * u)]
    assert volumes[1] > max(volumes[0], volumes[2])
