"""Numbers that are allowed but look like slips of units, as sentences: of single tubes and of sweeps, in shell and Python.

A millimetre taken for a metre is a factor of 1000, a radian for a degree 57, a psi for a pascal 6895. What is told lies
beyond any tube that is made; each limit leaves room for what only a theorist would ask.
"""

import warnings

import numpy as np

from ..atlas.schema import PARAMETERS

LARGEST = {"length": 20.0, "radius": 1.0}  # [m]: beyond any tube that is wound by hand or machine
SMALLEST = {"length": 1e-4, "radius": 1e-5}  # [m]
SLENDER = 2e4  # length over radius
THINNEST = 1e-4  # wall over radius
THICKEST = {False: 1.0, True: 20.0}  # of a membrane, and of a wall that is taken for as thick as it is
RADIANS = 0.5 * np.pi  # [degree]: if no fiber is steeper, angles are likely given in radians
SOFTEST, HARDEST = 10.0, 1e9  # [Pa] of c10: gels, hard plastics
RUBBERS = 5e3, 5e6  # [Pa] of c10: the softest and the hardest that tubes are made of
PRESSURES = {"psi": 6894.757, "kPa": 1e3, "MPa": 1e6}  # [Pa] units that constants of rubbers are printed in
USUAL = 1e-3, 1e4  # of the largest pressure over c10 wall/radius, which is a tenth to a hundred
LOAD = 1e4  # largest force over radius^2 c10, torque over radius^3 c10
HELD = 10.0  # times the undeformed length, or a part of it: a length that is held
LOOSEST = {"alpha": 45.0, "beta": 45.0}  # [degree] of a tolerance; of other parameters as much as they are
HINT = 'plain numbers are in SI units and degrees, others need theirs, as in "4.76 mm" or "0.17 MPa"'


def design_doubts(design, thick=False, thickness=None) -> list:
    """Sentences on the values of a ``design``: name -> number or array [degree, m, Pa], of alpha, beta, length, radius, wall
    and c10; none for most. ``thickness`` is wall over radius of each design, where these are more than one; a wall may be
    taken for ``thick``.
    """
    return _of_design(**_arrays(design, thickness), thick=thick)


def load_doubts(design, loads, thickness=None) -> list:
    """Sentences on the ``loads`` of a design: name -> number or array [Pa, N, N m, m], of pressure, force, torque, and a
    deformed length that is held; none for most.
    """
    held = loads.get("deformed_length")
    given = {name: loads.get(name, 0.0) for name in ("pressure", "force", "torque")}
    return _of_load(**_arrays(design, thickness), **given, held=held)


def tolerance_doubts(design, tolerances) -> list:
    """Sentences on ``tolerances`` of a design, standard deviations by name [degree, m, Pa, 1], that are as large as what
    they are of; none for most.
    """
    found = []
    for name, tolerance in tolerances.items():
        most = LOOSEST.get(name, abs(design.get(name, 0.0)))
        if tolerance > most > 0.0:
            size, limit = (f"{number:g} {PARAMETERS[name].units}".removesuffix(" 1") for number in (tolerance, most))
            found.append(f"a tolerance of {size} of {name} is more than {limit}; {HINT}")
    return found


def _arrays(design, thickness):
    """The values of a design, and its thickness, as arrays."""
    thickness = np.divide(design["wall"], design["radius"]) if thickness is None else thickness
    return {name: np.atleast_1d(np.asarray(value, float)) for name, value in {**design, "thickness": thickness}.items()}


def warn_of(found, stacklevel):
    """Warn of each doubt ``found``."""
    for doubt in found:
        warnings.warn(doubt, stacklevel=stacklevel + 1)


def _of_design(alpha, beta, length, radius, wall, c10, thickness, thick):
    found = []
    if thickness.max() > THICKEST[thick]:
        k = int(np.argmax(thickness))
        widest = wall[k] if wall.size == thickness.size else wall.max()
        narrow = radius[k] if radius.size == thickness.size else radius.min()
        why = HINT if thick else "the model takes a thin wall"
        found.append(f"wall {widest:g} m is thicker than the inner radius {narrow:g} m: {why}")
    for name, values in (("length", length), ("radius", radius)):
        if values.max() > LARGEST[name]:
            found.append(f"the {name} is {values.max():g} m; {HINT}")
        elif values.max() < SMALLEST[name]:
            found.append(f"the {name} is only {values.max():g} m; {HINT}")
    if length.min() > SLENDER * radius.max():
        found.append(f"a length of {length.min():g} m is {length.min() / radius.max():.2g} radii; {HINT}")
    if thickness.max() < THINNEST:
        found.append(f"the wall is only {wall.max():g} m for a radius of {radius.min():g} m; {HINT}")
    steepest = max(np.abs(alpha).max(), np.abs(beta).max())
    if 0.0 < steepest < RADIANS:
        found.append(f"no fiber angle exceeds {steepest:g} degree, as if they were radians; {HINT}")
    if c10.max() < SOFTEST or c10.min() > HARDEST:
        found.append(f"no rubber has a c10 of {c10.max():g} Pa{_meant(c10.max())}; {HINT}")
    return found


def _meant(c10):
    """The units that make a rubber of a number which is none in pascals, as part of a sentence; "" of what is one."""
    low, high = RUBBERS
    units = [f'"{c10:g} {unit}"' for unit, pascals in PRESSURES.items() if low <= c10 * pascals <= high]
    return f" ({' or '.join(units)}?)" if units and not low <= c10 <= high else ""


def _of_load(pressure, force, torque, held, length, radius, c10, thickness, **_):
    found = []
    low, high = USUAL
    highest, softest = np.max(pressure), c10.min()
    free = not (np.any(force) or np.any(torque))  # which may work on a tube of hardly any pressure
    if free and 0.0 < highest < low * softest * thickness.min():
        found.append(f"no pressure exceeds {highest:g} Pa, which hardly deforms a c10 of {softest:g} Pa; {HINT}")
    if highest > high * softest * thickness.max():
        far = f"the pressure reaches {highest:g} Pa, {highest / softest:.1g} times a c10 of {softest:g} Pa"
        locked = "; so far beyond its rubber a tube has its locked shape (lock)" if free and held is None else ""
        found.append(f"{far}{_meant(softest)}{locked}; {HINT}")
    if held is not None and (np.max(held) > HELD * length.max() or np.max(held) < length.min() / HELD):
        found.append(f"a held length of {np.max(held):g} m is far from the tube's {length.max():g} m; {HINT}")
    for name, values, unit, power in (("force", force, "N", 2), ("torque", torque, "N m", 3)):
        if (largest := np.max(np.abs(values))) > LOAD * radius.max() ** power * c10.max():
            found.append(f"a {name} of {largest:g} {unit} is far beyond what this tube can bear; {HINT}")
    return found
