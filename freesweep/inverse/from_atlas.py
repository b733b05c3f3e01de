"""A wide look by asking an atlas instead of the solver: what its grid tells of designs, where they lie within it."""

import numpy as np

from ..atlas.schema import PARAMETERS, SHAPE, YEOH
from ..description.families import families_of
from ..description.tube_model import fiber_surface, model_of
from .outputs import output
from .vectors import Kind

SAMPLE = 1024  # designs of which an atlas has to hold one
SAME = 1e-9  # relative: what an atlas holds one value of
TOLD = ("deformed_length", "rotation", "volume", "mid_radius", "strain_energy")
NEEDS = {"stroke": "deformed_length", "length_change": "deformed_length", "outer_radius": "mid_radius"}


def tells(atlas, misfit) -> bool:
    """Whether an atlas tells anything of such designs: it is of such tubes, and holds some of them."""
    from scipy.stats import qmc

    known, space = told(atlas, misfit), misfit.space
    if not any(known):
        return False
    free = len(space.names)
    draws = qmc.Sobol(free, seed=np.random.default_rng(0)).random(SAMPLE) if free else np.zeros((SAMPLE, 0))
    choice = np.arange(SAMPLE) % len(space.choices)
    values = ask(atlas, misfit.wishes, space.columns(draws, choice), known)
    return bool(np.any(np.all(np.isfinite(values[:, known]), axis=1)))


def told(atlas, misfit) -> list:
    """Which wishes an atlas can answer: parameters, and outputs of free tubes under a pressure alone; none of other tubes
    than its own, of tubes that vary or lack a family.
    """
    attributes, own = atlas.data.attrs, Kind.of(misfit.space.template)
    model, here = model_of(attributes), {name for name in TOLD if name in atlas.data}
    theirs = Kind(attributes["energy"], model._replace(fiber_radius=own.model.fiber_radius), families_of(attributes))
    if theirs != own or not atlas._reader.frame.uniform_along_x or not misfit.space.is_alike:
        here = set()
    found = [
        wish.kind == "free"
        and {"pressure"} >= {name for name, _ in wish.conditions}
        and NEEDS.get(wish.output, wish.output) in here
        for wish in misfit.wishes
    ]
    return [some or (any(found) and wish.kind == "design") for some, wish in zip(found, misfit.wishes)]


def ask(atlas, wishes, columns, known):
    """Values (n, wishes) of the ``known`` wishes, NaN beyond the atlas, and where it does not answer."""
    data, count = atlas.data, len(columns["radius"])
    values = np.full((count, len(wishes)), np.nan)
    axes = [name for name in data.dims if name in PARAMETERS]
    inside = np.ones(count, bool)
    for name in data.coords:
        if name in columns and name not in data.dims and data[name].ndim == 0 and name != "pressure":
            inside &= np.isclose(columns[name], data[name].item(), rtol=SAME, atol=0.0)
    surface = fiber_surface({name: columns[name] for name in ("radius", "wall")}, model_of(data.attrs))
    usual = {name: 0.0 for name in (*YEOH, *SHAPE)} | {"fiber_radius": surface}
    for name, value in usual.items():  # what an atlas does not name
        if name in columns and name not in data.coords:
            inside &= np.isclose(columns[name], value, rtol=SAME, atol=0.0)
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
