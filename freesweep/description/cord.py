"""The muscle of a cord: its angle, and where it lies."""

import math

from .faults import ActuatorError
from .fields import ENERGIES
from .given import read_number
from .tube_model import DEFAULT, FIBER_PLACES, MODELS, SHARES, word_faults


def of_cord(cord, turns, length, others) -> dict:
    """Parameters of the actuator that a cord [m] makes which winds ``turns`` times around a ``length`` [m], with ``others``
    that are given; raises :class:`ActuatorError`.
    """
    faults = []
    read = {
        name: read_number(name, value, unit, faults, positive=True)
        for name, value, unit in (("cord", cord, "m"), ("turns", turns, "1"), ("length", length, "m"))
    }
    if not faults and read["cord"] <= read["length"]:
        faults.append(f"cord: found {read['cord']:g} m around a length of {read['length']:g} m; it has to be longer")
    place = others.get("fiber_radius")
    if "alpha" in others or not (place is None or place in FIBER_PLACES) or (place and "radius" in others):
        faults.append("cord: it tells alpha and where the fibers lie; leave alpha and a fiber radius out")
    if others.get("model", DEFAULT) not in MODELS:
        faults += word_faults(others["model"], None, None, "full", ENERGIES)
    if faults:
        raise ActuatorError(faults)
    cord, turns, length = read.values()
    around = math.sqrt(cord**2 - length**2) / (2.0 * math.pi * turns)
    alpha = math.degrees(math.acos(length / cord))
    if "radius" in others:
        others["fiber_radius"] = around
    else:
        place = place or MODELS[others.get("model", DEFAULT)].fiber_radius
        thickness = read_number("wall", others.get("wall"), "m", faults, positive=True) if SHARES[place] > 0.0 else 0.0
        if not faults and around <= SHARES[place] * thickness:
            faults.append(f"cord: it lies at a radius of {around:g} m, which is less than the wall inside it")
        if faults:
            raise ActuatorError(faults)
        others["radius"] = around - SHARES[place] * thickness
    return {"alpha": alpha, "length": length, "beta": -alpha} | others
