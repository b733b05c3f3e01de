"""Kernels that become part of who calls them, with all that they call: then nothing is worked out that no one looks at.

A density gives six numbers, of which derivatives need two. Three times as fast for that, and a few seconds of compiling.
"""

import types

from numba.core import config
from numba.core.dispatcher import Dispatcher

from ...jit import kernel


def inlined(own, made=None):
    """A kernel's twin: the same code, compiled into its callers."""
    if config.DISABLE_JIT:
        return own
    made = {} if made is None else made
    function = own.py_func
    if function not in made:
        known = function.__globals__
        names = {"__builtins__": known["__builtins__"], "__name__": known["__name__"]}
        twin = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)
        made[function] = kernel(twin, forceinline=True)
        # its own name may be among them
        names.update({name: _plain(known[name], made) for name in function.__code__.co_names if name in known})
    return made[function]


def _plain(thing, made):
    """What stands for a name of a kernel's."""
    if isinstance(thing, Dispatcher):
        return inlined(thing, made)
    if isinstance(thing, types.ModuleType) and thing.__name__.startswith("freesweep.solver"):
        return _Twins(thing, made)
    return thing


class _Twins(types.ModuleType):
    """A module of kernels, each made when it is asked for."""

    def __init__(self, module, made):
        super().__init__(module.__name__)
        self._module, self._made = module, made

    def __getattr__(self, name):
        return _plain(getattr(self._module, name), self._made)
