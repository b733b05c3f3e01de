"""All designs that are allowed: a design is a point u of the unit box, one number for each free parameter, and one of the
``choices``.
"""

import itertools
import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..atlas.schema import SHAPE
from ..derivative.request import constants as named_constants
from ..description.actuator import Actuator
from ..description.elastomer import rubber_of
from ..description.faults import ActuatorError
from ..description.tube_model import MODELS, fiber_place
from .wishes import TUBE

LOADS = ("pressure", "force", "torque")
CONSTANTS = ("c10", "c01", "c20", "c30")
SPREAD = 64  # designs of which each is looked at whether it is a tube
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
        for name, knots in self.knots.items():  # straight between them
            own = [values[k] for k, each in enumerate(self.names) if each.startswith(f"{name}[")]
            found[name] = 0.5 * (own[(knots - 1) // 2] + own[knots // 2])
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
        if constants := {name: columns[name] for name in CONSTANTS if name in changed}:
            rubber = _with(rubber, constants)
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

    def no_tube(self) -> str:
        """Why none of these designs is an actuator; "" where one of some that are evenly spread is, with any choice."""
        from scipy.stats import qmc

        fault, free = "", len(self.names)
        draws = qmc.Sobol(free, seed=np.random.default_rng(0)).random(SPREAD) if free else np.zeros((1, 0))
        for k, u in itertools.product(range(len(self.choices[:SPREAD])), draws):
            try:
                self.actuator(u, k)
                return ""
            except ActuatorError as error:
                fault = fault or error.faults[0]
        return fault

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


def _with(rubber, constants):
    """The rubber with other ``constants``, of its own kind where that has them."""
    own = {of: name for name, of in named_constants(rubber).items()}
    if set(constants) <= set(own):
        return replace(rubber, largest_stretch=None, source="", **{own[name]: constants[name] for name in constants})
    return rubber_of(**({name: getattr(rubber, name) for name in CONSTANTS} | constants))
