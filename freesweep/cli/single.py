"""The commands for one actuator: lock, inflate, block. They parse and call; a table goes to the screen."""

import sys

from ..description.tube_model import DEFAULT, FIBER_PLACES, FIBERS, MODELS, WALL_MODELS
from .shell import ends_in

CONSTANTS = ("c10", "c01", "c20", "c30")
ALONG = ("alpha", "beta", "radius", "wall")  # what may vary along the tube


def add_single(commands):
    """Add the commands of this module to the command line."""
    _keep(add_actuator(commands, "lock", "the locked shape of one actuator", _run_lock, rubber=False))
    inflate = add_actuator(commands, "inflate", "one actuator under pressure, force and torque", _run_inflate)
    add_loads(inflate, required=True)
    _keep(inflate)
    block = add_actuator(commands, "block", "the force or torque that holds the length or the rotation", _run_block)
    _add_pressures(block, required=True)
    block.add_argument("--hold", choices=("length", "rotation"), required=True, help="what is held; the other is free")
    block.add_argument("--at", metavar="VALUE", help="held length or rotation (default: the undeformed one)")
    block.add_argument("--force", default=0.0, metavar="F", help="axial force while the rotation is held (default 0)")
    block.add_argument("--torque", default=0.0, metavar="M", help="torque while the length is held (default 0)")
    block.add_argument("--buckled", action="store_true", help="the state beside the unstable cylinder (rotation held)")
    _keep(block)


def add_loads(command, required):
    """Options for pressure, force and torque."""
    _add_pressures(command, required)
    command.add_argument("--force", default=0.0, metavar="F", help="axial force, positive in tension (default 0)")
    command.add_argument("--torque", default=0.0, metavar="M", help="torque toward growing rotation (default 0)")


def _add_pressures(command, required):
    command.add_argument(
        "--pressure", required=required, nargs="+", metavar="P", help='"0.1 MPa", several, or START STOP --steps N'
    )
    command.add_argument("--steps", type=int, metavar="N", help="that many pressures from the first to the last given")


def add_actuator(commands, name, text, run, rubber=True):
    """A command whose options describe one actuator; ``rubber``: its constants have to be given."""
    command = commands.add_parser(name, help=text)
    for angle in ("alpha", "beta"):
        command.add_argument(
            f"--{angle}",
            required=True,
            metavar="A",
            help="fiber angle from the axis, 'none' without such a family, or 'geodesic 30 deg' of a body",
        )
    profile = ", or along x/l as '0:8mm,1:5mm' ('smooth 0:...': a spline)"
    for size, more in (("length", ""), ("radius", profile), ("wall", ", or 'constant volume 1.5 mm' of a body")):
        command.add_argument(
            f"--{size}", required=True, metavar="L", help=f"undeformed {size}, such as '4.76 mm'{more}"
        )
    command.add_argument("--taper", default=0.0, metavar="T", help="share by which the far end is slimmer (default 0)")
    command.add_argument("--bulge", default=0.0, metavar="B", help="share by which the middle is wider (default 0)")
    add_rubber(command, "" if rubber else "; the locked shape needs none")
    command.add_argument("--fiber-extension", default=1.0, metavar="G", help="stretch of the fibers, 1 or more")
    command.add_argument(
        "--model", choices=tuple(MODELS), default=DEFAULT,
        help=f"physical: thick wall, loose fibers at the outer radius; source: what the source computes (default {DEFAULT})",
    )  # fmt: skip
    command.add_argument(
        "--fiber-radius", metavar="L", help=f"where the fibers lie: a radius, or one of {', '.join(FIBER_PLACES)}"
    )
    command.add_argument("--wall-model", choices=WALL_MODELS, help="if not as the model has it")
    command.add_argument("--fibers", choices=FIBERS, help="if not as the model has it")
    command.add_argument(
        "--energy", choices=("full", "principal"), default="full", help="principal: Eq. 2.5 as printed"
    )
    command.set_defaults(run=run, rubber=rubber)
    return command


def add_rubber(command, remark=""):
    """Options for a rubber: a name of the library, or constants."""
    command.add_argument("--material", metavar="NAME", help=f"a rubber of the library, such as dragon-skin-30{remark}")
    command.add_argument("--c10", "--c1", metavar="C", help=f"first constant, Mooney-Rivlin or Yeoh{remark}")
    command.add_argument("--c01", metavar="C", help="second Mooney-Rivlin constant (default 0)")
    command.add_argument("--c20", "--c2", metavar="C", help="second Yeoh constant (default 0)")
    command.add_argument("--c30", "--c3", metavar="C", help="third Yeoh constant (default 0)")


