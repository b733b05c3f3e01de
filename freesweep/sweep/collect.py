"""From records of distinct states to the variables of an atlas, for some designs of the grid at a time."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .. import ideal, status
from ..atlas.schema import absent
from ..description.families import BITS
from ..scaling import ALONG, OF_MEMBRANES, OUTPUTS, SLACK, output_scales, wall_volume_inside
from .grid import Grid
from .plan import FREE
from .records import upward

SAME_PROBLEM = 5e-13  # relative: two problems that agree to reduce.KEPT_BITS bits are solved as one
DOUBLE, BOUND, CODE = np.dtype("<f8"), np.dtype("<f4"), np.dtype("i1")


class Group(NamedTuple):
    """Variables that are made together, and vary in the same dimensions."""

    kind: str  # the states that they are made from
    make: Callable  # of table, records and designs: name -> (n, p), or (n, 1) without the pressure
    variables: dict  # name -> dtype
    grid: Grid
    pressure: bool  # whether they vary with it

    def arrays(self, tables, records, at):
        """The variables of designs ``at`` of the group's grid."""
        table = tables[self.kind]
        made = self.make(table, records[self.kind], self.grid.within(table.grid, at))
        return {name: made[name].astype(dtype, copy=False) for name, dtype in self.variables.items()}


def groups(sweep) -> list:
    """All variables of an atlas."""
    shapes = [f"locked_{name}" for name in OUTPUTS if name != "strain_energy"]
    along = _along(sweep)
    wanted = [
        (FREE, _states, [*OUTPUTS, *along], ["status", "slack_fiber", "stable"]),
        (FREE, _limits, ["limit_pressure"], ["limit_found"]),
        (FREE, _locked, shapes, []),
        (FREE, _locked, ["locked_strain_energy"], ["locked_status"]),
    ]
    wanted += [(FREE, _locked, [f"locked_{name}" for name in SLACK], [])] if along else []
    for kind in sweep.blocked:
        slack = [f"{kind}_{name}" for name in SLACK] if along else []
        wanted += [(kind, _blocked, [kind, *slack], [f"{kind}_status", f"{kind}_stable"])]
    uniform = not {"alpha", "beta"} & set(sweep.profiles) and not sweep.is_of_bodies and len(sweep.families) == 2
    if uniform and not sweep.model.is_loose:  # bars may push, threads do not
        wanted += [(FREE, _ideal, [name], [f"{name}_status"]) for name in ideal.NAMES]
    return [_group(sweep, *each) for each in wanted]


def _along(sweep):
    """What an atlas tells of physical tubes along their length: of thick walls most, of bodies nothing but slack."""
    if not sweep.is_physical:
        return ()
    return SLACK if sweep.is_of_bodies else ALONG if sweep.model.is_thick else OF_MEMBRANES


def _group(sweep, kind, make, values, codes):
    variables = dict.fromkeys(values, DOUBLE) | {f"{name}_error": BOUND for name in values} | dict.fromkeys(codes, CODE)
    dropped = absent([*values, *codes][0], "fiber_radius" in sweep.places or sweep.model.fiber_radius != "inner")
    return Group(kind, make, variables, Grid(sweep, dropped), "pressure" in sweep.axes and "pressure" not in dropped)


def _codes(found, states):
    """Status of states of designs, what was known before among them; which designs were solved; which values count."""
    solved = found.status == status.OK
    codes = np.repeat(found.status[:, None], states.shape[1], axis=1)
    codes[solved] = states["status"]
    return codes, solved, (codes == status.OK) | (codes == status.INACCURATE)


def _spread(column, solved, valued, empty):
    """Numbers of the solved designs (s, p) over all of them (n, p); ``empty`` where there is none."""
    if np.all(solved):
        return np.where(valued, column, empty)
    full = np.full(valued.shape, empty)
    full[solved] = column
    return np.where(valued, full, empty)


