"""Reads TOML that may be hostile: size, nesting and key depth are capped before the parser sees the text.

``tomllib`` recurses on nested brackets and needs seconds for one dotted key of 40 kB.
"""

import re
import tomllib
from pathlib import Path

from ..description.units import shown
from .faults import SpecificationError

MAX_BYTES = 256_000  # a long list of designs fits a hundred times
MAX_NESTING = 8  # open brackets; a specification needs two
MAX_DOTS = 8  # in one key; a specification needs two

# Comments and texts are skipped whole; a quote that matches none of them is never closed, and ends the scan.
_TOKEN = re.compile(
    r"""
      \#[^\n]*
    | \"{3}(?:[^\\]|\\.)*?\"{3,5} | '{3}.*?'{3,5}
    | "(?!"")(?:[^"\\\n]|\\[^\n])*" | '(?!'')[^'\n]*'
    | (?P<unclosed>["'])
    | (?P<open>[\[{]) | (?P<close>[\]}]) | (?P<dot>\.) | (?P<next>[\n=,])
    """,
    re.VERBOSE | re.DOTALL,
)


def read_text(path: str | Path) -> str:
    """The text of a specification file.

    Raises FileNotFoundError if there is none, SpecificationError if it is no file, too large or not UTF-8.
    """
    path = Path(path)
    name = shown(str(path), 200)
    if not path.exists():
        raise FileNotFoundError(f"there is no specification {name}; check the path")
    if not path.is_file():  # a pipe or a device may never end
        raise SpecificationError([f"{name} is not a file; give the path of a TOML file"], str(path))
    with path.open("rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise SpecificationError([_too_large("more than")], str(path))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise SpecificationError(
            [f"line {line}: byte {data[error.start]:#04x} is not UTF-8 text; save the file as UTF-8"], str(path)
        ) from None


def load(text: str, name: str = "specification") -> dict:
    """The document as plain dictionaries and lists; raises SpecificationError if it is not TOML or beyond the caps."""
    refusal = _refusal(text)
    if refusal:
        raise SpecificationError([refusal], name)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SpecificationError([_syntax_fault(text, str(error))], name) from None
    except ValueError:  # Python's own limit on the digits of an integer, or a date that is none
        raise SpecificationError(
            ["a number or date cannot be read; write plain numbers and quantities"], name
        ) from None


def _refusal(text):
    """Why the text must not reach the parser, or None."""
    if len(text) > MAX_BYTES:
        return _too_large(f"{len(text):,}")
    try:
        text.encode("utf-8")
    except UnicodeEncodeError as error:
        return f"line {text.count(chr(10), 0, error.start) + 1}: not valid Unicode; save the file as UTF-8"
    depth = dots = 0
    for token in _TOKEN.finditer(text):
        match token.lastgroup:
            case "unclosed":
                return None  # the parser stops here and names the line
            case "open":
                depth, dots = depth + 1, 0
            case "close":
                depth, dots = max(depth - 1, 0), 0
            case "dot":
                dots += 1
            case "next":
                dots = 0
        if depth > MAX_NESTING or dots > MAX_DOTS:
            line = text.count("\n", 0, token.start()) + 1
            what = f"{MAX_NESTING} brackets" if depth > MAX_NESTING else f"{MAX_DOTS} dots in one key"
            return f"line {line}: nested too deeply; at most {what} are allowed, a specification needs two"
    return None


def _too_large(found):
    return f"found {found} characters, at most {MAX_BYTES:,} bytes are allowed; give ranges in [axes] instead of lists"


def _syntax_fault(text, message):
    place = re.search(r"\(at line (\d+), column \d+\)", message)
    if place is None:
        return f"not valid TOML: {message[:200]}"
    line = text.split("\n")[int(place[1]) - 1].strip()
    hint = '; quantities with units stand in quotes, as in wall = "1.59 mm"' if message.startswith(_UNQUOTED) else ""
    return f"line {place[1]}: not valid TOML: {message[:200]}: {shown(line, 80)}{hint}"


_UNQUOTED = ("Expected newline or end of document after a statement", "Invalid value", "Unclosed")
