"""The smaller table inside a page without a server: some nodes of the atlas, and how a place between them is read.

The page reads it as :func:`read` does: along each axis a cubic through the four nearest nodes (in the coordinate in which
the axis is smooth), a line through the nearest two where one of the others has no number; no number beside failed nodes.
"""

import base64
import zlib
from itertools import product

import numpy as np

from ..query.axis import LOG, SQRT
from .measures import evaluate, floor_of

NODES = 600_000  # of all axes together: some megabytes
FEWEST = {"pressure": 8}  # to which an axis is thinned before the angles are
FEW = 4
DIGITS = 13  # binary, of a number
SAMPLE, CHUNK, SEED = 24_000, 4000, 1  # places at which the table is held against the atlas
BINS = (6, 12)  # of the first two axes, in each of which its deviation is stated
QUANTILE = 0.99
ANGLES = ("alpha", "beta")
SCALES = {  # what a measure grows with, as powers of sizes: what is left is smooth along them
    "rotation": {"length": 1, "radius": -1}, "deformed_length": {"length": 1}, "mid_radius": {"radius": 1},
    "outer_radius": {"radius": 1}, "volume": {"length": 1, "radius": 2}, "strain_energy": {"length": 1, "radius": 1},
    "blocked_force": {"radius": 2}, "blocked_torque": {"radius": 3},
    "least_tension_alpha": {"radius": 2}, "least_tension_beta": {"radius": 2},
}  # fmt: skip


def small_table(desk, told=lambda: None) -> dict:
    """What the page holds: axes with their kinds, and each measure over its own axes; ``deviation``: how far it is from the
    atlas, relative, in QUANTILE of the places of each bin. ``told`` is called :func:`steps` times meanwhile.
    """
    reader = desk.reader
    nodes = thinned({name: reader.frame.values[name] for name in desk.axes})
    if desk.labels:
        raise ValueError("--html: a list of named designs is shown by the server; an atlas of axes makes a page")
    kinds = {name: _kind(reader.frame.axis(name)) for name in nodes}
    tables, arrays = {}, {}
    desk.make(told)
    for names, some in _by_axes(desk).items():
        axes = [name for name in nodes if name in names]
        grid = np.meshgrid(*(nodes[name] for name in axes), indexing="ij")
        shape, size = grid[0].shape, grid[0].size
        values = {name: np.full(size, nodes[name][-1]) for name in nodes}
        values |= {name: array.ravel() for name, array in zip(axes, grid)}
        found = evaluate(reader, values, size, some)
        for one in some:
            scale = {key: power for key, power in SCALES.get(plain(one.name), {}).items() if key in axes}
            arrays[one.name] = (found.value[one.name] / size_of(scale, values)).reshape(shape)
            tables[one.name] = {
                "axes": axes, "scale": scale, "values": coded(arrays[one.name]),
                "status": _packed(found.status[one.name]), "slack": _packed(found.slack.astype(np.uint8)),
            }  # fmt: skip
            told()
    axes = {name: {"nodes": array.tolist(), "kind": kinds[name]} for name, array in nodes.items()}
    for name, error in _deviations(desk, axes, tables, arrays, told).items():
        tables[name]["deviation"] = error
    return {"axes": axes, "tables": tables, "bins": BINS}


def steps(desk) -> int:
    """How often :func:`small_table` tells that it goes on."""
    return len({one.source for one in desk.measures.values()}) + 2 * len(desk.measures)