def _keep(command):
    command.add_argument("--json", action="store_true", help="print the table as JSON")
    command.add_argument(
        "-o", "--out", type=ends_in(".nc", ".csv"), metavar="FILE",
        help="keep everything, profiles too, as netCDF4 (.nc), or a row for each state (.csv)",
    )  # fmt: skip


def tube_of(options):
    """The actuator that the options describe; every quantity that cannot be read is named in one ValueError."""
    from ..description.actuator import Actuator

    faults = []
    names = ("alpha", "beta", "length", "radius", "wall", "taper", "bulge", "fiber_extension", "fiber_radius")
    is_word = options.fiber_radius in FIBER_PLACES
    along = {name: found for name in ALONG if (found := _along(name, getattr(options, name), faults)) is not None}
    plain = [name for name in (names[:-1] if is_word else names) if name not in along]
    values = along | read_options(options, plain, faults)
    words = {name: getattr(options, name) for name in ("model", "wall_model", "fibers", "energy")}
    if is_word:
        words["fiber_radius"] = options.fiber_radius
    any_rubber = () if options.rubber else ("100 kPa",)
    material = read_rubber(options, faults, *any_rubber)
    if faults:
        raise ValueError("\n".join(["cannot read this actuator:", *(f"  - {fault}" for fault in faults)]))
    return Actuator(**values, **words, material=material)


def _along(name, text, faults):
    """What a text says that varies along the tube: pairs "0:8mm,1:5mm", smooth if that is said before, a rule or that there
    is no such family as it is given; None of a number. Faults are noted.
    """
    from ..atlas.schema import PARAMETERS
    from ..description.along import Profile, rule_of
    from ..description.families import FAMILIES, is_none
    from ..description.units import quantity

    if rule_of(name, text) or (name in FAMILIES and is_none(text)):
        return text
    if ":" not in text:
        return None
    word, _, rest = text.strip().partition(" ")
    smooth = word == "smooth"
    pairs = []
    for pair in (rest if smooth else text).split(","):
        place, _, value = pair.partition(":")
        try:
            pairs.append((quantity(place.strip(), "1"), quantity(value.strip(), PARAMETERS[name].units)))
        except ValueError as error:
            faults.append(f"--{name}: {pair.strip()!r}: {error}")
    return Profile(tuple(pairs), smooth=True) if smooth else tuple(pairs)


def read_options(options, names, faults) -> dict:
    """Numbers of the options that are given, by name, in SI units and degrees; faults are noted."""
    from ..atlas.schema import PARAMETERS
    from ..description.units import quantity

    values = {}
    for name in (name for name in names if getattr(options, name) is not None):
        try:
            values[name] = quantity(getattr(options, name), PARAMETERS[name].units)
        except ValueError as error:
            faults.append(f"--{name.replace('_', '-')}: {error}")
    return values


def read_rubber(options, faults, *default):
    """The rubber of the options of ``add_rubber``, or of a ``default`` c10; None after noting faults."""
    from ..description.elastomer import rubber_of
    from ..description.faults import ActuatorError
    from ..description.material_library import material
    from ..description.units import quantity

    before = len(faults)
    given = [name for name in CONSTANTS if getattr(options, name) is not None]
    values = read_options(options, given, faults)
    if options.material is not None and given:
        faults.append(f"--material: --{given[0]} is given too; give a name or constants")
    elif "c01" in given and {"c20", "c30"} & set(given):
        faults.append("--c01: a Yeoh rubber, with --c20 or --c30, has none; remove one of the two")
    elif options.material is None and "c10" not in given and not default:
        faults.append("--c10: is missing; give the constants of the rubber, or its name, --material")
    if len(faults) > before:
        return None
    try:
        if options.material is not None:
            return material(options.material)
        c10 = values["c10"] if "c10" in values else quantity(*default, "Pa")
        return rubber_of(c10, *(values.get(name, 0.0) for name in CONSTANTS[1:]))
    except ActuatorError as error:
        faults += error.faults
        return None


