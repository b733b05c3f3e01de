"""What physical tubes that are the same all along are like from the clamped end to the middle: where families are slack, how
wide and how far stretched they get, and how little the fibers pull. A first integral tells it from the stretch in the
middle.
"""

import functools
import math

import numpy as np

from ..jit import entry_point, kernel
from ..solver.along.places import pulls, strain_square
from ..solver.physics.fibers import multipliers, reach
from ..solver.physics.physical import place, uniform_tube
from ..solver.physics.wall import slopes, stored
from .physical_tube import LEAST, problem
from .reference import C10, FIBERS, RADIUS, WALL
from .slack import PLACES, UNKNOWN, UNSURE

PULLS, ENOUGH = 30, 1e-10  # Newton's steps for the resultant, three are usual; share of the load that ends them
MISSING = 1e-5  # of G, what a slack family lacks: below it, the stored state's own end decides otherwise
HALVED = 5  # times the way between two places, to find where a tension is least
LEFT = 0.25**HALVED  # of what lies between places
TOLD = 4  # numbers of :func:`worst_places`


@kernel
def along(y, constant, cell, load):
    """``(T', G - 1, psi, taut alpha, taut beta)`` where the stretch is ``y``.

    Where nothing varies along a tube, L - v L_v = T' sqrt(G) - W + m psi is ``constant``, with G and psi those at slope 0
    under T' = T sqrt(G)/s; it rises with T' by sqrt(G).
    """
    T = load.p * y * y + load.f
    pull, scale, G_1, psi, taut_alpha, taut_beta = T, load.p + abs(load.f), 0.0, 0.0, True, True
    for _ in range(PULLS):
        _, G_1, psi, taut_alpha, taut_beta = place(y, 0.0, pull, cell, load)
        s = math.sqrt(max(1.0 + G_1, LEAST))
        error = pull * s - stored(y, G_1, psi, cell[2], load.rubber, load.wall) + load.m * psi - constant
        pull = max(pull - error / s, 0.5 * pull)
        if abs(error) <= ENOUGH * scale:
            break
    return pull, G_1, psi, taut_alpha, taut_beta


@kernel
def firmness(y, constant, cell, load):
    """How firmly both families are held where the stretch is ``y``, over the load: multipliers, and of a slack one how much
    is missing, negative.
    """
    scale, (pull, G_1, psi, taut_alpha, taut_beta) = load.p + abs(load.f), along(y, constant, cell, load)
    _, W_G, W_p, _, _, _, _, _, _ = slopes(y, G_1, psi, cell[2], load.rubber, load.wall)
    s = math.sqrt(max(1.0 + G_1, LEAST))
    alpha, beta = multipliers(y, s, psi, (taut_alpha, taut_beta), cell, pull, load.m, W_G, W_p)
    stretch, h, d = load.gamma * load.gamma - 1.0, cell[0], cell[1]
    alpha = alpha / scale if taut_alpha else G_1 - reach(y, psi, h + d, stretch)
    beta = beta / scale if taut_beta else G_1 - reach(y, psi, h - d, stretch)
    return alpha, beta


@functools.partial(entry_point, others=("solver",))
def slack_somewhere(points, mid_radius, thick, loose, columns, out):
    """:func:`slack.slack_families` of physical tubes: of loose ones, which families are slack somewhere."""
    for k in range(len(points)):
        point = points[k]
        cell, load = problem(point, thick, loose, columns)
        y_middle = mid_radius[k] / point[FIBERS]
        constant = uniform_tube(y_middle, cell, load)[2]
        least_alpha, least_beta = math.inf, math.inf
        for j in range(PLACES + 1):
            alpha, beta = firmness(1.0 + (y_middle - 1.0) * j / PLACES, constant, cell, load)
            least_alpha, least_beta = min(least_alpha, alpha), min(least_beta, beta)
        out[k] = UNKNOWN
        if is_sure(least_alpha, loose) and is_sure(least_beta, loose):
            out[k] = (1 if least_alpha < 0.0 else 0) | (2 if least_beta < 0.0 else 0)


@kernel
def is_sure(firm, loose):
    """Whether a sign is far enough from zero: of a slack thread what is missing, of second order there, is told."""
    return firm > UNSURE or firm < (-MISSING if loose > 0.0 else -UNSURE)


@functools.partial(entry_point, others=("solver",))
def middles(points, mid_radius, thick, loose, columns, out):
    """Meridional stretch, stretch and twist rate (n, 3) of the fiber surface in the middle of physical tubes under pressure,
    from the radius there (n,) [m]; NaN where none is.
    """
    for k in range(len(points)):
        cell, load = problem(points[k], thick, loose, columns)
        y = mid_radius[k] / points[k, FIBERS]
        out[k, 0], out[k, 1], out[k, 2] = math.nan, math.nan, math.nan
        if y > 0.0:
            _, G_1, psi, _, _ = place(y, 0.0, load.p * y * y + load.f, cell, load)
            out[k, 0], out[k, 1], out[k, 2] = math.sqrt(max(1.0 + G_1, LEAST)), y, psi


