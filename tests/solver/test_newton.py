"""The numerics alone, on problems that the solver has never heard of and whose solutions are known in closed form.

* soap film between two rings, ``L = -y sqrt(1 + v^2)``: the catenoid ``y = c cosh((x - X)/c)``,
  a stable and an unstable one
* hanging chain of given length, ``L = -(y - mu) sqrt(1 + v^2)`` with ``int sqrt(1 + v^2)`` held
* Bratu's problem, ``L = -v^2/2 + lambda exp(y - 1)``: a turning point at ``lambda = 3.513830719125...``

Half of each is solved: x from the end to the plane of symmetry at X = 1/2.
"""

from math import cosh, log, pi, sinh, sqrt, tanh

import numpy as np
import pytest
from plain import as_kernels_divide, plain
from scipy.optimize import brentq

from freesweep.solver.free import space
from freesweep.solver.load import NO_CHANGE, Load
from freesweep.solver.numerics import bordered, continuation, error_bounds, held, mesh, nested, newton
from freesweep.solver.numerics.bordered import FOLLOWED
from freesweep.solver.numerics.functional import Functional
from freesweep.solver.numerics.held import NOTHING, Target
from freesweep.solver.numerics.newton import Mesh
from freesweep.solver.numerics.path import Held, Path
from freesweep.solver.numerics.properties_along import Tube

