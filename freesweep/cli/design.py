"""The command `freesweep design`: parses and calls."""


def add_design(commands):
    """Add the command to the command line."""
    command = commands.add_parser(
        "design",
        help="the tubes that do what a file of wishes says",
        description="Looks for the tubes that meet the goals and keep the limits of a TOML file, such as those under"
        " sweeps/wishes, and says in one sentence whether there are any.",
    )
    command.add_argument("wishes", metavar="WISH.toml", help="goals, limits and what is free")
    command.add_argument("-o", "--out", metavar="FILE", help="keep the candidates (.csv or .nc)")
    command.add_argument("--picture", metavar="FILE", help="draw them: angles, goal curves, shapes (.png, .svg, .pdf)")
    command.add_argument("--json", action="store_true", help="print the candidates as JSON")
    command.set_defaults(run=_run)


def _run(options):
    from pathlib import Path

    from ..atlas.files import write_whole
    from ..inverse import wish_file
    from ..inverse.designing import find
    from ..inverse.report import csv, lines, table
    from ..plot.suffixes import SUFFIXES
    from ..report import shown_in
    from .as_json import of_candidates, tell_kept

    if options.out and Path(options.out).suffix not in (".csv", ".nc"):
        raise ValueError(f"--out: found {options.out!r}; candidates are kept as .csv or .nc")
    if options.picture and Path(options.picture).suffix.lower() not in SUFFIXES:
        raise ValueError(f"--picture: found {options.picture!r}; the suffix must be one of {', '.join(SUFFIXES)}")
    asked = wish_file.read(options.wishes)
    shown_as = shown_in(wish_file.units_asked(options.wishes))
    found, tubes = find(**asked, shown=shown_as)
    if options.out:  # files first: who reads the table may not wait for its end
        content = csv(found).encode() if options.out.endswith(".csv") else found.to_netcdf(engine="netcdf4")
        write_whole(options.out, content)
    if options.picture:
        from ..inverse.shown import shown
        from ..plot.candidates import draw
        from ..plot.style import save

        save(draw(found, *shown(found, tubes, asked["goals"], asked["limits"])), options.picture)
    if options.json:
        print(of_candidates(found))
    else:
        print(table(found, shown_as))
        print(found.attrs["summary"])
        for note in found.attrs.get("notes", "").splitlines():
            print(f"- {note}")
        if found.attrs.get("prices"):
            print(found.attrs["prices"])
        print(lines(found))
    for kept in filter(None, (options.out, options.picture)):
        tell_kept(kept, options.json)
