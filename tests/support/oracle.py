"""Independent solutions of the boundary-value problem; nothing here shares code with freesweep.

``first_integral``: constant angles and wall leave the density free of x, so L - y' L_y' is constant along the tube::

    T G/s - a w + m psi = U(y_m),   T = p y^2 + f,   U(y) = T sqrt(G) - a w + m psi

With D(y) = U(y_m) - U(y) the slope is explicit, y'^2 = G D (2 T sqrt(G) + D)/(T sqrt(G) + D)^2, and everything is a
quadrature. The middle stretch y_m lies exponentially close to the stretch u of the uniform tube, U'(u) = 0. With
z = |u - y| = e cosh(theta) and e = |u - y_m| the integrand is smooth and almost constant along the tube, and
theta = 0 is its middle; where e falls below rounding, only the difference from the uniform tube is integrated.

``collocation``: SciPy's solve_bvp on the canonical form (y, q = L_y') of the Euler-Lagrange equation; parameters may
vary along x. Both take their expressions from SymPy, in extended precision where differences are small.

Lengths in r0, volumes in pi r0^3, energies in pi r0^3 C10, rotation in rad, all of the WHOLE tube.
"""

from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise

import numpy as np
import sympy as sp
from scipy.integrate import solve_bvp
from scipy.optimize import brentq, minimize_scalar
from sympy.printing.numpy import NumPyPrinter

PARAMETERS = sp.symbols("H D a g c k p f m e c2 c3", real=True)
Y, V = sp.symbols("y v", real=True)


def _gauss(n):
    """Gauss-Legendre nodes and weights on -1..1, to the rounding of extended precision."""
    x = np.asarray(np.polynomial.legendre.leggauss(n)[0], np.longdouble)
    for _ in range(3):
        before, here = np.ones_like(x), x.copy()
        for k in range(2, n + 1):
            before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
        slope = n * (x * here - before) / (x * x - 1)
        x = x - here / slope
    return x, 2 / ((1 - x * x) * slope**2)


NODES, WEIGHTS = _gauss(16)
NODES, WEIGHTS = 0.5 * (NODES + 1), 0.5 * WEIGHTS  # on 0..1
FEW_NODES, FEW_WEIGHTS = _gauss(8)  # for short stretches of a smooth function
FEW_NODES, FEW_WEIGHTS = 0.5 * (FEW_NODES + 1), 0.5 * FEW_WEIGHTS
DEEP = 34.0  # e-folds between end and middle beyond which the middle is uniform to rounding
ENERGIES = {"principal": 0, "full": 1}


class NoState(Exception):
    """The branch from the undeformed cylinder does not reach this load, or not as a shape between 1 and u."""


class Products(NumPyPrinter):
    """Whole and half powers as products and roots: ``powl`` costs as much as thirty of them."""

    def _print_Pow(self, expr, rational=False):
        base, power = expr.as_base_exp()
        if not (2 * power).is_Integer or power == sp.S.Half:
            return super()._print_Pow(expr, rational)
        printed = f"({self._print(base)})"
        whole, half = divmod(abs(int(2 * power)), 2)
        product = "*".join([printed] * whole + [f"numpy.sqrt({printed})"] * half)
        return f"({product})" if power > 0 else f"(1.0/({product}))"


