"""What a calibration may change: any scalar of the actuator, and two of the bench; between bounds, with priors and ties."""

import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..atlas.schema import PARAMETERS
from ..description.actuator import Actuator
from ..description.faults import ActuatorError
from ..description.given import described, numbers
from ..description.impossible import LARGEST_ANGLE
from ..inverse.freedom import TIE
from ..sweep.axis import outside

EXTENSION = "fiber_extension"
DEAD, THRESHOLD = "dead_length", "threshold_pressure"
SCALARS = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", EXTENSION)
BENCH = (DEAD, THRESHOLD)
UNITS = {name: PARAMETERS[name].units for name in SCALARS} | {DEAD: "m", THRESHOLD: "Pa"}
PERCENT = 0.01  # extensions are searched in percent, constants in units of the first guess, angles in tens: all near 1
LARGEST_EXTENSION = 20.0  # [%]
LEAST = {
    "c10": 1e-4,
    "c1": 1e-4,
    "c2": -np.inf,
    "c3": -np.inf,
}  # of constants, in units of the first guess; 0 for others
TEN_DEGREES, WINDOW = 10.0, 1.5  # angles are searched within 15 degree of where they are
STEEPEST = 8.95  # [ten degrees]
SHARES = {"radius": (0.5, 2.0), "wall": (0.3, 3.0), "length": (0.7, 1.4)}  # of what is given: where it is searched
DEAD_SHARE, MOST_DEAD = 0.05, 0.4  # of the length: what dead lengths are searched in units of, and up to where


class Parameter(NamedTuple):
    """One number: ``offset + unit theta``, of the measurements in ``owners`` (m,); no prior: sigma is infinite."""

    name: str
    label: str
    start: float
    low: float
    high: float
    unit: float
    offset: float
    mean: float
    sigma: float
    owners: np.ndarray
    possible: tuple  # least and largest value that is any, whatever is searched


class Setup(NamedTuple):
    """The actuator that works in a measurement, and what the bench leaves of length and pressure."""

    tube: Actuator
    length: float  # [m], with what is dead
    dead: float  # [m]
    threshold: float  # [Pa]


def known_names(material) -> list:
    """Names of all that can be fitted."""
    return [*material.constants, EXTENSION, *(name for name in SCALARS if name != EXTENSION), *BENCH]