def _run_lock(options):
    from ..statics import lock

    dataset = lock(tube_of(options))
    if options.c10 is None and options.material is None:
        dataset = dataset.drop_vars(["strain_energy", "strain_energy_error"])
    _show(dataset, options)


def quantities(faults, **texts):
    """Texts as numbers by option name: ``name=(texts, unit)``; what cannot be read goes to ``faults``."""
    from ..description.units import quantity

    numbers = {}
    for name, (given, unit) in texts.items():
        for text in given:
            try:
                numbers.setdefault(name, []).append(quantity(text, unit))
            except ValueError as error:
                apart = f'; as one word: "{before} {text}"' if (before := _number_before(given, text)) else ""
                faults.append(f"--{name}: {error}{apart}")
    if faults:
        raise ValueError("\n".join(["cannot read this load:", *(f"  - {fault}" for fault in faults)]))
    return numbers


def _number_before(given, text):
    """The number before a unit that stands alone among texts, "" where that is not what is wrong."""
    from ..description.units import known_units

    k = given.index(text)
    alone = k > 0 and any(text in known_units(kind) for kind in ("Pa", "N", "N m", "m", "degree"))
    return given[k - 1] if alone else ""


def _run_inflate(options):
    _show(inflated(options), options)


def inflated(options):
    """The Dataset of :func:`freesweep.inflate` that the options of ``add_actuator`` and ``add_loads`` ask for."""
    from ..statics import inflate

    tube = tube_of(options)
    loads = quantities(
        [], pressure=(options.pressure, "Pa"), force=([options.force], "N"), torque=([options.torque], "N m")
    )
    return inflate(tube, _pressures(loads["pressure"], options.steps), loads["force"][0], loads["torque"][0])


def _pressures(given, steps):
    """A number or an array [Pa]: those that are given, or ``steps`` from the first to the last of two."""
    import numpy as np

    if steps is not None:
        if len(given) != 2 or not 2 <= steps <= 100_000:
            raise ValueError("--steps: give two pressures, first and last, and 2 to 100000 steps between them")
        return np.linspace(*given, steps)
    return given[0] if len(given) == 1 else np.array(given)


def _run_block(options):
    from ..holding import blocked_force, blocked_torque

    tube = tube_of(options)
    length = options.hold == "length"
    unused = "force" if length else "torque"
    if getattr(options, unused) != 0.0:
        raise ValueError(
            f"--{unused}: it is what holds the {options.hold}, so it cannot be given. With length and rotation both held,"
            " force and torque are not separately determined"
        )
    if length and options.buckled:
        raise ValueError("--buckled: only a held rotation has a straight state to buckle from")
    given = quantities(
        [], pressure=(options.pressure, "Pa"), force=([options.force], "N"), torque=([options.torque], "N m"),
        at=([options.at] if options.at is not None else [], "m" if length else "degree"),
    )  # fmt: skip
    pressure = _pressures(given["pressure"], options.steps)
    at = given.get("at", [None if length else 0.0])[0]
    if length:
        _show(blocked_force(tube, pressure, at, given["torque"][0]), options)
    else:
        _show(blocked_torque(tube, pressure, at, given["force"][0], buckled=options.buckled), options)


def asked_in_units(options):
    """What was given in units, and the unit in which that is kept."""
    given = vars(options)
    for names, kept in (("length radius wall", "m"), ("alpha beta", "degree"), ("force", "N"), ("torque", "N m")):
        yield from ((given[name], kept) for name in names.split() if given.get(name) is not None)
    yield from ((text, "Pa") for text in given.get("pressure") or ())
    if given.get("at") is not None:
        yield given["at"], "m" if options.hold == "length" else "degree"


def _show(dataset, options):
    from ..atlas.files import write_whole
    from ..report import shown_in, table
    from .as_json import of_states, tell_kept
    from .query import as_csv

    if options.out:  # first: who reads the table may not wait for its end
        if options.out.lower().endswith(".csv"):
            write_whole(options.out, f"{as_csv(dataset.drop_dims('x'))}\n".encode())
        else:
            write_whole(options.out, dataset.to_netcdf(engine="netcdf4"))
    print(of_states(dataset) if options.json else table(dataset, shown_in(asked_in_units(options))))
    if note := dataset.attrs.get("thin_wall_note"):
        print(f"freesweep: note: {note}", file=sys.stderr)
    if options.out:
        tell_kept(options.out, options.json)
