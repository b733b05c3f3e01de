"""What a test bench measured: states of actuators under pressure, as arrays in SI units and degrees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..description.actuator import Actuator
from ..description.faults import ActuatorError
from ..description.given import described, read_column
from ..description.options import read_choice
from ..description.quantities import Quantities
from ..report import quantity

COLUMNS = {"deformed_length": "m", "rotation": "degree", "mid_radius": "m", "force": "N", "torque": "N m"}
SHORTENINGS = {"contraction": "1", "stroke": "m"}  # in place of a deformed length: share of the length, shortening
DOMAINS = {"pressure": {"least": 0.0}, "deformed_length": {"positive": True}, "mid_radius": {"positive": True}}


class Bench(NamedTuple):
    """What a test bench can measure at once, and what it imposes meanwhile."""

    measured: tuple
    imposed: tuple


FREE = Bench(("deformed_length", "rotation", "mid_radius"), ("force", "torque"))
BENCHES = {  # by the load that is measured: it holds the length, or the rotation
    "force": Bench(("force", "rotation", "mid_radius"), ("deformed_length", "torque")),
    "torque": Bench(("torque", "deformed_length", "mid_radius"), ("rotation", "force")),
}


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measured states of one actuator: arrays of one length; a single number counts for all states.

    Parameters
    ----------
    tube : the actuator; of what is fitted its numbers are a first guess, of the rest the truth
    pressure : [Pa]
    deformed_length, rotation, mid_radius, force, torque : [m, degree, m, N, N m], measured or imposed. Where ``force`` was
        measured, the bench imposed length and torque (left out: the undeformed length, no torque); where ``torque`` was,
        rotation and force (left out: none); where neither was, force and torque (left out: none)
    measured : name or names of what was measured; may be left out where the columns leave no doubt
    sigma : standard uncertainties by name, such as ``{"deformed_length": 5e-4}``; left out, the scatter tells them
    contraction, stroke : in place of a deformed length: shortening per undeformed length [1], shortening [m]; they go along
        where the length itself is fitted
    branch : of a loop, +1 for loading and -1 for unloading; left out, what rises and then falls is a loop

    A force of exactly 0 where the force was measured is a slack muscle: only a model that pulls there is wrong.
    ``length_as`` says how lengths were given, ``half_width`` half of what parts the branches of a loop (NaN where there is
    one only), ``notes`` what was passed over when a file was read.

    Raises :class:`ActuatorError`, which lists every fault.
    """

    tube: Actuator
    pressure: np.ndarray
    deformed_length: np.ndarray | None = None
    rotation: np.ndarray | None = None
    mid_radius: np.ndarray | None = None
    force: np.ndarray | None = None
    torque: np.ndarray | None = None
    measured: tuple[str, ...] = ()
    sigma: dict[str, Any] = field(default_factory=dict)
    contraction: np.ndarray | None = None
    stroke: np.ndarray | None = None
    branch: np.ndarray | None = None
    half_width: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    length_as: str = "deformed_length"

    if TYPE_CHECKING:  # what may be given is more than what is kept

        def __init__(
            self,
            tube: Actuator,
            pressure: Quantities,
            deformed_length: Quantities | None = None,
            rotation: Quantities | None = None,
            mid_radius: Quantities | None = None,
            force: Quantities | None = None,
            torque: Quantities | None = None,
            measured: str | Sequence[str] = (),
            sigma: Mapping[str, Quantities] = ...,
            contraction: Quantities | None = None,
            stroke: Quantities | None = None,
            branch: Quantities | None = None,
            half_width: Mapping[str, Quantities] = ...,
            notes: Sequence[str] = (),
            length_as: str = "deformed_length",
        ) -> None: ...

    def __post_init__(self):
        faults = [] if isinstance(self.tube, Actuator) else [f"tube: found {described(self.tube)}; give an Actuator"]
        if isinstance(self.tube, Actuator) and self.tube.is_body:
            faults.append("tube: its radius varies; measurements are judged of tubes of one radius only")
        elif isinstance(self.tube, Actuator) and not self.tube.has_two_families:
            faults.append("tube: it has fewer than two families of fibers; measurements are judged of tubes with two")
        arrays = {"pressure": read_column("pressure", self.pressure, "Pa", faults, **DOMAINS["pressure"])}
        for name, units in COLUMNS.items():
            if getattr(self, name) is not None:
                arrays[name] = read_column(name, getattr(self, name), units, faults, **DOMAINS.get(name, {}))
        for name in SHORTENINGS:
            if getattr(self, name) is not None:
                self._shortened(name, arrays, faults)
        measured = tuple(map(as_length, read_names("measured", self.measured, faults)))
        measured = measured or default_measured(arrays)
        faults += measured_faults(measured, arrays)
        sigma = {}
        if not isinstance(self.sigma, Mapping):
            faults.append(
                f"sigma: found {described(self.sigma)}; give standard uncertainties by name, such as"
                f" {{{(measured or ('deformed_length',))[0]!r}: 5e-4}}"
            )
        for name, value in self.sigma.items() if isinstance(self.sigma, Mapping) else ():
            if name not in measured or name not in COLUMNS:  # also of a text or a number
                faults.append(f"sigma: {name!r:.40} is not measured; measured: {', '.join(measured) or 'nothing'}")
            else:
                sigma[name] = read_column(f"sigma of {name}", value, COLUMNS[name], faults, positive=True)
        columns = {name: array.size for name, array in arrays.items() if array is not None}
        columns |= {f"sigma of {name}": array.size for name, array in sigma.items() if array is not None}
        branch = None if self.branch is None else read_column("branch", self.branch, "1", faults)
        if branch is not None:
            columns["branch"] = branch.size
            if not np.all(np.abs(branch) == 1.0):
                faults.append("branch: give +1 for each state of loading, -1 for each of unloading")
        if len({n for n in columns.values() if n > 1}) > 1:
            faults.append(f"columns differ in length: {', '.join(f'{name} {n}' for name, n in columns.items())}")
        if faults:
            raise ActuatorError(faults)
        count = max(columns.values())
        for name, array in arrays.items():
            object.__setattr__(self, name, _read_only(array, count))
        object.__setattr__(self, "sigma", {name: _read_only(array, count) for name, array in sigma.items()})
        object.__setattr__(self, "measured", measured)
        if branch is not None:
            object.__setattr__(self, "branch", _read_only(branch, count))

    def _shortened(self, name, arrays, faults):
        """Put deformed lengths in place of a shortening."""
        most = {"most": 1.0} if name == "contraction" else {}
        array = read_column(name, getattr(self, name), SHORTENINGS[name], faults, **most)
        if array is None:
            arrays.setdefault("deformed_length", None)
            return
        if "deformed_length" in arrays:
            faults.append(
                f"{name}: deformed lengths are given too; give one of contraction, stroke and deformed_length"
            )
        elif isinstance(self.tube, Actuator):
            length = self.tube.length * (1.0 - array) if name == "contraction" else self.tube.length - array
            if not np.all(length > 0.0):
                faults.append(f"{name}: found {array.max():g}; nothing would be left of the length")
            arrays["deformed_length"] = length
            object.__setattr__(self, "length_as", name)

    @property
    def slack(self) -> np.ndarray:
        """Whether a state is a measured force of exactly 0 (n,): the muscle hangs slack, and only pulling would be wrong."""
        return self.force == 0.0 if "force" in self.measured else np.zeros(len(self), bool)

    def __len__(self):
        return len(self.pressure)

    def __repr__(self):
        pressure = " to ".join(dict.fromkeys(quantity(end, "Pa") for end in (self.pressure.min(), self.pressure.max())))
        return f"<Measurement of {', '.join(self.measured)}: {len(self)} states at {pressure} of {self.tube}>"

    def imposed(self, name: str) -> np.ndarray:
        """An imposed column (n,); where the bench left it out, what it is then. Raises :class:`ActuatorError`."""
        faults = []
        if read_choice("name", name, tuple(COLUMNS), faults) is None:
            raise ActuatorError(faults)
        if getattr(self, name) is not None and name not in self.measured:
            return getattr(self, name)
        return np.full(len(self), self.tube.length if name == "deformed_length" else 0.0)