class Parameters:
    """What is fitted, as numbers theta (p,) all near 1."""

    def __init__(self, measurements, names, own_extension=False, bounds=(), priors=(), ties=()):
        self.measurements = measurements
        self.material = measurements[0].tube.material
        self.ties = dict(ties)
        faults, made = [], []
        for name in names:
            made += self._made(name, own_extension, dict(bounds), dict(priors), faults)
        for name, (_, other) in self.ties.items():
            if not all(isinstance(_given(other, m.tube), float) for m in measurements):
                faults.append(f"ties: {name}: {other} is a profile along the tube; only a number can be followed")
        if faults:
            raise ActuatorError(faults)
        self.all = made
        keys = [
            (_bare(m.tube), m.tube.fiber_extension, [one.owners[k] for one in made]) for k, m in enumerate(measurements)
        ]
        self.twins = [keys.index(key) for key in keys]  # the first measurement of the same actuator
        self.labels = tuple(one.label for one in made)
        for field in ("start", "low", "high", "unit", "offset", "mean", "sigma"):
            setattr(self, field, np.array([getattr(one, field) for one in made]))
        self.start = np.clip(self.start, self.low, self.high)
        self.start = np.where(np.isfinite(self.sigma), np.clip(self.mean, self.low, self.high), self.start)

    def _made(self, name, own_extension, bounds, priors, faults):
        """The parameters of one name: one for all measurements, or for each value that is given."""
        given = [_given(name, m.tube) for m in self.measurements]
        if not all(isinstance(value, float) for value in given):
            faults.append(f"fit: {name} is a profile along the tube; only a number can be fitted")
            return []
        which = np.zeros(len(given), int)
        if name == EXTENSION:
            if own_extension:
                bare = [_bare(m.tube) for m in self.measurements]
                which = np.array([bare.index(one) for one in bare])
        elif name in SCALARS:
            which = np.array([given.index(value) for value in given])
        firsts = sorted(set(which.tolist()))
        made = []
        for count, first in enumerate(firsts, 1):
            label = f"{name}_{count}" if len(firsts) > 1 else name
            unit, offset, low, high = self._scales(name, given[first], self.measurements[first])
            mean, sigma = priors.get(label, priors.get(name, (0.0, np.inf)))
            if (name in bounds) or label in bounds:
                low, high = ((end - offset) / unit for end in bounds.get(label, bounds.get(name)))
            start = (given[first] - offset) / unit
            made.append(
                Parameter(
                    name,
                    label,
                    start,
                    low,
                    high,
                    unit,
                    offset,
                    (mean - offset) / unit,
                    sigma / unit,
                    which == first,
                    _possible(name, self.measurements[first].tube),
                )
            )
        return made

    def _scales(self, name, given, measurement):
        """Unit and offset of theta, and where it is searched."""
        tube = measurement.tube
        if name in self.material.constants:
            return getattr(self.material, self.material.constants[0]), 0.0, LEAST.get(name, 0.0), np.inf
        if name == EXTENSION:
            return PERCENT, 1.0, 0.0, LARGEST_EXTENSION
        if name in ("alpha", "beta"):
            low, high = given / TEN_DEGREES - WINDOW, given / TEN_DEGREES + WINDOW
            return TEN_DEGREES, 0.0, max(low, -STEEPEST), min(high, STEEPEST)
        if name == "fiber_radius":
            wall = float(np.min(tube.profile("wall").samples()))
            return given, 0.0, tube.radius / given, (tube.radius + wall) / given
        if name == DEAD:
            return DEAD_SHARE * tube.length, 0.0, 0.0, MOST_DEAD / DEAD_SHARE
        if name == THRESHOLD:
            most = max(float(np.max(m.pressure)) for m in self.measurements)
            return 0.1 * most, 0.0, 0.0, 5.0
        return given, 0.0, *SHARES[name]

    def within(self, intervals):
        """Intervals (p, 2), less what no parameter can be: no constant of a rubber is negative, nor is a thickness."""
        least, most = np.array([one.possible for one in self.all]).T
        return np.clip(intervals, least[:, None], most[:, None])

    def values(self, theta):
        """Values in SI units and degrees (p,)."""
        return self.offset + self.unit * theta

    def setups(self, theta) -> list:
        """The :class:`Setup` of each measurement; raises :class:`ActuatorError` where the numbers are no actuator."""
        values = self.values(theta).tolist()
        made = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what is odd about a tube was said where it was made
            for k, measurement in enumerate(self.measurements):
                twin = self.twins[k]
                own = {one.name: value for one, value in zip(self.all, values) if one.owners[k]}
                made.append(made[twin] if twin < k else self._setup(measurement.tube, own))
        return made

    def _setup(self, tube, own):
        for name, (factor, other) in self.ties.items():
            own[name] = factor * (own[other] if other in own else _given(other, tube))
        if "alpha" in own and "beta" not in own and tube.beta == -tube.alpha:
            own["beta"] = -own["alpha"]
        constants = {name: own.pop(name) for name in tube.material.constants if name in own}
        dead, threshold = own.pop(DEAD, 0.0), own.pop(THRESHOLD, 0.0)
        length = own.get("length", tube.length)
        own["length"] = length - dead
        if "fiber_radius" in own or isinstance(tube.fiber_radius, float):
            inner, wall = own.get("radius", tube.radius), own.get("wall", tube.wall)
            least = float(np.min(replace(tube, wall=wall, fiber_radius=None).profile("wall").samples()))
            own["fiber_radius"] = min(max(own.get("fiber_radius", tube.fiber_radius), inner), inner + least)
        rubber = tube.material
        if constants:
            rubber = replace(rubber, largest_stretch=None, source="", **constants)
        return Setup(replace(tube, material=rubber, **own), length, dead, threshold)


