"""Tables of numbers as people have them: a line that names columns and units, then rows; one reader for all commands.

Parted by commas, semicolons or tabs; decimal points or commas; any byte order mark; comments, empty lines and lines above
the names passed over. Nothing is dropped without a word: ``notes`` count what was passed over. Faults name line and column.
"""

import csv
import re
from typing import NamedTuple

import numpy as np

from .description.faults import ActuatorError
from .description.units import quantity, shown
from .table_heads import NUMBER, RATIO, TEXT, Known, read_head, units_below, wanted_of, where_names_are

LARGEST_FILE = 64_000_000  # bytes
MOST_FAULTS = 30
COMMENTS = ("#", "%", "//")
NO_NUMBER = {"", "nan", "na", "n/a", "#n/a", "#div/0!", "-", "--", "none", "null", "missing"}
MARKS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}  # what spreadsheets call Unicode text

_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_POINT = re.compile(r"[+-]?\d*\.\d+(?:[eE][+-]?\d+)?")


class Columns(NamedTuple):
    """What a file holds: name -> numbers (rows,) or texts; ``lines`` (rows,) of the file; what was passed over, in words;
    name -> unit as it was written, and -> column of the file, from 1; names of columns that were passed over.
    """

    values: dict
    lines: np.ndarray
    notes: tuple
    units: dict
    places: dict
    others: tuple

    def where(self, name, row) -> str:
        """Where in the file a number stands."""
        return f"(line {self.lines[row]}, column {self.places[name]})"


def read_columns(path, known: Known, plain=False) -> Columns:
    """The columns of a file that are ``known``; the rest is passed over. Raises :class:`ActuatorError` with every fault.

    ``plain``: a column that names no unit is in that of the API. Rows that lack a number in a column wanted are skipped.
    """
    notes, faults = [], []
    lines = _lines(path, notes)
    parting, at = where_names_are(lines, known)
    if at:
        notes.append(f"{_count(at, 'line')} above the names passed over")
    rows = [(number, _parted(text, parting, number)) for number, text in lines[at:]]
    (line, heads), rows = rows[0], rows[1:]
    named = max((place for place, text in enumerate(heads, 1) if text.strip()), default=0)
    heads = [read_head(text, place, known) for place, text in enumerate(_ended(heads, named), 1)]
    heads, rows = units_below(heads, rows, known)
    if not rows:
        raise ActuatorError([f"found {len(lines)} lines; give a line of names and units, then the states"])
    empty = [number for number, row in rows if not any(row)]
    rows = [(number, _ended(row, len(heads))) for number, row in rows if any(row)]
    if empty:
        notes.append(f"{_count(len(empty), 'row')} of empty cells passed over ({_which(empty)})")
    for number, row in rows:
        if len(row) != len(heads) and len(faults) < MOST_FAULTS:
            faults.append(f"line {number}: {len(row)} cells under {len(heads)} names; {_uneven(row, len(heads))}")
    if len(heads) == 1 and all(_is_spaced(row[0]) for _, row in rows):
        raise ActuatorError(
            [f"line {line}: blanks alone part its columns; write commas, semicolons or tabs (column 1)"]
        )
    wanted, others = wanted_of(heads, line, known, plain, faults)
    if others:
        notes.append(
            f"{_count(len(others), 'column')} not needed and passed over: "
            + ", ".join(f"{shown(head.text)} (column {head.place})" for head in others)
        )
    comma = _decimal_comma(wanted, rows, parting, faults, notes) if not faults else False
    values = {head.name: _cells(head, rows, known.units[head.name], comma, faults) for head in wanted}
    if faults:
        raise ActuatorError(faults)
    units, places = ({head.name: getattr(head, part) for head in wanted} for part in ("unit", "place"))
    complete = _complete(values, np.array([number for number, _ in rows]), known, notes)
    return Columns(*complete, units, places, tuple(head.text for head in others))


def _lines(path, notes):
    """Numbered lines that hold something, without comments."""
    if path.is_dir():
        raise ActuatorError(["is a folder; give the paths of CSV files"])
    if (size := path.stat().st_size) > LARGEST_FILE:
        raise ActuatorError([f"{size:,} bytes; at most {LARGEST_FILE:,} are read"])
    content = path.read_bytes()
    try:
        text = content.decode(MARKS.get(content[:2], "utf-8-sig"))
    except UnicodeDecodeError as error:
        before = content[: error.start].split(b"\n")
        place = f"line {len(before)}, character {len(before[-1]) + 1}"
        raise ActuatorError([f"not a text in UTF-8 ({place}); save it as CSV (UTF-8)"]) from None
    numbered = list(enumerate(text.splitlines(), 1))
    filled = [(number, line) for number, line in numbered if line.strip()]
    lines = [(number, line) for number, line in filled if not line.lstrip().startswith(COMMENTS)]
    for count, what in ((len(numbered) - len(filled), "empty line"), (len(filled) - len(lines), "comment line")):
        if count:
            notes.append(f"{_count(count, what)} passed over")
    if len(lines) < 2:
        raise ActuatorError([f"found {len(lines)} lines; give a line of names and units, then the states"])
    return lines