def thinned(axes: dict) -> dict:
    """Nodes of the axes, few enough: the loads and sizes are thinned first, then the angles."""
    sizes = {name: len(nodes) for name, nodes in axes.items()}
    while np.prod(list(sizes.values())) > NODES:
        room = {name: size / FEWEST.get(name, FEW) for name, size in sizes.items() if name not in ANGLES}
        name = max(room, key=room.get, default=None)
        if name is None or room[name] <= 1.0:
            for name in ANGLES:
                if name in sizes:
                    sizes[name] = max((sizes[name] + 1) // 2, 2)
            if max(sizes.get(name, 2) for name in ANGLES) == 2:
                break
        else:
            sizes[name] -= 1
    return {
        name: nodes[np.unique(np.linspace(0, len(nodes) - 1, sizes[name]).round().astype(int))]
        for name, nodes in axes.items()
    }


def coded(array) -> str:
    """Numbers as text: float32 of DIGITS binary digits, bytes of equal weight together, deflated."""
    bits = np.ascontiguousarray(array, np.float32).ravel().view(np.uint32)
    drop = 23 - DIGITS
    nan = np.isnan(array.ravel())
    kept = ((bits + np.uint32(1 << (drop - 1))) >> np.uint32(drop)) << np.uint32(drop)
    kept = np.where(nan, np.uint32(0x7FC00000), kept).astype("<u4")
    return _packed(kept.view(np.uint8).reshape(-1, 4).T)


def decoded(text, shape):
    """The numbers of :func:`coded`."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(4, -1)
    return np.ascontiguousarray(planes.T).view("<f4").reshape(shape).astype(float)


def _packed(array) -> str:
    return base64.b64encode(zlib.compress(np.ascontiguousarray(array).tobytes(), 9)).decode()


def _kind(axis):
    return {SQRT: "sqrt", LOG: "log"}.get(axis.kind, "linear")


def _by_axes(desk):
    """Measures by the axes that they vary along."""
    groups = {}
    for one in desk.measures.values():
        needed = set(desk.reader.needed([one.source]))
        if one.name != one.source:  # relative to a size, or made with all of the design
            needed |= set(desk.design_axes) & {
                "alpha",
                "beta",
                "length",
                "radius",
                "wall",
                "fiber_radius",
                "fiber_extension",
            }
        groups.setdefault(frozenset(needed & set(desk.axes)), []).append(one)
    return {names: some for names, some in groups.items() if names}


def plain(name):
    """A measure without the word for its state."""
    return name.removeprefix("locked_").removeprefix("ideal_")


def size_of(scale, values):
    """The product of powers of axes by which a table's numbers are multiplied."""
    return np.prod([values[name] ** power for name, power in scale.items()] or [1.0], axis=0)


def place(value, kind):
    """The coordinate in which an axis is smooth."""
    return np.sqrt(value) if kind == "sqrt" else np.log(value) if kind == "log" else value


def weights(nodes, at):
    """``(first, cubic, linear)``: the first of up to four nodes around places (n,), and their weights (k, n)."""
    count = min(4, len(nodes))
    piece = np.clip(np.searchsorted(nodes, at, "right") - 1, 0, len(nodes) - 2)
    first = np.clip(piece - 1, 0, len(nodes) - count)
    window = nodes[first + np.arange(count)[:, None]]
    cubic = np.ones((count, len(at)))
    for j, k in product(range(count), repeat=2):
        if j != k:
            cubic[j] *= (at - window[k]) / (window[j] - window[k])
    share = (at - nodes[piece]) / (nodes[piece + 1] - nodes[piece])
    linear = np.zeros_like(cubic)
    linear[piece - first, np.arange(len(at))] = 1.0 - share
    linear[piece - first + 1, np.arange(len(at))] = share
    return first, cubic, linear


def read(axes, names, table, values):
    """The table (nodes of ``names``) at places ``values`` (name -> (n,)), axis by axis from the last."""
    size = len(values[names[0]])
    given = [
        weights(place(np.array(axes[n]["nodes"]), axes[n]["kind"]), place(values[n], axes[n]["kind"])) for n in names
    ]
    table = np.ascontiguousarray(table)
    strides = np.array(table.strides) // table.itemsize
    around = np.zeros(1, np.int64)  # of the nodes that count, from the first of them
    for (_, cubic, _), stride in zip(given, strides):
        around = np.add.outer(around, stride * np.arange(len(cubic))).ravel()
    first = sum(stride * first for (first, _, _), stride in zip(given, strides))
    found = table.ravel()[around[:, None] + first]
    for _, cubic, linear in reversed(given):
        found = found.reshape(-1, len(cubic), size)
        smooth = _weighed(cubic, found)
        lost = ~np.isfinite(smooth)
        found = np.where(lost, _weighed(linear, found), smooth) if lost.any() else smooth
    return found.reshape(size)


def _weighed(weights, found):
    """Sums over the nodes of an axis; those of no weight may have no number."""
    with np.errstate(invalid="ignore"):
        parts = (np.where(w != 0.0, w * found[:, k], 0.0) for k, w in enumerate(weights))
        total = next(parts)
        for part in parts:
            total += part
    return total


def _deviations(desk, axes, tables, arrays, told):
    """Measure -> deviation from the atlas at random places, relative to the value (small ones to the floor), in each of the
    BINS of the first two axes, row by row.
    """
    rng = np.random.default_rng(SEED)
    ranges, names = desk.reader.frame.ranges, list(axes)[: len(BINS)]
    values = {name: rng.uniform(*ranges[name], SAMPLE) for name in axes}
    bins = np.zeros(SAMPLE, int)
    for name, count in zip(names, BINS):
        low, high = ranges[name]
        bins = bins * count + np.minimum((count * (values[name] - low) / (high - low)).astype(int), count - 1)
    found = evaluate(desk.reader, values, SAMPLE, list(desk.measures.values()))
    result = {}
    for name, table in tables.items():
        told()
        numbers = decoded(table["values"], arrays[name].shape)
        made = [
            read(axes, table["axes"], numbers, {key: array[k : k + CHUNK] for key, array in values.items()})
            for k in range(0, SAMPLE, CHUNK)
        ]
        made = np.concatenate(made) * size_of(table["scale"], values)
        true = found.value[name]
        far = np.abs(made - true) / np.maximum(np.abs(true), max(floor_of(desk.measures[name].unit), 1e-300))
        both = np.isfinite(far)
        worst = float(np.quantile(far[both], QUANTILE)) if both.any() else 0.0
        parts = [far[both & (bins == k)] for k in range(int(np.prod(BINS)))]
        result[name] = [float(np.quantile(part, QUANTILE)) if len(part) > FEW else worst for part in parts]
    return result
