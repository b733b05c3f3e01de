"""Faults of what a person describes: sentences, listed all at once in one error."""

from collections.abc import Iterable


class ActuatorError(ValueError):
    """The description of an actuator or a load has faults; ``faults`` lists them all."""

    def __init__(self, faults: Iterable[str]) -> None:
        self.faults: list[str] = list(faults)
        super().__init__("\n".join(["faults in what was given:", *(f"  - {fault}" for fault in self.faults)]))
