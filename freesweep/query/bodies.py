"""The closed form behind the numbers of bodies of revolution: at each place along a body the uniform tube of its own radius.

A long slender body is locally that tube. With the fibers' surface R(x), e = sqrt(1 + R'^2) and the local tube's stretch y,
meridional stretch sqrt(G), twist psi and energy w::

    length = int e sqrt(G - (y R'/e)^2) dx,    rotation = int e psi/R dx,    volume = pi int R^2 y^2 (length's integrand) dx

Ends, and what slopes and curvatures add, are what is interpolated. Held loads are those of the tube at half length.
"""

import numpy as np

from . import reference as r

STATIONS, WEIGHTS = (0.5 * (np.polynomial.legendre.leggauss(8)[k] + (k == 0)) for k in (0, 1))
TOGETHER = 1 << 14  # points whose local tubes are solved at once
BODY = (
    r.UNIFORM + 3
)  # numbers that describe the tubes of a body: those of the one at half length, with means in the place
HALF, SWEPT, INSIDE = range(
    r.UNIFORM, BODY
)  # of some; its fiber radius [m]; volume per length, and that of the wall [m2]


def states(kind, points, bodies, uniform):
    """The local tubes of ``bodies`` at points (n, 17), (n, BODY); ``uniform(points)`` solves tubes (m, UNIFORM)."""
    found = np.empty((len(points), BODY))
    for begin in range(0, len(points), TOGETHER):
        some = slice(begin, begin + TOGETHER)
        found[some] = _states(kind, points[some], bodies, uniform)
    return found


@np.errstate(all="ignore")  # what is no number is refused
def _states(kind, points, bodies, uniform):
    design = {name: points[:, k] for k, name in enumerate(r.COLUMNS)}
    half = bodies.at(design, 0.5)
    found = np.full((len(points), BODY), np.nan)
    found[:, : r.UNIFORM] = uniform(_placed(points, half))
    found[:, r.TAUT] = 3.0  # which fibers pull differs along a body
    found[:, HALF] = half["fiber_radius"]
    if kind in (r.LENGTH_HELD, r.ROTATION_HELD):
        return found
    column = {name: array[:, None] for name, array in design.items()}
    along, rise = bodies.at(column, STATIONS), bodies.rise(column, STATIONS)
    radius = along["fiber_radius"]
    many = np.repeat(points, len(STATIONS), axis=0)
    local = uniform(_placed(many, {name: np.broadcast_to(along[name], radius.shape).ravel() for name in along}))
    _, _, area, q, s, psi, w = (local[:, k].reshape(radius.shape) for k in range(7))
    arc = np.hypot(1.0, rise)
    axial = arc * np.sqrt(s * s - q * (rise / arc) ** 2)
    first = design["fiber_radius"]
    found[:, 4], found[:, 5] = axial @ WEIGHTS, (psi * arc / radius) @ WEIGHTS * first
    found[:, 6] = (area * w * radius**2 * arc) @ WEIGHTS / (found[:, 2] * first**2)
    found[:, SWEPT] = np.pi * (radius**2 * q * axial) @ WEIGHTS
    found[:, INSIDE] = bodies.surface(design)[1] / design["length"]
    return found


def _placed(points, local):
    """Points (n, 17) of the tubes that bodies are at one place each."""
    placed = points.copy()
    for column, name in ((r.ALPHA, "alpha"), (r.BETA, "beta"), (r.RADIUS, "radius"), (r.WALL, "wall")):
        placed[:, column] = local[name]
    placed[:, r.FIBERS] = local["fiber_radius"]
    return placed


def terms(variable, points, u):
    """``(offset, base, scale)`` (n, 3) of a variable where the local tubes are ``u`` (n, BODY), as those of
    :func:`reference.reference`; SI units, degrees.
    """
    first, length, half = points[:, r.FIBERS], points[:, r.LENGTH], u[:, HALF]
    swelling, wider = u[:, 3] - 1.0, np.sqrt(u[:, 3]) - 1.0
    offset, base, scale = np.zeros((3, len(points)))
    if variable == r.DEFORMED_LENGTH:
        offset, scale = length * u[:, 4], half * swelling
    elif variable == r.ROTATION:
        offset, scale = np.degrees(length / first * u[:, 5]), np.degrees(u[:, 0] * swelling)
    elif variable == r.ENERGY:
        stored = np.pi * first**2 * points[:, r.C10] * u[:, 2] * u[:, 6]
        offset, scale = stored * length, stored * first
    elif variable == r.VOLUME:
        offset, base, scale = -u[:, INSIDE] * length, u[:, SWEPT] * length, wider * half / length
    elif variable == r.BODY_RADIUS:
        offset, scale = half * (1.0 + wider), half * wider
    elif variable == r.HOLDING_FORCE:
        force = np.pi * half**2 * points[:, r.C10]
        offset, scale = force * u[:, 7], force / u[:, 1]
    elif variable == r.HOLDING_TORQUE:
        torque = np.pi * half**3 * points[:, r.C10]
        offset, scale = torque * u[:, 7], torque / u[:, 0]
    else:  # shares of the length, and what is no shape
        scale = half / length if variable in (r.SLACK_ALPHA, r.SLACK_BETA) else scale + 1.0
    return np.column_stack([offset, base, scale])