def _given(name, tube):
    """What a parameter is of a ``tube`` whose bench has no faults."""
    if name in tube.material.constants:
        return getattr(tube.material, name)
    if name in BENCH:
        return 0.0
    return tube.fiber_surface if name == "fiber_radius" else getattr(tube, name)


def _possible(name, tube):
    """Least and largest value that is any, in SI units and degrees."""
    if name in ("c2", "c3"):
        return -np.inf, np.inf
    if name in ("alpha", "beta"):
        return -LARGEST_ANGLE, LARGEST_ANGLE
    if name == "fiber_radius":
        return tube.radius, tube.radius + float(np.max(tube.profile("wall").samples()))
    return (1.0 if name == EXTENSION else 0.0), np.inf


def _bare(tube):
    """What tells actuators apart: all that is not fitted."""
    names = ("alpha", "beta", "length", "radius", "wall", "fiber_radius", "energy", "model", "wall_model", "fibers")
    values = {name: getattr(tube, name) for name in names}
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()}


def read_pairs(what, given, material, faults, positive=False) -> dict:
    """``name: (number, number)`` of bounds or priors, units read; faults are noted."""
    known, found = known_names(material), {}
    if given is None:
        return found
    if not isinstance(given, dict):
        faults.append(f"{what}: found {described(given)}; give a dict such as {{'alpha': (30, 1)}}")
        return found
    for name, pair in given.items():
        base = next((one for one in known if name == one or str(name).rstrip("0123456789") == f"{one}_"), None)
        if base is None:
            faults.append(f"{what}: found {described(name)}; choose among {', '.join(known)}")
            continue
        try:
            array = numbers(pair, UNITS.get(base, "Pa"))
        except ValueError as error:
            faults.append(f"{what} of {name}: {error}")
            continue
        rightly = array.shape == (2,) and np.all(np.isfinite(array))
        if not rightly or (positive and not array[1] > 0.0) or (not positive and not array[0] < array[1]):
            kind = "(value, standard uncertainty above 0)" if positive else "(lowest, highest)"
            faults.append(f"{what} of {name}: found {described(pair)}; give {kind}")
            continue
        ends = array[:1] if positive else array
        wrong = [fault for end, one in zip(ends.tolist(), pair) if (fault := _outside(base, end, one))]
        faults += [f"{what} of {name}: {fault}" for fault in wrong]
        if wrong:
            continue
        found[name] = tuple(array.tolist())
    return found


def _outside(name, number, given):
    """What is wrong with a number as an end or a guess of a parameter: 0 is no more than the border of what is above it."""
    if name in SCALARS or name in ("c10", "c1", "c01"):
        name = {"c1": "c10"}.get(name, name)
        return "" if number == 0.0 and name != EXTENSION else outside(name, number, given)
    return f"found {described(given)}; it has to be 0 or more" if name in BENCH and number < 0.0 else ""


def read_ties(given, material, faults) -> dict:
    """``name: (factor, other)`` of ties such as ``{"beta": "-alpha", "c01": "0.5*c10"}``; faults are noted."""
    known, found = known_names(material), {}
    if given is not None and not isinstance(given, dict):
        faults.append(f"ties: found {described(given)}; give a dict such as {{'beta': '-alpha'}}")
        return found
    for name, text in (given or {}).items():
        match = TIE.fullmatch(text) if isinstance(text, str) else None
        if name not in known or match is None or match[3] not in known:
            faults.append(
                f"ties: found {described(name)}: {described(text)}; tie a parameter to a number times another: '-alpha',"
                f" '0.5*c10', among {', '.join(known)}"
            )
            continue
        other = match[3]
        own, its = (UNITS.get(one, "Pa") for one in (name, other))
        if own != its:
            faults.append(f"ties: {name!r}: found {text!r}; what is in [{own}] cannot follow what is in [{its}]")
        elif other in given:
            faults.append(f"ties: {name!r}: tied to {other!r}, which is tied itself; tie it to what is not")
        else:
            found[name] = (-1.0 if match[1] else 1.0) * float(match[2] or 1.0), other
    return found
