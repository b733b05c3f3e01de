"""What varies along the tubes of a sweep, as a specification writes it: pairs, knots of a smooth profile, rules by words."""

import numpy as np

from ..description.along import RULES, Profile, rule_of
from ..description.families import FAMILIES
from ..description.profiles import ProfileError, as_profile
from ..description.units import quantity, shown
from . import axis
from .faults import Faults

VARYING = ("alpha", "beta", "wall", "radius")  # may be profiles
MAX_PAIRS = 64  # of a profile: each place where it bends makes a segment of the mesh
SMOOTH = ("knots", "smooth")  # of a table
ENDS = ("start", "stop")  # of a range: what a rule's word stands before


def is_profile(name, given) -> bool:
    """Whether a value of [actuator] is a profile: a list, or a table with knots."""
    return name in VARYING and (isinstance(given, list) or (isinstance(given, dict) and "knots" in given))


def profile(faults: Faults, path: str, name: str, given):
    """A profile along the tube, of values in the unit of schema.PARAMETERS: pairs (x/l, value), or a smooth
    :class:`freesweep.Profile` of them; None after noting its faults.
    """
    if isinstance(given, list):
        return _pairs(faults, path, name, given)
    faults.unknown_keys(given, SMOOTH, path)
    smooth = given.get("smooth", False)
    if not isinstance(smooth, bool):
        faults.add(f"{path}.smooth", f"found {shown(smooth)}; write true or false")
        return None
    if not isinstance(given["knots"], list):
        faults.add(f"{path}.knots", f"found {shown(given['knots'])}; give pairs, as in [[0, 30], [0.5, 40], [1, 30]]")
        return None
    return _pairs(faults, f"{path}.knots", name, given["knots"], smooth)


def _pairs(faults, path, name, given, smooth=False):
    if not all(isinstance(pair, list) and len(pair) == 2 for pair in given) or len(given) > MAX_PAIRS:
        hint = "a profile is a list of pairs, as in [[0, 30], [0.5, 40], [1, 30]]; several values belong in [axes]"
        faults.add(path, f"found {shown(given)} ({len(given)} entries); {hint}; at most {MAX_PAIRS} pairs are allowed")
        return None
    pairs = []
    for i, (place, entry) in enumerate(given):
        try:
            share = quantity(place, "1")
        except ValueError as error:
            faults.add(f"{path}[{i}][0]", str(error))
            share = None
        pairs.append((share, axis.value(faults, f"{path}[{i}][1]", name, entry)))
    if any(None in pair for pair in pairs):
        return None
    found = Profile(tuple(pairs), smooth=True) if smooth else tuple(pairs)
    try:
        as_profile(found)
    except ProfileError as error:
        faults.add(path, str(error))
        return None
    return found


def pairs_of(found) -> tuple:
    """The pairs of a profile, smooth or not."""
    return found.knots if isinstance(found, Profile) else found


def attributes_of(sweep) -> dict:
    """Attributes of an atlas that say what varies along its tubes, and by which rules."""
    found = {f"profile_{name}": np.ravel(pairs_of(own)) for name, own in sweep.profiles.items()}
    found |= {f"smooth_{name}": 1 for name, own in sweep.profiles.items() if isinstance(own, Profile)}
    found |= {f"family_{name}": "none" for name in FAMILIES if name not in sweep.families}
    return found | {f"rule_{name}": word for name, word in sweep.rules.items()}


def unworded(faults: Faults, path: str, name: str, given):
    """``(values, rule)``: what is given for a parameter without the word of the rule that all of it follows, None without.
    Notes a fault where only some follow it.
    """
    if name not in RULES:
        return given, None
    if isinstance(given, dict):
        ends = {key: rule_of(name, given[key]) for key in ENDS if key in given}
        rest, found = given | {key: rest for key, rest in ends.items() if rest}, list(ends.values())
    elif isinstance(given, list):
        found = [rule_of(name, one) for one in given]
        rest = [text or one for text, one in zip(found, given)]
    else:
        rest, found = rule_of(name, given), [rule_of(name, given)]
    if not any(found):
        return given, None
    if not all(found):
        faults.add(
            path,
            f"some values follow the rule {RULES[name]!r}, others do not; a sweep has one for each parameter: make two",
        )
    return rest, RULES[name]
