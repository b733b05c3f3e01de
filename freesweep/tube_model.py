"""What a tube is taken for: where its fibers lie, whether they can push, whether its wall has a thickness. One word for all
three, or each by itself.
"""

from typing import NamedTuple

FIBER_PLACES = ("inner", "middle", "outer")
WALL_MODELS = ("thick", "membrane")
FIBERS = ("loose", "bonded")


class TubeModel(NamedTuple):
    """The parts that one word stands for."""

    fiber_radius: str  # one of FIBER_PLACES
    wall_model: str  # one of WALL_MODELS
    fibers: str  # one of FIBERS


MODELS = {
    "physical": TubeModel("outer", "thick", "loose"),
    "source": TubeModel("inner", "membrane", "bonded"),
}
DEFAULT = "source"
LOOSE_PRINCIPAL = (
    "energy, fibers: 'principal' charges a twist nothing, so loose fibers would leave it open; choose energy='full', or"
    " fibers='bonded'"
)


def word_faults(model, wall_model, fibers, energy, energies) -> list:
    """Faults of the words that describe a tube; a part may be None: as the model has it."""
    from .given import described  # the shell names these words without NumPy

    faults = [
        f"{name}: found {described(value)}; choose one of {', '.join(map(repr, allowed))}"
        for name, value, allowed in (
            ("model", model, MODELS),
            ("wall_model", wall_model, (*WALL_MODELS, None)),
            ("fibers", fibers, (*FIBERS, None)),
            ("energy", energy, energies),
        )
        if not (value is None or isinstance(value, str)) or value not in allowed
    ]
    if not faults and energy == "principal" and (fibers or MODELS[model].fibers) == "loose":
        faults.append(LOOSE_PRINCIPAL)
    return faults


def fiber_place(place, radius, wall):
    """Radius [m] of one of FIBER_PLACES in a wall [m], of one that varies the thinnest."""
    return radius + {"inner": 0.0, "middle": 0.5, "outer": 1.0}[place] * wall
