"""The explorer of an atlas from Python: in a notebook, or in the browser beside a script."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..atlas.store import Atlas
from ..description.faults import ActuatorError
from ..description.given import described
from ..description.options import read_switch
from ..description.quantities import Path as PathName

if TYPE_CHECKING:
    from .server import Explorer


def explore(
    atlas: Atlas | PathName, html: PathName | None = None, port: int = 0, progress: bool = True
) -> Explorer | Path:
    """Explore an atlas in the browser; a notebook shows it below the cell.

    Parameters
    ----------
    atlas : an :class:`freesweep.Atlas`, or the path of one
    html : a path: write one file that needs no server, with a smaller table inside, instead of serving
    port : of 127.0.0.1; 0: any free one
    progress : show a bar while a file is made

    Returns the running explorer, whose ``url`` a browser opens and whose ``stop()`` ends it; or the path that was written.
    Needs Bokeh: ``pip install 'freesweep[explore]'``. Raises :class:`freesweep.ActuatorError` for what is no atlas, and
    ImportError.
    """
    check_bokeh()
    faults = []
    progress = read_switch("progress", progress, faults)
    if faults:
        raise ActuatorError(faults)
    if not isinstance(atlas, Atlas):
        from ..atlas.store import open_atlas

        if not hasattr(atlas, "__fspath__") and not isinstance(atlas, str):
            raise ActuatorError([f"atlas: found {described(atlas)}; give what freesweep.open_atlas opens, or its path"])
        atlas = open_atlas(atlas)
    if html is None:
        from .server import Explorer

        return Explorer(atlas, port).start()

    from ..atlas.files import write_whole
    from ..sweep.jobs import bar
    from .desk import Desk
    from .page import page_of
    from .table import small_table, steps

    desk = Desk(atlas)
    with bar(steps(desk) + 1, 0, " steps", progress) as shown:
        content = page_of(desk, small_table(desk, shown.update)).encode()
        shown.update()
    write_whole(html, content)
    return Path(html)


def check_bokeh():
    """Raises ImportError with the remedy where Bokeh is missing."""
    try:
        import bokeh  # noqa: F401
    except ImportError as error:
        raise ImportError(
            "the explorer draws with Bokeh, which is not here: pip install 'freesweep[explore]'"
        ) from error
