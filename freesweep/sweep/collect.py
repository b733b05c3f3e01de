"""From results of distinct problems to the dataset of a grid."""

import numpy as np

from .. import closed_form, status
from ..atlas.schema import FLAG_OF, STATUS_OF, VARIABLES, attributes
from ..scaling import OUTPUTS, output_scales, wall_volume_inside

SAME_PROBLEM = 5e-13  # relative: two problems that agree to plan.DIGITS digits are solved as one
EPSILON = np.finfo(float).eps


def collect(sweep, plan, results):
    """The Dataset of a sweep from ``results``: name -> array over the rows of the plan."""
    import xarray as xr

    arrays = _states(plan, results, plan.rows) | _limits(plan, results) | _ideal(plan)
    arrays |= {f"locked_{name}": array for name, array in _outputs(plan, results, plan.locked_rows[:, None]).items()}
    if sweep.blocked:
        arrays |= _blocked(plan, results)
    dataset = xr.Dataset({name: _placed(plan, name, array) for name, array in arrays.items()})
    dataset = dataset.assign_coords(plan.coordinates | {"pressure": ("pressure", plan.pressure)})
    if "pressure" not in sweep.axes:
        dataset = dataset.isel(pressure=0)
    for name in dataset.variables:
        if name != "design":
            dataset[name].attrs = attributes(name)
    return dataset


def _placed(plan, name, array):
    """``(dimensions, array)`` of a variable over the grid, without the dimensions it does not vary in."""
    of = name.removesuffix("_error")
    without = STATUS_OF[of][1] if of in STATUS_OF else FLAG_OF[of][1] if of in FLAG_OF else VARIABLES[of].without
    if "fiber_radius" in plan.coordinates:  # it decides with the wall which designs are valid
        without = tuple(name for name in without if name != "wall")
    dimensions = (*plan.dimensions, "pressure")
    array = array.reshape(*plan.shape, -1)
    keep = tuple(0 if name in without else slice(None) for name in dimensions)
    return tuple(name for name in dimensions if name not in without), np.array(array[keep], order="C")


def _outputs(plan, results, rows):
    """Status, outputs and bounds of the grid's designs at some rows of the results: arrays (d, p)."""
    good = (plan.status == status.OK)[:, None]
    codes = np.where(good, _at(results["status"], rows, status.NOT_CONVERGED), plan.status[:, None])
    valued = np.isin(codes, status.VALUED)
    design = {name: column[:, None] for name, column in plan.design.items()}
    scales = output_scales(design)
    arrays = {"status": codes.astype(np.int8)}
    for k, name in enumerate(OUTPUTS):
        value = np.where(valued, _at(results["values"][:, k], rows, np.nan), np.nan) * scales[name]
        if name == "rotation":
            value = np.where(plan.mirrored[:, None], -value, value) + 0.0  # + 0.0: no negative zeros
        if name == "volume":
            value = value - wall_volume_inside(design)
        bound = np.where(valued, _at(results["bounds"][:, k], rows, np.nan), np.nan) * scales[name]
        arrays[name], arrays[f"{name}_error"] = value, upward(bound + SAME_PROBLEM * np.abs(value))
    return arrays


def _states(plan, results, rows):
    """Outputs and flags under pressure."""
    arrays = _outputs(plan, results, rows)
    valued = np.isin(arrays["status"], status.VALUED)
    slack = np.where(valued, _at(results["slack"], rows, 0), 0)
    exchanged = (slack & 1) << 1 | slack >> 1
    arrays["slack_fiber"] = np.where(plan.swapped[:, None], exchanged, slack).astype(np.int8)
    arrays["stable"] = valued.astype(np.int8)  # the walk keeps to stable states
    return arrays


def _limits(plan, results):
    """Limit pressures [Pa], one for each design."""
    good = plan.status == status.OK
    found = np.where(good[:, None], _at(results["limits"], plan.problem, np.nan), np.nan) * plan.design["c10"][:, None]
    found[found[:, 0] > plan.pressure.max()] = np.nan  # met on behalf of another material, at more than was asked here
    return {
        "limit_pressure": found[:, :1],
        "limit_pressure_error": upward(found[:, 1:]),
        "limit_found": np.isfinite(found[:, :1]).astype(np.int8),
    }


