"""What loads a tube: everything about it that does not vary along it, and how that changes."""

from typing import NamedTuple

from ..jit import kernel


class Load(NamedTuple):
    """Fiber extension gamma; rubber and wall, as the density takes them; pressure p, force f and torque m; and the weight e
    of the wall's energy, 0 for a locked tube. A change of the load is a load, too, of which rubber and wall say nothing.
    """

    gamma: float
    rubber: tuple
    wall: tuple
    p: float
    f: float
    m: float
    e: float


SPARED = 0.2  # of the pressure: what a push leaves it
NO_CHANGE = Load(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def by(p, f, m):
    """A change of pressure, force and torque alone."""
    return Load(0.0, 0.0, 0.0, p, f, m, 0.0)


@kernel
def under(load, p, f, m):
    """The load with other loads in it: fibers, rubber and wall stay."""
    return Load(load.gamma, load.rubber, load.wall, p, f, m, load.e)


@kernel
def at_pressure(load, p):
    """The load under another pressure."""
    return under(load, p, load.f, load.m)


@kernel
def fibers_alone(gamma):
    """Fibers of this extension, and nothing else: what the constraints ask for."""
    return Load(gamma, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def loaded(load, direction, mu):
    """The load changed by ``mu`` along ``direction``, component by component."""
    return Load(
        load.gamma + mu * direction.gamma,
        load.rubber,
        load.wall,
        load.p + mu * direction.p,
        load.f + mu * direction.f,
        load.m + mu * direction.m,
        load.e + mu * direction.e,
    )