@kernel
def worst_at(y, constant, cell, load, outside, out):
    """Squares of the outer radius and of the largest stretch, and the tensions of both families, less where more is worse,
    where the stretch is ``y``: into ``out`` (TOLD,).
    """
    pull, G_1, psi, taut_alpha, taut_beta = along(y, constant, cell, load)
    G_1 = max(G_1, LEAST - 1.0)
    s = math.sqrt(1.0 + G_1)
    _, W_G, W_p, _, _, _, _, _, _ = slopes(y, G_1, psi, cell[2], load.rubber, load.wall)
    alpha, beta = multipliers(y, s, psi, (taut_alpha, taut_beta), cell, pull, load.m, W_G, W_p)
    alpha, beta = pulls(alpha, beta, cell, load)
    out[0], out[1], out[2], out[3] = y * y + outside / s, strain_square(y, G_1, psi, cell, load.wall), -alpha, -beta


@kernel
def sought_between(i, y_middle, constant, cell, load, outside, seen, most, at):
    """What is worst of the i-th number, ``most[i]``, and at which share of the way to the middle, ``at[i]``: sought on
    either side of the place that it was found at, ever nearer.
    """
    step = 1.0 / PLACES
    for _ in range(HALVED):
        step, centre = 0.5 * step, at[i]
        for side in (-1.0, 1.0):
            share = centre + side * step
            if 0.0 <= share <= 1.0:
                worst_at(1.0 + (y_middle - 1.0) * share, constant, cell, load, outside, seen)
                if seen[i] > most[i]:
                    most[i], at[i] = seen[i], share


@kernel
def seen_again(y_middle, at, cell, load, outside, seen, most):
    """The worst of a tube whose middle is a little off, into ``most`` (TOLD,): at both ends, and where it was worst, ``at``
    (TOLD,), shares of the way to the middle.
    """
    constant = uniform_tube(y_middle, cell, load)[2]
    for n in range(-2, TOLD):
        share = at[n] if n >= 0 else n + 2.0
        new = n < 0 or 0.0 < share < 1.0
        for i in range(n):
            new = new and at[i] != share
        if new:
            worst_at(1.0 + (y_middle - 1.0) * share, constant, cell, load, outside, seen)
            for i in range(TOLD):
                most[i] = max(most[i], seen[i]) if n > -2 else seen[i]


@kernel
def write_told(most, r, tension, out):
    """What was seen of a tube, (TOLD,), in the units that are told."""
    out[0], out[1] = r * math.sqrt(most[0]), math.sqrt(most[1])
    out[2], out[3] = -tension * most[2] + 0.0, -tension * most[3] + 0.0


@functools.partial(entry_point, others=("solver",))
def worst_places(points, mid_radius, beside, thick, loose, columns, out, missed):
    """The largest outer radius [m] and stretch, and the least tension of both families [N], along tubes with these radii in
    the middle (n,) [m], from the clamped ends on, and of those ``beside`` (n, 2): (n, 3, TOLD); and what the first may miss
    between the places looked at, (n, TOLD).
    """
    seen, most, doubt, at = np.empty((3, TOLD)), np.empty(TOLD), np.empty(TOLD), np.empty(TOLD)
    for k in range(len(points)):
        point, r = points[k], points[k, FIBERS]
        cell, load = problem(point, thick, loose, columns)
        y_middle, outside = mid_radius[k] / r, ((point[RADIUS] + point[WALL]) / r) ** 2 - 1.0
        tension = 2.0 * math.pi * r * r * point[C10]
        for i in range(TOLD):
            out[k, 0, i], out[k, 1, i], out[k, 2, i], missed[k, i] = math.nan, math.nan, math.nan, 0.0
        if not y_middle > 0.0:
            continue
        if load.p == 0.0 and load.f == 0.0 and load.m == 0.0:
            for n in range(3):
                out[k, n, 0], out[k, n, 1], out[k, n, 2], out[k, n, 3] = r * math.sqrt(1.0 + outside), 1.0, 0.0, 0.0
            continue
        constant = uniform_tube(y_middle, cell, load)[2]
        for j in range(PLACES + 1):
            now = j % 3
            worst_at(1.0 + (y_middle - 1.0) * j / PLACES, constant, cell, load, outside, seen[now])
            for i in range(TOLD):
                here, last, before = seen[now, i], seen[now - 1, i], seen[now - 2, i]
                doubt[i] = max(doubt[i], 0.125 * abs(here - 2.0 * last + before)) if j > 1 else 0.0
                if j == 0 or here > most[i]:
                    most[i], at[i] = here, j / PLACES
        for i in range(2, TOLD):  # tensions, which may be least just before the middle
            if most[i] < 0.0:
                doubt[i] *= LEFT
                sought_between(i, y_middle, constant, cell, load, outside, seen[(PLACES + 1) % 3], most, at)
        write_told(most, r, tension, out[k, 0])
        for i in range(TOLD):
            inside = most[i] > seen[PLACES % 3, i] and (loose == 0.0 or i < 2 or most[i] < 0.0)
            unit = tension if i > 1 else 0.5 * (r if i == 0 else 1.0) / math.sqrt(most[i])
            missed[k, i] = doubt[i] * unit if inside else 0.0
        for n in range(2):
            y_beside = beside[k, n] / r
            if y_beside > 0.0:
                seen_again(y_beside, at, cell, load, outside, seen[0], most)
                write_told(most, r, tension, out[k, n + 1])
            if abs(outside) < LEAST:  # the fibers are the outermost
                out[k, n + 1, 0] = r * math.sqrt(max(1.0, y_beside) ** 2 + outside)
        if abs(outside) < LEAST:
            out[k, 0, 0], missed[k, 0] = r * math.sqrt(max(1.0, y_middle) ** 2 + outside), 0.0
