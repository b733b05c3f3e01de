"""The shell: parses, calls, prints. Quantities carry units ("4.76 mm", "15 psi", "30 deg"); plain numbers are SI, degrees.

Exit codes: 0 done, 2 bad input, 3 the environment (disk, memory, permissions), 130 interrupted.
"""

import argparse
import contextlib
import sys

from .calibrate import add_calibrate
from .design import add_design
from .draw import Map, add_plot, check_map
from .explore import add_explore
from .export import add_export
from .interrupt import INTERRUPTED, SENTENCE, ends_in_time
from .judge import add_judging
from .query import add_query
from .shell import SHELLS, Completion, Parser
from .single import add_single
from .thesis import add_thesis

DONE, BAD_INPUT, ENVIRONMENT = 0, 2, 3


def main(arguments=None) -> int:
    """Run one command; returns the exit code."""
    import warnings

    warnings.showwarning = lambda message, *_: print(f"freesweep: warning: {message}", file=sys.stderr)
    options = parser().parse_args(_joined(sys.argv[1:] if arguments is None else arguments))
    try:
        with ends_in_time():
            return options.run(options) or DONE
    except KeyboardInterrupt:
        _say(SENTENCE)
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except MemoryError as error:
        short = "not enough memory; close other programs, use fewer --threads, or split the sweep"
        _say(f"freesweep: {str(error) or short}")
        return ENVIRONMENT
    except ValueError as error:
        _say(f"freesweep: {error}")
        return BAD_INPUT
    except OSError as error:
        from ..atlas.files import is_of_environment

        named = error.filename is not None and error.strerror  # without the number and quotes of the system
        _say(f"freesweep: {error.filename}: {error.strerror}" if named else f"freesweep: {error}")
        return ENVIRONMENT if is_of_environment(error) else BAD_INPUT
    except RuntimeError as error:
        if not str(error).startswith("NetCDF: "):  # of a number that is read when it is used
            raise
        _say(
            f"freesweep: a file could not be read to its end ({error}); freesweep verify FILE says whether it is damaged"
        )
        return ENVIRONMENT


def _say(text):
    """On standard error, if anybody is there: a terminal may be gone."""
    with contextlib.suppress(OSError):
        print(text, file=sys.stderr, flush=True)


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
    top = Parser(
        prog="freesweep",
        description="Statics of fiber-reinforced soft actuators: solve one, sweep a design space, draw it.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="print the version")
    top.add_argument(
        "--print-completion",
        action=Completion,
        choices=SHELLS,
        metavar="SHELL",
        help=f"a script for {', '.join(SHELLS)}",
    )
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    _sweep(commands)
    add_plot(commands)
    _info(commands)
    add_query(commands)
    add_export(commands)
    add_single(commands)
    add_judging(commands)
    add_calibrate(commands)
    add_design(commands)
    add_explore(commands)
    add_thesis(commands)
    return top


class _Version(argparse.Action):
    def __call__(self, parser, *_):
        from .. import __version__

        print(f"freesweep {__version__}")
        parser.exit()


def _sweep(commands):
    command = commands.add_parser("sweep", help="solve a grid of designs into an atlas")
    command.add_argument("spec", nargs="?", help="TOML specification, such as sweeps/quick.toml")
    command.add_argument(
        "--example", metavar="NAME", help="instead of SPEC: one that comes with freesweep, such as quick"
    )
    command.add_argument("-o", "--out", metavar="FILE.nc", help="the atlas to make (default: named after SPEC, here)")
    command.add_argument("--map", metavar="FILE", help="draw the design-space map too (.png, .svg, .pdf)")
    command.add_argument("--threads", type=int, metavar="N", help="default: one for each core")
    command.add_argument(
        "--dask",
        nargs="?",
        const="",
        type=_address,
        metavar="ADDRESS",
        help="solve on the workers of the Dask scheduler there (tcp://host:8786); without ADDRESS on processes here",
    )
    command.add_argument("--overwrite", action="store_true", help="replace an atlas of another specification")
    command.add_argument("--dry-run", action="store_true", help="say what would be solved, and stop")
    command.add_argument("--quiet", action="store_true", help="no progress bar, no summary")
    command.set_defaults(run=_run_sweep)


def _address(text):
    """The word behind --dask, unless it was meant to be the specification."""
    if text.endswith(".toml"):
        raise argparse.ArgumentTypeError(f"found {text!r}, which is no address; write SPEC before --dask")
    return text


def _run_sweep(options):
    from pathlib import Path

    from ..sweep.atlas_name import named_otherwise
    from ..sweep.spec import read_file

    if (options.spec is None) == (options.example is None):
        raise ValueError("give SPEC, the path of a TOML specification, or --example NAME, such as quick")
    if options.example is not None:
        from ..example import specification

        options.spec = str(specification(options.example))
    sweep = read_file(options.spec)
    out = Path(options.out or Path(options.spec).with_suffix(".nc").name)
    if options.threads is not None and options.threads < 1:
        raise ValueError(f"--threads: found {options.threads}; give 1 or more")
    if out.exists() and out.samefile(options.spec):
        raise ValueError(f"--out: {out} is the specification itself; give the name of the atlas to make")
    if faults := named_otherwise(out):
        raise ValueError(*faults)
    if options.map:
        check_map(sweep, options.map)
    if options.dry_run:
        from ..description.unit_warnings import warn_of
        from ..sweep.estimate import dry_run
        from ..sweep.unit_doubts import doubts_of

        warn_of(doubts_of(sweep), stacklevel=1)
        print(dry_run(sweep, out, options.threads))
        return
    from ..sweep.run import run

    with _executor(options) as executor:
        drawn = Map(options.map) if options.map else None
        modules = drawn.modules if drawn else ()
        atlas = run(sweep, out, options.threads, executor, not options.quiet, options.overwrite, 2, modules, drawn)
    if drawn:
        drawn.save(atlas.data)


def _executor(options):
    """What solves instead of threads, as a context manager."""
    if options.dask is None:
        return contextlib.nullcontext()
    from ..sweep.cluster import executor_of
    from ..sweep.estimate import cores

    return executor_of(options.dask, options.threads or cores(), lambda text: options.quiet or print(text))


def _info(commands):
    command = commands.add_parser("info", help="what an atlas holds and where it comes from")
    command.add_argument("atlas")
    command.add_argument("--specification", action="store_true", help="print the specification it was made from")
    command.add_argument("--json", action="store_true", help="print it as JSON")
    command.set_defaults(run=_run_info)


def _run_info(options):
    import warnings

    from ..atlas.store import UnsealedWarning, describe, open_atlas

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnsealedWarning)  # one of the lines says so
        atlas = open_atlas(options.atlas)
    with atlas:
        if options.json:
            from .as_json import of_atlas

            print(of_atlas(atlas))
        else:
            print(atlas.data.attrs.get("specification", "") if options.specification else describe(atlas))
