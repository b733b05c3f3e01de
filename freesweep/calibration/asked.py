"""What a calibration is asked for, checked."""

from typing import NamedTuple

from ..description.actuator import ActuatorError
from ..description.given import described
from ..description.options import read_switch
from .branches import mean_of_loops
from .measured import Measurement, read_names
from .parameters import EXTENSION, known_names, read_pairs, read_ties


class Asked(NamedTuple):
    """What was asked for, checked."""

    measurements: tuple
    names: list
    own_extension: bool
    bounds: dict
    priors: dict
    ties: dict
    notes: tuple


def checked(measurements, fit, own_extension, bounds, priors, ties, known):
    """What was asked for; raises :class:`ActuatorError`."""
    if not isinstance(measurements, (list, tuple)):
        measurements = (measurements,)
    strangers = [
        f"measurements: found {type(m).__name__}; give Measurement objects"
        for m in measurements
        if not isinstance(m, Measurement)
    ]
    if strangers or not measurements:
        raise ActuatorError(strangers or ["measurements: found none; give one or more"])
    material = measurements[0].tube.material
    materials = {type(m.tube.material) for m in measurements}
    faults = []
    own_extension = read_switch("own_extension", own_extension, faults)
    if len(materials) > 1:
        faults.append(
            f"measurements: materials differ in kind, {' and '.join(sorted(t.__name__ for t in materials))}; give one"
        )
    allowed, usual = known_names(material), [*material.constants, EXTENSION]
    names = usual if fit is None else list(read_names("fit", fit, faults))
    faults += [f"fit: found {name!r:.40}; choose among {', '.join(allowed)}" for name in names if name not in allowed]
    if priors is not None and not isinstance(priors, dict):
        faults.append(f"priors: found {described(priors)}; give a dict such as {{'alpha': (30, 1)}}")
        priors = None
    own_priors = priors
    bounds = read_pairs("bounds", bounds, material, faults)
    priors = read_pairs("priors", {**(priors or {}), **known}, material, faults, positive=True)
    ties = read_ties(ties, material, faults)
    twice = [] if own_priors is None else [name for name in known if name in own_priors]
    faults += [f"priors: found {name} twice; keep one of priors= and {name}=" for name in twice]
    faults += [
        f"fit: {name} is tied; leave it out there, or in ties" for name in names if fit is not None and name in ties
    ]
    names += [base for base in dict.fromkeys(_base(name, allowed) for name in priors) if base not in names]
    names = [name for name in names if name not in ties]
    idle = [name for name in bounds if _base(name, allowed) not in names]
    faults += [f"bounds of {name}: it is not fitted; name it in fit, or leave its bounds out" for name in idle]
    if not names and not faults:
        faults.append(f"fit: nothing to fit; choose among {', '.join(allowed)}")
    if faults:
        raise ActuatorError(faults)
    averaged, notes = [], []
    for measurement in measurements:
        mean, note = mean_of_loops(measurement)
        averaged.append(mean)
        notes += [*measurement.notes, *([note] if note else [])]
    order = [name for name in allowed if name in names]
    return Asked(tuple(averaged), order, own_extension, bounds, priors, ties, tuple(notes))


def _base(name, allowed):
    return name if name in allowed else name.rstrip("0123456789").removesuffix("_")