def as_length(name) -> str:
    """What stands for a column: a shortening is a deformed length."""
    return "deformed_length" if name in SHORTENINGS else name


def read_names(what, names, faults) -> tuple:
    """A name or several as a tuple; what else is given goes to ``faults``."""
    names = (names,) if isinstance(names, str) else names
    if not isinstance(names, (list, tuple)) or not all(isinstance(name, str) for name in names):
        faults.append(f"{what}: found {described(names)}; give a name or a list of names")
        return ()
    return tuple(names)


def default_measured(given) -> tuple:
    """What was measured, if the names of the columns leave no doubt; else nothing."""
    given = tuple(name for name in COLUMNS if name in given)
    loads = tuple(name for name in given if name in BENCHES)
    return given if not loads or (len(loads) == 1 and given == loads) else ()


def measured_faults(measured, given) -> list:
    """Sentences on what no bench can measure, or impose, together."""
    given = [name for name in COLUMNS if name in given]
    if not given:
        return [f"measured: nothing was; beside the pressure give one or more of {', '.join(COLUMNS)}"]
    if not measured:
        return [f"measured: {' and '.join(given)} are given; say which was measured: the bench imposed the others"]
    if unknown := [name for name in measured if name not in given]:
        return [f"measured: {name!r:.40} is not among the columns given, {', '.join(given)}" for name in unknown]
    loads = [name for name in measured if name in BENCHES]
    bench = BENCHES[loads[0]] if loads else FREE
    faults = [
        f"measured: {name} beside {loads[0]}; a bench that measures {loads[0]} can measure"
        f" {' and '.join(bench.measured[1:])} too, nothing else"
        for name in measured
        if name not in bench.measured
    ]
    return faults + [
        f"{name}: given and not measured, but with {' and '.join(measured)} measured a bench imposes"
        f" {' and '.join(bench.imposed)} only; leave it out, or call it measured"
        for name in given
        if name not in measured and name not in bench.imposed
    ]


def _read_only(array, count):
    array = np.array(np.broadcast_to(array, (count,)))
    array.setflags(write=False)
    return array
