"""What of a wish looks like a slip of units: all that is free or given, as :mod:`freesweep.description.unit_warnings` takes
it, and what is wished for, by the size of the tubes.
"""

import numpy as np

from ..description.unit_warnings import HINT, RADIANS, THICKEST, design_doubts, load_doubts

DESIGN = ("alpha", "beta", "length", "radius", "wall", "c10")
LOADS = ("pressure", "force", "torque")
FAR = {"deformed_length": 10.0, "length_change": 10.0, "mid_radius": 100.0, "outer_radius": 100.0, "volume": 1e5}
HARDLY = 2e-2  # of c10 wall/radius: a pressure that nobody asks for a shape at
SMALL = ("deformed_length", "mid_radius", "outer_radius", "volume")  # of these, too little is doubted, too


def doubts_of(space, wishes) -> list:
    """Sentences on what is free in a ``space`` and on the ``wishes``; none for most. What was said of its template is not
    said again.
    """
    design = {name: _values(space, name) for name in DESIGN}
    thickness = np.divide.outer(design["wall"], design["radius"])
    thickest = THICKEST[space.template.is_thick]  # of ranges, that which is doubted least
    doubted = max(thickness.min(), min(thickness.max(), thickest))
    doubted, is_thick = np.array([doubted]), space.template.is_thick
    own = {name: space.held.get(name, 0.0) for name in DESIGN}
    said = design_doubts(own, is_thick)
    found = [doubt for doubt in design_doubts(design, is_thick, doubted) if doubt not in said]
    typical = design["c10"].min() * np.sqrt(thickness.min() * thickness.max())
    for loads in _loads(space, wishes):
        of_loads, highest = load_doubts(design, loads, doubted), loads["pressure"].max()
        found += of_loads
        if not of_loads and 0.0 < highest < HARDLY * typical:
            found.append(f"no pressure exceeds {highest:g} Pa, which hardly deforms these tubes; {HINT}")
    return found + _of_rotations(wishes) + _of_sizes(design, wishes)


def _values(space, name):
    """Every value that a parameter or a load may have, (n,)."""
    values = [
        end for each, *ends in zip(space.names, space.low, space.high) if each.partition("[")[0] == name for end in ends
    ]
    for options in space.choices:
        values += [options[name]] if name in options else []
        values += [options["material"].c10] if name == "c10" and "material" in options else []
    if name in space.ties:
        factor, other = space.ties[name]
        values += (factor * _values(space, other)).tolist()
    return np.array(values or [space.held.get(name, 0.0)], float)


def _loads(space, wishes):
    """What tubes bear, as :func:`load_doubts` takes it: together, and each pressure that a limit is wished for at."""
    pressures = _finite(value for wish in wishes for name, value in wish.conditions if name == "pressure")
    pressures = np.append(pressures, _values(space, "pressure"))
    if np.any(pressures > 0.0):
        loads = {"pressure": pressures}
        for name in LOADS[1:]:
            given = [value for wish in wishes for each, value in wish.conditions if each == name]
            ends = [end for wish in wishes if wish.output == name for end in (wish.low, wish.high)]
            loads[name] = np.append(_finite([*given, *ends]), _values(space, name))
        held = _finite(value for wish in wishes for name, value in wish.conditions if name == "deformed_length")
        yield loads | ({"deformed_length": held} if len(held) else {})
    ends = [wish.low if np.isfinite(wish.low) else wish.high for wish in wishes if wish.output == "limit_pressure"]
    yield from ({"pressure": np.array([end])} for end in ends if np.isfinite(end))


def _finite(values):
    return np.array([value for value in values if np.isfinite(value)], float)


def _of_rotations(wishes):
    """Of rotations that shall be one number; small ranges about none are meant."""
    turns = [abs(wish.low) for wish in wishes if wish.output == "rotation" and wish.low == wish.high]
    turns += [abs(value) for wish in wishes for name, value in wish.conditions if name == "rotation"]
    if not 0.0 < max(turns, default=0.0) <= 2.0 * RADIANS:
        return []
    return [f"no rotation that is wished for exceeds {max(turns):g} degree, as if they were radians; {HINT}"]


def _of_sizes(design, wishes):
    """Of lengths, radii and volumes that are no size of these tubes, and strokes of more than all of it."""
    length, radius, found = design["length"], design["radius"], []
    sizes = dict.fromkeys(("deformed_length", "length_change"), length)
    sizes |= dict.fromkeys(("mid_radius", "outer_radius"), radius)
    sizes["volume"] = np.pi * np.multiply.outer(radius**2, length)
    for name, size in sizes.items():
        ends = _ends(wishes, name)
        if ends and (max(ends) > FAR[name] * size.max() or (name in SMALL and max(ends) < size.min() / FAR[name])):
            unit = "m3" if name == "volume" else "m"
            found.append(
                f"the wished {name} of {max(ends):g} {unit} is far from the tubes' {size.max():.3g} {unit}; {HINT}"
            )
    if (most := max(_ends(wishes, "stroke"), default=0.0)) > 1.0:
        found.append(
            f'the wished stroke of {most:g} is more than all of the length, of which it is a share: 0.2, "20 %"'
        )
    return found


def _ends(wishes, name):
    """What an output shall be, by its size; 0 is any."""
    ends = [end for wish in wishes if wish.output == name for end in (wish.low, wish.high)]
    return [abs(end) for end in ends if np.isfinite(end) and end != 0.0]
