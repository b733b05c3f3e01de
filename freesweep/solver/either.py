"""Choices that are written once for a float and for a vector of designs (:mod:`.lanes.vector`), whose truths are masks.

Join truths by ``&`` and ``|``, turn them by :func:`isnt`: Python's ``~`` of a truth is a number. Each of the two that
:func:`select` chooses from is worked out; what is dear stands behind ``if some(...)``.
"""

from numba.core import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin


def select(where, yes, no):
    """``yes`` where it is true, else ``no``."""
    return yes if where else no


def some(where):
    """Whether it is true anywhere."""
    return bool(where)


def isnt(where):
    """Where it is not true."""
    return not where


@infer_global(select)
class _Select(AbstractTemplate):
    def generic(self, args, kws):
        numbers = all(isinstance(kind, types.Float | types.Integer) for kind in args[1:])
        fits = len(args) == 3 and isinstance(args[0], types.Boolean) and numbers
        return signature(types.float64, types.boolean, types.float64, types.float64) if fits else None


class _OfTruth(AbstractTemplate):
    def generic(self, args, kws):
        return signature(types.boolean, types.boolean) if isinstance(args[0], types.Boolean) else None


lower_builtin(select, types.Boolean, types.Float, types.Float)(
    lambda context, builder, sig, args: builder.select(*args)
)
for _function, _build in ((some, lambda builder, a: a), (isnt, lambda builder, a: builder.not_(a))):
    infer_global(_function)(type("_Truth", (_OfTruth,), {}))
    lower_builtin(_function, types.Boolean)(lambda context, builder, sig, args, build=_build: build(builder, *args))
