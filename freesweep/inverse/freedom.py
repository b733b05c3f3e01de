"""What may change: parameters between bounds, lists of what can be bought, ties, and profiles with knots.

A design is a point u of the unit box, one number for each free parameter, and one of the ``choices``.
"""

import itertools
import re
import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS, SHAPE
from ..description.actuator import Actuator
from ..description.along import Profile
from ..description.families import FAMILIES, followed, given_by
from ..description.faults import ActuatorError
from ..description.given import described, numbers
from ..description.material_library import material
from ..description.tube_model import MODELS, fiber_place
from .wishes import DESIGN, TUBE

LOADS = ("pressure", "force", "torque")
CONSTANTS = ("c10", "c01", "c20", "c30")
TIE = re.compile(r"\s*(-?)\s*(?:([0-9.]+(?:e-?[0-9]+)?)\s*\*\s*)?([a-z_0-9]+)\s*", re.ASCII)
KNOTTED = ("alpha", "beta", "wall", "radius")  # what may vary along the tube by free knots
FOLLOWED = 1e-6  # accuracy to which splines follow most profiles


class Space(NamedTuple):
    """All designs that are allowed: ``names`` (p,) of what is free, between ``low`` and ``high`` (p,)."""

    template: Actuator
    names: tuple
    low: np.ndarray
    high: np.ndarray
    ties: dict  # name -> (factor, other name)
    choices: list  # of dicts: name -> value
    knots: dict  # name -> number of knots
    held: dict  # name -> number: the template's own

    def values(self, u):
        """Values of what is free at points u (n, p)."""
        return self.low + u * (self.high - self.low)

    def point(self, values):
        """The point of the unit box of ``values`` (p,)."""
        return (values - self.low) / (self.high - self.low)

    def columns(self, u, choice, values=None) -> dict:
        """Designs and loads at points u (n, p) with ``choice`` (n,): name -> (n,); of profiles, the middle's. ``values``: of
        what is free, if not these arrays but other numbers such as dual ones, p of them.
        """
        values, count = self.values(u).T if values is None else values, len(u)
        found = {name: np.full(count, value) for name, value in self.held.items()}
        found |= {name: np.zeros(count) for name in LOADS}
        for k, options in enumerate(self.choices):
            own = choice == k
            for name, value in options.items():
                if name == "material":
                    for constant in CONSTANTS:
                        found[constant] = np.where(own, getattr(value, constant), found[constant])
                else:
                    found[name] = np.where(own, value, found[name])
        found |= {name: values[k] for k, name in enumerate(self.names) if "[" not in name}
        found |= {name: factor * found[other] for name, (factor, other) in self.ties.items() if other in found}
        place = self.template.fiber_radius or MODELS[self.template.model].fiber_radius
        if isinstance(place, str) and "fiber_radius" not in (*self.names, *self.ties):
            found["fiber_radius"] = fiber_place(place, found["radius"], found["wall"])
        return found

    def actuator(self, u, k) -> Actuator:
        """The actuator at one point u (p,) with choice ``k``; raises :class:`ActuatorError`."""
        columns = {name: column.item() for name, column in self.columns(u[None], np.array([k])).items()}
        options = self.choices[k]
        changed = {*self.names, *self.ties, *options}
        changes = {name: columns[name] for name in TUBE if name in changed}
        rubber = options.get("material", self.template.material)
        constants = {name: columns[name] for name in CONSTANTS if name in changed}
        if constants:
            names = dict(zip(("c10", "c20", "c30"), ("c1", "c2", "c3"))) if hasattr(rubber, "c1") else {}
            own = {names.get(name, name): value for name, value in constants.items()}
            rubber = replace(rubber, largest_stretch=None, source="", **own)
        values = self.values(u)
        for name, count in self.knots.items():
            own = [values[i] for i, each in enumerate(self.names) if each.startswith(f"{name}[")]
            changes[name] = list(zip(np.linspace(0.0, 1.0, count).tolist(), map(float, own)))
        for name, (factor, other) in self.ties.items():
            if other in self.knots:
                changes[name] = [(x, factor * value) for x, value in changes[other]]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what is odd about the template was said where it was made
            return replace(self.template, **changes, material=rubber)

    def actuator_or_none(self, u, k):
        """The same, None where these numbers are no actuator."""
        try:
            return self.actuator(u, k)
        except ActuatorError:
            return None

    @property
    def is_alike(self):
        """Whether all designs are the same all along: vectors solve many of them."""
        free = {*self.names, *self.ties, *self.choices[0]}
        return not (self.knots or free & {*SHAPE} or self.template.varies)

    @property
    def is_source(self):
        """Whether they are the source's tubes, too: vectors tell their derivatives."""
        return self.is_alike and not (self.template.is_thick or self.template.threads)

    def accuracy(self, asked):
        """The accuracy that is ``asked`` for, or what profiles along a tube allow."""
        return max(asked, FOLLOWED) if self.knots or self.template.varies else asked

    def mirrored(self, u):
        """Points u (n, p) with the two fiber families exchanged, which is the same tube; NaN where that is not free."""
        if not {"alpha", "beta"} <= set(self.names):
            return np.full_like(u, np.nan)
        values = self.values(u).copy()
        a, b = self.names.index("alpha"), self.names.index("beta")
        values[:, [a, b]] = values[:, [b, a]]
        return (values - self.low) / (self.high - self.low)


