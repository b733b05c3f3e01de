"""What can be wrong with a question to an atlas."""

import difflib

from ..description.given import described


class QueryError(ValueError):
    """A question that an atlas cannot answer; ``faults`` lists all that is wrong with it."""

    def __init__(self, faults):
        self.faults = list(faults)
        super().__init__("\n".join(["cannot ask this of the atlas:", *(f"  - {fault}" for fault in self.faults)]))


def unknown(kind, name, known) -> str:
    """A sentence on a name that is none of ``known``."""
    name = name if isinstance(name, str) else described(name)
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.4)
    meant = f"did you mean {near[0]!r}? " if near else ""
    return f"{kind} {name[:60]!r} is unknown here; {meant}known: {', '.join(known) or 'none'}"