@cache
def expressions():
    """Symbolic G, psi, w, density L and uniform density U (theory.md, sections 2 and 3)."""
    H, D, a, g, c, k, p, f, m, e, c2, c3 = PARAMETERS
    psi = H * (g**2 / Y**2 - 1)
    G = g**2 * (1 + H**2 + D**2) - D**2 * Y**2 - g**4 * H**2 / Y**2
    # k = 1: invariants of the in-plane tensor C, k = 0: lambda_1 and lambda_2 are the principal stretches
    C = sp.Matrix([[G + k * Y**2 * psi**2, sp.sqrt(k) * Y**2 * psi], [sp.sqrt(k) * Y**2 * psi, Y**2]])
    thickness = 1 / (G * Y**2)  # det C = G y^2
    first = C.trace() + thickness
    second = G * Y**2 + C.trace() * thickness
    w = (first - 3) + c * (second - 3) + c2 * (first - 3) ** 2 + c3 * (first - 3) ** 3
    T = p * Y**2 + f
    s = sp.sqrt(G - V**2)
    return {
        "G": G,
        "psi": psi,
        "w": w,
        "T": T,
        "s": s,
        "L": T * s - e * a * w + m * psi,
        "U": T * sp.sqrt(G) - e * a * w + m * psi,
        "size": sp.Abs(p * Y**2) * sp.sqrt(G) + sp.Abs(f) * sp.sqrt(G)
        + e * a * (G + Y**2 + thickness + c * (G * Y**2 + 2)) + sp.Abs(m) * (1 + sp.Abs(H)),
    }  # fmt: skip


@cache
def compiled():
    """The uniform quantities as functions of (y, parameters)."""
    have = expressions()
    arguments = (Y, PARAMETERS)

    def numpy_function(*what, of=arguments):
        return sp.lambdify(of, what, "numpy", cse=True, printer=Products)

    return {
        "state": numpy_function(have["G"], have["psi"], have["w"], have["T"]),
        "U": numpy_function(have["U"], have["size"]),
        "slopes": numpy_function(sp.diff(have["U"], Y), sp.diff(have["U"], Y, 2)),
        "curvature": numpy_function(sp.diff(have["U"], Y, 2)),
        "w_yy": numpy_function(sp.diff(have["w"], Y, 2)),
        "canonical": numpy_function(sp.diff(have["L"], Y), have["G"], have["T"], of=(Y, V, PARAMETERS)),
    }


def half_sum_and_difference(alpha, beta):
    """H and D of the theory from angles in degrees."""
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    return 0.5 * (ta + tb), 0.5 * (ta - tb)


def parameters(alpha, beta, area, ratio, p, f, m, gamma, energy, weight=1.0):
    """All parameters of the density, extended precision; ``ratio``: C01/C10, or (C01, C20, C30)/C10."""
    H, D = half_sum_and_difference(alpha, beta)
    c, *yeoh = _ratios(ratio)
    return tuple(np.longdouble(q) for q in (H, D, area, gamma, c, ENERGIES[energy], p, f, m, weight, *yeoh))


def _ratios(ratio):
    return ratio if isinstance(ratio, tuple) else (ratio, 0.0, 0.0)


def _between(start, end, t):
    return tuple(a + t * (b - a) for a, b in zip(start, end))


def follow_uniform(u, start, end, largest_change=0.05):
    """Carry the stationary stretch of the uniform tube along a straight line of parameters; NoState at a fold."""
    slopes = compiled()["slopes"]
    t, step = 0.0, 1 / 16
    while t < 1.0:
        ahead = min(1.0, t + step)
        now = _between(start, end, ahead)
        trial, arrived = np.longdouble(u), False
        with np.errstate(all="ignore"):
            for _ in range(40):
                slope, curvature = slopes(trial, now)
                if not curvature < 0:
                    break
                change = -slope / curvature
                trial = trial + change
                if not abs(trial - u) < largest_change * u:
                    break
                if abs(change) < 1e-17 * u:
                    arrived = True
                    break
        if arrived:
            t, u, step = ahead, trial, 1.5 * step
        else:
            step *= 0.5
            if step < 1e-9:
                raise NoState(f"the uniform tube is followed up to {t:.9g} of the way only, stretch {float(u):.6g}")
    return u


