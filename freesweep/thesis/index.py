"""The page that leads to everything: the table of claims, then every figure with what was chosen for it."""

from html import escape
from typing import NamedTuple

from .. import __version__
from .claims.claim import NO, PARTLY, UNKNOWN, YES
from .claims.table import COLUMNS, rows_of

SOURCE = "Design and Analysis of Fiber Reinforced Elastomeric Enclosures with Application in Upper Arm Orthosis"
STYLE = """
body { font: 16px/1.45 Georgia, serif; color: #23272e; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; }
h2 { font-size: 1.25rem; margin-top: 2.5rem; }
table { border-collapse: collapse; font-size: 0.86rem; }
th, td { text-align: left; vertical-align: top; padding: 0.4rem 0.6rem; }
th { border-bottom: 1.5px solid #23272e; }
td { border-bottom: 1px solid #e9e9ea; }
td.verdict { font-weight: bold; }
.yes { color: #10664a; } .part { color: #8a5a00; } .no { color: #8f1513; } .unknown { color: #6b717b; }
figure { margin: 2rem 0; }
figcaption { color: #6b717b; max-width: 46rem; }
figcaption b { color: #23272e; }
img { max-width: 100%; height: auto; }
"""
CLASSES = {YES: "yes", PARTLY: "part", NO: "no", UNKNOWN: "unknown"}


class Entry(NamedTuple):
    """One figure or table: its name, what it shows, what was chosen for it, and its files."""

    name: str
    title: str
    note: str
    files: tuple
    width: float = 0.0  # of the picture [mm]
    rows: tuple = ()  # of a table: texts, the heads first


def page(made, judged) -> str:
    """The page as HTML: ``made`` lists an :class:`Entry` for each figure and table, ``judged`` the claims."""
    parts = [
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">',
        f"<title>The source, recomputed</title><style>{STYLE}</style></head><body>",
        "<h1>The source, recomputed</h1>",
        f"<p>Every figure and table of <i>{SOURCE}</i> that has content of the model, computed by freesweep {__version__},",
        "and what its text claims. <b>principal</b> is the strain energy as the source prints it (Eq. 2.5), <b>full</b>",
        "charges the shear that twisting makes. The source's measured markers are not printed as numbers: none are shown.",
        "</p>",
    ]
    if judged:
        parts += ["<h2>Claims</h2>", f"<p>{summary(judged)}</p>", _table(judged)]
    parts += [_entry(entry) for entry in made]
    return "\n".join([*parts, "</body></html>", ""])


def summary(judged) -> str:
    """How many claims have which verdict."""
    counts = {}
    for row in judged:
        counts[row.verdict] = counts.get(row.verdict, 0) + 1
    order = [*CLASSES, *(verdict for verdict in counts if verdict not in CLASSES)]
    words = [f"{verdict}: {counts[verdict]}" for verdict in order if verdict in counts]
    return f"{len(judged)} claims. {'; '.join(words)}."


def _entry(entry):
    """A picture or a table with what it shows and the links to its files."""
    links = " · ".join(f'<a href="{file}">{file.rpartition(".")[2].upper()}</a>' for file in entry.files)
    shown = ""
    for file in entry.files:
        if file.endswith(".png"):
            shown = f'<img src="{file}" alt="{escape(entry.title)}" style="width:{entry.width:.0f}mm">'
    if entry.rows:
        cells = ["".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in row) for tag, row in _tagged(entry.rows)]
        shown = "<table>" + "".join(f"<tr>{row}</tr>" for row in cells) + "</table>"
    heading = entry.name if entry.rows else f"Figure {entry.name}"
    caption = f"<b>{heading}.</b> {escape(entry.title)} {escape(entry.note)}<br>{links}"
    return f'<figure id="{escape(entry.name)}">{shown}<figcaption>{caption}</figcaption></figure>'


def _tagged(rows):
    return [("th", rows[0]), *(("td", row) for row in rows[1:])]


def _table(judged):
    head = "".join(f"<th>{name}</th>" for name in COLUMNS)
    lines = ["<table>", f"<tr>{head}</tr>"]
    for row in rows_of(judged):
        cells = [escape(cell) for cell in row]
        cells[1] = " ".join(f'<a href="#{name}">{name}</a>' for name in row[1].split())
        verdict = row[COLUMNS.index("verdict")]
        marked = [
            f'<td class="verdict {CLASSES.get(verdict, "part")}">{cell}</td>'
            if head == "verdict"
            else f"<td>{cell}</td>"
            for head, cell in zip(COLUMNS, cells)
        ]
        lines.append(f"<tr>{''.join(marked)}</tr>")
    return "\n".join([*lines, "</table>"])
