"""What comes after solving, made ready by a thread beside those that solve: libraries that take a second to import, and the
machine code with which an atlas measures itself.
"""

import contextlib
import functools
import importlib

from . import kernels

WRITING = ("netCDF4", "h5py", "xarray")  # atlases


def make_ready(sweep, modules):
    """Import what writes atlases, and ``modules``, and load, if they lie on disk, the kernels that measure those of a sweep.

    What cannot be done will be heard of where it is needed.
    """
    for name in (*WRITING, *modules):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    words = kernels.of_measuring(sweep)
    if words:
        _load(words)


@functools.cache
def _load(words):
    kernels.compile_idle(words)
