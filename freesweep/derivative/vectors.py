"""Derivatives of many states of tubes that are the same all along, in compiled vectors of states."""

import numpy as np

from ..scaling import ALONG, OUTPUTS, PULLS, output_scales, problem_columns
from ..solver.problem import FORCE, TORQUE
from .dual import Dual
from .physics import OWN, outputs_of
from .table import rows_of


def differentiated(design, energy, sizes, names, accuracy, thick=False, threads=0.0, known=None):
    """Rows and bounds (outputs ``names``, 1 + seeds, n) of n free states, NaN where vectors have no answer.

    ``design``: name -> dual number, or array, of design and loads in SI units and degrees; the locked shape's pressure is
    infinite. ``sizes`` (seeds, n or 1): what each seed is measured by. The wall is ``thick``, or the ``threads`` are not
    two bonded families, of physical tubes; what is ``known`` of their states, if anything, are middle radius [m] and where
    a family goes slack along a part, (n,) each.
    """
    from ..solver.slopes import differentiate

    design = {name: number if isinstance(number, Dual) else Dual(np.asarray(number)) for name, number in design.items()}
    seeds, sizes = len(sizes), np.concatenate([np.ones_like(sizes[:1]), sizes]) if len(sizes) else np.ones((1, 1))
    n = max(np.size(number.value) for number in design.values())
    locked = np.broadcast_to(np.isinf(design["pressure"].value), n)
    design["pressure"] = Dual(np.where(locked, 0.0, design["pressure"].value), design["pressure"].parts)
    inner = (design["radius"] / design["fiber_radius"]) ** 2
    columns = (*problem_columns(design, energy, thick, threads), design["pressure"] / design["c10"], inner)
    problems, changes = np.zeros((n, len(columns))), np.zeros((n, seeds, len(columns)))
    for k, column in enumerate(columns):
        if not isinstance(column, Dual):
            problems[:, k] = column
            continue
        problems[:, k] = column.value
        if column.parts is not None:
            changes[..., k] = (column.parts[OWN:] * sizes[1:]).T
    for k in (FORCE, TORQUE, -2):
        problems[locked, k], changes[locked, :, k] = 0.0, 0.0
    pressures, surface = np.where(locked, np.inf, problems[:, -2]), (problems[:, -1], changes[..., -1])
    problems, changes = (np.ascontiguousarray(array) for array in (problems[:, :-2], changes[..., :-1]))
    state = (None, None) if known is None else (known[0] / design["fiber_radius"].value, known[1])
    values, bounds = differentiate(problems, pressures, changes, accuracy, *state, surface)  # (n, 1 + seeds, results)
    none = np.zeros((OWN, n))
    values, bounds = (
        np.moveaxis(array, (2, 1), (0, 1)) / sizes for array in (values, bounds)
    )  # (results, 1 + seeds, n)
    numbers = [Dual(own[0], np.concatenate([none, own[1:]])) for own in values]
    per_pressure = {name: 2.0 * np.pi * design["fiber_radius"] ** 2 for name in PULLS if np.all(locked)}
    made = outputs_of(design, numbers, per_pressure)
    scales = rows_of(output_scales(design) | per_pressure, names, seeds)  # (outputs, 1 + seeds, 1 or n)
    doubts = bounds[[(*OUTPUTS, *ALONG).index(name) for name in names]]
    found = np.abs(scales[:, :1]) * doubts
    found[:, 1:] += np.abs(scales[:, 1:]) * doubts[:, :1]
    return rows_of(made, names, seeds), found
