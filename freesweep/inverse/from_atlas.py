"""A wide look by asking an atlas instead of the solver: what its grid tells of designs, where they lie within it."""

import numpy as np

from ..atlas.schema import PARAMETERS
from .outputs import output

SAME = 1e-9  # relative: what an atlas holds one value of
TOLD = ("deformed_length", "rotation", "volume", "mid_radius", "strain_energy")
NEEDS = {"stroke": "deformed_length", "length_change": "deformed_length", "outer_radius": "mid_radius"}


def told(atlas, wishes) -> list:
    """Which wishes an atlas can answer: parameters, and outputs of free tubes under a pressure alone, but of tubes that vary
    or lack a family.
    """
    here = {name for name in TOLD if name in atlas.data and atlas._reader.frame.uniform_along_x}
    return [
        wish.kind == "design"
        or (wish.kind == "free" and {"pressure"} >= {name for name, _ in wish.conditions}
            and NEEDS.get(wish.output, wish.output) in here)
        for wish in wishes
    ]  # fmt: skip


def ask(atlas, wishes, columns, known):
    """Values (n, wishes) of the ``known`` wishes, NaN beyond the atlas, and where it does not answer."""
    data, count = atlas.data, len(columns["radius"])
    values = np.full((count, len(wishes)), np.nan)
    axes = [name for name in data.dims if name in PARAMETERS]
    inside = np.ones(count, bool)
    for name in data.coords:
        if name in columns and name not in data.dims and data[name].ndim == 0 and name != "pressure":
            inside &= np.isclose(columns[name], data[name].item(), rtol=SAME, atol=0.0)
    for k, wish in enumerate(wishes):
        if wish.kind == "design":
            values[:, k] = columns[wish.output]
        elif known[k]:
            points = columns | {name: np.full(count, value) for name, value in wish.conditions}
            names = [NEEDS.get(wish.output, wish.output)]
            found = atlas.query(**{name: points[name] for name in axes}, variables=names)
            found = {name: variable.values for name, variable in found.data_vars.items()}
            values[:, k] = np.where(inside, output(wish.output, wish.kind, found, points)[0], np.nan)
    return values
