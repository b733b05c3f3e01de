"""The one compilation policy of every kernel.

* ``error_model="numpy"``: a division by zero gives inf or nan, which the guards catch; no exception paths in loops.
* ``fastmath={"contract"}``: fused multiply-add only. Reordering or ignoring NaN would break guards and determinism.
* ``nogil``: kernels are driven by a thread pool, never by ``prange`` (its ``workqueue`` layer aborts the process when
  two Python threads enter it).
* A literal, or a name that stands for one, is a type of its own to Numba, which compiles what it is handed to once more:
  kernels take it for any other whole number or truth.
* The compiler is Numba's without what kernels never need; only entry points become machine code (:mod:`compiler`).

Entry points are cached on disk, by a cache of our own (:mod:`kernel_cache`). Numba's knows only the file of the cached
function, so editing the physics in another file would run stale code: the folder is named after a hash of all sources in
the kernel's room.
"""

import functools
import hashlib
import os
import sys
from pathlib import Path

import numba
from numba.core import config, types

from .compiler import KernelCompiler, PartCompiler
from .kernel_cache import KernelCache

_POLICY = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True, "pipeline_class": KernelCompiler}
_POLICY["no_cfunc_wrapper"] = True  # no kernel is called from C
_INNER = {"no_cpython_wrapper": True, "pipeline_class": PartCompiler}  # nor these from Python


@functools.cache
def source_hash(*rooms: str) -> str:
    """Hash of how kernels are compiled, of the sources of ``rooms`` ("solver", "query"), of Numba's version and Python's."""
    here = Path(__file__).parent
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    sources = [path for room in rooms for path in sorted((here / room).rglob("*.py"))]
    for path in [Path(__file__), here / "compiler.py", here / "lowering.py", *sources]:
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def cache_folder(*rooms: str) -> str | None:
    """Where the machine code of some rooms' very sources lies; None: nobody is at home here, nothing is kept."""
    try:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    except RuntimeError:  # neither HOME nor an entry of this user's
        return None
    return str(Path(base) / "freesweep" / "kernels" / f"{'+'.join(rooms)}-{source_hash(*rooms)}")


def kernel(function, **more):
    """Compile a kernel that other kernels call. Called from Python, as by a test, it hands on to one that has a door."""
    inner = numba.njit(**{**_POLICY, **_INNER, **more})(function)
    if config.DISABLE_JIT:
        return inner
    ask = inner.get_call_template  # by another kernel, with the types of a call
    inner.get_call_template = lambda given, named: ask(
        tuple(map(types.unliteral, given)), {name: types.unliteral(kind) for name, kind in named.items()}
    )
    inner._insert = lambda *_, **__: None  # nothing that Python could call
    inner._compile_for_args = lambda *_, **__: _with_door(function)
    return inner


def in_place(function):
    """Compile a kernel into those that call it: what is fused, and so rounded, hangs on what stands in one place; and to
    hand a dozen arrays over takes a twentieth of a short mesh's time.
    """
    return kernel(function, forceinline=True)


_with_door = functools.cache(numba.njit(**_POLICY))


def entry_point(function, others=()):
    """Compile a kernel that Python calls, and keep its machine code on disk; ``others``: rooms whose kernels it calls."""
    dispatcher = numba.njit(**_POLICY)(function)
    if folder := cache_folder(function.__module__.split(".")[1], *others):
        dispatcher._cache = KernelCache(function, folder)
    return dispatcher