def _blocked(plan, results):
    """Blocked force and torque from the solver: arrays (d, p)."""
    arrays = {}
    r, c10 = plan.design["fiber_radius"][:, None], plan.design["c10"][:, None]
    good = (plan.status == status.OK)[:, None]
    for kind, name in enumerate(("blocked_force", "blocked_torque")):
        found = _at(results["blocked_status"][:, kind], plan.rows, status.NOT_CONVERGED)
        codes = np.where(good, found, plan.status[:, None])
        valued = np.isin(codes, status.VALUED)
        scale = np.pi * r ** (2 + kind) * c10
        value = np.where(valued, _at(results["blocked"][:, kind], plan.rows, np.nan), np.nan) * scale
        if name == "blocked_torque":
            value = np.where(plan.mirrored[:, None], -value, value) + 0.0
        bound = np.where(valued, _at(results["blocked_bounds"][:, kind], plan.rows, np.nan), np.nan) * scale
        arrays[name], arrays[f"{name}_error"] = value, upward(bound + SAME_PROBLEM * np.abs(value))
        arrays[f"{name}_status"] = codes.astype(np.int8)
        stable = np.where(valued, _at(results["blocked_stable"][:, kind], plan.rows, 0), 0)
        arrays[f"{name}_stable"] = stable.astype(np.int8)
    return arrays


def _at(column, rows, empty):
    """``column[rows]``, or ``empty`` where the grid holds no solvable design at all."""
    return column[rows] if len(column) else np.full(rows.shape + column.shape[1:], empty)


def upward(bound):
    """An error bound in single precision, rounded up: it still holds."""
    single = bound.astype(np.float32)
    return np.where(single < bound, np.nextafter(single, np.float32(np.inf)), single)


def _ideal(plan):
    """Blocked force and torque of inextensible fibers, in closed form: arrays (d, p)."""
    alpha, beta, radius = (plan.design[name][:, None] for name in ("alpha", "beta", "fiber_radius"))
    ta, tb = np.tan(np.radians(alpha)), np.tan(np.radians(beta))
    product = ta * tb
    # rounding of the tangents, and what is left of it in their product and sum
    of_ta, of_tb = (
        2.0 * EPSILON * (np.abs(t) + np.abs(np.radians(a)) * (1.0 + t * t)) for t, a in ((ta, alpha), (tb, beta))
    )
    of_product = np.abs(ta) * of_tb + np.abs(tb) * of_ta
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = {
            "ideal_blocked_force": 2.0 * of_product / product**2,
            "ideal_blocked_torque": of_product / np.abs(ta + tb)
            + np.abs(2.0 + product) * (of_ta + of_tb) / (ta + tb) ** 2,
        }
    arrays = {}
    for name, value in (
        ("ideal_blocked_force", closed_form.blocked_force(alpha, beta, radius, plan.pressure)),
        ("ideal_blocked_torque", closed_form.blocked_torque(alpha, beta, radius, plan.pressure)),
    ):
        solved = np.isfinite(value)
        region_one = (product > 0.0) & (name == "ideal_blocked_force")
        failed = np.where(region_one, status.COMPRESSED, status.HELD_IMPOSSIBLE)
        codes = np.where(solved, status.OK, np.where(alpha == beta, status.DEGENERATE, failed))
        refused = (plan.status == status.INVALID)[:, None]
        codes, value = np.where(refused, status.INVALID, codes), np.where(refused, np.nan, value)
        solved = solved & ~refused
        scale = np.pi * radius**2 * plan.pressure * (1.0 if name == "ideal_blocked_force" else radius)
        arrays[name], arrays[f"{name}_status"] = value, codes.astype(np.int8)
        bound = scale * np.where(solved, relative[name], 0.0) + 8.0 * EPSILON * (scale + np.abs(value))
        arrays[f"{name}_error"] = upward(np.where(solved, bound, np.nan))
    return arrays