def locked_uniform(values):
    """First maximum of y^2 sqrt(G) met on leaving 1, by scanning."""
    slopes = compiled()["slopes"]

    def slope(y):
        with np.errstate(all="ignore"):
            return slopes(np.longdouble(y), values)[0]

    sign = np.sign(slope(1.0))
    if abs(slope(1.0)) < 1e-15:
        return np.longdouble(1)
    near, step = 1.0, 1e-3
    while True:
        far = near + sign * step
        value = slope(far)
        if not np.isfinite(value):  # beyond G = 0
            step *= 0.5
        elif value * sign <= 0:
            break
        else:
            near, step = far, 1.3 * step
    u = np.longdouble(brentq(lambda y: float(slope(y)), min(near, far), max(near, far), xtol=1e-15))
    for _ in range(3):
        first, second = slopes(u, values)
        u = u - first / second
    return u


@dataclass
class Shape:
    """One equilibrium: results of the whole tube, their errors by comparison of two quadratures, and y at stations."""

    length: float
    volume: float
    rotation: float
    energy: float
    middle: float
    errors: np.ndarray
    folds: float  # e-folds from end to middle
    uniform: float
    y: np.ndarray


class _Quadrature:
    def __init__(self, values, u):
        self.values, self.u, self.exact_rest = values, u, values[3] == 1
        self.sign = np.sign(u - 1)
        self.reach = abs(u - 1)
        self.panel = None
        self.at_u = compiled()["U"](u, values)[0]

    def drop(self, z):
        """(U(u) - U(u - sign z))/z^2 without cancellation."""
        functions = compiled()
        y = self.u - self.sign * z
        value, size = functions["U"](y, self.values)
        direct = self.at_u - value
        out = direct / z**2
        small = np.abs(direct) < 1e-7 * size
        if np.any(small):
            inner = self.u - self.sign * z[small][:, None] * FEW_NODES
            weights = FEW_WEIGHTS * (1 - FEW_NODES)
            out[small] = -(functions["curvature"](inner, self.values)[0] * weights).sum(axis=1)
        return out

    def energy(self, y, w):
        if self.exact_rest:
            near = np.abs(y - 1) < 1e-3
            if np.any(near):
                inner = 1 + (y[near] - 1)[:, None] * NODES
                curvature = compiled()["w_yy"](inner, self.values)[0] + 0 * inner
                w = np.where(near, 0, w)
                w[near] = (y[near] - 1) ** 2 * (curvature * WEIGHTS * (1 - NODES)).sum(axis=1)
        return w

    def slopes(self, theta, folds):
        """dx/dtheta at theta, and y, s, psi, w; ``folds`` is theta at the end, or None in the limit."""
        if folds is None:  # theta counts from the end: z = reach exp(-theta)
            z = self.reach * np.exp(-theta)
            ratio = self.drop(z)
            fall = ratio * z**2
        else:
            smallest = self.reach / np.cosh(np.longdouble(folds))
            z = smallest * np.cosh(theta)
            every = self.drop(np.append(z, smallest))
            here, middle = every[:-1], every[-1]
            ratio = here + (here - middle) / np.sinh(theta) ** 2
            fall = ratio * (smallest * np.sinh(theta)) ** 2
        y = self.u - self.sign * z
        G, psi, w, T = compiled()["state"](y, self.values)
        if not (np.all(ratio > 0) and np.all(G > 0) and np.all(T > 0)):
            raise NoState("no monotonic shape between 1 and the uniform stretch")
        flat = T * np.sqrt(G)
        return (flat + fall) / np.sqrt(ratio * G * (2 * flat + fall)), y, T * G / (flat + fall), psi, w

    def at(self, theta, folds):
        """dx/dtheta and the integrands (s, y^2 s, psi, w) at theta."""
        rate, y, s, psi, w = self.slopes(theta, folds)
        return rate, (s, y * y * s, psi + 0 * y, self.energy(y, w))

    def integrals(self, low, high, panels, folds):
        """Integrals over theta of dx and of what is asked for, and x at the panels' edges."""
        edges = np.linspace(np.longdouble(low), np.longdouble(high), panels + 1)
        width = edges[1] - edges[0]
        theta = (edges[:-1, None] + width * NODES).ravel()
        rate, parts = self.at(theta, folds)
        weight = np.tile(WEIGHTS, panels) * width * rate
        if folds is None:
            one = np.array([self.u])
            G, psi, w, _ = compiled()["state"](one, self.values)
            middle = (np.sqrt(G)[0], self.u**2 * np.sqrt(G)[0], (psi + 0 * one)[0], self.energy(one, w)[0])
            totals = [np.sum(weight * (part - there)) for part, there in zip(parts, middle)]
            return np.array([np.sum(weight), *totals]), middle, edges, weight.reshape(panels, -1).sum(axis=1)
        totals = [np.sum(weight), *(np.sum(weight * part) for part in parts)]
        return np.array(totals), None, edges, weight.reshape(panels, -1).sum(axis=1)

    def refined(self, low, high, folds, tolerance=1e-13):
        panels = max(2, int(np.ceil(0.5 * (high - low))))
        before = self.integrals(low, high, panels, folds)
        while True:
            panels *= 2
            now = self.integrals(low, high, panels, folds)
            error = np.abs(now[0] - before[0])
            if np.all(error < tolerance * np.abs(now[0]) + 1e-22) or panels > 600:
                return now, error
            before = now

    def half_length(self, folds):
        """Half of the undeformed length that belongs to a middle ``folds`` e-folds from the end."""
        if self.panel is None:
            edges = self.refined(0.0, folds, folds)[0][2]
            self.panel = edges[1] - edges[0]
        edges = np.linspace(np.longdouble(0), np.longdouble(folds), max(4, int(np.ceil(folds / self.panel))) + 1)
        theta = (edges[:-1, None] + edges[1] * NODES).ravel()
        return float(np.sum(np.tile(WEIGHTS, len(edges) - 1) * edges[1] * self.slopes(theta, folds)[0]))


