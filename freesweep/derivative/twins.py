"""The solver's kernels over dual numbers: the same code objects, whose arithmetic is that of :mod:`dual`."""

import types

from numba.core.dispatcher import Dispatcher

from . import dual

ARITHMETIC = {"sqrt": dual.sqrt, "max": dual.maximum, "min": dual.minimum, "abs": dual.absolute}


def twin(kernel, **instead):
    """A kernel's twin, and those of all that it calls; ``instead`` names what takes the place of some of these."""
    return _twin(_function(kernel), {**ARITHMETIC, **instead}, {})


def _function(thing):
    """The function of a kernel, compiled or, where compiling is off, plain; None of anything else."""
    if isinstance(thing, Dispatcher):
        return thing.py_func
    own = isinstance(thing, types.FunctionType) and thing.__module__.startswith("freesweep.solver")
    return thing if own else None


def _twin(function, instead, made):
    if function not in made:
        names = {"__builtins__": function.__globals__["__builtins__"]}
        made[function] = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)
        for name in function.__code__.co_names:
            if name in instead:
                names[name] = instead[name]
            elif name in function.__globals__:
                names[name] = _plain(function.__globals__[name], instead, made)
    return made[function]


def _plain(thing, instead, made):
    """What stands for a name of a kernel's."""
    if isinstance(thing, types.ModuleType) and thing.__name__.startswith("freesweep.solver"):
        return _Twins(thing, instead, made)
    inner = _function(thing)
    return thing if inner is None else _twin(inner, instead, made)


class _Twins:
    """A module of kernels, each made dual when it is asked for."""

    def __init__(self, module, instead, made):
        self._module, self._instead, self._made = module, instead, made

    def __getattr__(self, name):
        return _plain(getattr(self._module, name), self._instead, self._made)
