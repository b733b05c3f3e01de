"""The command `freesweep calibrate`: parses and calls."""

from .single import CONSTANTS, add_rubber, read_options, read_rubber

NUMBERS = ("alpha", "beta", "length", "radius", "wall", "fiber_extension", "fiber_radius")  # of an actuator


def add_calibrate(commands):
    """Add the command to the command line."""
    command = commands.add_parser(
        "calibrate",
        help="material constants and fiber extension from measured curves",
        description="Fits material constants and fiber extension to measured curves of length, rotation, force or torque."
        " Each CSV file begins with a line of names and units, such as 'pressure [psi],deformed_length [mm]'; columns:"
        " pressure, deformed_length, rotation, mid_radius, force, torque, their standard uncertainties as force_sigma, and"
        " whatever describes the actuator, unless it is given as an option.",
    )
    command.add_argument("files", nargs="+", metavar="FILE.csv", help="measured curves, of one or more actuators")
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
        help="what to fit (default: all: c10 c01, or c1 c2 c3 of a Yeoh rubber, and fiber_extension)",
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
    command.add_argument("-o", "--out", metavar="FILE.nc", help="keep parameters, covariance and curves as netCDF4")
    command.set_defaults(run=_run)


def _run(options):
    from ..actuator import ActuatorError
    from ..atlas.files import write_whole
    from ..calibration.csv_file import FIRST_GUESS, read_measurements
    from ..calibration.fit import calibrate
    from ..calibration.report import table, to_dataset
    from ..elastomer import Yeoh

    faults = []
    values = read_options(options, NUMBERS, faults)
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
    found = calibrate(measurements, options.fit, own_extension=options.own_extension)
    print(table(found))
    if options.out:
        write_whole(options.out, to_dataset(found).to_netcdf(engine="netcdf4"))
        print(options.out)


def _any_rubber(options):
    return any(getattr(options, name) is not None for name in ("material", *CONSTANTS))
