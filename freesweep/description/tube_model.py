"""What a tube is taken for: where its fibers lie, whether they can push, whether its wall has a thickness. One word for all
three, or each by itself.
"""

from typing import NamedTuple

SHARES = {"inner": 0.0, "middle": 0.5, "outer": 1.0}  # of the wall inside the fibers
FIBER_PLACES = tuple(SHARES)
WALL_MODELS = ("thick", "membrane")
FIBERS = ("loose", "bonded")


class TubeModel(NamedTuple):
    """The parts that one word stands for."""

    fiber_radius: str  # one of FIBER_PLACES
    wall_model: str  # one of WALL_MODELS
    fibers: str  # one of FIBERS

    @property
    def is_thick(self) -> bool:
        """Whether each layer of the wall is strained by itself."""
        return self.wall_model == "thick"

    @property
    def is_loose(self) -> bool:
        """Whether the fibers are threads, which cannot push."""
        return self.fibers == "loose"

    @property
    def is_physical(self) -> bool:
        """Whether it is more than the source's membrane with bonded fibers, wherever they lie."""
        return self.is_thick or self.is_loose


MODELS = {
    "physical": TubeModel("outer", "thick", "loose"),
    "source": TubeModel("inner", "membrane", "bonded"),
}
DEFAULT = "source"
# by how many families there are, and what they are: as the solver takes it (:mod:`freesweep.solver.physics.wall`)
THREADS = {
    (2, "bonded"): 0.0,
    (2, "loose"): 1.0,
    (1, "loose"): 2.0,
    (1, "bonded"): 3.0,
    (0, "loose"): 4.0,
    (0, "bonded"): 4.0,
}
ATTRIBUTES = dict(zip(TubeModel._fields, ("fiber_place", "wall_model", "fibers")))  # by which atlases tell the parts
LOOSE_PRINCIPAL = (
    "energy, fibers: 'principal' charges a twist nothing, so loose fibers would leave it open; choose energy='full', or"
    " fibers='bonded'"
)
FEW_PRINCIPAL = (
    "energy, alpha, beta: 'principal' charges a twist nothing, so fewer than two families would leave it open; choose"
    " energy='full'"
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


def attributes_of(model) -> dict:
    """Attributes of an atlas of such tubes: of the parts that are not the source's."""
    return {
        ATTRIBUTES[name]: part for name, part, known in zip(TubeModel._fields, model, MODELS["source"]) if part != known
    }


def model_of(attributes) -> TubeModel:
    """The model whose parts an atlas tells in its attributes; those it does not tell are the source's."""
    return TubeModel(*(attributes.get(ATTRIBUTES[name], known) for name, known in MODELS["source"]._asdict().items()))


def fiber_surface(data, model):
    """Radius of the fibers [m] of designs by the names of their parameters, where they give none as the ``model`` says."""
    if "fiber_radius" in data:
        return data["fiber_radius"]
    return fiber_place(model.fiber_radius, data["radius"], data["wall"] if model.fiber_radius != "inner" else 0.0)


def fiber_place(place, radius, wall):
    """Radius [m] of one of FIBER_PLACES in a wall [m], of one that varies the thinnest."""
    return radius if place == "inner" else radius + SHARES[place] * wall
