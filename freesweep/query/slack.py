"""Slack fibers of a tube that is the same all along, from the stretch in its middle: a first integral gives the rest.

Where material and loads do not vary, ``(p y^2 + f) G/s - a w + m psi = c`` along the tube, so the axial stretch s at any y
follows from the middle, where s^2 = G, and with it the tension of both families (the multipliers of the fiber constraints).
"""

import math
from typing import NamedTuple

from ..jit import entry_point, kernel
from .reference import C10, EXTENSION, FIBERS, FORCE, PRESSURE, TORQUE, rubber_at
from .uniform_tube import energy, kinematics

PLACES = 12  # stretches looked at, from the clamped end to the middle
TENSIONLESS = 1e-9  # of the load: as where states are solved
UNSURE = 2e-3  # of the load: nearer to zero than that, the stored state's own end decides otherwise
UNKNOWN = 255


class Tube(NamedTuple):
    """Half the sum and difference of the fibers' tangents, the wall's area, and what the energy of the rubber takes; and the
    loads.
    """

    h: float
    d: float
    area: float
    gamma: float
    rubber: tuple
    shear: float
    p: float
    f: float
    m: float


@kernel
def tensions(q, s, tube):
    """Multipliers of both families at squared stretch q and axial stretch s [pi r0^2 C10]."""
    h, d, area, gamma, rubber, shear, p, f, m = tube
    G, _, _, psi, _, _ = kinematics(q, h, d, gamma)
    sheared = 1.0 + shear * psi * psi
    c, c2, c3 = rubber
    i1 = G + q * sheared + 1.0 / (G * q) - 3.0
    slope = 1.0 + i1 * (2.0 * c2 + 3.0 * c3 * i1)  # of Yeoh's energy, along I1
    w_G = slope * (1.0 - 1.0 / (G * G * q)) + c * (q - sheared / (G * G))
    w_psi = 2.0 * shear * psi * (slope * q + c / G)
    both = (p * q + f) / (2.0 * s) - area * w_G
    apart = ((m - area * w_psi) / (2.0 * q) - both * h * gamma * gamma / q) / d
    return 0.5 * (both + apart), 0.5 * (both - apart)


@entry_point
def slack_families(points, states, mid_radius, shear, out):
    """Bit 1: the alpha family would have to push somewhere, bit 2: the beta family; UNKNOWN where it is too close to say.

    Points (n, 17), their uniform states (n, 8) and radii in the middle (n,) [m]; into ``out`` (n,).
    """
    for k in range(len(points)):
        u, point = states[k], points[k]
        r, c10, gamma = point[FIBERS], point[C10], point[EXTENSION]
        h, area, rubber = u[0], u[2], rubber_at(point)
        d = math.sqrt(max(h * h - u[1], 0.0))
        if math.tan(math.radians(point[0])) < math.tan(math.radians(point[1])):
            d = -d
        p, f = point[PRESSURE] / c10, point[FORCE] / (math.pi * r * r * c10)
        m = point[TORQUE] / (math.pi * r * r * r * c10)
        y_middle = mid_radius[k] / r
        q = y_middle * y_middle
        state = kinematics(q, h, d, gamma)
        w, _, _ = energy(q, state, rubber, shear)
        held = (p * q + f) * math.sqrt(state[0]) - area * w + m * state[3]
        scale, tube = p + abs(f), Tube(h, d, area, gamma, rubber, shear, p, f, m)
        least_alpha, least_beta = math.inf, math.inf
        for j in range(PLACES + 1):
            y = 1.0 + (y_middle - 1.0) * j / PLACES
            q = y * y
            state = kinematics(q, h, d, gamma)
            w, _, _ = energy(q, state, rubber, shear)
            s = (p * q + f) * state[0] / (held + area * w - m * state[3])
            alpha, beta = tensions(q, s, tube)
            least_alpha, least_beta = min(least_alpha, alpha), min(least_beta, beta)
        out[k] = UNKNOWN
        if abs(least_alpha) > UNSURE * scale and abs(least_beta) > UNSURE * scale:
            out[k] = (1 if least_alpha < 0.0 else 0) | (2 if least_beta < 0.0 else 0)
