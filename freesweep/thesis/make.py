"""Makes the figures, the tables and the page that leads to them."""

import csv
import difflib
import io
from pathlib import Path

from ..atlas.files import write_whole
from ..plot import style
from .claims.table import COLUMNS, judged, rows_of
from .figures import FIGURES, title
from .index import Entry, page
from .muscles import table_1_rows

TABLES = {"table-1": "Table 1", "claims": "claims"}


def names_of(words) -> list[str]:
    """Figures and tables by name, in the order of the source: ``2-7``, ``figure-2-7``, ``table-1``, ``claims``; none: all.

    Raises ValueError that names every unknown one.
    """
    known = [*FIGURES, *TABLES]
    plain = [word.lower().removeprefix("figure-").removeprefix("figure ").replace(".", "-") for word in words]
    wrong = [word for word, name in zip(words, plain) if name not in known]
    if wrong:
        near = {word: difflib.get_close_matches(word, known, n=1) for word in wrong}
        hints = [f"{word!r}" + (f" (did you mean {near[word][0]}?)" if near[word] else "") for word in wrong]
        raise ValueError(f"no figure {', '.join(hints)}; there are {', '.join(known)}")
    return [name for name in known if name in plain or not plain]


def make(names=(), out="thesis", progress=None, resolution=style.RESOLUTION) -> Path:
    """Makes some figures of the source (default: all) in the folder ``out``, and returns the path of their page.

    Each figure becomes PNG, SVG and CSV; ``claims`` is the table of what the text says. With figures named, the page holds
    these and the claims that belong to them. ``progress`` is called with the name of what is made next; ``resolution`` is
    that of the pictures [dots per inch]. Raises ValueError for unknown names, OSError where the folder cannot be written.
    """
    wanted, out = names_of(names), Path(out)
    out.mkdir(parents=True, exist_ok=True)
    tell = progress or (lambda name: None)
    made = []
    for name in wanted:
        if name in FIGURES:
            tell(f"figure {name}")
            made.append(_figure(name, out, resolution))
    if "table-1" in wanted:
        made.append(_table_1(out))
    figures = [name for name in wanted if name in FIGURES]
    rows = []
    if figures or "claims" in wanted:
        tell("claims")
        rows = judged(None if "claims" in wanted else figures)
        _write(out / "claims.csv", _claims_csv(rows))
    _write(out / "index.html", page(made, rows))
    return out / "index.html"


def _figure(name, out, resolution):
    drawing = FIGURES[name]()
    stem = f"figure-{name}"
    style.save(drawing.figure, out / f"{stem}.png", resolution)
    style.save(drawing.figure, out / f"{stem}.svg", resolution)
    _write(out / f"{stem}.csv", drawing.numbers.csv())
    width = drawing.figure.get_size_inches()[0] * style.INCH
    return Entry(name, title(name), drawing.note, tuple(f"{stem}.{suffix}" for suffix in ("png", "svg", "csv")), width)


def _table_1(out):
    text = table_1_rows().csv()
    _write(out / "table-1.csv", text)
    note = "As printed, in SI units, with the fiber extension of section 2.3.4."
    return Entry(
        "Table 1", "Constants of the three muscles.", note, ("table-1.csv",), rows=tuple(csv.reader(io.StringIO(text)))
    )


def _claims_csv(rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([COLUMNS, *rows_of(rows)])
    return text.getvalue()


def _write(path, text):
    write_whole(path, text.encode("utf-8"))