def _outputs(table, records, at, rows):
    """Status and outputs of designs at some rows of the records, one row for each design and pressure: (n, p)."""
    found = table.reduced(at)
    states = records.states(rows[found.status == status.OK])
    codes, solved, valued = _codes(found, states)
    design = {name: column[:, None] for name, column in table.grid.columns(at).items()}
    scales, inside = output_scales(design), wall_volume_inside(design)
    if table.grid.sweep.is_of_bodies:
        scales["mid_radius"], inside = table.grid.surface_of_bodies(at)[..., None]
    arrays = {"status": codes}
    for k, name in enumerate((*OUTPUTS, *_along(table.grid.sweep))):
        value = _spread(states["values"][..., k], solved, valued, np.nan) * scales[name]
        if name == "rotation":
            value = np.where(found.mirrored[:, None], -value, value) + 0.0  # + 0.0: no negative zeros
        if name == "volume":
            value = value - inside
        bound = _spread(states["bounds"][..., k].astype(float), solved, valued, np.nan) * scales[name]
        arrays[name], arrays[f"{name}_error"] = value, upward(bound + SAME_PROBLEM * np.abs(value))
    turn, single, families = found.swapped[:, None], found.single[:, None], table.grid.sweep.families
    for what, share in (("slack", 1.0), ("least_tension", 1.0 / max(len(families), 1))):
        _tell_families(arrays, what, share, turn, single, families)
    slack = _spread(states["slack"], solved, valued, 0)
    both = np.where(turn, (slack & 1) << 1 | slack >> 1, slack)
    arrays["slack_fiber"] = np.where(single, (slack & 1) * sum(BITS[name] for name in families), both)
    arrays["stable"] = valued  # the walk keeps to stable states
    return arrays


def _tell_families(arrays, what, share, turn, single, families):
    """Put what is known of the two lines that were followed in the places of the families: of those that ``turn``, changed,
    of a ``single`` line the share of it that each of its ``families`` has.
    """
    for end in ("", "_error") if f"{what}_alpha" in arrays else ():
        one, other = arrays[f"{what}_alpha{end}"], arrays[f"{what}_beta{end}"]
        for name, own in (("alpha", np.where(turn, other, one)), ("beta", np.where(turn, one, other))):
            arrays[f"{what}_{name}{end}"] = np.where(single, (share if name in families else 0.0) * one, own)


def _states(table, records, at):
    """Outputs and flags under pressure."""
    return _outputs(table, records, at, table.rows(at))


def _locked(table, records, at):
    """Outputs of the locked shape."""
    arrays = _outputs(table, records, at, table.locked_rows(at))
    return {f"locked_{name}": array for name, array in arrays.items()}


def _limits(table, records, at):
    """Limit pressures [Pa], one for each design."""
    solved = table.reduced(at).status == status.OK
    found = records.limits(table.problem[at[solved]])
    c10 = table.grid.columns(at)["c10"]
    limit, bound = np.full(len(at), np.nan), np.full(len(at), np.nan)
    limit[solved], bound[solved] = found["limit"] * c10[solved], found["bound"] * c10[solved]
    # met on behalf of another material, at more than was asked here
    limit[limit > table.pressure.max()] = np.nan
    bound[np.isnan(limit)] = np.nan
    arrays = {"limit_pressure": limit, "limit_pressure_error": upward(bound), "limit_found": np.isfinite(limit)}
    return {name: array[:, None] for name, array in arrays.items()}


def _blocked(table, records, at):
    """Blocked force or torque from the solver."""
    name, found = table.kind, table.reduced(at)
    states = records.states(table.rows(at)[found.status == status.OK])
    codes, solved, valued = _codes(found, states)
    design = table.grid.columns(at)
    power = 2 if name == "blocked_force" else 3
    scale = np.pi * design["fiber_radius"][:, None] ** power * design["c10"][:, None]
    value = _spread(states["value"], solved, valued, np.nan) * scale
    if name == "blocked_torque":
        value = np.where(found.mirrored[:, None], -value, value) + 0.0
    bound = _spread(states["bound"].astype(float), solved, valued, np.nan) * scale
    arrays = {
        name: value,
        f"{name}_error": upward(bound + SAME_PROBLEM * np.abs(value)),
        f"{name}_status": codes,
        f"{name}_stable": _spread(states["stable"], solved, valued, 0),
    }
    if "slack" in states.dtype.names:
        for k, slack in enumerate(SLACK):
            share, bound = (_spread(states[of][..., k], solved, valued, np.nan) for of in ("slack", "slack_bound"))
            arrays[f"{name}_{slack}"], arrays[f"{name}_{slack}_error"] = share, bound
        turned, single = found.swapped[:, None], found.single[:, None]
        _tell_families(arrays, f"{name}_slack", 1.0, turned, single, table.grid.sweep.families)
    return arrays


def _ideal(table, _, at):
    """Blocked force and torque of inextensible fibers, in closed form, as long as nothing deforms."""
    design, refused = table.grid.columns(at), table.reduced(at).status[:, None] == status.INVALID
    alpha, beta, radius = (design[name][:, None] for name in ("alpha", "beta", "fiber_radius"))
    arrays = {}
    for name in ideal.NAMES:
        value, bound, codes = ideal.ideal_blocked(name, alpha, beta, radius, table.pressure)
        arrays[name], arrays[f"{name}_status"] = (
            np.where(refused, np.nan, value),
            np.where(refused, status.INVALID, codes),
        )
        arrays[f"{name}_error"] = upward(np.where(refused, np.nan, bound))
    return arrays