class _FromMiddle(_Quadrature):
    """The same quadrature from a middle stretch, without a uniform one: z = |y_m - y| = scale (cosh(theta) - 1)."""

    def __init__(self, values, y_m):
        super().__init__(values, np.longdouble(y_m))
        self.y_m = self.u
        slope, curvature = compiled()["slopes"](self.y_m, values)
        if not self.sign * slope > 0:
            raise NoState("the uniform potential does not rise toward the middle")
        self.scale = min(self.reach, max(self.sign * slope / abs(curvature), 1e-16 * self.reach))
        self.end = np.arccosh(1 + self.reach / self.scale)

    def slopes(self, theta, folds):
        functions = compiled()
        z = self.scale * 2 * np.sinh(0.5 * theta) ** 2
        y = self.u - self.sign * z
        value, size = functions["U"](y, self.values)
        fall = self.at_u - value
        small = np.abs(fall) < 1e-7 * size
        if np.any(small):
            inner = self.u - self.sign * z[small][:, None] * FEW_NODES
            fall[small] = z[small] * self.sign * (functions["slopes"](inner, self.values)[0] * FEW_WEIGHTS).sum(axis=1)
        G, psi, w, T = functions["state"](y, self.values)
        if not (np.all(fall > 0) and np.all(G > 0) and np.all(T > 0)):
            raise NoState("no monotonic shape between 1 and the middle")
        flat = T * np.sqrt(G)
        rate = self.scale * np.sinh(theta) * (flat + fall) / np.sqrt(G * fall * (2 * flat + fall))
        return rate, y, T * G / (flat + fall), psi, w

    def total(self, tolerance):
        return float(self.refined(np.longdouble(0), self.end, self.end, tolerance)[0][0][0])


