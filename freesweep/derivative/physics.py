"""A state's density and integrands over all cells of a mesh, as dual numbers of what design and load are: in SI units and
degrees, so that no chain rule is left to do outside.
"""

from copy import copy
from functools import cache

import numpy as np

from ..description.elastomer import Yeoh
from ..description.tube_model import FIBER_PLACES, fiber_place
from ..scaling import ALONG, OUTPUTS, output_scales, problem_columns, wall_volume_inside
from .along import lines_of
from .dual import Dual, sqrt, value_of
from .request import constants, place_of_fibers
from .twins import twin

BY_Y, BY_V, OWN = 0, 1, 2  # first parts of every dual number: by y, by its slope; then by the parameters
RISE = 4  # place of dR/dx among the numbers of a body's cell
NEXT_TO_NOTHING = 1e-300  # of C1: a constant of Yeoh's that is 0 counts, too, where its derivative is asked for


@cache
def kernels():
    """Density, integrands and the rise of a meridian, as the solver has them, and how it eases a guess."""
    from ..solver import cells
    from ..solver.numerics import mesh
    from ..solver.physics import lagrangian

    return twin(lagrangian.density), twin(lagrangian.integrands), twin(cells.rise), twin(mesh.ease)


@cache
def membranes():
    """The tube of a body's radius, its stretch and twist, its fibers' multipliers, these as the body has them, and all of
    it where a flux is known.
    """
    from ..solver.physics import body, lagrangian, membrane

    parts = body.as_tube, membrane.kinematics, membrane.fiber_multipliers, body.of_multipliers, lagrangian.at_flux
    return tuple(map(twin, parts))


def outputs_of(design, numbers, scales=None, inside=None) -> dict:
    """Outputs in SI units and degrees from dimensionless ones of half a tube, in the order of kernels: length, volume,
    twist, energy, stretch in the middle; and what is largest and least along it, if that is there. A body has ``scales``
    and a volume of wall ``inside`` the fibers of its own.
    """
    scales = output_scales(design) | (scales or {})
    made = {name: number * scales[name] for name, number in zip((*OUTPUTS, *ALONG), numbers)}
    return made | {"volume": made["volume"] - (wall_volume_inside(design) if inside is None else inside)}