def read(template, free, faults):
    """The :class:`Space` of a ``template`` and what is ``free``; None after noting faults."""
    if not isinstance(template, Actuator):
        faults.append(f"template: found {described(template)}; give an Actuator")
        return None
    if given_by(template) != followed(template):
        faults.append(
            "template: its two families have one angle, as if they were one; give angles that differ, or beta=None"
        )
        return None
    if not isinstance(free, dict) or not free:
        faults.append(
            f"free: found {described(free)}; give a dict such as {{'alpha': (0, 85), 'radius': (3e-3, 12e-3)}}"
        )
        return None
    before, absent = len(faults), set(FAMILIES) - set(given_by(template))
    names, low, high, ties, lists, knots = [], [], [], {}, [], {}
    for key, given in free.items():
        parts = [part.strip() for part in key.split(",")] if isinstance(key, str) else [key]
        unknown = [part for part in parts if part not in (*DESIGN, *LOADS, "material")]
        if unknown:
            can = ", ".join((*DESIGN, "material", *LOADS))
            found = repr(unknown[0])[:60] if isinstance(key, str) else described(key)
            faults.append(f"free: found {found}; what may be free is {can}")
        elif missing := absent.intersection(parts):
            faults.append(
                f"free[{key!r}]: the template has no family {missing.pop()}; give it an angle there, or leave this out"
            )
        elif isinstance(given, Profile):
            _read_profile(key, given, (names, low, high, knots), faults)
        elif isinstance(given, str):
            _read_tie(key, given, free, ties, faults)
        elif isinstance(given, list):
            lists.append([dict(zip(parts, row)) for row in _read_list(key, parts, given, faults)])
        elif (pair := _read_range(key, given, faults)) is not None:
            names.append(key)
            low.append(pair[0])
            high.append(pair[1])
    if not names and not lists and len(faults) == before:
        faults.append("free: nothing is free; give a range such as (0, 85), or a list of what can be bought")
    if len(faults) > before:
        return None
    choices = [{k: v for part in parts for k, v in part.items()} for parts in itertools.product(*lists)]
    lines = template.design()  # the first line is that of the one family, if there are not two
    held = lines | {name: lines["alpha"] for name in given_by(template)[:1]}
    held = {name: value for name, value in held.items() if name not in absent}
    held |= {name: getattr(template, name) for name in SHAPE}
    return Space(template, tuple(names), np.array(low), np.array(high), ties, choices, knots, held)


def _read_range(key, given, faults):
    try:
        pair = numbers(given, PARAMETERS[key].units) if key in PARAMETERS else None
    except ValueError as error:
        faults.append(f"free[{key!r}]: {error}")
        return None
    if pair is None or pair.shape != (2,) or not np.all(np.isfinite(pair)) or not pair[0] < pair[1]:
        faults.append(
            f"free[{key!r}]: found {described(given)}; give (lowest, highest), the first below the second, a list of what"
            " can be bought, or a tie such as '-alpha'"
        )
        return None
    if key == "pressure" and pair[0] < 0.0:
        faults.append(f"free['pressure']: found {described(given)}; pressures are 0 or more")
        return None
    return pair.tolist()


def _read_profile(key, given, found, faults):
    names, low, high, knots = found
    if key not in KNOTTED:
        faults.append(f"free[{key!r}]: only {', '.join(KNOTTED)} may vary along the tube where they are free")
    elif not given.is_free:
        faults.append(
            f"free[{key!r}]: its knots are given; give a number of knots, and between, or put it in the template"
        )
    elif (pair := _read_range(key, given.between, faults)) is not None:
        knots[key] = given.knots
        names += [f"{key}[{k}]" for k in range(given.knots)]
        low += [pair[0]] * given.knots
        high += [pair[1]] * given.knots


def _read_tie(key, given, free, ties, faults):
    match = TIE.fullmatch(given)
    if match is None or match[3] not in DESIGN:
        faults.append(
            f"free[{key!r}]: found {given!r}; a tie is a parameter, or a number times one: '-alpha', '0.3*radius'"
        )
    elif isinstance(free.get(match[3]), str):
        faults.append(f"free[{key!r}]: tied to {match[3]!r}, which is tied itself; tie it to what is free")
    else:
        ties[key] = (-1.0 if match[1] else 1.0) * float(match[2] or 1.0), match[3]


def _read_list(key, parts, given, faults):
    rows = [row if len(parts) > 1 else (row,) for row in given]
    read = []
    for row in rows:
        if not isinstance(row, (tuple, list)) or len(row) != len(parts):
            faults.append(f"free[{key!r}]: found {described(row)}; give {len(parts)} values each")
            return []
        try:
            read.append([
                (material(value) if isinstance(value, str) else value) if part == "material"
                else numbers(value, PARAMETERS[part].units).item()
                for part, value in zip(parts, row)
            ])  # fmt: skip
        except (ActuatorError, ValueError) as error:
            faults += [f"free[{key!r}]: {text}" for text in getattr(error, "faults", [str(error)])]
            return []
    if not read:
        faults.append(f"free[{key!r}]: an empty list; give what can be bought")
    return read
