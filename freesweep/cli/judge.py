"""The commands that judge: verify, bench, census. They parse and call."""

from argparse import ArgumentTypeError

from ..description.tube_model import DEFAULT, MODELS

SUBJECTS = ("solver", "query")  # of a bench


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
    verify.add_argument("--json", action="store_true", help="print the comparison as JSON")
    verify.set_defaults(run=_run_verify)
    bench = commands.add_parser(
        "bench", help="how fast this is on this machine, beside its peers, and with which errors"
    )
    bench.add_argument("subject", nargs="?", choices=SUBJECTS, default="solver", help="what is timed (default: solver)")
    bench.add_argument("--quick", action="store_true", help="few designs: a first look in seconds")
    bench.add_argument(
        "--json", nargs="?", const="", type=_kept_as, metavar="FILE",
        help="print all figures as JSON; with FILE the table, and all figures there",
    )  # fmt: skip
    bench.set_defaults(run=_run_bench)
    census = commands.add_parser("census", help="random designs over the whole domain: every one solved, or explained")
    census.add_argument("count", type=int, metavar="N", help="how many designs")
    census.add_argument("--seed", type=int, default=0, help="of the designs drawn (default 0)")
    census.add_argument(
        "--audit", type=int, default=1000, metavar="M", help="states solved again on a finer mesh (default 1000)"
    )
    census.add_argument("--model", choices=tuple(MODELS), default=DEFAULT, help=f"of the tubes (default: {DEFAULT})")
    census.add_argument("--threads", type=int, metavar="N", help="default: one for each core")
    census.add_argument("--quiet", action="store_true", help="no progress bar")
    census.add_argument("--json", action="store_true", help="print all figures as JSON")
    census.set_defaults(run=_run_census)


def _kept_as(text):
    """The word behind --json, unless it was meant to be what is timed."""
    if text in SUBJECTS:
        raise ArgumentTypeError(f"found {text!r}, which is no file; write it before --json")
    return text


def _run_verify(options):
    from ..atlas.store import AtlasError, open_atlas
    from ..verification.verify import faults

    if options.resolve is not None and options.resolve < 1:
        raise ValueError(f"--resolve: found {options.resolve}; give 1 or more")
    if found := faults(options.atlas):
        if options.json:
            from .as_json import of_comparisons

            print(of_comparisons(options.atlas, [], found))
        raise AtlasError(f"{options.atlas} fails:\n" + "\n".join(f"  - {fault}" for fault in found))
    if options.json:
        from .as_json import of_comparisons

        points, comparisons = None, []
        if options.resolve is not None:
            with open_atlas(options.atlas) as atlas:
                points, comparisons, _ = _compared(atlas, options)
        print(of_comparisons(options.atlas, comparisons))
        _refuse(points, comparisons)
        return
    print(
        f"{options.atlas}: whole; every bit is the one that was written, and the grid is what its specification asks for"
    )
    if options.resolve is not None:
        with open_atlas(options.atlas) as atlas:
            _resolve(atlas, options)


def _compared(atlas, options):
    """Points of an atlas solved anew: points, comparisons, notes."""
    from ..verification.cross_check import draw, resolve
    from ..verification.restate import finer

    points = draw(atlas.data, options.resolve, options.seed)
    return points, *(resolve if points.has_first_integral else finer)(points)


def _resolve(atlas, options):
    from ..verification.cross_check import table

    points, comparisons, notes = _compared(atlas, options)
    if points.has_first_integral:
        print(
            "solved anew by quadrature of the first integral, which shares nothing with the finite-difference solver:\n"
        )
    print(*([table(comparisons)] if comparisons else []), *notes, sep="\n")
    _refuse(points, comparisons)
    print("\nbounds hold, and none is far wider than the solver states anew; limit pressures are those that it states")


def _refuse(points, comparisons):
    """Raises if stored numbers are not those of the second method, or what is stated of them not what the solver states."""
    from ..atlas.store import AtlasError
    from ..verification.restate import faults

    if broken := sum(int(compared.broken.sum()) for compared in comparisons):
        raise AtlasError(f"{broken:,} stored numbers lie farther from the second method's than both errors allow")
    if points is not None and (found := faults(points)):
        raise AtlasError("\n  - ".join(["what is stated of its numbers is not what the solver states:", *found]))


def _run_bench(options):
    import json
    import sys

    from ..atlas.files import write_whole

    if options.subject == "query":
        from ..bench.query import measure, table
    else:
        from ..bench.solver import measure
        from ..bench.table import table
    found = measure(options.quick, lambda text: print(f"{text} ...", file=sys.stderr))
    print(json.dumps(found, indent=1) if options.json == "" else table(found))
    if options.json:
        write_whole(options.json, json.dumps(found, indent=1).encode())
        print(options.json)


def _run_census(options):
    import json

    from ..census.run import census

    found = census(
        options.count, options.seed, audit=options.audit, threads=options.threads, progress=not options.quiet,
        model=options.model,
    )  # fmt: skip
    print(json.dumps(found.figures(), indent=1) if options.json else found.report())
