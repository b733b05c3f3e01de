"""Grid lines chosen by measurement: nodes are added until what lies between them is as exact as a sweep asks for.

Each axis is tried on its own. At random designs the exact solutions at the nodes around a design are interpolated to it, as
a query of the atlas would; pieces between which designs fail are halved. That costs some thousand solutions, a small share
of the sweep. The finished atlas measures itself on its whole grid, as any other.
"""

import math
from dataclasses import replace

import numpy as np

from ..atlas.schema import HELD
from ..description.local import Bodies
from ..description.tube_model import fiber_place
from ..query import reference
from ..query.axis import LABEL, make_axis
from ..query.exact import Tubes, solve
from ..query.family import LOOSE, family_of
from ..query.predictor import Predictor
from ..status import VALUED

SEED = 20260202
DESIGNS = 400  # for each axis and round
MEASURED = ("deformed_length", "rotation", "volume", "mid_radius")
SHARE = 0.25  # of the tolerance that true errors along one axis may use: several add up
FACTOR = 5.0  # of estimates, beyond which an answer would be refused: about what measurements of atlases give
FAILING = 0.02  # share of designs that may fail along one axis
FLOOR = 0.1  # [degree]: smaller rotations are held to the tolerance of this one
ROUNDS = 40


def graded(sweep, say=lambda text: None):
    """The sweep with nodes added to its axes until its ``interpolation_tolerance`` is met, or ``budget`` points are reached.

    ``say`` is told of each round. A sweep of named designs, of tubes with profiles, or without tolerance stays as it is.
    """
    if sweep.interpolation_tolerance is None or sweep.designs or sweep.profiles:
        return sweep
    axes = {name: values for name, values in sweep.axes.items() if len(values) > 1 and name not in HELD}
    failing = {name: _failing(sweep, axes, name) for name in axes}
    for _ in range(ROUNDS):
        worst = max(axes, key=lambda name: len(failing[name]), default=None)
        if worst is None or len(failing[worst]) <= FAILING * DESIGNS:
            break
        room = sweep.budget / math.prod(map(len, (sweep.axes | axes).values()))
        most = int((room - 1.0) * len(axes[worst]))
        if most < 1:
            break
        pieces, counts = np.unique(failing[worst], return_counts=True)
        # all pieces in which many fail; where the budget ends, the worst of them
        chosen = pieces[np.argsort(-counts, kind="stable")][: min(most, max(1, (counts >= counts.max() / 4).sum()))]
        axes[worst] = _halved(worst, axes[worst], chosen)
        failing[worst] = _failing(sweep, axes, worst)
        say(f"{worst}: {len(axes[worst])} nodes, {len(failing[worst]) / DESIGNS:.1%} of designs beyond the tolerance")
    finished = sweep.axes | axes
    for values in finished.values():
        values.setflags(write=False)
    return replace(sweep, axes=finished)


def _halved(name, values, pieces):
    """Nodes of an axis with one more in the middle of each of ``pieces``, in the coordinate that is interpolated."""
    axis = make_axis(name, values)
    middles = axis.back(0.5 * (axis.nodes[pieces] + axis.nodes[pieces + 1]))
    return np.union1d(values, [float(f"{middle:.6g}") for middle in middles])


def _failing(sweep, axes, name):
    """Pieces of one axis in which random designs are not interpolated well enough along it, one entry for each design."""
    draw = np.random.default_rng(SEED)
    points = np.tile(_fixed(sweep), (DESIGNS, 1))
    for other, values in (sweep.axes | axes).items():
        if other in reference.COLUMNS:
            points[:, reference.COLUMNS.index(other)] = draw.uniform(values[0], values[-1], DESIGNS)
    axis, column = make_axis(name, axes[name]), reference.COLUMNS.index(name)
    if axis.kind == LABEL:
        return np.empty(0, np.int64)
    x = axis.forward(points[:, column])
    piece = np.clip(np.searchsorted(axis.nodes, x, side="right") - 1, 0, len(axis.nodes) - 2)
    share = (x - axis.nodes[piece]) / (axis.nodes[piece + 1] - axis.nodes[piece])
    weights = _weights(axis, piece, share)
    around = np.repeat(points, axis.window, axis=0)
    around[:, column] = axis.values[(axis.first[piece][:, None] + np.arange(axis.window)).ravel()]
    _place_fibers(sweep, points)
    _place_fibers(sweep, around)
    bodies = Bodies(sweep.model, sweep.rules, sweep.families) if sweep.is_of_bodies else None
    tubes = Tubes(sweep.energy, sweep.model, sweep.families, bodies)
    exact = solve(reference.LOADED, points, tubes, sweep.accuracy)
    nodes = solve(reference.LOADED, around, tubes, sweep.accuracy)
    predictor = Predictor(sweep.model, sweep.energy, bodies, sweep.families)
    variables = family_of("state", sweep.is_of_bodies).variables
    at, beside = (predictor.states(reference.LOADED, some) for some in (points, around))
    known = np.isin(exact["status"], VALUED) & np.isin(nodes["status"], VALUED).reshape(DESIGNS, -1).all(axis=1)
    fails = np.zeros(DESIGNS, bool)
    for variable in MEASURED:
        kind = variables[variable]
        effects, noise = np.empty(len(around)), np.empty(len(around))
        stored, errors = nodes[variable], nodes[f"{variable}_error"]
        args = (stored, errors, effects, noise)
        predictor.end_effects(kind, reference.LOADED, around, beside, *args)
        effects = effects.reshape(DESIGNS, -1)
        effect = (weights * effects).sum(axis=1)
        rest = np.abs((axis.remainder[piece, : axis.window] * effects).sum(axis=1)) * 4.0 * share * (1.0 - share)
        value, estimate, bound = np.empty((3, DESIGNS))
        args = (effect, rest, np.zeros(DESIGNS), value, estimate, bound)
        predictor.restore(kind, points, at, *args)
        size = np.maximum(np.abs(exact[variable]), FLOOR if variable == "rotation" else 0.0)
        allowed = sweep.interpolation_tolerance * (10.0 if kind in LOOSE else 1.0) * size
        with np.errstate(invalid="ignore"):
            error = np.maximum(np.abs(value - exact[variable]) / SHARE, FACTOR * estimate)
            fails |= known & np.isfinite(effect) & (error > allowed)
    return piece[fails]


def _fixed(sweep):
    """What a sweep fixes of a point (17,)."""
    point = np.zeros(len(reference.COLUMNS))
    for column, name in enumerate(reference.COLUMNS):
        if name in sweep.fixed:
            point[column] = sweep.fixed[name]
    point[reference.HELD] = 1.0
    return point


def _place_fibers(sweep, points):
    if "fiber_radius" not in sweep.places:
        sizes = points[:, reference.RADIUS], points[:, reference.WALL]
        points[:, reference.FIBERS] = fiber_place(sweep.model.fiber_radius, *sizes)


def _weights(axis, piece, share):
    """Weights (n, window) of the nodes around points at a share (n,) of their pieces."""
    t, window = share[:, None], axis.window
    weights = t * (1.0 - t) ** 2 * axis.left[piece, :window] - t * t * (1.0 - t) * axis.right[piece, :window]
    place = piece - axis.first[piece]
    rows = np.arange(len(piece))
    end = (t * t * (3.0 - 2.0 * t))[:, 0]
    weights[rows, place] += 1.0 - end
    weights[rows, place + 1] += end
    return weights