class Physics:
    """A tube's state under given loads, whose derivatives by some ``parameters`` are wanted.

    ``loads``: pressure, force and torque in SI units; an infinite pressure is that of the locked shape. ``course``: what
    varies along the tube, or None.
    """

    def __init__(self, tube, course, loads, parameters):
        self.tube, self.course, self.parameters = tube, course, tuple(parameters)
        lines = lines_of(tube)
        self.design = {name: self.seed(lines.get(name, name), value) for name, value in (tube.design() | loads).items()}
        for own, name in constants(tube.material).items():
            self.design[name] = self.seed(own, self.design[name].value)
        place = place_of_fibers(tube)
        if tube.is_body:
            self.design["fiber_radius"] = course.first_surface(self.seed)
        elif place in FIBER_PLACES:
            thinnest = float(np.min(tube.profile("wall").samples()))
            self.design["fiber_radius"] = fiber_place(place, self.design["radius"], self.seed("wall", thinnest))
        self.is_locked = bool(np.all(np.isinf(loads["pressure"])))
        if self.is_locked:
            self.design["pressure"] = 0.0 * self.design["length"]
        self.length = self.design["length"] / self.design["fiber_radius"]

    def seed(self, name, value):
        """A number, or numbers along the tube (n,), with the derivative by the parameter ``name``, if that is wanted."""
        value = np.atleast_1d(np.asarray(value, float))
        parts = np.zeros((OWN + len(self.parameters), 1))
        if name not in self.parameters:
            return Dual(value)
        parts[OWN + self.parameters.index(name)] = 1.0
        return Dual(value, parts)

    def bear(self, name, load):
        """Bear another ``load``, in SI units, in each cell."""
        self.design = self.design | {name: self.seed(name, load)}

    def in_cells(self, some):
        """The physics of some of the cells that it was asked of last."""
        here = copy(self)
        here.design = {name: number.take(some) for name, number in self.design.items()}
        return here

    def columns(self, design):
        """Those of a dimensionless problem."""
        return problem_columns(design, self.tube.energy, self.tube.is_thick, self.tube.threads)

    def properties(self, share):
        """``(cell, load)`` as kernels take them, for cells whose middles lie at places x/l."""
        from ..solver.load import Load

        tube, design = self.tube, self.design
        if self.course is not None:
            design = design | self.course.at(share, self.seed)
        H, D, area, gamma, ratio, shear, f, m, _, second, third, *wall = self.columns(design)
        cell = H, D, area
        if tube.is_body:  # its loads are those of the tube of the radius at x = 0
            R, rise = design["fiber_radius"] / self.design["fiber_radius"], self.course.rise(share, self.seed)
            cell = *cell, R, rise / design["length"], wall[0] if wall else 0.0
            f, m = self.columns(self.design)[6:8]
        p, e = design["pressure"] / design["c10"], 0.0 if self.is_locked else 1.0
        if self.is_locked:
            p, f, m = 1.0, 0.0, 0.0
        rubber = (ratio,)
        if isinstance(tube.material, Yeoh):
            rubber = (ratio, second, third + NEXT_TO_NOTHING)
        return cell, Load(gamma, rubber, (shear, *wall), p, f, m, e)

    def outputs(self, integrals, middle, half):
        """The outputs in SI units and degrees from dimensionless dual numbers, of ``half`` the tube or all of it."""
        share = 1.0 if half else 0.5
        numbers = [*(share * integral for integral in integrals), middle]
        if not self.tube.is_body:
            return outputs_of(self.design, numbers)
        scales = {"mid_radius": self.course.at(0.5, self.seed)["fiber_radius"]}
        return outputs_of(
            self.design, numbers, scales, np.pi * self.design["length"] * self.course.squares(self.seed)[1]
        )

    def local(self, y, v, share):
        """``(room, L_y, L_v)`` in all cells, at their middles."""
        room, L_y, L_v, _, _, _ = kernels()[0](y, v, *self.properties(share))
        return room.value, L_y, L_v

    def integrands(self, y, v, share):
        """What the outputs integrate, in the cells of which :meth:`local` was asked last."""
        return kernels()[1](y, v, *self.properties(share))[:4]

    def place(self, y, v, share):
        """``(G - 1, twist rate, tensions of both lines [N])`` in the cells of which :meth:`local` was asked last; of a
        locked shape tensions are per pressure.
        """
        as_tube, kinematics, multipliers, of_multipliers, _ = membranes()
        given, load = self.properties(share)
        cell, slope, own = as_tube(y, v, given, load)
        psi, _, _, G_1, _, _ = kinematics(y, cell, own)
        pulls = multipliers(y, sqrt(G_1 + 1.0 - slope * slope), cell, own)
        return G_1, psi, self.tensions(given, *of_multipliers(given, 0.0, *pulls)[1:])

    def at_flux(self, y, flux, share):
        """As :meth:`place`, at any places where the flux T v/s is known."""
        given, load = self.properties(share)
        psi, G_1, *pulls = membranes()[-1](y, flux, given, load)
        return G_1, psi, self.tensions(given, *pulls)

    def tensions(self, cell, alpha, beta):
        """Of both lines [N], all around the tube, from their multipliers."""
        r, tangents = self.design["fiber_radius"], (cell[0] + cell[1], cell[0] - cell[1])
        unit = 2.0 * np.pi * r * r * self.design["fiber_extension"]
        unit = unit if self.is_locked else unit * self.design["c10"]
        return [unit * pull * sqrt(t * t + 1.0) for pull, t in zip((alpha, beta), tangents)]

    def surfaces(self, share):
        """Undeformed radii of the wall's surfaces, and of the fibers [m]."""
        design = self.design if self.course is None else self.design | self.course.at(share, self.seed)
        return design["radius"], design["radius"] + design["wall"], design["fiber_radius"]

    def begin(self, other):
        """Take over from another one of the same state what helps to find it."""

    def kinks(self, segments, cells=slice(None)):
        """Places x/l, other than where segments meet, at which the kind of the ``cells`` changed that were seen last."""
        return np.zeros(0)

    def rest_integrals(self):
        """What the outputs integrate, of the undeformed tube."""
        none, volume = 0.0 * self.length, self.length
        if self.tube.is_body:
            volume = volume * self.course.squares(self.seed)[0] / self.design["fiber_radius"] ** 2
        return [self.length, volume, none, none]

    def meridian(self, y, v, share):
        """Rise of the deformed meridian, and axial length, in all cells, both per length."""
        cell, load = self.properties(share)
        found = kernels()[2](Dual(y), Dual(v), cell), kernels()[1](Dual(y), Dual(v), cell, load)[0]
        return tuple(np.broadcast_to(number.value, y.shape) for number in found)

    def eased(self, x, y, share, cosine, middle):
        """A guess ``y`` at nodes ``x`` (x/l) that leaves every cell room, whose middles are at ``share``, and whose meridian
        has about that ``cosine``: followed from both ends on to the node in the ``middle``.
        """
        cell, load = self.properties(share)
        rows = np.stack([np.broadcast_to(value_of(number), share.shape) for number in cell], axis=-1)
        back = rows[::-1] * np.where(np.arange(len(cell)) == RISE, -1.0, 1.0)
        numbers = [tuple(map(_float, part)) if isinstance(part, tuple) else _float(part) for part in load]
        load, integrands, ease = type(load)(*numbers), *kernels()[1::2]

        def followed(x, y, rows, cosine, n):
            y, rows = y[: n + 1].copy(), rows[:n] if len(cell) == 3 else rows[:n].reshape(-1, 2, 3)
            ease(integrands, x * self.length.value, y, n, cosine, rows, load)
            return y

        left = followed(x, y, rows, cosine, middle)
        right = followed(x[-1] - x[::-1], y[::-1], back, cosine[::-1], len(share) - middle)
        return np.concatenate([left, right[-2::-1]])


def _float(number):
    """A number that does not vary along a tube."""
    return float(np.ravel(value_of(number))[0])
