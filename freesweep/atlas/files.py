"""Files that are whole or absent: bytes made in memory, written beside the target, flushed, renamed."""

import contextlib
import os
import shutil
import tempfile
from pathlib import Path


class EnvironmentFault(OSError):
    """Disk, folder or memory do not allow what was asked; nothing already stored is lost."""


def write_whole(path, content) -> None:
    """Write ``content`` (bytes) to ``path``: after any interruption the file is the old one or the new one.

    Raises :class:`EnvironmentFault` with the path and the bytes needed and free.
    """
    path = Path(path)
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
        temporary = None
        flush_folder(path.parent)
    except OSError as error:
        raise EnvironmentFault(f"cannot write {path}: {error.strerror}; {space(path.parent, len(content))}") from error
    finally:
        if temporary:
            with contextlib.suppress(OSError):
                os.unlink(temporary)


def flush_folder(folder) -> None:
    """Make a rename in ``folder`` durable."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def space(folder, needed) -> str:
    """Bytes needed and free, in words."""
    try:
        free = f"{shutil.disk_usage(folder).free:,}"
    except OSError:
        return f"{needed:,} bytes needed; the folder {folder} cannot be read (does it exist?)"
    return f"{needed:,} bytes needed, {free} free in {folder}"
