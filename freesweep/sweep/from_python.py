"""``freesweep.sweep``: a grid of designs from Python's arguments, without a file of its own."""


def sweep(
    *,
    out,
    alpha=None,
    beta=None,
    length=None,
    radius=None,
    wall=None,
    pressure=None,
    material=None,
    c10=None,
    c01=None,
    c20=None,
    c30=None,
    fiber_extension=None,
    fiber_radius=None,
    force=None,
    torque=None,
    held_length=None,
    held_length_ratio=None,
    held_rotation=None,
    designs=None,
    title=None,
    energy=None,
    model=None,
    wall_model=None,
    fibers=None,
    accuracy=None,
    blocked=None,
    interpolation_tolerance=None,
    budget=None,
    threads=None,
    executor=None,
    progress=True,
    overwrite=False,
):
    """Solve a grid of designs and store its atlas, as :func:`freesweep.run_sweep` does with a TOML specification.

    Parameters
    ----------
    out : path of the atlas to make
    alpha, beta, length, radius, wall, pressure, ... : each parameter of the actuator and its load [degree, m, Pa, N, N m]: a
        number; an array or a list of values, which makes an axis; a range ``(start, stop, step)`` or ``{"start": 0, "stop":
        3e5, "num": 41, "spacing": "sqrt"}``; for alpha, beta and wall a profile, pairs ``[(x/l, value), ...]``. Texts with
        units ("4.76 mm") and what carries units are read as everywhere
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
