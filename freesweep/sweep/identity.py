"""What makes two sweeps the same: the specification, and the code whose change could change a number."""

import functools
import hashlib
from pathlib import Path

import numpy as np

SOURCES = (
    *("solver/*.py", "solver/*/*.py", "sweep/*.py", "scaling.py", "closed_form.py", "ideal.py"),
    *("description/*.py", "status.py", "atlas/schema.py"),
)


def identify(sweep) -> dict:
    """Hashes of specification and code, and the version."""
    from .. import __version__

    return {"specification_sha256": sweep.sha256, "code_sha256": code_sha256(), "version": __version__}


@functools.cache
def code_sha256() -> str:
    """Hash of the code whose change could change a number, of Numba's version and of Python's."""
    from ..jit import source_hash

    root = Path(__file__).parent.parent
    digest = hashlib.sha256(source_hash("solver").encode())  # Numba and Python, too
    for path in sorted({path for pattern in SOURCES for path in root.glob(pattern)}):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def fingerprint(tables, parts) -> str:
    """Hash of what is solved, and of how it is split: shards of another split are not this sweep's."""
    digest = hashlib.sha256()
    for kind, table in tables.items():
        digest.update(table.digest + np.array(parts[kind], np.int64).tobytes())
    return digest.hexdigest()
