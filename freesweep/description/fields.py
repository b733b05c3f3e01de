"""The fields of an actuator as a person gives them, read: numbers, texts with units, profiles, words."""

import math

import numpy as np

from .along import Profile as Given
from .along import rule_of, written
from .elastomer import ELASTOMERS
from .families import FAMILIES, is_none
from .faults import ActuatorError
from .given import read_number
from .material_library import material as named_rubber
from .profiles import ProfileError, as_profile, is_profile
from .tube_model import FIBER_PLACES, word_faults

LARGEST_EXTENSION = 10.0  # of fibers: a stretch, not a percentage
ENERGIES = ("full", "principal")
VARYING = {"alpha": "degree", "beta": "degree", "wall": "m", "radius": "m"}
POSITIVE = ("wall", "radius")
SHAPE = {"taper": (-10.0, math.nextafter(1.0, 0.0)), "bulge": (math.nextafter(-1.0, 0.0), 10.0)}  # least, most: no cusp


def read_fields(tube, faults) -> dict:
    """What stands in the fields of a ``tube`` that is made: name -> value in SI units and degrees; notes what is wrong."""
    read = {}
    for name in ("alpha", "beta", "length", "radius", "wall"):
        if name in VARYING:
            read[name] = _read_along(name, getattr(tube, name), VARYING[name], faults)
        else:
            read[name] = read_number(name, getattr(tube, name), "m", faults, positive=True)
    for name, (least, most) in SHAPE.items():
        read[name] = read_number(name, getattr(tube, name), "1", faults, least=least, most=most)
    if isinstance(read["radius"], float) and not (read["taper"] or read["bulge"]):  # rules follow what varies
        for name in VARYING:
            if text := rule_of(name, read[name]):
                read[name] = read_number(name, text, VARYING[name], faults)
    read["fiber_extension"] = read_number(
        "fiber_extension", tube.fiber_extension, "1", faults, least=1.0, most=LARGEST_EXTENSION
    )
    if tube.fiber_radius is not None and not (isinstance(tube.fiber_radius, str) and tube.fiber_radius in FIBER_PLACES):
        unread = []
        read["fiber_radius"] = read_number("fiber_radius", tube.fiber_radius, "m", unread, positive=True)
        faults += [f"{fault}, or one of {', '.join(map(repr, FIBER_PLACES))}" for fault in unread]
    if isinstance(tube.material, str):
        try:
            read["material"] = named_rubber(tube.material)
        except ActuatorError as error:
            faults += error.faults
    elif not isinstance(tube.material, ELASTOMERS):
        faults.append(
            f"material: found {type(tube.material).__name__}; give MooneyRivlin(c10, c01), NeoHookean(c10) or"
            " Yeoh(c1, c2, c3), in [Pa], or the name of a rubber in freesweep.materials"
        )
    faults += word_faults(tube.model, tube.wall_model, tube.fibers, tube.energy, ENERGIES)
    return read


def _read_along(name, value, unit, faults):
    """A float, pairs of floats, smooth or not, a callable or a rule; None after noting what is wrong with it."""
    positive = name in POSITIVE
    if text := rule_of(name, value):
        number = read_number(name, text, unit, faults, positive=positive)
        return None if number is None else written(name, number, unit)
    if name in FAMILIES and is_none(value):
        return None
    if not is_profile(value):
        return read_number(name, value, unit, faults, positive=positive)
    try:
        profile = as_profile(value, unit)
        samples = profile.samples()
    except ProfileError as error:
        faults.append(f"{name}: {error}")
        return None
    if positive and not np.all(samples > 0.0):
        faults.append(f"{name}: the profile falls to {samples.min():g} {unit}; it has to be above 0")
    if callable(value):
        return value
    pairs = tuple(zip(profile.x.tolist(), profile.values.tolist()))
    if name == "radius":
        if np.any((np.diff(profile.x) == 0.0) & (np.diff(profile.values) != 0.0)):
            faults.append("radius: it jumps; a body's radius may bend at a place, but not jump")
        if len(set(profile.values.tolist())) == 1:
            return pairs[0][1]  # a tube
    return Given(pairs, smooth=True) if isinstance(value, Given) and value.smooth else pairs