bordered, continuation, held, mesh, nested, newton, space = plain(
    bordered, continuation, held, mesh, nested, newton, space
)  # so small a problem is solved in less time than compiled for
X = 0.5
FILM, BRATU = 0.0, 1.0
BRATU_LIMIT = 3.513830719125162
REST = NO_CHANGE
ALONG_MU = Load(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


def at_point(y, v, cell, load):
    mu = load[3]
    if cell[0] == BRATU:
        growth = mu * np.exp(y - 1.0)
        return 1.0, growth, -v, growth, 0.0, -1.0
    root = sqrt(1.0 + v * v)
    return y - mu, -root, -(y - mu) * v / root, 0.0, -v / root, -(y - mu) / root**3


def density(y, v, cell, load):
    if len(cell) > 4:  # and what is handed on from cell to cell: nothing
        return (*at_point(y, v, cell, load), cell[4])
    return at_point(y, v, cell, load)


def conjugate(y, v, cell, load, direction):
    if cell[0] == BRATU:
        growth = direction[3] * np.exp(y - 1.0)
        return growth, growth, 0.0, 0.0
    root = sqrt(1.0 + v * v)
    return direction[3] * root, 0.0, direction[3] * v / root, 0.0


def integrands(y, v, cell, load):
    """Length of the axis, volume/pi, length of the meridian, area/(2 pi)."""
    root = sqrt(1.0 + v * v)
    if len(cell) > 4:
        return 1.0, y * y, root, y * root, 0.0, cell[4]
    return 1.0, y * y, root, y * root, 0.0


def scales(outputs, cell, load, length, tolerance):
    floor = 2e-13 + 10.0 * tolerance
    return (1.0, 1.0, 1.0, 1.0, 1.0, 1.0), (floor, floor, floor, floor, floor, floor)


FUNCTIONAL = Functional(density, conjugate, integrands, scales)


@pytest.fixture(autouse=True)
def division():
    with as_kernels_divide():
        yield


def catenoid(c):
    """The six outputs of half a catenoid, exactly."""
    area = X / 2 + c / 4 * sinh(2 * X / c)
    return np.array([X, c * c * area, c * sinh(X / c), c * area, c, 0.0])


STABLE, UNSTABLE = (brentq(lambda c: c * cosh(X / c) - 1.0, *pair, xtol=1e-15) for pair in ((0.5, 1.0), (0.1, 0.4)))


def bratu_theta(strength, pair=(0.01, 4.7)):
    """Parameter of Bratu's ``y = 1 - 2 log(cosh(theta (X - x)/2)/cosh(theta/4))``; the lower branch by default."""
    return brentq(lambda t: t / cosh(t / 4) - sqrt(2 * strength), *pair, xtol=1e-15)


def bratu(theta):
    def y(x):
        return 1.0 - 2.0 * log(cosh(theta * (X - x) / 2) / cosh(theta / 4))

    def v(x):
        return theta * tanh(theta * (X - x) / 2)

    def total(function):
        return 0.5 * X * sum(w * function(0.5 * X * (1 + t)) for t, w in zip(*np.polynomial.legendre.leggauss(60)))

    return y, [
        X,
        total(lambda x: y(x) ** 2),
        total(lambda x: sqrt(1 + v(x) ** 2)),
        total(lambda x: y(x) * sqrt(1 + v(x) ** 2)),
        y(X),
        0.0,
    ]


def on_one_mesh(x, y, cell, load, free=True, tolerance=1e-14):
    """Newton on one mesh: (status, negative pivots)."""
    work = np.zeros((13, len(x)))
    own = Mesh(x, len(x) - 1, free, np.array([[cell, 0.0, 0.0]]))
    return newton.solve(density, y, own, load, newton.UNKNOWN, tolerance, work)[:2]


def on_nested_meshes(x, y, cell, load=REST, target=NOTHING, mu=0.0, accuracy=1e-8):
    """``(status, unstable, doublings, values, bounds, table)`` of nested.solve."""
    room = space.make_space(len(x) - 1, 1)
    room.x[:], room.y[:] = x, y
    course, last = np.zeros((1, 1, 3, 4)), len(x) - 1
    course[0, 0, 0, 0] = cell
    tube = Tube(course, np.array([0, last]), np.zeros((1, 3)), True, last, np.array([0.0, X]))
    status, unstable, doublings = nested.solve(FUNCTIONAL, room, tube, load, target, mu, 2, accuracy)
    return status, unstable, doublings, room.out[0], room.out[1], room.table


def start(cells=24, value=1.0):
    x = np.empty(cells + 1)
    mesh.layer_mesh(X, 2.0, cells, x)
    return x, np.full(cells + 1, value)


def curvature(x, y, cell, load, free):
    """Negative pivots of the second variation at y: unstable directions."""
    n = len(x) - 1
    own = newton.system_in(np.zeros((8, n + 1)))
    assert newton.assemble(density, x, y, n, np.array([[cell, 0.0, 0.0]]), load, False, own)
    return newton.factor(own.d, own.e, 1, n if free else n - 1, own.inverse)


def orders(errors):
    return np.log2(np.abs(errors[:-1] / errors[1:]))


def test_a_soap_film_is_a_catenoid():
    x, y = start()
    status, negative = on_one_mesh(x, y, FILM, REST)
    assert (status, negative) == (newton.CONVERGED, 0)
    assert y == pytest.approx(STABLE * np.cosh((X - x) / STABLE), abs=2e-4)


@pytest.mark.parametrize(("cell", "load"), [(FILM, REST), (BRATU, Load(0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0))])
def test_one_mesh_is_of_second_order_and_extrapolation_of_fourth(cell, load):
    exact = catenoid(STABLE) if cell == FILM else np.array(bratu(bratu_theta(3.0))[1])
    x, y = start()
    status, *_, table = on_nested_meshes(x, y, cell, load, accuracy=1e-30)
    assert status == nested.UNREACHED
    # volume, meridian, area and middle on meshes of 24, 48, ... cells, as far as rounding lets one see the order
    error = (table - exact)[:, 1:5]
    assert orders(error[2:7]) == pytest.approx(2.0, abs=0.05)
    extrapolated = ((4 * table[1:] - table[:-1]) / 3 - exact)[:, 1:5]
    seen = extrapolated[1:5]
    assert np.all(np.abs(seen) > 1e-14)
    assert orders(seen)[-1] == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("cells", [12, 24])
def test_bounds_hold_and_meet_the_accuracy_asked_for(accuracy, cells):
    problems = [(FILM, 0.0, catenoid(STABLE))]
    problems += [(BRATU, mu, np.array(bratu(bratu_theta(mu))[1])) for mu in (0.3, 1.0, 2.0, 3.0, 3.4)]
    for cell, mu, exact in problems:
        x, y = start(cells)
        load = Load(0.0, 0.0, 0.0, mu, 0.0, 0.0, 0.0)
        status, unstable, _, values, bounds, _ = on_nested_meshes(x, y, cell, load, accuracy=accuracy)
        assert (status, unstable) == (newton.CONVERGED, 0)
        assert np.all(np.abs(values - exact)[:5] <= bounds[:5]), (cell, mu)
        assert np.all(bounds <= 1.01 * accuracy + 1e-10)


def test_a_chain_of_given_length_hangs_as_a_catenary():
    """The held integral's multiplier is the level from which the catenary's height counts."""
    length = 0.6
    c = brentq(lambda t: t * sinh(X / t) - length, 0.1, 2.0, xtol=1e-15)
    x, _ = start()
    y = 1.0 - 0.5 * np.sin(0.5 * pi * x / X)
    status, unstable, _, values, bounds, _ = on_nested_meshes(
        x, y, FILM, target=Target(ALONG_MU, length, True), mu=0.2, accuracy=1e-8
    )
    assert (status, unstable) == (newton.CONVERGED, 0)
    exact = 1.0 - c * cosh(X / c)
    assert values[error_bounds.MIDDLE] == pytest.approx(exact + c, abs=1e-8)
    assert abs(values[error_bounds.MULTIPLIER] - exact) <= bounds[error_bounds.MULTIPLIER] < 2e-8
    assert values[2] == pytest.approx(length, abs=1e-12)


def fold_of_bratu(cells, begin):
    """Strength at the fold of Bratu's problem on one mesh, by continuation from a state of that strength."""
    x, y = start(cells)
    load = Load(0.0, 0.0, 0.0, begin, 0.0, 0.0, 0.0)
    assert on_one_mesh(x, y, BRATU, load)[0] == newton.CONVERGED
    track = space.make_track(cells, True, False)
    track.x[:], track.y[:] = x, y
    path, own, work = Path(REST, ALONG_MU, 0.0, False), np.array([[BRATU, 0.0, 0.0]]), np.zeros((13, cells + 2))
    status, _, mu, slope = bordered.correct(
        FUNCTIONAL, track, track.y, begin, cells, own, path, 1.0, track.tangent, work
    )
    assert status == FOLLOWED
    slope, step = continuation.make_unit(track, cells, mu, slope, path), 0.01
    while True:
        status, negative, ahead, next_slope, made, step = continuation.advance(
            FUNCTIONAL, track, cells, own, path, (mu, slope), step, work
        )
        assert status == FOLLOWED
        if not continuation.is_stable(negative, next_slope, 1.0):
            return continuation.last_alike(FUNCTIONAL, track, cells, own, path, (mu, slope), made, 1.0, True, work)[0]
        track.y[:], track.tangent[:] = track.next_y, track.next_tangent
        mu, slope = ahead, continuation.make_unit(track, cells, ahead, next_slope, path)


@pytest.mark.parametrize("begin", [0.5, 2.0, 3.4])
def test_the_fold_of_bratus_problem(begin):
    folds = np.array([fold_of_bratu(cells, begin) for cells in (48, 96, 192)])
    assert np.all(np.diff(abs(folds - BRATU_LIMIT)) < 0.0)
    extrapolated = (4.0 * folds[1:] - folds[:-1]) / 3.0
    assert extrapolated[-1] == pytest.approx(BRATU_LIMIT, abs=2e-8)


def test_where_the_conjugate_integral_is_held_a_way_goes_on_through_the_fold():
    """Its load rises to the fold's and falls again; all states are stable while it is held."""
    cells, work, own = 96, np.zeros((13, 98)), np.array([[BRATU, 0.0, 0.0]])
    track = space.make_track(cells, True, True)
    track.x[:], track.y[:-1] = start(cells)
    load = Load(0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0)
    assert on_one_mesh(track.x, track.y[:-1], BRATU, load)[0] == newton.CONVERGED
    first, _ = held.hold(conjugate, track.x, track.y, cells, own, load, ALONG_MU, work[8])
    track.y[-1] = 2.0
    path = Path(REST, REST, 1.0, False, Held(ALONG_MU, first, 9.0 * first, True, 0))
    status, _, mu, slope = bordered.correct(FUNCTIONAL, track, track.y, 0.0, cells, own, path, 1.0, track.tangent, work)
    slope, step, loads, shares = continuation.make_unit(track, cells, mu, slope, path), 0.01, [], []
    while mu < 1.0:
        status, unstable, mu, slope, _, step = continuation.advance(
            FUNCTIONAL, track, cells, own, path, (mu, slope), step, work
        )
        assert (status, unstable) == (FOLLOWED, 0)
        track.y[:], track.tangent[:] = track.next_y, track.next_tangent
        slope = continuation.make_unit(track, cells, mu, slope, path)
        loads.append(track.y[-1])
        shares.append(mu)
    top = int(np.argmax(loads))
    assert 0 < top < len(loads) - 1
    a, b, c = np.polyfit(np.array(shares)[top - 1 : top + 2], loads[top - 1 : top + 2], 2)
    assert c - b * b / (4.0 * a) == pytest.approx(fold_of_bratu(cells, 2.0), rel=5e-4)


def test_no_state_is_found_beyond_the_turning_point():
    x, y = start()
    load = Load(0.0, 0.0, 0.0, 1.02 * BRATU_LIMIT, 0.0, 0.0, 0.0)
    assert on_one_mesh(x, y, BRATU, load)[0] != newton.CONVERGED


STRINGS = [(0.9, False, 0), (1.1, False, 1), (2.5, False, 2), (5.5, False, 5)]
STRINGS += [(0.4, True, 0), (0.6, True, 1), (1.4, True, 1), (1.6, True, 2)]


@pytest.mark.parametrize(("waves", "free", "unstable"), STRINGS)
def test_pivots_count_the_unstable_directions_of_a_string(waves, free, unstable):
    """-v^2/2 + k^2 y^2/2 on 0..X, held ends: as many unstable sines as half waves of wave number k fit in; with one end
    free, quarter waves.

    Bratu's density at y = 1 has this second variation, with k^2 = lambda.
    """
    x = np.linspace(0, X, 801)
    k = waves * pi / X
    assert curvature(x, np.ones_like(x), BRATU, Load(0.0, 0.0, 0.0, k * k, 0.0, 0.0, 0.0), free) == unstable


def test_the_deep_soap_film_is_unstable():
    """Of two catenoids through the same rings only the shallow one is stable; Newton never settles on the other."""
    x = np.linspace(0, X, 801)
    shallow, deep = (c * np.cosh((X - x) / c) for c in (STABLE, UNSTABLE))
    assert curvature(x, shallow, FILM, REST, True) == 0
    assert curvature(x, deep, FILM, REST, True) == 1
    y = deep.copy()
    status, _ = on_one_mesh(x, y, FILM, REST)
    assert status != newton.CONVERGED or abs(y[-1] - STABLE) < 1e-3


@pytest.mark.parametrize(("strength", "pair", "sign"), [(2.0, (0.01, 4.7), 1), (2.0, (4.9, 20.0), -1)])
def test_holding_the_conjugate_integral_stabilises_the_upper_branch(strength, pair, sign):
    """Bratu's upper branch has one unstable direction, none while ``int exp(u)`` is held."""
    shape, _ = bratu(bratu_theta(strength, pair))
    x = np.linspace(0, X, 401)
    y = np.array([shape(t) for t in x])
    cells, load = np.array([[BRATU, 0.0, 0.0]]), Load(0.0, 0.0, 0.0, strength, 0.0, 0.0, 0.0)
    assert curvature(x, y, BRATU, load, True) == (0 if sign > 0 else 1)
    work = np.zeros((13, len(x)))
    target, _ = held.hold(conjugate, x, y, len(x) - 1, cells, load, ALONG_MU, work[8])
    own, what = Mesh(x, len(x) - 1, True, cells), Target(ALONG_MU, target, True)
    status, unstable, mu = held.solve_held(FUNCTIONAL, y, own, REST, what, 0.9 * strength, 1e-12, work)
    assert (status, unstable) == (newton.CONVERGED, 0)
    assert mu == pytest.approx(strength, rel=1e-4)