def _shape(quadrature, folds, half, y_m, stations, area):
    """Results of the whole tube; ``folds`` None: the middle is uniform to rounding."""
    if folds is None:
        (totals, middle, edges, pieces), error = quadrature.refined(0.0, 40.0, None)
        results = totals[1:] + np.array(middle) * half
        from_end = np.concatenate([[0], np.cumsum(pieces)])
    else:
        (totals, _, edges, pieces), error = quadrature.refined(0.0, folds, folds)
        results = totals[1:]
        from_end = np.concatenate([[0], np.cumsum(pieces[::-1])])
    y = np.array([_stretch(quadrature, folds, edges, from_end, x, half) for x in stations])
    scale = np.array([1, 1, 1, area])
    return Shape(
        *(float(q) for q in 2 * results * scale),
        float(y_m),
        np.array([*(2 * error[1:] * scale).astype(float), 1e-13]),
        float("inf") if folds is None else float(folds),
        float(quadrature.u),
        y,
    )


def _middle_of(values, u, half):
    """The quadrature about ``u``, e-folds from end to middle (None: more than DEEP) and middle stretch."""
    if abs(u - 1) < 1e-13:
        raise NoState("nothing moves")
    quadrature = _Quadrature(values, u)

    def miss(folds):
        return quadrature.half_length(folds) - half

    if miss(DEEP) < 0:
        return quadrature, None, u
    high = 2.0
    while miss(high) < 0:
        high = min(DEEP, 1.5 * high)
    low = high / 1.5
    while miss(low) > 0:
        low /= 1.5
    folds = brentq(miss, low, high, xtol=1e-14, rtol=1e-14)
    return quadrature, folds, u - quadrature.sign * quadrature.reach / np.cosh(np.longdouble(folds))


def _solve(values, u, half, stations):
    quadrature, folds, y_m = _middle_of(values, u, half)
    return _shape(quadrature, folds, half, y_m, stations, float(values[2]))


def _nearby_middle(values, y, half, reach, tolerance=1e-9):
    """The middle stretch near ``y`` at which the half length is met and rises outward; NoState if there is none."""
    sign = np.sign(y - 1)

    def excess(middle):  # monotonic in the half length; 1 where it is infinite
        try:
            return 1.0 - half / _FromMiddle(values, middle).total(tolerance)
        except NoState:
            return 1.0

    here, step = excess(y), 1e-3 * min(abs(y - 1), reach * y)
    if here == 0:
        return y
    direction = sign if here < 0 else -sign
    near, value, before = y, here, None
    while abs(near + direction * step - y) < reach * y:
        far = near + direction * step
        if (far - 1) * sign <= 0:
            break
        ahead = excess(far)
        if ahead * here < 0:
            return brentq(excess, *sorted((near, far)), xtol=tolerance**1.2, rtol=1e-15)
        if here < 0 and ahead < value:  # past the greatest length: is that long enough?
            low = y if before is None else before
            top = minimize_scalar(lambda t: -excess(t), bounds=sorted((low, far)), method="bounded").x
            if excess(top) > 0:
                return brentq(excess, *sorted((low, top)), xtol=tolerance**1.2, rtol=1e-15)
            break
        before, near, value, step = near, far, ahead, 1.5 * step
    raise NoState("no middle stretch nearby")


def _uniform_beside(values, y):
    """A stationary stretch of the uniform tube just beyond ``y``, seen from 1; None if there is none."""
    slopes = compiled()["slopes"]
    u = np.longdouble(y)
    for _ in range(30):
        slope, curvature = slopes(u, values)
        if not curvature < 0 or abs(u / y - 1) > 1e-4:
            return None
        u = u - slope / curvature
    return u if (u - y) * (y - 1) >= 0 else None


