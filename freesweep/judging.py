"""The commands that judge: verify. They parse and call."""


def add_judging(commands):
    """Add the commands of this module to the command line."""
    verify = commands.add_parser(
        "verify", help="whether an atlas is what was written, to the last bit, and holds its bounds"
    )
    verify.add_argument("atlas")
    verify.add_argument(
        "--resolve",
        type=int,
        metavar="N",
        help="solve N of its points anew by a second method, and hold them against their bounds",
    )
    verify.add_argument("--seed", type=int, default=0, help="of the points drawn (default 0)")
    verify.set_defaults(run=_run_verify)


def _run_verify(options):
    from .atlas.store import AtlasError, open_atlas
    from .verify import faults

    if options.resolve is not None and options.resolve < 1:
        raise ValueError(f"--resolve: found {options.resolve}; give 1 or more")
    if found := faults(options.atlas):
        raise AtlasError(f"{options.atlas} fails:\n" + "\n".join(f"  - {fault}" for fault in found))
    print(
        f"{options.atlas}: whole; every bit is the one that was written, and the grid is what its specification asks for"
    )
    if options.resolve is not None:
        with open_atlas(options.atlas) as atlas:
            _resolve(atlas, options)


def _resolve(atlas, options):
    from .atlas.store import AtlasError
    from .resolve import resolve, table

    comparisons, notes = resolve(atlas.data, options.resolve, options.seed)
    print("solved anew by quadrature of the first integral, which shares nothing with the finite-difference solver:\n")
    print(table(comparisons), *notes, sep="\n")
    if broken := sum(int(compared.broken.sum()) for compared in comparisons):
        raise AtlasError(f"{broken:,} stored numbers lie farther from the second method's than both errors allow")
