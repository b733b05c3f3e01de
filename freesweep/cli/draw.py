"""The commands that draw: plot map, validity, curve, shape. Names of files are checked before anything is solved."""

import os

from .picked import read, selection

STILL = ".png, .svg or .pdf"
FINEST = (40.0, 1200.0)  # resolutions that may be asked for [dots per inch]


def add_plot(commands):
    """Add the commands of this module to the command line."""
    kinds = commands.add_parser("plot", help="draw an atlas or an actuator").add_subparsers(
        required=True, metavar="KIND"
    )
    _map(kinds)
    _validity(kinds)
    _curve(kinds)
    _shape(kinds)


def _out(command, default, kinds=STILL):
    command.add_argument("-o", "--out", metavar="FILE", help=f"{kinds} (default: {default})")
    add_resolution(command)


def add_resolution(command):
    """The option for the resolution of pictures."""
    command.add_argument("--resolution", type=float, metavar="DPI", help="dots per inch (default: 300; of a .gif 110)")


def fineness(options) -> dict:
    """The resolution as a keyword, if one is asked for; refuses what is too coarse to read or too fine to hold."""
    if options.resolution is None:
        return {}
    if not FINEST[0] <= options.resolution <= FINEST[1]:
        raise ValueError(f"--resolution: found {options.resolution:g}; give {FINEST[0]:g} to {FINEST[1]:g}")
    return {"resolution": options.resolution}


def _at(command):
    command.add_argument(
        "--at",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help='where in the other axes, such as pressure="0.1 MPa"',
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
        "--over",
        nargs="+",
        action="extend",
        metavar="AXIS",
        help="small multiples along one or two more axes, such as pressure length",
    )
    _at(command)
    _out(command, "named after ATLAS, here")
    command.set_defaults(run=_run_map)


def _run_map(options):
    from ..plot.style import save

    out = _target(options, _named(options.atlas, options.variable))
    x, y = options.axes
    with read(options.atlas) as data:
        if options.over:
            from ..plot.section import multiples

            picture = multiples(data, options.variable, x, y, options.over, **selection(options.at))
        elif {x, y} == {"alpha", "beta"}:
            from ..plot.map import design_map

            picture = design_map(data, options.variable, **selection(options.at))
        else:
            from ..plot.section import section_map

            picture = section_map(data, options.variable, x, y, **selection(options.at))
        save(picture, out, **fineness(options))
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

    from ..plot.style import save
    from ..plot.validity import validity_maps

    out = _target(options, _named(options.atlas[0], "validity"))
    with contextlib.ExitStack() as stack:
        data = [stack.enter_context(read(path)) for path in options.atlas]
        save(validity_maps(data, options.of, *options.axes, **selection(options.at)), out, **fineness(options))
    print(out)


def _curve(kinds):
    command = kinds.add_parser("curve", help="a variable along one axis, with its error bound as a band")
    command.add_argument("data", help="an atlas, or what inflate and block keep with --out")
    command.add_argument("--variable", help="what to draw (default: deformed_length, or what holds it)")
    command.add_argument("--along", default="pressure", metavar="AXIS", help="the axis of the plot (default: pressure)")
    command.add_argument("--each", metavar="AXIS", help="one line for each value of this axis")
    _at(command)
    _out(command, "named after DATA, here")
    command.set_defaults(run=_run_curve)


def _run_curve(options):
    from ..plot.curve import curve
    from ..plot.style import save

    _target(options, "curve.png")
    with read(options.data) as data:
        usual = ("deformed_length", "force", "torque")  # of what is held the length is given
        variable = options.variable or next((name for name in usual if name in data.data_vars), usual[0])
        out = _target(options, _named(options.data, variable))
        picture = curve(data, variable, options.along, options.each, **selection(options.at))
        save(picture, out, **fineness(options))
    print(out)


def _shape(kinds):
    from .single import add_actuator, add_loads

    command = add_actuator(kinds, "shape", "an actuator in space, undeformed and deformed", _run_shape, rubber=False)
    add_loads(command, required=False)
    _out(command, "shape.png", ".png, .svg or .pdf; .gif: motion along the pressures")


def _run_shape(options):
    from ..plot.suffixes import SUFFIXES
    from .single import inflated, tube_of

    out = _target(options, "shape.png", (*SUFFIXES, ".gif"))
    moves = out.lower().endswith(".gif")
    if options.pressure is None:
        if moves:
            raise ValueError('--out: a .gif shows motion along pressure; give --pressure 0 "0.2 MPa" --steps 31')
        from ..statics import lock

        tube = tube_of(options)
        states, titles = [lock(tube)], ["locked"]
    else:
        if options.c10 is None and options.material is None:
            raise ValueError(
                "--c10: under pressure the rubber counts; give its constants or its name, or leave --pressure out"
            )
        from ..plot.display import describe

        tube, data = tube_of(options), inflated(options)
        states = [data] if not data["pressure"].dims else [data.isel(pressure=k) for k in range(data.sizes["pressure"])]
        titles = [describe("pressure", float(state["pressure"])).split("\u00a0", 1)[1] for state in states]
    if moves:
        from ..plot.motion import save_motion

        print(save_motion(tube, data, out, **fineness(options)))
        return
    from ..plot.style import save
    from ..plot.tubes import shape_plot

    save(shape_plot(tube, *states, titles=titles), out, **fineness(options))
    print(out)


def check_map(sweep, path):
    """Refuse a map that could not be drawn before anything is solved."""
    from pathlib import Path

    from ..plot.suffixes import SUFFIXES

    faults = []
    if Path(path).suffix.lower() not in SUFFIXES:
        faults.append(f"the suffix of {Path(path).name!r} must be one of {', '.join(SUFFIXES)}")
    if any(len(sweep.axes.get(name, ())) < 2 for name in ("alpha", "beta")):
        faults.append("a map needs alpha and beta as axes of two values or more")
    if faults:
        raise ValueError(f"--map: {'; '.join(faults)}")
    if not os.access(folder := Path(path).parent, os.W_OK):
        from ..atlas.files import EnvironmentFault

        absent = "cannot be written" if folder.is_dir() else "is not there, make it first"
        raise EnvironmentFault(f"--map: the folder {folder} {absent}")


class Map:
    """The map of rotation over both fiber angles that a sweep draws into the file ``out``."""

    modules = ("freesweep.plot.map", "matplotlib.backends.backend_agg")  # half a second to import

    def __init__(self, out):
        self.out, self.content = out, None

    def __call__(self, data):
        """Draw it, of a Dataset that is not an atlas yet."""
        self.content = self._drawn(data)

    def save(self, data):
        """Write the file, once there is an atlas with that ``data``."""
        from ..atlas.files import write_whole

        write_whole(self.out, self.content or self._drawn(data))
        print(self.out)

    def _drawn(self, data):
        from ..plot import map as maps
        from ..plot import style

        with style.context():
            ax = style.new_figure(*maps.SIZE).add_subplot()  # no window shows it, so that any thread may draw it
        return style.drawn(maps.design_map(data, "rotation", ax), self.out)


def _target(options, default, suffixes=None):
    """The file to make, once its suffix (default: those of pictures) and the resolution are checked."""
    from pathlib import Path

    from ..plot.suffixes import SUFFIXES

    out, suffixes = options.out or default, suffixes or SUFFIXES
    if Path(out).suffix.lower() not in suffixes:
        raise ValueError(f"--out: the suffix of {Path(out).name!r} must be one of {', '.join(suffixes)}")
    fineness(options)
    return out


def _named(path, variable):
    from pathlib import Path

    return f"{Path(path).stem}-{variable}.png"