def _follow_tube(legs, half, closest=1e-8):
    """The middle stretch of the clamped tube, carried along straight lines of parameters from leg to leg; and the
    uniform stretch beside it, None if there is none.
    """
    u, t, step, y, lost = np.longdouble(1), 0.0, 1 / 64, None, False
    for start, end in pairwise(legs):
        t = 0.0
        while t < 1.0:
            ahead = min(1.0, t + step)
            now = _between(start, end, ahead)
            try:
                if not lost:
                    try:
                        # stays clear of the uniform tube's own fold, where its middle is hard to tell apart
                        further = follow_uniform(u, _between(start, end, t), now, 0.02)
                        _, folds, y = _middle_of(now, further, half)
                        u = further
                        if folds is None:
                            y = u - (u - 1) * np.exp(-np.longdouble(DEEP))
                    except NoState:
                        if y is None:
                            raise
                        lost = step < 1e-3
                        if not lost:
                            raise
                        continue
                else:
                    y = _nearby_middle(now, y, half, 0.06)
                    again = _uniform_beside(now, y)
                    if again is not None:  # past the uniform tube's fold: the middle nears its stretch again
                        u, y, lost = again, _middle_of(now, again, half)[2], False
                t, step = ahead, 1.5 * step
            except NoState:
                step *= 0.5
                if step < closest:
                    reached = _between(start, end, t)
                    raise NoState(f"limit at p = {float(reached[6]):.9g}, {t:.9g} of the way") from None
    return (_nearby_middle(legs[-1], y, half, 1e-3, 1e-13), None) if lost else (y, u)


def _stretch(quadrature, folds, edges, from_end, x, half):
    """y at a distance x from the end: theta is found panel by panel."""
    x = min(float(x), 2 * half - float(x))
    if x <= 0:
        return 1.0
    if x >= from_end[-1]:
        return float(quadrature.u - quadrature.sign * quadrature.reach / (np.cosh(folds) if folds else np.inf))
    j = int(np.searchsorted(from_end.astype(float), x)) - 1

    if folds is None:
        start, width = edges[j], edges[j + 1] - edges[j]
    else:
        start, width = edges[len(edges) - 1 - j], -(edges[1] - edges[0])

    def distance(part):
        nodes = start + part * width * NODES
        return float(from_end[j] + abs(part * width) * np.sum(WEIGHTS * quadrature.slopes(nodes, folds)[0])) - x

    theta = start + width * brentq(distance, 1e-12, 1.0, xtol=1e-13)
    z = quadrature.reach * (np.exp(-theta) if folds is None else np.cosh(theta) / np.cosh(folds))
    return float(quadrature.u - quadrature.sign * z)


def first_integral(
    alpha, beta, length_over_radius, wall_ratio_area_a, c_ratio, p, f=0.0, m=0.0, gamma=1.0, energy="full",
    stations=(),
):  # fmt: skip
    """The equilibrium on the branch from the undeformed cylinder, by quadrature.

    The loads and gamma - 1 rise in proportion until they have :func:`settled`, then the pressure alone changes; p =
    infinity is the locked shape, y^2 G/s = c. Stations are distances from one end in radii. Where the uniform tube
    folds the clamped tube is followed itself; NoState (with the pressure reached) where that folds too.
    """
    given = (alpha, beta, wall_ratio_area_a, c_ratio)
    if np.isinf(p):
        values = parameters(*given, 1.0, 0.0, 0.0, gamma, energy, weight=0.0)
        u = locked_uniform(values)
    else:
        if p <= 0 or p + f <= 0:
            raise NoState("the end is not under meridional tension")
        values = parameters(*given, p, f, m, gamma, energy)
        try:
            u = _uniform_of(*given, settled(p, f, m, gamma), p, f, m, gamma, energy)
        except NoState:
            first = settled(p, f, m, gamma)
            legs = [parameters(*given, *load, energy) for load in ((0, 0, 0, 1.0), (first, f, m, gamma))]
            legs += [values] if first != p else []
            y_m, u = _follow_tube(legs, 0.5 * length_over_radius)
            if u is not None:
                return _solve(values, u, 0.5 * length_over_radius, stations)
            found = _FromMiddle(values, y_m)
            return _shape(found, found.end, 0.5 * length_over_radius, found.y_m, stations, float(values[2]))
    return _solve(values, u, 0.5 * length_over_radius, stations)


