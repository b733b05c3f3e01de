"""Files that are whole or absent: written beside the target, flushed, read back, renamed.

Every call to the system that stores something is made here, through ``os``. What is in the making carries this program's
mark in its name, so that what a killed process left can be told from files of others.
"""

import contextlib
import errno
import hashlib
import os
import re
import shutil
import tempfile
from pathlib import Path

BLOCK = 1 << 22  # [bytes] read at once
IN_THE_MAKING = re.compile(r"\.(?P<name>.+)\.freesweep-[a-z0-9_]{8}\.part")
NO_LINKS = (errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS)  # of a file system without hard links
NO_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS)  # of one without locks
WRONG_NAMES = (errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENAMETOOLONG, errno.ELOOP, errno.EINVAL)


class EnvironmentFault(OSError):
    """Disk, folder or memory do not allow what was asked; nothing already stored is lost."""


def is_of_environment(error) -> bool:
    """Whether an OSError tells of the machine (disk, permissions, open files) rather than of a name that was given."""
    if isinstance(error, EnvironmentFault | PermissionError):
        return True
    return (error.errno or 0) > 0 and error.errno not in WRONG_NAMES


def check_environment(path, error):
    """Raise :class:`EnvironmentFault` if an error of a library that reads ``path`` is the machine's, not the file's."""
    if isinstance(error, MemoryError):
        raise error
    if isinstance(error, OSError) and is_of_environment(error):
        raise EnvironmentFault(f"cannot read {path}: {os.strerror(error.errno)}") from error


def left_behind(folder, name) -> list:
    """Files in the making that a killed process left in a folder, and that were to become ``name``."""
    found = [(path, IN_THE_MAKING.fullmatch(path.name)) for path in Path(folder).iterdir()]
    return [path for path, made in found if made and made["name"] == name]


class WholeFile:
    """A file in the making, a file object in which one may seek; at ``path`` it appears whole or not at all.

    The first fault of a write is kept, and what follows goes nowhere: a library that cannot cope with a full disk, as
    HDF5, never hears of it. :meth:`check` and :meth:`publish` raise it as :class:`EnvironmentFault`.
    """

    def __init__(self, path, needed=0):
        self.path, self.needed = Path(path), needed
        self.fault, self.place, self.size, self.temporary = None, 0, 0, None
        try:
            self.descriptor, self.temporary = tempfile.mkstemp(
                prefix=f".{self.path.name}.freesweep-", suffix=".part", dir=self.path.parent
            )
        except OSError as error:
            raise self._fault(error) from error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.discard()

    def write(self, content) -> int:
        """Write bytes at the present place."""
        view = memoryview(content).cast("B")
        place = self.place
        self.place += len(view)
        self.size = max(self.size, self.place)
        while len(view) and self.fault is None:
            try:
                done = os.pwrite(self.descriptor, view, place)
                view, place = view[done:], place + done
            except OSError as error:
                self._keep(error)
        return self.place - place + len(view)

    def read(self, size) -> bytes:
        """Read from the present place."""
        content = self._read(size, self.place)
        self.place += len(content)
        return content

    def _read(self, size, place):
        try:
            return os.pread(self.descriptor, size, place)
        except OSError as error:
            self._keep(error)
            return b""

    def _keep(self, error):
        """Keep the first fault, not who called: HDF5's own, which would never be let go of."""
        self.fault = self.fault or error.with_traceback(None)

    def readinto(self, buffer) -> int:
        """Read from the present place into a buffer."""
        view = memoryview(buffer).cast("B")
        content = self.read(len(view))
        view[: len(content)] = content
        return len(content)

    def seek(self, offset, whence=os.SEEK_SET) -> int:
        """Change the present place."""
        start = {os.SEEK_SET: 0, os.SEEK_CUR: self.place, os.SEEK_END: self.size}[whence]
        self.place = start + offset
        return self.place

    def tell(self) -> int:
        """The present place."""
        return self.place

    def truncate(self, size=None) -> int:
        """Cut or extend the file."""
        size = self.place if size is None else size
        try:
            os.ftruncate(self.descriptor, size)
        except OSError as error:
            self._keep(error)
        self.size = size
        return size

    def flush(self):
        """Nothing is held back."""

    def check(self):
        """Raise :class:`EnvironmentFault` if a write has failed, or reading back."""
        if self.fault is not None:
            raise self._fault(self.fault) from self.fault

    def digest(self):
        """A ``hashlib.sha256()`` of what can be read back."""
        digest, place = hashlib.sha256(), 0
        while block := self._read(BLOCK, place):
            digest.update(block)
            place += len(block)
        self.check()
        return digest

    def check_content(self, content):
        """Raise :class:`EnvironmentFault` unless ``content`` is what can be read back."""
        view, place = memoryview(content), 0
        while (block := self._read(BLOCK, place)) and block == view[place : place + len(block)]:
            place += len(block)
        self.check()
        if block or place != len(view):
            raise self.misread()

    def misread(self):
        """The fault of a disk that gives back other bytes than it was given."""
        return EnvironmentFault(
            f"cannot write {self.path}: other bytes are read back than were written; check the disk"
        )

    def publish(self, replace=True):
        """Flush, and give the file its name: in place of what has it, or else raise FileExistsError."""
        self.check()
        try:
            os.fsync(self.descriptor)
            os.fchmod(self.descriptor, 0o644)
            os.close(self._taken())
            (os.replace if replace else _rename_beside)(self.temporary, self.path)
            self.temporary = None
            flush_folder(self.path.parent)
        except FileExistsError:
            raise
        except OSError as error:
            raise self._fault(error) from error

    def discard(self):
        """Leave nothing behind, unless it was published."""
        with contextlib.suppress(OSError):
            if self.descriptor is not None:
                os.close(self._taken())
        with contextlib.suppress(OSError):
            if self.temporary:
                os.unlink(self.temporary)

    def _taken(self):
        descriptor, self.descriptor = self.descriptor, None
        return descriptor

    def _fault(self, error):
        return EnvironmentFault(
            f"cannot write {self.path}: {error.strerror}; {space(self.path.parent, max(self.needed, self.place))}"
        )


def write_whole(path, content) -> None:
    """Write ``content`` (bytes) to ``path``: after any interruption the file is the old one or the new one.

    Raises :class:`EnvironmentFault` with the path and the bytes needed and free.
    """
    content = bytes(content)
    with WholeFile(path, len(content)) as file:
        file.write(content)
        file.check()
        file.check_content(content)
        file.publish()


def _rename_beside(temporary, path):
    """Rename a file where nothing has that name; raises FileExistsError, and leaves what has it alone."""
    try:
        os.link(temporary, path)  # unlike a rename it never replaces
    except OSError as error:
        if error.errno not in NO_LINKS:
            raise
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        os.replace(temporary, path)
    else:
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
