"""The actuators that the source describes, with the rubber and the fiber extension it gives them (sections 2.3 to 3.5)."""

import functools

import numpy as np

from ..description.actuator import Actuator, MooneyRivlin

RADIUS, WALL = 4.76e-3, 1.59e-3  # inner radius and wall of every prototype [m]
# fiber angle [degree]: length [m], C10, C01 [Pa] (Table 1), fiber extension (section 2.3.4)
MUSCLES = {
    30: (0.192, 0.11e6, 0.06e6, 1.005),
    35: (0.192, 0.18e6, 0.12e6, 1.0075),
    40: (0.193, 0.18e6, 0.10e6, 1.0075),
}
ROTATING = {
    "A": (10.0, 50.0, 0.141),
    "B": (0.0, 30.0, 0.131),
    "C": (0.0, 60.0, 0.143),
}  # alpha, beta [degree], length [m]
# not printed for A, B and C: those of the rotator (section 2.5.1), rounded
RUBBER = MooneyRivlin(c10=0.17e6, c01=0.08e6)
ROTATOR_RUBBER = MooneyRivlin(c10=0.1716e6, c01=0.08e6)
TABLE_1 = MooneyRivlin(c10=0.11e6, c01=0.06e6)
SWITCH = 0.125  # width of the rotator's change of angles, over its length: the profile is not printed
FOUND = {
    "alpha": (5.50777916, 15.364258698, 62.316682009, 82.950193561),
    "beta": (-63.051602913, -56.877608903, -66.433401521, -54.015628784),
}  # by the search for one that keeps its length
SLEEVE_LENGTH, SLEEVE_EXTENSION = 0.640, 1.0075  # [m]
SHELL_RADIUS, SHELL_HEIGHT = 42.8e-3, 99.2e-3  # [m]
ENERGIES = ("principal", "full")
PSI = 6894.757293168361  # [Pa]
source_tube = functools.partial(Actuator, model="source")


@functools.cache
def muscle(angle, extended=False, energy="principal") -> Actuator:
    """One of the McKibben prototypes; ``extended`` with its fiber extension."""
    length, c10, c01, extension = MUSCLES[angle]
    return source_tube(
        alpha=angle, beta=-angle, length=length, radius=RADIUS, wall=WALL, material=MooneyRivlin(c10, c01),
        fiber_extension=extension if extended else 1.0, energy=energy,
    )  # fmt: skip


@functools.cache
def rotating(name, energy="principal", extension=1.0) -> Actuator:
    """Prototype A, B or C (section 2.4)."""
    alpha, beta, length = ROTATING[name]
    return source_tube(
        alpha=alpha, beta=beta, length=length, radius=RADIUS, wall=WALL, material=RUBBER, fiber_extension=extension,
        energy=energy,
    )  # fmt: skip


@functools.cache
def physical_rotating(name) -> Actuator:
    """The same with a thick wall and threads at its outer radius that cannot push, of the rubber of Table 1."""
    alpha, beta, length = ROTATING[name]
    return Actuator(alpha=alpha, beta=beta, length=length, radius=RADIUS, wall=WALL, material=TABLE_1, model="physical")


def _switched(first, last):
    return lambda share: first + (last - first) * 0.5 * (1.0 + np.tanh((share - 0.5) / SWITCH))


@functools.cache
def rotator(profile="switch", energy="principal") -> Actuator:
    """The purely rotating actuator (section 2.5.1), its angles changing by a ``switch`` or along a straight ``line``."""
    alpha, beta = (0.0, 67.5), (-30.0, -67.5)
    if profile == "switch":
        angles = {"alpha": _switched(*alpha), "beta": _switched(*beta)}
    else:
        angles = {"alpha": list(zip((0.0, 1.0), alpha)), "beta": list(zip((0.0, 1.0), beta))}
    return source_tube(**angles, length=0.2, radius=RADIUS, wall=WALL, material=ROTATOR_RUBBER, energy=energy)


@functools.cache
def found_rotator() -> Actuator:
    """The purely rotating actuator of the same length, section and rubber that `freesweep design
    sweeps/wishes/pure-rotator.toml` finds in some minutes: angles [degree] at four places.
    """
    angles = {name: list(zip((0.0, 1 / 3, 2 / 3, 1.0), values)) for name, values in FOUND.items()}
    return source_tube(**angles, length=0.2, radius=RADIUS, wall=WALL, material=ROTATOR_RUBBER)


@functools.cache
def two_walls(energy="principal") -> Actuator:
    """The muscle whose far half has twice the wall (section 2.5.2), with the length and rubber of the 30 degree muscle."""
    wall = [(0.0, WALL), (0.5, WALL), (0.5, 2.0 * WALL), (1.0, 2.0 * WALL)]
    return source_tube(alpha=20, beta=-20, length=0.192, radius=RADIUS, wall=wall, material=TABLE_1, energy=energy)


@functools.cache
def sleeve_muscle(extended=False, angle=30.0, length=SLEEVE_LENGTH, radius=RADIUS, energy="principal") -> Actuator:
    """The muscle of the sleeve (section 3.4); rubber of the 30 degree muscle."""
    return source_tube(
        alpha=angle, beta=-angle, length=length, radius=radius, wall=WALL, material=TABLE_1, energy=energy,
        fiber_extension=SLEEVE_EXTENSION if extended else 1.0,
    )  # fmt: skip
