"""How fast and how exact answers between the nodes of an atlas are, beside what SciPy and xarray make of the same grid."""

import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

SPECIFICATION = """
title = "Benchmark of the query"
[actuator]
wall = "1.59 mm"
c10 = "0.17 MPa"
c01 = "0.08 MPa"
[axes]
alpha = {{ start = "10 deg", stop = "60 deg", num = {angles} }}
beta = {{ start = "-70 deg", stop = "-20 deg", num = {angles} }}
length = {{ start = "80 mm", stop = "300 mm", num = {sizes}, spacing = "log" }}
radius = {{ start = "3 mm", stop = "8 mm", num = {sizes} }}
pressure = {{ start = "0 kPa", stop = "150 kPa", num = {pressures}, spacing = "sqrt" }}
"""
NAME = "deformed_length"
REPEATS = 3
COMPARED = 2000  # answers held against exact solutions


def measure(quick, say) -> dict:
    """Rates, times of single points and errors of each way to read a five-dimensional atlas, ``quick`` or in full."""
    from ..atlas.store import Atlas
    from ..query.calibration import TOLERANCE
    from ..sweep.run import run_sweep
    from ..sweep.spec import parse

    say("sweeping a grid of five axes")
    angles, sizes, pressures = (7, 6, 11) if quick else (11, 7, 17)
    text = SPECIFICATION.format(angles=angles, sizes=sizes, pressures=pressures)
    with tempfile.TemporaryDirectory() as folder:
        atlas = run_sweep(parse(text), Path(folder) / "bench.nc", progress=False)
        data = atlas.data.load()
        atlas.close()
    data.attrs[TOLERANCE] = np.inf  # every point is to be answered
    atlas = Atlas(data, Path("bench.nc"))
    axes = list(data[NAME].dims)
    draw = np.random.default_rng(1)
    count = 100_000 if quick else 1_000_000
    points = {name: draw.uniform(data[name].values[0], data[name].values[-1], count) for name in axes}
    exact = _exact(atlas, {name: array[:COMPARED] for name, array in points.items()})
    rows = []
    for title, made, most in _ways(atlas, data, axes):
        say(title)
        rows.append({"way": title, **_timed(made, points, min(most, count), exact)})
    return {"nodes": int(data[NAME].size), "points": count, "repeats": REPEATS, "rows": rows}


def _exact(atlas, points):
    from ..query.refine import as_points, exact_answers

    reader = atlas._reader
    full = reader.complete(points, COMPARED)
    return exact_answers(reader, "state", as_points(reader, "state", full), [NAME], 1e-8)[NAME]


def _ways(atlas, data, axes):
    """``(title, function of axis -> (n,), most points at once)`` of each way to read the grid."""
    f = atlas.interpolator(NAME)
    yield "atlas.interpolator, cubic", lambda points: f(*points.values()), 1_000_000
    yield (
        "atlas.query, cubic, stated errors",
        lambda points: atlas.query(**points, variables=NAME)[NAME].values,
        1_000_000,
    )
    grid = tuple(data[name].values for name in axes)
    values = data[NAME].values
    yield "NdBSpline, axis by axis, cubic", _spline(grid, values), 100_000
    from scipy.interpolate import RegularGridInterpolator

    linear = RegularGridInterpolator(grid, values)
    yield "RegularGridInterpolator, linear", lambda points: linear(np.column_stack(list(points.values()))), 100_000
    cubic = RegularGridInterpolator(grid, values, method="cubic")
    yield "RegularGridInterpolator, cubic", lambda points: cubic(np.column_stack(list(points.values()))), 1_000
    import xarray as xr

    only = data[[NAME]]

    def interp(points):
        return only.interp({name: xr.DataArray(array, dims="point") for name, array in points.items()})[NAME].values

    yield "Dataset.interp, linear", interp, 100_000


def _spline(grid, values):
    from scipy.interpolate import NdBSpline, make_interp_spline

    knots, coefficients = [], values
    for axis, nodes in enumerate(grid):
        spline = make_interp_spline(nodes, coefficients, k=3, axis=axis)
        knots.append(spline.t)
        coefficients = np.moveaxis(spline.c, 0, axis)
    whole = NdBSpline(tuple(knots), np.ascontiguousarray(coefficients), 3)
    return lambda points: whole(np.column_stack(list(points.values())))


def _timed(function, points, count, exact):
    some = {name: array[:count] for name, array in points.items()}
    one = {name: array[:1] for name, array in points.items()}
    compared = {name: array[: min(count, COMPARED)] for name, array in points.items()}
    found = function(compared)
    error = np.abs(found / exact[: len(found)] - 1.0)
    function(some)
    return {
        "points": count,
        "rate": count / _median(lambda: function(some), 1),
        "single": _median(lambda: function(one), 50),
        "error": float(np.nanquantile(error, 0.95)),  # a query refuses what it cannot flag
    }


def _median(function, times):
    """Median time of one call [s of one core], ``times`` calls at a go."""
    function()
    seconds = []
    for _ in range(REPEATS):
        begun = time.process_time()
        for _ in range(times):
            function()
        seconds.append((time.process_time() - begun) / times)
    return statistics.median(seconds)


def table(found) -> str:
    """The benchmark of the query in words and columns."""
    from ..report import aligned

    rows = [("way", "points", "points/s on one core", "one point [us]", "error of 95 %")]
    for row in found["rows"]:
        rate, single = f"{row['rate']:,.0f}", f"{1e6 * row['single']:,.0f}"
        rows.append((row["way"], f"{row['points']:,}", rate, single, f"{row['error']:.1e}"))
    head = f"{NAME} between the nodes of a grid of five axes, {found['nodes']:,} nodes; medians of {found['repeats']}"
    note = "error: relative, against exact solutions at random points; times are those of processors, not of the clock"
    return "\n".join([head, "", *aligned(rows), "", note])
