"""The command `freesweep export`: parses and calls."""

FORMATS = ("csv", "npz", "mat", "c", "json", "mujoco", "simulink")
MOST = 100_000  # values of an axis that START:STOP:COUNT may ask for


def add_export(commands):
    """Add the command to the command line."""
    command = commands.add_parser(
        "export",
        help="a table of an atlas for another program",
        description="Writes a slice of an atlas, with units, error and status of each number, as CSV, NumPy or MATLAB"
        " arrays, a C header, JSON, a MuJoCo model or a Simulink script. Axes that --at leaves out keep their nodes.",
    )
    command.add_argument("atlas", help="an atlas made by freesweep sweep")
    command.add_argument("--to", choices=FORMATS, help="default: by the suffix of --out")
    command.add_argument("--variable", nargs="+", action="extend", metavar="NAME", help="which (default: all)")
    command.add_argument(
        "--at",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=VALUE",
        help='one value, as in pressure="0.1 MPa", or evenly spaced ones, pressure="0 kPa:200 kPa:21"; design=NAME',
    )
    command.add_argument("--derivatives", action="store_true", help="of each variable by each axis, too")
    command.add_argument("-o", "--out", metavar="FILE", help="default: named after ATLAS, here")
    command.set_defaults(run=_run)


def _run(options):
    from pathlib import Path

    from ..atlas.store import open_atlas
    from ..export.write import FORMATS as WRITERS

    if options.out is None and options.to is None:
        raise ValueError("--to: is missing; choose one of " + ", ".join(FORMATS) + ", or give --out with its suffix")
    out = options.out or Path(options.atlas).with_suffix(WRITERS[options.to][1]).name
    with open_atlas(options.atlas) as atlas:
        atlas.export(out, options.to, options.variable, options.derivatives, **_chosen(options.at))
    print(out)


def _chosen(items):
    """Values of ``--at`` by name; raises ValueError with every fault."""
    import numpy as np

    from ..atlas.schema import PARAMETERS
    from ..description.units import quantity

    faults, chosen = [], {}
    for item in items:
        name, equals, text = item.partition("=")
        if not equals:
            faults.append(f'found {item!r}; give NAME=VALUE, such as pressure="0.1 MPa"')
        elif name not in PARAMETERS:
            chosen[name] = text
        else:
            start, *rest = text.split(":")
            try:
                ends = [quantity(one, PARAMETERS[name].units) for one in (start, *rest[:1])]
                if rest:
                    if len(rest) != 2 or not rest[1].isdecimal() or not 2 <= int(rest[1]) <= MOST:
                        raise ValueError(f"found {text!r}; give START:STOP:COUNT, from 2 to {MOST:,} values")
                    chosen[name] = np.linspace(*ends, int(rest[1]))
                else:
                    chosen[name] = start  # with its unit, in which faults are told
            except ValueError as error:
                faults.append(f"{name}: {error}")
    if faults:
        raise ValueError("\n".join(["cannot read --at:", *(f"  - {fault}" for fault in faults)]))
    return chosen
