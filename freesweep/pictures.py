"""The commands that draw: plot map, validity, curve, shape; thesis. Names of files are checked before anything is solved."""

STILL = ".png, .svg or .pdf"


def add_plot(commands):
    """Add the commands of this module to the command line."""
    kinds = commands.add_parser("plot", help="draw an atlas or an actuator").add_subparsers(
        required=True, metavar="KIND"
    )
    _map(kinds)
    _validity(kinds)
    _curve(kinds)
    _shape(kinds)


def add_thesis(commands):
    """Add the command that reproduces the source."""
    command = commands.add_parser(
        "thesis", help="every figure and table of the source, recomputed, and its claims checked"
    )
    command.add_argument(
        "figures", nargs="*", metavar="FIGURE", help="such as 2-7, table-1 or claims (default: everything)"
    )
    command.add_argument("-o", "--out", default="thesis", metavar="DIR", help="folder to make (default: thesis, here)")
    command.add_argument("--quiet", action="store_true", help="say nothing but the path of the page")
    command.set_defaults(run=_run_thesis)


def _run_thesis(options):
    import sys

    from .thesis.make import make

    def progress(name):
        print(name, file=sys.stderr, flush=True)

    print(make(options.figures, options.out, None if options.quiet else progress))


def _out(command, default, kinds=STILL):
    command.add_argument("-o", "--out", metavar="FILE", help=f"{kinds} (default: {default})")


def _at(command):
    command.add_argument(
        "--at", nargs="+", default=[], metavar="NAME=VALUE", help='where in the other axes, such as pressure="0.1 MPa"'
    )


def _axes(command):
    command.add_argument(
        "--axes", nargs=2, default=("alpha", "beta"), metavar=("X", "Y"), help="of the map (default: alpha beta)"
    )


def _map(kinds):
    command = kinds.add_parser(
        "map", help="one variable over the fiber angles, or over any two axes, as filled contours"
    )
    command.add_argument("atlas", help="an atlas made by freesweep sweep")
    command.add_argument("--variable", default="rotation", help="what to draw (default: rotation)")
    _axes(command)
    command.add_argument(
        "--over", nargs="+", metavar="AXIS", help="small multiples along one or two more axes, such as pressure length"
    )
    _at(command)
    _out(command, "named after ATLAS, here")
    command.set_defaults(run=_run_map)


def _run_map(options):
    from .plot.style import save

    out = checked(options.out or _named(options.atlas, options.variable))
    x, y = options.axes
    with read(options.atlas) as data:
        if options.over:
            from .plot.section import multiples

            save(multiples(data, options.variable, x, y, options.over, **selection(options.at)), out)
        elif {x, y} == {"alpha", "beta"}:
            from .plot.map import design_map

            save(design_map(data, options.variable, **selection(options.at)), out)
        else:
            from .plot.section import section_map

            save(section_map(data, options.variable, x, y, **selection(options.at)), out)
    print(out)


def _validity(kinds):
    command = kinds.add_parser(
        "validity", help="where an atlas has results, which fibers would have to push, what is unstable"
    )
    command.add_argument("atlas", nargs="+", help="one atlas, or several side by side (one for each strain energy)")
    states = ("equilibrium", "blocked_force", "blocked_torque")
    command.add_argument("--of", choices=states, default=states[0], help="of which state (default: equilibrium)")
    _axes(command)
    _at(command)
    _out(command, "named after the first ATLAS, here")
    command.set_defaults(run=_run_validity)


def _run_validity(options):
    import contextlib

    from .plot.style import save
    from .plot.validity import validity_maps

    out = checked(options.out or _named(options.atlas[0], "validity"))
    with contextlib.ExitStack() as stack:
        data = [stack.enter_context(read(path)) for path in options.atlas]
        save(validity_maps(data, options.of, *options.axes, **selection(options.at)), out)
    print(out)


def _curve(kinds):
    command = kinds.add_parser("curve", help="a variable along one axis, with its error bound as a band")
    command.add_argument("data", help="an atlas, or what inflate and block keep with --out")
    command.add_argument("--variable", default="deformed_length", help="what to draw (default: deformed_length)")
    command.add_argument("--along", default="pressure", metavar="AXIS", help="the axis of the plot (default: pressure)")
    command.add_argument("--each", metavar="AXIS", help="one line for each value of this axis")
    _at(command)
    _out(command, "named after DATA, here")
    command.set_defaults(run=_run_curve)


