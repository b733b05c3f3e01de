"""``freesweep.sweep``: a grid of designs from Python's arguments, without a file of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from ..description.quantities import Along, Path, Quantities

if TYPE_CHECKING:
    from ..atlas.store import Atlas
    from ..description.elastomer import MooneyRivlin, Yeoh

Axis: TypeAlias = "Quantities | Mapping[str, Any]"  # a number, values, a range


def sweep(
    *,
    out: Path,
    alpha: Axis | Along | None = None,
    beta: Axis | Along | None = None,
    length: Axis | None = None,
    radius: Axis | Along | None = None,
    wall: Axis | Along | None = None,
    taper: Axis | None = None,
    bulge: Axis | None = None,
    pressure: Axis | None = None,
    material: MooneyRivlin | Yeoh | str | None = None,
    c10: Axis | None = None,
    c01: Axis | None = None,
    c20: Axis | None = None,
    c30: Axis | None = None,
    fiber_extension: Axis | None = None,
    fiber_radius: Axis | None = None,
    force: Axis | None = None,
    torque: Axis | None = None,
    held_length: Axis | None = None,
    held_length_ratio: Axis | None = None,
    held_rotation: Axis | None = None,
    designs: Sequence[Mapping[str, Any]] | None = None,
    title: str | None = None,
    energy: str | None = None,
    model: str | None = None,
    wall_model: str | None = None,
    fibers: str | None = None,
    accuracy: float | None = None,
    blocked: bool | None = None,
    interpolation_tolerance: float | None = None,
    budget: int | None = None,
    threads: int | None = None,
    executor: Any = None,
    progress: bool = True,
    overwrite: bool = False,
) -> Atlas:
    """Solve a grid of designs and store its atlas, as :func:`freesweep.run_sweep` does with a TOML specification.

    Parameters
    ----------
    out : path of the atlas to make
    alpha, beta, length, radius, wall, taper, bulge, pressure, ... : each parameter of the actuator and its load [degree, m,
        Pa, N, N m]: a number; an array or a list of values, which makes an axis; a range ``(start, stop, step)`` or
        ``{"start": 0, "stop": 3e5, "num": 41, "spacing": "sqrt"}``; for alpha, beta, wall, radius a profile, pairs
        ``[(x/l, value), ...]`` or :class:`freesweep.Profile`. Texts with units ("4.76 mm") and what carries units are read
        as everywhere; where the radius varies, "geodesic 30 deg" and "constant volume 1 mm", too
    material : a rubber or the name of one, instead of ``c10``, ``c01``, ``c20``, ``c30``
    held_length, held_length_ratio, held_rotation, blocked : ask for blocked force and torque
    designs : named designs, each combined with all axes: a list of ``{"name": "A", "beta": 50}``
    title, energy, model, wall_model, fibers, accuracy, interpolation_tolerance, budget : as in a specification
    threads, executor, progress, overwrite : as of :func:`freesweep.run_sweep`

    The atlas keeps what was asked for as the text of a specification, ``atlas.data.attrs["specification"]``; written into a
    file and given to ``freesweep sweep`` it makes the same bits. Returns the opened :class:`freesweep.Atlas`. Raises
    SpecificationError, SweepError, EnvironmentFault.
    """
    given = dict(locals())
    from .run import run
    from .written import sweep_of

    how = {name: given.pop(name) for name in ("out", "threads", "executor", "progress", "overwrite")}
    return run(sweep_of(given), **how, stacklevel=3)
