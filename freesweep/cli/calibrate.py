"""The command `freesweep calibrate`: parses and calls."""

from ..description.tube_model import FIBER_PLACES, FIBERS, MODELS, WALL_MODELS
from .shell import ends_in
from .single import CONSTANTS, add_rubber, read_options, read_rubber

NUMBERS = ("alpha", "beta", "length", "radius", "wall", "fiber_extension", "fiber_radius")  # of an actuator
WORDS = ("model", "wall_model", "fibers")


def add_calibrate(commands):
    """Add the command to the command line."""
    command = commands.add_parser(
        "calibrate",
        help="rubber, angle, fiber extension and other scalars of an actuator from measured curves",
        description="Fits any scalar of an actuator to measured curves of length, rotation, force or torque."
        " Each CSV file has a line of names and units, such as 'pressure [psi],contraction [%]'; columns:"
        " pressure, deformed_length (or contraction, stroke), rotation, mid_radius, force, torque, their standard"
        " uncertainties as force_sigma, branch, and whatever describes the actuator, unless it is given as an option."
        " A file FILE.toml holds all of that, with the options, and is given alone.",
    )
    command.add_argument("files", nargs="+", metavar="FILE", help="measured curves (.csv), or one calibration (.toml)")
    for name in NUMBERS:
        command.add_argument(
            f"--{name.replace('_', '-')}", metavar="VALUE", help="of all actuators without such a column"
        )
    add_rubber(command, "; here a first guess, or the value of what is not fitted")
    command.add_argument(
        "--fit",
        nargs="+",
        action="extend",
        metavar="NAME",
        help="what to fit: c10 c01, or c1 c2 c3 of a Yeoh rubber, fiber_extension alpha beta length radius wall fiber_radius"
        " dead_length threshold_pressure (default: the rubber and fiber_extension)",
    )
    for name, example, text in (
        ("prior", "alpha=30,1", "known before: value, standard uncertainty; such a parameter is fitted"),
        ("bounds", "'wall=1 mm,2 mm'", "where it is searched"),
        ("tie", "c01=0.5*c10", "a parameter that follows another"),
    ):
        command.add_argument(
            f"--{name}", nargs="+", action="extend", default=[], metavar="NAME=...", help=f"{text}, as {example}"
        )
    command.add_argument(
        "--measured",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME",
        help="which columns were measured, in files that have them; the bench imposed the others",
    )
    command.add_argument(
        "--own-extension", action="store_true", help="a fiber extension for each actuator instead of one for all"
    )
    command.add_argument(
        "--energy", choices=("full", "principal"), default="full", help="principal: Eq. 2.5 as printed"
    )
    for name, choices in (("model", MODELS), ("wall-model", WALL_MODELS), ("fibers", FIBERS)):
        command.add_argument(f"--{name}", choices=tuple(choices), help="of all actuators, as in freesweep inflate")
    command.add_argument(
        "-o", "--out", type=ends_in(".nc"), metavar="FILE.nc", help="keep parameters, covariance and curves as netCDF4"
    )
    command.add_argument(
        "--report", metavar="FILE", help="a page to send around (.html), or its picture (.png, .svg, .pdf)"
    )
    command.add_argument("--json", action="store_true", help="print what was found as JSON")
    command.set_defaults(run=_run)


def _run(options):
    from pathlib import Path

    from ..atlas.files import write_whole
    from ..calibration.case_file import read_case, units_asked
    from ..calibration.csv_file import units_of_files
    from ..calibration.fit import calibrate
    from ..calibration.report import shown_as, table, to_dataset
    from ..plot.suffixes import SUFFIXES
    from .as_json import of_calibration, tell_kept
    from .single import asked_in_units

    faults = []
    asked = {"fit": options.fit, "own_extension": options.own_extension}
    if options.report and Path(options.report).suffix.lower() not in (".html", *SUFFIXES):
        raise ValueError(f"--report: found {options.report!r}; give FILE.html, or FILE{', FILE'.join(SUFFIXES)}")
    if any(str(name).endswith(".toml") for name in options.files):
        if len(options.files) > 1:
            raise ValueError("a calibration as TOML names its data; give it alone")
        measurements, asked = read_case(options.files[0])
        shown = shown_as(units_asked(options.files[0]))
    else:
        measurements = _measurements(options, asked, faults)
        shown = shown_as([*units_of_files(map(Path, options.files)), *asked_in_units(options)])
    found = calibrate(measurements, **asked)
    if options.out:
        write_whole(options.out, to_dataset(found).to_netcdf(engine="netcdf4"))
    if options.report:
        if options.report.lower().endswith(".html"):
            from ..calibration.page import page

            write_whole(options.report, page(found, shown).encode())
        else:
            from ..calibration.picture import picture
            from ..plot.style import save

            save(picture(found, shown), options.report)
    print(of_calibration(found) if options.json else table(found, shown))
    for kept in filter(None, (options.out, options.report)):
        tell_kept(kept, options.json)


def _measurements(options, asked, faults):
    """The measurements of CSV files and options; puts priors, bounds and ties into what is ``asked``."""
    from ..calibration.csv_file import FIRST_GUESS, read_measurements
    from ..description.actuator import ActuatorError
    from ..description.elastomer import Yeoh

    is_word = options.fiber_radius in FIBER_PLACES
    values = read_options(options, NUMBERS[:-1] if is_word else NUMBERS, faults)
    values |= {"fiber_radius": options.fiber_radius} if is_word else {}
    values |= {name: getattr(options, name) for name in WORDS if getattr(options, name) is not None}
    for key, option in (("priors", "prior"), ("bounds", "bounds"), ("ties", "tie")):
        pairs = [text.partition("=") for text in getattr(options, option)]
        faults += [f"--{option}: found {text[0]!r}; write NAME=..." for text in pairs if not text[2]]
        asked[key] = {
            name.strip(): value.strip() if key == "ties" else [part.strip() for part in value.split(",")]
            for name, _, value in pairs
        }
    material = read_rubber(options, faults, f"{FIRST_GUESS.c10} Pa") if _any_rubber(options) else FIRST_GUESS
    if material is not None and {"c2", "c3"} & set(options.fit or ()) and not isinstance(material, Yeoh):
        material = Yeoh(material.c10)
    if not faults:
        try:
            measurements = read_measurements(
                options.files, measured=options.measured, material=material, energy=options.energy, **values
            )
        except ActuatorError as error:
            faults = error.faults
    if faults:
        raise ValueError("\n".join(["cannot read these measurements:", *(f"  - {fault}" for fault in faults)]))
    return measurements


def _any_rubber(options):
    return any(getattr(options, name) is not None for name in ("material", *CONSTANTS))
