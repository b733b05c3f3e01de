"""The command explore: an atlas in the browser, or as one page to send around."""


def add_explore(commands):
    """Add the command of this module to the command line."""
    command = commands.add_parser(
        "explore",
        help="an atlas in the browser: maps, pinned designs, wishes",
        description="Serves the explorer of an atlas on this machine alone and opens it in the browser, until Ctrl-C;"
        " or writes it as one page that needs no server. Needs the extra explore: pip install 'freesweep[explore]'.",
    )
    command.add_argument("atlas")
    command.add_argument("--html", metavar="FILE.html", help="write one page with a smaller table inside, and stop")
    command.add_argument("--port", type=int, default=0, metavar="N", help="of 127.0.0.1 (default: any free one)")
    command.add_argument("--no-browser", action="store_true", help="print the address only")
    command.add_argument("--quiet", action="store_true", help="no progress bar while the page is made")
    command.set_defaults(run=_run)


def _run(options):
    from ..atlas.store import open_atlas
    from ..explorer.notebook import check_bokeh, explore

    if not 0 <= options.port <= 65535:
        raise ValueError(f"--port: found {options.port}; give 0 to 65535")
    if options.html and not options.html.lower().endswith((".html", ".htm")):
        raise ValueError(f"--html: found {options.html!r}; the suffix must be .html")
    try:
        check_bokeh()
    except ImportError as error:
        raise ValueError(str(error)) from error
    with open_atlas(options.atlas) as atlas:
        if options.html:
            print(explore(atlas, options.html, progress=not options.quiet))
            return
        with explore(atlas, port=options.port) as explorer:
            print(f"{explorer.url} (Ctrl-C ends it)", flush=True)
            if not options.no_browser:
                import webbrowser

                webbrowser.open(explorer.url)
            explorer.wait()
