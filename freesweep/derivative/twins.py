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
                known = function.__globals__[name]
                inner = _function(known)
                names[name] = known if inner is None else _twin(inner, instead, made)
    return made[function]
