"""The commands that judge: verify. They parse and call."""


def add_judging(commands):
    """Add the commands of this module to the command line."""
    verify = commands.add_parser("verify", help="whether an atlas is what was written, to the last bit")
    verify.add_argument("atlas")
    verify.set_defaults(run=_run_verify)


def _run_verify(options):
    from .atlas.store import AtlasError
    from .verify import faults

    if found := faults(options.atlas):
        raise AtlasError(f"{options.atlas} fails:\n" + "\n".join(f"  - {fault}" for fault in found))
    print(
        f"{options.atlas}: whole; every bit is the one that was written, and the grid is what its specification asks for"
    )
