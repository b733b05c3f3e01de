"""Machine code on disk, one file for each kernel and types of arguments, behind the SHA-256 of its bytes.

A flipped bit in machine code kills the process that runs it, and after a power cut a file may be empty. So nothing is
loaded that is not the very bytes that were written; whatever else goes wrong counts as a miss: the kernel is compiled again
and its file replaced. A disk that takes no files costs nothing but the time of compiling in each process.
"""

import contextlib
import hashlib
import os
import pickle
import tempfile
from pathlib import Path

from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

DIGEST = hashlib.sha256().digest_size  # [bytes]


class KernelCache(_Cache):
    """The machine code of one function in a ``folder``, as Numba's dispatchers ask for it.

    Which sources it was made from, the name of the folder says.
    """

    def __init__(self, function, folder):
        self.stem, self.folder, self.enabled = stem(function), Path(folder), True

    @property
    def cache_path(self):
        return str(self.folder)

    def enable(self):
        self.enabled = True

    def disable(self):
        self.enabled = False

    def flush(self):
        for path in self.folder.glob(f"{self.stem}-*.nbc"):
            path.unlink(missing_ok=True)

    def load_overload(self, sig, target_context):
        """What was compiled for arguments of such types, or None."""
        target_context.refresh()  # so it is ready for what is put into it
        if not self.enabled:
            return None
        try:
            content = _whole(self._path(sig, target_context.codegen()))
            return None if content is None else CompileResult._rebuild(target_context, *pickle.loads(content))
        except Exception:  # of a library that changed under the same version, or of LLVM: a miss
            return None

    def holds(self, sig, codegen):
        """Whether there is machine code for arguments of such types."""
        return _whole(self._path(sig, codegen)) is not None

    def save_overload(self, sig, data):
        """Keep what was compiled, unless it holds addresses of this process."""
        if self.enabled and not (data.lifted or data.library.has_dynamic_globals):
            with contextlib.suppress(OSError):
                _store(self._path(sig, data.codegen), dumps(data._reduce()))

    def _path(self, sig, codegen):
        kind = hashlib.sha256(repr((sig, codegen.magic_tuple())).encode()).hexdigest()[:16]  # types and processor
        return self.folder / f"{self.stem}-{kind}.nbc"


def stem(function) -> str:
    """How the names of a function's files begin."""
    return f"{function.__module__}.{function.__name__}"


def compiled(folder) -> set:
    """The :func:`stem` of each function of which a ``folder`` holds whole files; None stands for no folder."""
    files = Path(folder).glob("*.nbc") if folder else ()
    return {path.name.rpartition("-")[0] for path in files if _whole(path) is not None}


def _whole(path):
    """The bytes behind a file's digest if they are those that were written, or None."""
    try:
        content = path.read_bytes()
    except OSError:
        return None
    return content[DIGEST:] if hashlib.sha256(content[DIGEST:]).digest() == content[:DIGEST] else None


def _store(path, content):
    """Write ``content`` behind its digest: another process sees the old file or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(hashlib.sha256(content).digest() + content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise
