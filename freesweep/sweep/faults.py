"""Collects the faults of a specification, so that its author sees all of them at once."""

import difflib
import re

from ..description.units import shown

MAX_FAULTS = 50  # listed in one error; a file with more is not a specification with slips
MAX_LINE = 200  # characters of a title or of a design's name


class SpecificationError(ValueError):
    """A specification that cannot be swept; ``faults`` lists every reason, each with the path of its key."""

    def __init__(self, faults: list[str], name: str = "specification"):
        super().__init__(faults, name)
        self.faults = list(faults)
        self.name = name

    def __str__(self):
        """All faults, one a line."""
        count = len(self.faults)
        lines = "\n  ".join(self.faults)
        return f"{self.name}: {count} fault{'s' if count != 1 else ''}\n  {lines}"


class Faults:
    """The faults met so far in the specification called ``name``."""

    def __init__(self, name: str):
        self.name = name
        self.found = []

    def add(self, path: str, sentence: str) -> None:
        """Notes one fault. Raises SpecificationError when there are too many to list."""
        self.found.append(f"{path}: {sentence}" if path else sentence)
        if len(self.found) >= MAX_FAULTS:
            self.found.append(f"the list stops at {MAX_FAULTS} faults")
            self.check()

    def line(self, path: str, text) -> str:
        """The text; notes a fault unless it is one line of printable text of moderate length."""
        if not isinstance(text, str) or len(text) > MAX_LINE or not text.isprintable():
            self.add(path, f"found {shown(text)}, allowed is one line of text of at most {MAX_LINE} characters")
        return text

    def check(self) -> None:
        """Raises SpecificationError if any fault was found."""
        if self.found:
            raise SpecificationError(self.found, self.name)

    def unknown_keys(self, table: dict, allowed, path: str = "", elsewhere=None) -> None:
        """Notes every key of ``table`` that is not ``allowed``; ``elsewhere`` maps keys to where they belong."""
        for key in table:
            if key in allowed:
                continue
            if elsewhere and key in elsewhere:
                hint = elsewhere[key]
            else:
                near = difflib.get_close_matches(key[:40], list(allowed), n=1)
                hint = f"did you mean {near[0]!r}? " if near else ""
                hint += f"Allowed: {', '.join(allowed)}"
            self.add(joined(path, key), f"unknown key; {hint}")


def joined(path: str, key: str) -> str:
    """The path of ``key`` inside ``path``, as TOML writes it."""
    key = key if re.fullmatch(r"[A-Za-z0-9_-]{1,40}", key) else shown(key)
    return f"{path}.{key}" if path else key
