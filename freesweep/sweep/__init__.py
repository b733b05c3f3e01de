"""Grids of designs, solved into atlases; called, it is :func:`freesweep.sweep.from_python.sweep`."""

import sys
from types import ModuleType

from .from_python import sweep


class _Called(ModuleType):
    """The room and the function share their name: ``fs.sweep(...)`` beside ``freesweep.sweep.spec``."""

    __call__ = staticmethod(sweep)


__wrapped__ = sweep  # for what asks for its signature
sys.modules[__name__].__class__ = _Called