def _parted(text, parting, number):
    """Cells of a line; a quotation mark ends with its line."""
    try:
        return [cell.strip() for cell in next(csv.reader([text], delimiter=parting, strict=True))]
    except csv.Error as error:
        if "unexpected end" in str(error):
            place = text.rindex('"') + 1
            raise ActuatorError(
                [f"line {number}: a quotation mark opens and does not end (character {place})"]
            ) from None
        raise ActuatorError([f"line {number}: {error}; no table has such a cell"]) from None


def _ended(row, names):
    """A row without the empty cells that separators at its end leave behind the last name."""
    return row[:names] if not any(row[names:]) else row


def _is_spaced(cell):
    """Whether a cell holds several numbers, with blanks between."""
    parts = cell.split()
    return len(parts) > 1 and all(NUMBER.fullmatch(part) for part in parts)


def _uneven(row, count):
    """What may have made a row longer or shorter than the ``count`` of names."""
    if len(row) < count:
        return f"cells are missing at its end (from column {len(row) + 1})"
    return f"a separator too many, or a decimal comma where a point belongs (from column {count + 1})"


def _decimal_comma(wanted, rows, parting, faults, notes):
    """Whether numbers have commas for points; a file has one of the two. Commas that part columns hardly stand for points:
    where each could part thousands, too, nobody knows.
    """
    commas, points = [], []
    for head in wanted:
        for number, row in rows:
            cell = row[head.place - 1]
            if _COMMA.fullmatch(cell):
                commas.append((number, head, cell))
            elif _POINT.fullmatch(cell):
                points.append((number, head, cell))
    if commas and points:
        few, many = sorted((commas, points), key=len)
        (line, head, cell), (other_line, _, other) = few[0], many[0]
        faults.append(
            f"line {line}, {head.name}: {cell!r:.30} beside {other!r:.30} on line {other_line}: decimal commas and points in"
            f" one file; write points (column {head.place})"
        )
    elif commas and parting != ";" and all(_THOUSANDS.fullmatch(cell) for _, _, cell in commas):
        line, head, cell = commas[0]
        small, large = (cell.replace(",", by) for by in (".", ""))
        faults.append(
            f"line {line}, {head.name}: {cell!r} is {small} or {large}? write points, and nothing between thousands (column"
            f" {head.place})"
        )
    elif commas:
        notes.append(f"decimal commas read as points, {_count(len(commas), 'cell')}")
    return bool(commas)


def _cells(head, rows, kept, comma, faults):
    """Numbers of a column, NaN where there is none; or its texts."""
    cells = [(number, row[head.place - 1]) for number, row in rows if head.place <= len(row)]
    if kept == TEXT:
        return [cell for _, cell in cells]
    found, unit = [], "1" if kept == RATIO else kept
    for number, cell in cells:
        if cell.lower() in NO_NUMBER:
            found.append(np.nan)
            continue
        text = cell.replace(",", ".") if comma and _COMMA.fullmatch(cell) else cell
        try:
            found.append(quantity(f"{text} {head.unit}", unit))
        except ValueError as error:
            if len(faults) < MOST_FAULTS:
                words = "its unit stands above; write the number alone" if _has_unit(cell, head.unit) else error
                words = f"found {cell!r:.30}: {words}" if words is not error else words
                faults.append(f"line {number}, {head.name}: {words} (column {head.place})")
    return np.array(found)


def _has_unit(cell, unit):
    """Whether a number brings the unit of its column along."""
    return bool(unit) and cell.endswith(unit) and bool(NUMBER.fullmatch(cell.removesuffix(unit).strip()))


def _complete(values, lines, known, notes):
    """Rows that have a number in every column, and a note on the others."""
    lacking = {name: ~np.isfinite(array) for name, array in values.items() if known.units[name] != TEXT}
    skipped = np.any(list(lacking.values()), axis=0) if lacking else np.zeros(len(lines), bool)
    if skipped.any():
        where = [f"{name}: {_which(lines[own].tolist())}" for name, own in lacking.items() if own.any()]
        notes.append(f"{_count(int(skipped.sum()), 'row')} without a number skipped ({'; '.join(where)})")
    if skipped.all() and len(lacking):
        raise ActuatorError([f"no row has a number in each of {', '.join(lacking)}; nothing is left to read"])
    kept = {
        name: array[~skipped] if known.units[name] != TEXT else [text for text, off in zip(array, skipped) if not off]
        for name, array in values.items()
    }
    return kept, lines[~skipped], tuple(notes)


def _count(number, what):
    return f"{number} {what}{'s' * (number != 1)}"


def _which(lines):
    listed = ", ".join(map(str, lines[:8])) + ", and so on" * (len(lines) > 8)
    return f"line{'s' * (len(lines) != 1)} {listed}"
