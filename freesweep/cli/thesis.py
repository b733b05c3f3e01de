"""The command ``freesweep thesis``: parses and calls."""


def add_thesis(commands):
    """Add the command of this module to the command line."""
    from .draw import add_resolution

    command = commands.add_parser(
        "thesis", help="every figure and table of the source, recomputed, and its claims checked"
    )
    command.add_argument(
        "figures", nargs="*", metavar="FIGURE", help="such as 2-7, table-1 or claims (default: everything)"
    )
    command.add_argument("-o", "--out", default="thesis", metavar="DIR", help="folder to make (default: thesis, here)")
    command.add_argument("--quiet", action="store_true", help="say nothing but the path of the page")
    add_resolution(command)
    command.set_defaults(run=_run_thesis)


def _run_thesis(options):
    import sys

    from ..thesis.make import make
    from .draw import fineness

    fine = fineness(options)

    def progress(name):
        print(name, file=sys.stderr, flush=True)

    print(make(options.figures, options.out, None if options.quiet else progress, **fine))
