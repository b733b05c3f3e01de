"""A Numba type that carries a number of several designs with its change along one direction of what they depend on.

``Tangent`` is a pair of lanes (:mod:`vector`), ``value`` and ``change``, and its arithmetic is that of a first derivative:
the physics, written for one float, gives exact derivatives of what it returns. A lane or a float beside a tangent does not
change. Comparisons and the choices of :mod:`..either` are those of the values.
"""

import math
import operator

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model

from ..either import select
from .vector import _DOUBLES, FLAGS, WIDTH, _intrinsic_call, _Lane, _Mask, lane, mask

_PAIR = ir.LiteralStructType([_DOUBLES, _DOUBLES])


class _Tangent(types.Type):
    """One float of each design, and its change."""

    def unify(self, typingctx, other):
        """A variable that is once a lane, which does not change, and once a tangent is a tangent."""
        return self if isinstance(other, _Lane) else None


tangent = _Tangent(f"tangent{WIDTH}")


@register_model(_Tangent)
class _TangentModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _PAIR)


def _pair(builder, value, change):
    return builder.insert_value(builder.insert_value(ir.Constant(_PAIR, ir.Undefined), value, 0), change, 1)


@lower_cast(_Lane, _Tangent)
def _from_lane(context, builder, fromty, toty, value):
    return _pair(builder, value, ir.Constant(_DOUBLES, [0.0] * WIDTH))


def _parts(builder, kind, number):
    """Value and change of a tangent; of a lane, which does not change, None."""
    if isinstance(kind, _Tangent):
        return builder.extract_value(number, 0), builder.extract_value(number, 1)
    return number, None


def _number(kind):
    """The type that an operand is taken for: floats are lanes. None if it is no number."""
    if isinstance(kind, _Tangent):
        return kind
    return lane if isinstance(kind, _Lane | types.Float | types.Integer) else None


def _operation(function, count, result, build, choice=False):
    """Teach Numba ``function`` of ``count`` numbers, at least one of which is a tangent, after a mask where it is a
    ``choice``; ``build(builder, parts of each)``.
    """
    first = 1 if choice else 0

    @infer_global(function)
    class Operation(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) != first + count or (choice and not isinstance(args[0], _Mask)):
                return None
            own = [_number(kind) for kind in args[first:]]
            if None in own or not any(isinstance(kind, _Tangent) for kind in own):
                return None
            return signature(result, *args[:first], *own)

    def lower(context, builder, sig, args):
        parts = [_parts(builder, kind, number) for kind, number in zip(sig.args[first:], args[first:])]
        return build(builder, *args[:first], *parts)

    kinds = [()]
    for _ in range(count):
        kinds = [(*before, kind) for before in kinds for kind in (_Tangent, _Lane)]
    for own in kinds:
        if _Tangent in own:
            lower_builtin(function, *[_Mask] * first, *own)(lower)


def _sum(name):
    def build(builder, a, b):
        operation = getattr(builder, name)
        value = operation(a[0], b[0], flags=FLAGS)
        if b[1] is None:
            return _pair(builder, value, a[1])
        if a[1] is None:
            return _pair(builder, value, builder.fneg(b[1]) if name == "fsub" else b[1])
        return _pair(builder, value, operation(a[1], b[1], flags=FLAGS))

    return build


def _times(builder, a, b):
    """Product of two lanes; None stands for no change."""
    return builder.fmul(a, b, flags=FLAGS) if a is not None and b is not None else None


def _add(builder, a, b):
    return b if a is None else a if b is None else builder.fadd(a, b, flags=FLAGS)


def _product(builder, a, b):
    change = _add(builder, _times(builder, a[1], b[0]), _times(builder, b[1], a[0]))
    return _pair(builder, builder.fmul(a[0], b[0], flags=FLAGS), change)


def _quotient(builder, a, b):
    """``(a/b)' = (a' - (a/b) b')/b``."""
    value = builder.fdiv(a[0], b[0], flags=FLAGS)
    change = a[1]
    if b[1] is not None:
        less = builder.fmul(value, b[1], flags=FLAGS)
        change = builder.fneg(less) if change is None else builder.fsub(change, less, flags=FLAGS)
    return _pair(builder, value, builder.fdiv(change, b[0], flags=FLAGS))


def _root(builder, a):
    root = _intrinsic_call("sqrt")(builder, a[0])
    twice = builder.fadd(root, root, flags=FLAGS)
    return _pair(builder, root, builder.fdiv(a[1], twice, flags=FLAGS))


def _choose(builder, where, a, b):
    none = ir.Constant(_DOUBLES, [0.0] * WIDTH)
    a, b = ((value, none if change is None else change) for value, change in (a, b))
    return _pair(builder, *(builder.select(where, one, other) for one, other in zip(a, b)))


def _extreme(comparison):
    """As of lanes: ``a`` unless ``b`` compares so with it."""
    return lambda builder, a, b: _choose(builder, builder.fcmp_ordered(comparison, b[0], a[0]), b, a)


def _size(builder, a):
    below = builder.fcmp_ordered("<", a[0], ir.Constant(_DOUBLES, [0.0] * WIDTH))
    return _choose(builder, below, (builder.fneg(a[0]), builder.fneg(a[1])), a)


for _function, _build in (
    (operator.add, _sum("fadd")), (operator.iadd, _sum("fadd")), (operator.sub, _sum("fsub")),
    (operator.mul, _product), (operator.truediv, _quotient), (min, _extreme("<")), (max, _extreme(">")),
):  # fmt: skip
    _operation(_function, 2, tangent, _build)
for _function, _sign in (
    (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
):  # fmt: skip
    _operation(_function, 2, mask, lambda builder, a, b, sign=_sign: builder.fcmp_ordered(sign, a[0], b[0]))
_operation(
    operator.neg, 1, tangent, lambda builder, a: _pair(builder, builder.fneg(a[0]), builder.fneg(a[1]))
)  # fmt: skip
_operation(math.sqrt, 1, tangent, _root)
_operation(abs, 1, tangent, _size)
_operation(select, 2, tangent, _choose, choice=True)


@intrinsic
def join(typingctx, value, change):
    """A tangent of two lanes."""
    return tangent(lane, lane), lambda context, builder, sig, args: _pair(builder, *args)


@intrinsic
def value_of(typingctx, number):
    """The value of a tangent."""
    return lane(tangent), lambda context, builder, sig, args: builder.extract_value(args[0], 0)


@intrinsic
def change_of(typingctx, number):
    """The change of a tangent."""
    return lane(tangent), lambda context, builder, sig, args: builder.extract_value(args[0], 1)
