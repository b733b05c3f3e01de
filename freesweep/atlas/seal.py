"""The seal of an atlas: the SHA-256 of every byte before it, as the last line of the file.

An HDF5 file says itself where it ends, so readers pass over what follows; and no bit of the file is left unwatched, as
checksums inside it would leave the slack between its objects.
"""

import hashlib
import os
from pathlib import Path

MARK = b"\nfreesweep sha256 "
SIZE = len(MARK) + 64 + 1
BLOCK = 1 << 22  # [bytes] read at once


def seal(digest) -> bytes:
    """The last line of a file whose other bytes went into ``digest``, a ``hashlib.sha256()``."""
    return MARK + digest.hexdigest().encode() + b"\n"


def sealed(content) -> bytes:
    """``content`` (bytes) with its seal behind it."""
    return bytes(content) + seal(hashlib.sha256(content))


def has_seal(path) -> bool:
    """Whether a file ends in a seal; whether it is the right one, :func:`seal_fault` says.

    What a library of netCDF adds to a file, or writes anew, goes in the seal's place. Raises OSError.
    """
    with Path(path).open("rb") as file:
        file.seek(max(os.path.getsize(path) - SIZE, 0))
        return file.read().startswith(MARK)


def seal_fault(path) -> str | None:
    """What is wrong with the seal of the file at ``path``, in words; None: every bit is the one that was written.

    Raises OSError where the file cannot be read.
    """
    rest = os.path.getsize(path) - SIZE
    digest = hashlib.sha256()
    with Path(path).open("rb") as file:
        while rest > 0 and (block := file.read(min(BLOCK, rest))):
            digest.update(block)
            rest -= len(block)
        last = file.read() if rest == 0 else b""
    if last == seal(digest):
        return None
    if last[: len(MARK)] == MARK:
        return "its bytes are not those that were written: the SHA-256 on its last line is another"
    return "it does not end in a seal: it was cut short, changed, or not written by this version"
