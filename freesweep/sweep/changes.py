"""What differs between two specifications, by the names of their keys: a hash says only that something does."""

from . import toml_guard
from .faults import SpecificationError, joined

LISTED = 6


def changes(before, now) -> str:
    """In words for a message, such as " (changed: axes.alpha)"; "" where one of the two is no specification."""
    try:
        before, now = (_flat(toml_guard.load(text)) for text in (before, now))
    except (SpecificationError, TypeError):
        return ""
    names = [name for name in now | before if repr(before.get(name)) != repr(now.get(name))]
    if not names:
        return " (changed: comments, or how it is written)"
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return f" (changed: {', '.join(names[:LISTED])}{more})"


def _flat(document):
    """Name of a key in its table -> value."""
    tables = {name: value if isinstance(value, dict) else {"": value} for name, value in document.items()}
    return {
        joined(joined("", name), key) if key else joined("", name): value
        for name, table in tables.items()
        for key, value in table.items()
    }
