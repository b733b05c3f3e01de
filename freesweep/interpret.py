"""Kernels in plain Python, for the first few states of a process.

The compiler takes twenty seconds, a state in plain Python a tenth of one: who asks for one state need not wait. Every
kernel has its twin: the same code object, with the twins of all that it calls. Same formulas in the same order; as
multiplications and additions are not fused, numbers differ by rounding, far within their bounds. Sweeps never do this.
"""

import sys
import types
from pathlib import Path

import numpy as np
from numba.core.dispatcher import Dispatcher

from .jit import cache_folder

FEW = 32  # states in one process: from here on the compiler's time is well spent
FEWER = 4  # and that of loading its work
NEVER = 1 << 40  # again
_spent = [0]
_twins = {}


def at_once(states, awaited, entry, *arguments) -> bool:
    """Whether the call ``entry(*arguments)`` of an entry point, for so many states, was done in plain Python.

    False, with all arguments as they were, where the ``awaited`` entry point's machine code is at hand, where many states
    are asked for, fewer if that code need only be loaded, and where plain Python raises an error at a number that kernels
    take for infinite.
    """
    if not isinstance(awaited, Dispatcher) or awaited.signatures:
        return False
    on_disk = _on_disk(awaited)
    _spent[0] += states
    if _spent[0] > (FEWER if on_disk else FEW):
        if not on_disk and _spent[0] < NEVER:
            print("freesweep: compiling the kernels, once for each version: half a minute", file=sys.stderr)
        _spent[0] = NEVER
        return False
    copies = [argument.copy() if isinstance(argument, np.ndarray) else argument for argument in arguments]
    try:
        with np.errstate(all="ignore"):
            _twin(entry.py_func)(*copies)
    except (ArithmeticError, ValueError):
        return False
    for argument, copy in zip(arguments, copies):
        if isinstance(argument, np.ndarray):
            argument[...] = copy
    return True


def _on_disk(entry):
    """Whether machine code of an entry point need only be loaded."""
    function = entry.py_func
    room = Path(cache_folder(function.__module__.split(".")[1]))
    return any(room.rglob(f"{function.__module__.rpartition('.')[2]}.{function.__name__}-*.nbc"))


def _twin(function):
    """A kernel's function, whose names stand for the twins of what it calls."""
    if function not in _twins:
        names = {"__builtins__": function.__globals__["__builtins__"]}
        _twins[function] = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)
        known = function.__globals__  # its own name may be among them
        names.update({name: _plain(known[name]) for name in function.__code__.co_names if name in known})
    return _twins[function]


def _plain(thing):
    if isinstance(thing, Dispatcher):
        return _twin(thing.py_func)
    if isinstance(thing, types.ModuleType) and thing.__name__.startswith(__package__):
        return _Twins(thing)
    return thing


class _Twins:
    """A module of kernels, each made plain when it is asked for."""

    def __init__(self, module):
        self._module = module

    def __getattr__(self, name):
        twin = _plain(getattr(self._module, name))
        setattr(self, name, twin)
        return twin
