"""Grids of designs, solved into atlases; called, it is :func:`freesweep.sweep.from_python.sweep`."""

import inspect
import sys
from types import ModuleType

from .from_python import sweep


class _Called(ModuleType):
    """The room and the function share their name: ``fs.sweep(...)`` beside ``freesweep.sweep.spec``."""

    __call__ = staticmethod(sweep)


__doc__ = f"{__doc__}\n\n{inspect.getdoc(sweep)}"  # what help(fs.sweep) shows
__wrapped__ = sweep  # for what asks for its signature
sys.modules[__name__].__class__ = _Called
