"""The shell: parses, calls, prints. Quantities carry units ("4.76 mm", "15 psi", "30 deg"); plain numbers are SI, degrees.

Exit codes: 0 done, 2 bad input, 3 the environment (disk, memory, permissions), 130 interrupted.
"""

import argparse
import sys

DONE, BAD_INPUT, ENVIRONMENT, INTERRUPTED = 0, 2, 3, 130


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    import warnings

    warnings.showwarning = lambda message, *_: print(f"freesweep: warning: {message}", file=sys.stderr)
    options = parser().parse_args(_joined(sys.argv[1:] if arguments is None else arguments))
    try:
        return options.run(options) or DONE
    except KeyboardInterrupt:
        print("interrupted; what was finished is kept, the same command goes on from there", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except (MemoryError, PermissionError) as error:
        print(f"freesweep: {error or 'not enough memory'}", file=sys.stderr)
        return ENVIRONMENT
    except (ValueError, OSError) as error:
        from .atlas.files import EnvironmentFault

        print(f"freesweep: {error}", file=sys.stderr)
        return ENVIRONMENT if isinstance(error, EnvironmentFault) else BAD_INPUT


def _joined(words):
    """Let "--beta -30deg" through: argparse takes it for an option."""
    joined = []
    for word in words:
        negative = len(word) > 1 and word[0] == "-" and (word[1].isdigit() or word[1] == ".")
        if negative and joined and joined[-1].startswith("--") and "=" not in joined[-1]:
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = argparse.ArgumentParser(
        prog="freesweep",
        description="Statics of fiber-reinforced soft actuators: solve one, sweep a design space, draw it.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    _sweep(commands)
    _plot(commands)
    _info(commands)
    _one(commands, "lock", "the locked shape of one actuator", _run_lock)
    inflate = _one(commands, "inflate", "one actuator under pressure, force and torque", _run_inflate)
    inflate.add_argument(
        "--pressure", required=True, nargs="+", metavar="P", help='"0.1 MPa", several, or START STOP --steps N'
    )
    inflate.add_argument("--steps", type=int, metavar="N", help="that many pressures from the first to the last given")
    inflate.add_argument("--force", default=0.0, metavar="F", help="axial force, positive in tension (default 0)")
    inflate.add_argument("--torque", default=0.0, metavar="M", help="torque toward growing rotation (default 0)")
    block = _one(commands, "block", "the force or torque that holds the length or the rotation", _run_block)
    block.add_argument("--pressure", required=True, nargs="+", metavar="P", help='"0.1 MPa", or several')
    block.add_argument("--hold", choices=("length", "rotation"), required=True, help="what is held; the other is free")
    block.add_argument("--at", metavar="VALUE", help="held length or rotation (default: the undeformed one)")
    block.add_argument("--force", default=0.0, metavar="F", help="axial force while the rotation is held (default 0)")
    block.add_argument("--torque", default=0.0, metavar="M", help="torque while the length is held (default 0)")
    block.add_argument("--buckled", action="store_true", help="the state beside the unstable cylinder (rotation held)")
    return top


class _Version(argparse.Action):
    def __call__(self, parser, *_):
        from . import __version__

        print(f"freesweep {__version__}")
        parser.exit()


def _sweep(commands):
    command = commands.add_parser("sweep", help="solve a grid of designs into an atlas")
    command.add_argument("spec", help="TOML specification, such as sweeps/quick.toml")
    command.add_argument("-o", "--out", metavar="FILE.nc", help="the atlas to make (default: named after SPEC, here)")
    command.add_argument("--map", metavar="FILE", help="draw the design-space map too (.png, .svg, .pdf)")
    command.add_argument("--threads", type=int, metavar="N", help="default: one for each core")
    command.add_argument("--overwrite", action="store_true", help="replace an atlas of another specification")
    command.add_argument("--dry-run", action="store_true", help="say what would be solved, and stop")
    command.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    command.set_defaults(run=_run_sweep)


def _run_sweep(options):
    from pathlib import Path

    from .sweep.spec import read_file

    sweep = read_file(options.spec)
    out = Path(options.out or Path(options.spec).with_suffix(".nc").name)
    if options.threads is not None and options.threads < 1:
        raise ValueError(f"--threads: found {options.threads}; give 1 or more")
    if options.dry_run:
        from .sweep.plan import plan

        planned = plan(sweep)
        print(f"{sweep.title}\n{sweep.points:,} grid points, {planned.equilibria:,} distinct equilibria -> {out}")
        return
    from .sweep.run import run_sweep

    atlas = run_sweep(sweep, out, threads=options.threads, progress=not options.quiet, overwrite=options.overwrite)
    if options.map:
        _draw_map(atlas, options.map, "rotation", {})


def _plot(commands):
    kinds = commands.add_parser("plot", help="draw an atlas").add_subparsers(required=True, metavar="KIND")
    command = kinds.add_parser("map", help="the design space of fiber angles, with one variable as filled contours")
    command.add_argument("atlas", help="an atlas made by freesweep sweep")
    command.add_argument("--variable", default="rotation", help="what to draw (default: rotation)")
    command.add_argument(
        "--at", nargs="+", default=[], metavar="NAME=VALUE", help='where in the other axes, such as pressure="0.1 MPa"'
    )
    command.add_argument("-o", "--out", metavar="FILE", help=".png, .svg or .pdf (default: named after ATLAS, here)")
    command.set_defaults(run=_run_map)


def _run_map(options):
    from pathlib import Path

    from .atlas.schema import PARAMETERS
    from .atlas.store import open_atlas
    from .units import quantity

    select = {}
    for item in options.at:
        name, equals, value = item.partition("=")
        if not equals:
            raise ValueError(f'--at: found {item!r}; give NAME=VALUE, such as pressure="0.1 MPa"')
        select[name] = quantity(value, PARAMETERS[name].units) if name in PARAMETERS else value
    out = options.out or f"{Path(options.atlas).stem}-{options.variable}.png"
    with open_atlas(options.atlas) as atlas:
        _draw_map(atlas, out, options.variable, select)


def _draw_map(atlas, out, variable, select):
    from .plot.map import design_map
    from .plot.style import save

    save(design_map(atlas.data, variable, **select), out)
    print(out)


def _info(commands):
    command = commands.add_parser("info", help="what an atlas holds and where it comes from")
    command.add_argument("atlas")
    command.add_argument("--specification", action="store_true", help="print the specification it was made from")
    command.set_defaults(run=_run_info)


def _run_info(options):
    from .atlas.store import describe, open_atlas

    with open_atlas(options.atlas) as atlas:
        print(atlas.data.attrs.get("specification", "") if options.specification else describe(atlas))


def _one(commands, name, text, run):
    command = commands.add_parser(name, help=text)
    for angle in ("alpha", "beta"):
        command.add_argument(f"--{angle}", required=True, metavar="A", help="fiber angle from the axis")
    for size in ("length", "radius", "wall"):
        command.add_argument(f"--{size}", required=True, metavar="L", help=f"undeformed {size}, such as '4.76 mm'")
    needed = name != "lock"
    without = "" if needed else "; without it no strain energy is given"
    command.add_argument("--c10", required=needed, metavar="C", help=f"Mooney-Rivlin constant{without}")
    command.add_argument("--c01", default="0 MPa", metavar="C", help="Mooney-Rivlin constant")
    command.add_argument("--fiber-extension", default=1.0, metavar="G", help="stretch of the fibers, 1 or more")
    command.add_argument("--fiber-radius", metavar="L", help="where the fibers lie; default: the inner radius")
    command.add_argument(
        "--energy", choices=("full", "principal"), default="full", help="principal: Eq. 2.5 as printed"
    )
    command.add_argument("-o", "--out", metavar="FILE.nc", help="keep everything, profiles too, as netCDF4")
    command.set_defaults(run=run)
    return command


def _tube(options):
    from .actuator import Actuator, MooneyRivlin
    from .atlas.schema import PARAMETERS
    from .units import quantity

    names = ("alpha", "beta", "length", "radius", "wall", "c10", "c01", "fiber_extension", "fiber_radius")
    values, faults = {}, []
    for name in (name for name in names if getattr(options, name) is not None):
        try:
            values[name] = quantity(getattr(options, name), PARAMETERS[name].units)
        except ValueError as error:
            faults.append(f"--{name.replace('_', '-')}: {error}")
    if faults:
        raise ValueError("\n".join(["cannot read this actuator:", *(f"  - {fault}" for fault in faults)]))
    material = MooneyRivlin(values.pop("c10", 1e5), values.pop("c01"))
    return Actuator(**values, material=material, energy=options.energy)


def _run_lock(options):
    from .statics import lock

    dataset = lock(_tube(options))
    if options.c10 is None:
        dataset = dataset.drop_vars(["strain_energy", "strain_energy_error"])
    _show(dataset, options)


def _quantities(faults, **texts):
    """Texts as numbers by option name: ``name=(texts, unit)``; what cannot be read goes to ``faults``."""
    from .units import quantity

    numbers = {}
    for name, (given, unit) in texts.items():
        for text in given:
            try:
                numbers.setdefault(name, []).append(quantity(text, unit))
            except ValueError as error:
                faults.append(f"--{name}: {error}")
    if faults:
        raise ValueError("\n".join(["cannot read this load:", *(f"  - {fault}" for fault in faults)]))
    return numbers


def _run_inflate(options):
    import numpy as np

    from .statics import inflate

    tube = _tube(options)
    loads = _quantities(
        [], pressure=(options.pressure, "Pa"), force=([options.force], "N"), torque=([options.torque], "N m")
    )
    pressure = np.array(loads["pressure"])
    if options.steps is not None:
        if len(pressure) != 2 or not 2 <= options.steps <= 100_000:
            raise ValueError("--steps: give two pressures, first and last, and 2 to 100000 steps between them")
        pressure = np.linspace(*pressure, options.steps)
    pressure = pressure[0] if len(pressure) == 1 else pressure
    _show(inflate(tube, pressure, loads["force"][0], loads["torque"][0]), options)


def _run_block(options):
    import numpy as np

    from .holding import blocked_force, blocked_torque

    tube = _tube(options)
    length = options.hold == "length"
    unused = "force" if length else "torque"
    if getattr(options, unused) != 0.0:
        raise ValueError(
            f"--{unused}: it is what holds the {options.hold}, so it cannot be given. With length and rotation both held,"
            " force and torque are not separately determined"
        )
    if length and options.buckled:
        raise ValueError("--buckled: only a held rotation has a straight state to buckle from")
    given = _quantities(
        [], pressure=(options.pressure, "Pa"), force=([options.force], "N"), torque=([options.torque], "N m"),
        at=([options.at] if options.at is not None else [], "m" if length else "degree"),
    )  # fmt: skip
    pressure = given["pressure"][0] if len(given["pressure"]) == 1 else np.array(given["pressure"])
    at = given.get("at", [None if length else 0.0])[0]
    if length:
        _show(blocked_force(tube, pressure, at, given["torque"][0]), options)
    else:
        _show(blocked_torque(tube, pressure, at, given["force"][0], buckled=options.buckled), options)


def _show(dataset, options):
    from .atlas.files import write_whole
    from .report import table

    print(table(dataset))
    if options.out:
        write_whole(options.out, dataset.to_netcdf(engine="netcdf4"))
        print(options.out)


if __name__ == "__main__":
    sys.exit(main())
