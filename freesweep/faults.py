"""Faults of what a person describes: sentences, listed all at once in one error."""

import math
from numbers import Real


class ActuatorError(ValueError):
    """The description of an actuator or a load has faults; ``faults`` lists them all."""

    def __init__(self, faults):
        self.faults = list(faults)
        super().__init__("\n".join(["faults in what was given:", *(f"  - {fault}" for fault in self.faults)]))


def number_fault(name, value, unit, positive=False, least=None):
    """A sentence on what is wrong with a number, or None."""
    if isinstance(value, str):
        return f"{name}: found the text {value!r}; the Python API takes a number in [{unit}]"
    if isinstance(value, bool) or not isinstance(value, Real):
        return f"{name}: found {type(value).__name__} {value!r:.60}; give one number in [{unit}]"
    if not math.isfinite(value):
        return f"{name}: found {value}; give a finite number in [{unit}]"
    if positive and not value > 0:
        return f"{name}: found {value:g} {unit}; it has to be above 0"
    if least is not None and value < least:
        return f"{name}: found {value:g}; it has to be {least:g} or more"
    return None
