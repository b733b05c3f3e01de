"""Names and units of the columns of a table, however people write them; which of them are wanted, and what is wrong."""

import difflib
import re
from typing import NamedTuple

from .description.units import NEAR, quantity, shown

MOST_ABOVE = 60  # lines above the names, of what a bench writes about itself
PARTED_BY = {",": "commas", ";": "semicolons", "\t": "tabs"}
EXAMPLES = {"m": "mm", "Pa": "kPa", "degree": "deg", "N": "N", "N m": "N m"}
TEXT = "text"  # in place of a unit: a column of words
RATIO = "ratio"  # in place of a unit: a number that says whether it is a percentage

_HEADS = [
    re.compile(pattern, re.DOTALL)
    for pattern in (
        r"(.*?)\s*[\[{](.*)[\]}]",  # pressure [kPa(g)]
        r"(.*?)\s*\((.*)\)",  # pressure (kPa)
        r"(.*?)\s*(?:/|,|\bin\b)\s*([^[{]+)",  # pressure / kPa
        r"(\S+)\s+([^[{]+)",  # pressure kPa(g)
        r"(.+)_([^[{]+)",  # pressure_kPa; "force_temperature [C]" is no force
    )
]
NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?")


class Known(NamedTuple):
    """Columns that are wanted: name -> unit they are kept in, and other names for them."""

    units: dict
    synonyms: dict


class Head(NamedTuple):
    """A column's name and unit, what stands above it, and which one it is."""

    name: str
    unit: str
    text: str
    place: int  # column of the file, from 1


def where_names_are(lines, known):
    """By what columns are parted, and which of the lines names them: the first with a known name."""
    for at, (_, text) in enumerate(lines[:MOST_ABOVE]):
        parting = max(PARTED_BY, key=text.count)
        if any(read_head(cell, 1, known).name in known.units for cell in text.split(parting)):
            return parting, at
    return max(PARTED_BY, key=lines[0][1].count), 0


def read_head(text, place, known):
    """Name and unit of a column, however they are written."""
    text = text.strip()
    tries = [
        Head(_called(match.group(1), known), match.group(2).strip(), text, place)
        for pattern in _HEADS
        if (match := pattern.fullmatch(text))
    ]
    plain = Head(_called(text, known), "", text, place)
    tries.insert(len(tries) if set("[{(") & set(text) else 0, plain)
    return next((head for head in tries if head.name in known.units), tries[0])


def _called(text, known):
    name = re.sub(r"\W+", "_", text.strip().lower()).strip("_")
    return known.synonyms.get(name, name)


def units_below(heads, rows, known):
    """Units from a line of their own, below the names, where there is one."""
    if not rows or any(head.unit for head in heads) or len(rows[0][1]) != len(heads):
        return heads, rows
    cells = [cell.strip("[](){} ") for cell in rows[0][1]]
    if any(NUMBER.fullmatch(cell) for cell in cells) or not any(
        cell and head.name in known.units and _is_unit(cell) for head, cell in zip(heads, cells)
    ):
        return heads, rows
    return [head._replace(unit=cell) for head, cell in zip(heads, cells)], rows[1:]


def _is_unit(text):
    return any(not _unit_fault(text, kept) for kept in (*EXAMPLES, "1"))


def wanted_of(heads, line, known, plain, faults):
    """Columns to be read, once each, and those that are passed over."""
    wanted, others = [], []
    for head in heads:
        kept, place = known.units.get(head.name), f" (line {line}, column {head.place})"
        if not head.text:
            faults.append(f"column {head.place}: has no name; name it or remove it{place}")
        elif kept is None:
            near = difflib.get_close_matches(head.name[:40], known.units, n=1, cutoff=NEAR)
            if near:
                faults.append(f"column {shown(head.text)}: unknown; did you mean {near[0]}?{place}")
            else:
                others.append(head)
        elif any(other.name == head.name for other in wanted):
            faults.append(f"column {shown(head.text)}: given twice{place}")
        elif kept == RATIO and head.unit not in ("%", "1"):
            faults.append(
                f"column {shown(head.text)}: a share or a percentage? write '{head.name} [%]' or '{head.name} [1]'{place}"
            )
        elif not head.unit and kept in EXAMPLES and not plain:
            faults.append(f"column {shown(head.text)}: names no unit; write '{head.name} [{EXAMPLES[kept]}]'{place}")
        elif kept != TEXT and (fault := _unit_fault(head.unit, "1" if kept == RATIO else kept)):
            faults.append(f"column {head.name}: {fault}{place}")
        else:
            wanted.append(head)
    return wanted, others


def _unit_fault(unit, kept):
    """What is wrong with a unit, said of one such quantity."""
    try:
        quantity(f"1 {unit}", kept)
    except ValueError as error:
        return str(error)
    return ""