def _run_curve(options):
    from .plot.curve import curve
    from .plot.style import save

    out = checked(options.out or _named(options.data, options.variable))
    with read(options.data) as data:
        save(curve(data, options.variable, options.along, options.each, **selection(options.at)), out)
    print(out)


def _shape(kinds):
    from .single import add_actuator, add_loads

    command = add_actuator(kinds, "shape", "an actuator in space, undeformed and deformed", _run_shape, rubber=False)
    add_loads(command, required=False)
    _out(command, "shape.png", ".png, .svg or .pdf; .gif: motion along the pressures")


def _run_shape(options):
    from .plot.style import SUFFIXES
    from .single import inflated, tube_of

    out = checked(options.out or "shape.png", (*SUFFIXES, ".gif"))
    moves = out.lower().endswith(".gif")
    if options.pressure is None:
        if moves:
            raise ValueError('--out: a .gif shows motion along pressure; give --pressure 0 "0.2 MPa" --steps 31')
        from .statics import lock

        tube = tube_of(options)
        states, titles = [lock(tube)], ["locked"]
    else:
        if options.c10 is None:
            raise ValueError("--c10: under pressure the rubber counts; give its constants, or leave --pressure out")
        from .plot.display import describe

        tube, data = tube_of(options), inflated(options)
        states = [data] if not data["pressure"].dims else [data.isel(pressure=k) for k in range(data.sizes["pressure"])]
        titles = [describe("pressure", float(state["pressure"])).split("\u00a0", 1)[1] for state in states]
    if moves:
        from .plot.motion import save_motion

        print(save_motion(tube, data, out))
        return
    from .plot.style import save
    from .plot.tubes import shape_plot

    save(shape_plot(tube, *states, titles=titles), out)
    print(out)


def check_map(sweep, path):
    """Refuse a map that could not be drawn before anything is solved."""
    from pathlib import Path

    from .plot.style import SUFFIXES

    faults = []
    if Path(path).suffix.lower() not in SUFFIXES:
        faults.append(f"the suffix of {Path(path).name!r} must be one of {', '.join(SUFFIXES)}")
    if any(len(sweep.axes.get(name, ())) < 2 for name in ("alpha", "beta")):
        faults.append("a map needs alpha and beta as axes of two values or more")
    if faults:
        raise ValueError(f"--map: {'; '.join(faults)}")


def draw_map(data, out, variable, select):
    """Draws the map of one variable into a file."""
    from .plot.map import design_map
    from .plot.style import save

    save(design_map(data, variable, **select), out)
    print(out)


def checked(out, suffixes=None):
    """``out``, if its suffix is one of ``suffixes`` (default: those of pictures)."""
    from pathlib import Path

    from .plot.style import SUFFIXES

    suffixes = suffixes or SUFFIXES
    if Path(out).suffix.lower() not in suffixes:
        raise ValueError(f"--out: the suffix of {Path(out).name!r} must be one of {', '.join(suffixes)}")
    return out


def _named(path, variable):
    from pathlib import Path

    return f"{Path(path).stem}-{variable}.png"


def read(path):
    """The Dataset of an atlas, or of one actuator as ``--out`` keeps it; a context manager."""
    from .atlas.store import AtlasError, open_atlas

    try:
        return open_atlas(path).data
    except AtlasError:
        import xarray as xr

        try:
            data = xr.open_dataset(path, engine="netcdf4", decode_times=False)
        except OSError:
            data = None
        if data is None or "status" not in data or "x" not in data.dims:
            raise
        return data


def selection(items):
    """Values of ``--at`` by name: quantities in stored units, the name of a design as it is."""
    from .atlas.schema import PARAMETERS, attributes
    from .plot.choice import DESIGN, HELD
    from .units import quantity

    select = {}
    for item in items:
        name, equals, value = item.partition("=")
        if not equals:
            raise ValueError(f'--at: found {item!r}; give NAME=VALUE, such as pressure="0.1 MPa"')
        known = name in PARAMETERS or name in HELD
        select[name] = value if name == DESIGN or not known else quantity(value, attributes(name)["units"])
    return select
