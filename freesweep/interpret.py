"""Kernels in plain Python, for the first few states of a process.

The compiler takes twenty seconds, for physical tubes forty to eighty; a state in plain Python takes two, of a physical tube
six: who asks for one state need not wait. Every kernel has its twin: the same code object, with the twins of all that it
calls. Same formulas in the same order; as multiplications and additions are not fused, numbers differ by rounding, far
within their bounds. Sweeps never do this.

Some states take plain Python minutes: each twin looks at the clock when it is called, and gives up in time.
"""

import sys
import threading
import time
import types

import numpy as np
from numba.core.dispatcher import Dispatcher

from .jit import cache_folder
from .kernel_cache import KernelCache, compiled, stem

FEW, SECONDS = 32, 15.0  # states, and [s] of processor time, in one process: from here on compiling is worth its time
FEWER, LESS = 4, 1.0  # and that of loading its work
NEVER = 1 << 40  # again
_spent = {}  # (awaited entry point, kinds of arguments) -> [states, seconds] in plain Python
_twins, _foretold, _told = {}, set(), set()
_stand_ins = {}  # name -> (thing that only compiled code knows, what twins take for it)
_making = threading.RLock()  # of twins: one that is found knows all its names


class _Clock(threading.local):
    """Of a thread's processor time [s], as a busy machine delays the compiler just as much. Less cheap to ask than the
    clock on the wall, which is not behind it: until that says ``look``, there is no need to.
    """

    end = look = np.inf

    def allow(self, seconds):
        self.end, self.look = time.thread_time() + seconds, time.perf_counter() + seconds

    def check(self):
        left = self.end - time.thread_time()
        if left < 0.0:
            raise _TooLong
        self.look = time.perf_counter() + left


class _TooLong(Exception):
    """Plain Python has had its time."""


_clock = _Clock()


def at_once(states, awaited, entry, *arguments, instead=None) -> bool:
    """Whether the call ``entry(*arguments)`` of an entry point, for so many states, was done without the compiler: in plain
    Python, or by the machine code of this very entry point, if there is any. ``instead``: what the ``awaited`` entry point
    would be called with, if it is another one.

    False, with all arguments as they were, where the ``awaited`` entry point's machine code is at hand, where many states
    are asked for or those asked for take long, fewer and less long if that code need only be loaded, and where plain Python
    raises an error at a number that kernels take for infinite. What serves a tube serves no body, and what serves one
    family of rubbers not the other: code is that for the kinds of the arguments.
    """
    if not isinstance(awaited, Dispatcher):
        return False
    kinds = _kinds(awaited, arguments if instead is None else instead)
    if kinds in awaited.overloads:
        return False
    kept = _is_kept(awaited, kinds)
    most, seconds = (FEWER, LESS) if kept else (FEW, SECONDS)
    spent = _spent.setdefault((awaited, kinds), [0, 0.0])
    spent[0] += states
    if spent[0] <= most and spent[1] < seconds:
        if entry is not awaited and not kept and _has_code(entry, _kinds(entry, arguments)):
            entry(*arguments)
            return True
        if _is_done(entry, arguments, spent, seconds):
            return True
    if spent[0] < NEVER and not kept:
        _tell(_folder(awaited))
    spent[0] = NEVER
    return False


def _kinds(entry, arguments):
    return tuple(map(entry.typeof_pyval, arguments))


def _tell(folder):
    if folder in _told:
        return
    _told.add(folder)
    where = "once for each version" if folder else "in each process, for there is no folder to keep them in"
    print(f"freesweep: compiling the kernels, {where}: half a minute to three", file=sys.stderr)


def _has_code(entry, kinds):
    """Whether there is machine code for arguments of these kinds, in this process or on disk."""
    return kinds in entry.overloads or _is_kept(entry, kinds)


def _is_kept(entry, kinds):
    """Whether machine code for arguments of these kinds need only be loaded."""
    return isinstance(entry._cache, KernelCache) and entry._cache.holds(kinds, entry.targetctx.codegen())


def stand_in(name, thing, plain):
    """Let twins take something ``plain`` for a thing of that name that only compiled code knows."""
    _stand_ins[name] = thing, plain


def run(entry, states, soon, *arguments):
    """Call an entry point, for so many states; ``soon``: without the compiler where that is quicker (:func:`at_once`)."""
    if not (soon and at_once(states, entry, entry, *arguments)):
        entry(*arguments)


def is_at_hand(entry) -> bool:
    """Whether an entry point's machine code is there, or need only be loaded."""
    return isinstance(entry, Dispatcher) and bool(entry.signatures or stem(entry.py_func) in compiled(_folder(entry)))


def foretell(entry):
    """Tell, once, that an entry point about to be called has to be compiled, if it has."""
    if isinstance(entry, Dispatcher) and entry not in _foretold and not is_at_hand(entry):
        _foretold.add(entry)
        _tell(_folder(entry))


def _folder(entry):
    return cache_folder(entry.py_func.__module__.split(".")[1])


def _is_done(entry, arguments, spent, seconds):
    """Whether plain Python did it before ``seconds`` were spent."""
    copies = [argument.copy() if isinstance(argument, np.ndarray) else argument for argument in arguments]
    begun = time.thread_time()
    _clock.allow(seconds - spent[1])
    try:
        with np.errstate(all="ignore"):
            _twin(entry.py_func)(*copies)
    except (ArithmeticError, ValueError, _TooLong):
        return False
    finally:
        spent[1] += time.thread_time() - begun
        _clock.allow(np.inf)
    for argument, copy in zip(arguments, copies):
        if isinstance(argument, np.ndarray):
            argument[...] = copy
    return True


def _twin(function):
    """A kernel's function, whose names stand for the twins of what it calls."""
    with _making:
        if function not in _twins:
            names = {"__builtins__": function.__globals__["__builtins__"]}
            plain = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)

            def twin(*arguments):
                if time.perf_counter() > _clock.look:
                    _clock.check()
                return plain(*arguments)

            _twins[function] = twin
            known = function.__globals__  # its own name may be among them
            names.update({name: _plain(known[name], name) for name in function.__code__.co_names if name in known})
        return _twins[function]


def _plain(thing, name=None):
    own, plain = _stand_ins.get(name, (None, None))
    if own is not None and thing is own:
        return plain
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
        twin = _plain(getattr(self._module, name), name)
        setattr(self, name, twin)
        return twin