def settled(p, f, m, gamma):
    """The pressure at which loads and fiber extension are at their full size (theory, section 7); ``p`` without any."""
    loaded = f != 0 or m != 0 or gamma != 1
    return max(2 * max(-f, 0.0), abs(m), gamma**2 - 1) if loaded else p


def uniform_stretch(alpha, beta, area, ratio, p, f=0.0, m=0.0, gamma=1.0, energy="full"):
    """Stretch of the uniform tube on its one path of loads."""
    return float(_uniform_of(alpha, beta, area, ratio, settled(p, f, m, gamma), p, f, m, gamma, energy))


@lru_cache(maxsize=256)
def _uniform_of(alpha, beta, area, ratio, first, p, f, m, gamma, energy):
    rest = parameters(alpha, beta, area, ratio, 0.0, 0.0, 0.0, 1.0, energy)
    corner = parameters(alpha, beta, area, ratio, first, f, m, gamma, energy)
    u = follow_uniform(np.longdouble(1), rest, corner)
    if p != first:
        u = follow_uniform(u, corner, parameters(alpha, beta, area, ratio, p, f, m, gamma, energy))
    return u


def collocation(
    cell, length_over_radius, c_ratio, pressures, f=0.0, m=0.0, gamma=1.0, energy="full", stations=(),
    tolerance=1e-9, symmetric=True,
):  # fmt: skip
    """Equilibria at rising ``pressures``, each the first guess of the next, by SciPy's collocation; infinity: locked.

    ``cell`` is (alpha, beta, a) in degrees, or a function of x/r0 that gives these three as arrays. The unknowns are y,
    q = L_y' and the four integrals: ``y' = -q sqrt(G)/sqrt(T^2 + q^2)``, ``q' = L_y``. A ``symmetric`` tube is solved
    on half of its length. Returns a list of (length, volume, rotation, energy, middle stretch, y at stations).
    """
    canonical, state = compiled()["canonical"], compiled()["state"]
    cells = cell if callable(cell) else lambda x: [np.full_like(x, q) for q in cell]
    end = 0.5 * length_over_radius if symmetric else length_over_radius
    mesh = end * (1 - np.cos(np.linspace(0, 0.5 * np.pi if symmetric else np.pi, 81))) / (1 if symmetric else 2)
    guess = np.zeros((6, len(mesh)))
    guess[0] = 1.0
    results, before = [], 1.0
    for p in pressures:
        loads = (1.0, 0.0, 0.0, 0.0) if np.isinf(p) else (p, f, m, 1.0)
        if np.isinf(p):
            guess[1] /= before
        before = p

        def rates(x, z, loads=loads):
            alpha, beta, area = cells(x)
            H, D = half_sum_and_difference(alpha, beta)
            c, *yeoh = _ratios(c_ratio)
            values = (H, D, area, gamma, c, ENERGIES[energy], *loads, *yeoh)
            y, q = z[0], z[1]
            G, psi, w, T = state(y, values)
            root = np.sqrt(T * T + q * q)
            v = -q * np.sqrt(G) / root
            s = T * np.sqrt(G) / root
            return np.array([v, canonical(y, v, values)[0], s, y * y * s, psi + 0 * y, area * w])

        def ends(left, right):
            last = right[1] if symmetric else right[0] - 1
            return np.array([left[0] - 1, last, left[2], left[3], left[4], left[5]])

        with np.errstate(invalid="ignore"):  # a trial step may leave the domain
            found = solve_bvp(rates, ends, mesh, guess, tol=tolerance, max_nodes=200_000)
        if not found.success:
            raise NoState(found.message)
        mesh, guess = found.x, found.y
        totals = found.y[2:, -1] * (2 if symmetric else 1)
        there = np.asarray(stations, float)
        there = np.minimum(there, length_over_radius - there) if symmetric else there
        middle = found.sol(0.5 * length_over_radius)[0]
        results.append((*totals, middle, found.sol(there)[0] if len(there) else there))
    return results
