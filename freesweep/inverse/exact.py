"""Exact derivatives of what is wished for, along what is free: of tubes of two families that are the same all along."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..derivative.dual import Dual
from ..derivative.extremes import EXTREMES
from ..derivative.physics import OWN
from ..derivative.request import SHAPE
from ..derivative.table import rows_of
from ..derivative.vectors import differentiated
from ..scaling import SLACK
from .beside import Held, load_slopes
from .outputs import FOLLOWING, derived
from .predict import state_of
from .space import LOADS
from .straight import straight
from .vectors import STRAIGHT, Kind, points_of
from .wishes import HELD

NAMES = (*SHAPE, *EXTREMES)
ACCURACY = 1e-4  # of the slopes, in the unit box: nearly all are told a thousand times as closely
STEP = 1e-4  # of the unit box, of central differences
SAME = 1e-4  # relative: by how much a value may differ from the one that was predicted


def exact_slopes(space, wishes, u, choice, values, middles=None):
    """Derivatives (n, wishes, p) of the ``values`` (n, wishes) along points u (n, p), NaN where there are none here: no
    state, a limit pressure, a tube that varies, or one of which vectors find no derivative, or another state; ``middles``
    (n, wishes): radii of the middle [m], if they are known; else states are those that a way from rest leads to.
    """
    count, free = u.shape
    slopes = np.full((count, len(wishes), free), np.nan)
    if not (space.is_alike and space.template.has_two_families) or count == 0 or free == 0:
        return slopes
    parts = np.zeros((free, OWN + free + 1, 1))  # along each that is free, and a load that holds something
    parts[np.arange(free), OWN + np.arange(free), 0] = space.high - space.low
    columns = space.columns(u, choice, [Dual(value, part) for value, part in zip(space.values(u).T, parts)])
    columns = {name: number if isinstance(number, Dual) else Dual(number) for name, number in columns.items()}
    states = {}
    for k, wish in enumerate(wishes):
        if wish.kind == "design":
            slopes[:, k] = rows_of(columns, [wish.output], free + 1)[0, 1:-1].T
        elif wish.kind == "every":
            slopes[:, k] = 0.0
        elif wish.output in (*NAMES, *FOLLOWING, *HELD) and wish.kind != "limit":
            states.setdefault(state_of(wish), []).append(k)
    jobs = [(state, own, some) for state, own in states.items() for some in _shares(values[:, own])]

    def solve(job):
        state, own, some = job
        known = None if middles is None else middles[some, own[0]]
        outputs = [wishes[k].output for k in own]
        return _state(space, state, outputs, columns, values[np.ix_(some, own)], known, some, free)

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for (_, own, some), found in zip(jobs, (pool.map if len(values) > 1 else map)(solve, jobs)):
            slopes[np.ix_(some, own)] = found
    return slopes


def _shares(values):
    """Rows that have all values, a share for each thread."""
    rows = np.flatnonzero(np.all(np.isfinite(values), axis=1))
    return [some for some in np.array_split(rows, os.cpu_count() or 1) if len(some)]


def _state(space, state, outputs, columns, values, middles, some, free):
    """Derivatives (n, outputs, free) in one state of designs ``some`` of the ``columns``."""
    given = dict(state.conditions)
    design = {name: number.take(some) for name, number in columns.items()}
    held = HELD[state.kind][0] if state.kind in HELD else None
    design |= {name: Dual(np.array([given[name]])) for name in LOADS if name in given}
    if state.kind == "locked":
        design["pressure"] = Dual(np.array([np.inf]))
    if held is not None:
        load = np.zeros((OWN + free + 1, 1))
        load[-1] = 1.0
        design[state.kind] = Dual(values[:, 0], load)
    tube, sizes = space.template, _sizes(design, state, len(some), free)

    limp = tube.is_loose or any(name in SLACK for name in outputs)  # only then ends of slack parts are looked for
    known = None if middles is None else (middles, np.full(len(middles), limp))
    rows, _ = differentiated(design, tube.energy, sizes, NAMES, ACCURACY, tube.is_thick, tube.threads, known)
    if held is not None:
        if space.is_source:
            made, there = straight(tube, design, free + 1, len(some))
            rows[: len(SHAPE)] = np.where(there, made, rows[: len(SHAPE)])
        target = (
            Dual(np.array([given[held]])) if held in given else design["length"] if held == "deformed_length" else None
        )
        moved = np.zeros((free, 1)) if target is None or target.parts is None else target.parts[OWN:-1]
        wanted = 0.0 if target is None else target.value
        own = rows[NAMES.index(held)]
        same = np.abs(own[0] - wanted) <= SAME * np.maximum(np.abs(wanted), _least(held, design))
        found = np.where(same, (moved - own[1:-1]) / own[-1], np.nan)
        return np.repeat(found.T[:, None], len(outputs), axis=1)
    none = np.zeros((OWN, len(some)))
    made = {name: Dual(row[0], np.concatenate([none, row[1:]])) for name, row in zip(NAMES, rows)}
    found = np.array([rows_of({"one": derived(name, made, design)}, ["one"], free + 1)[0, :-1] for name in outputs])
    same = np.abs(found[:, 0] - values.T) <= SAME * np.maximum(
        np.abs(values.T), [_least(name, design) for name in outputs]
    )
    return np.moveaxis(np.where(same[:, None], found[:, 1:], np.nan), -1, 0)


def held_slopes(space, wishes, u, choice, found, slopes):
    """Write to ``slopes`` (n, wishes, p), where it has none, those of loads that hold tubes the states of which were
    ``found`` in two numbers, but for those that stay straight.
    """
    own = Kind.of(space.template)
    if own.is_source or not space.is_alike:
        return
    size = STEP * np.eye(u.shape[1])
    for k, wish in enumerate(wishes):
        bent = np.abs(found.middles[:, k] / space.columns(u, choice)["fiber_radius"] - 1.0) > STRAIGHT
        rows = np.flatnonzero(bent & np.any(np.isnan(slopes[:, k]), axis=1))
        if wish.output not in HELD or len(rows) == 0:
            continue
        state, count = state_of(wish), len(rows)
        tubes = [
            Held(wish.output, points_of(state, space.columns(u[rows] + step, choice[rows]), count), own)
            for step in (0.0 * size[:1], *size, *-size)
        ]
        middle = found.middles[rows, k] / tubes[0].radius
        slopes[rows, k] = load_slopes(
            tubes[0], list(zip(tubes[1 : 1 + len(size)], tubes[1 + len(size) :])), found.values[rows, k], middle, STEP
        )


def _sizes(design, state, count, free):
    """What each direction is measured by: the unit box, and the natural size of a load that holds."""
    sizes = np.ones((free + 1, count))
    if state.kind in HELD:
        power = 2 if state.kind == "force" else 3
        sizes[-1] = np.pi * design["fiber_radius"].value ** power * design["c10"].value
    return sizes


def _least(name, design):
    """By what the difference of an output is measured where it is near 0, (n,)."""
    size = {"deformed_length": "length", "length_change": "length", "mid_radius": "radius", "outer_radius": "radius"}
    if name in size:
        return design[size[name]].value + 0.0 * design["alpha"].value
    return np.full_like(design["alpha"].value + 0.0 * design["length"].value, 1.0 if name == "rotation" else 1e-2)
