"""A Numba type that holds one number of each of several designs: the physics, written for one float, runs on it as it
is.

``Lane`` is LLVM's ``<WIDTH x double>``. Its ``+ - * /``, unary minus, comparisons, ``sqrt``, ``abs``, ``min`` and
``max`` are LLVM's own vector operations, lane by lane, so no design can see its neighbours; a float beside a lane
stands for all of them. Comparisons give a ``Mask``, joined by ``& | ~``; where a condition is asked for, a mask is true
if any lane is. :mod:`..either` chooses. Only compiled code knows these types.

Arrays of lanes are plain arrays of shape (n, WIDTH): :func:`get`, :func:`put`. In plain Python
(:mod:`freesweep.interpret`) a vector has one lane, which is a number.
"""

import math
import operator

import numpy as np
from llvmlite import ir
from numba.core import config, types
from numba.core.codegen import get_host_cpu_features
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, lower_cast, models, register_model

from ...interpret import stand_in
from ..either import isnt, select, some


def _width() -> int:
    """Designs per vector: two registers of this machine, whose instructions fill each other's waiting times."""
    features = config.CPU_FEATURES if config.CPU_FEATURES is not None else get_host_cpu_features()
    return 16 if "+avx512f" in features else 8 if "+avx2" in features else 4


WIDTH = _width()
HUGE = 1e300
FLAGS = ("contract",)  # fused multiply-add, as in every kernel
_DOUBLES = ir.VectorType(ir.DoubleType(), WIDTH)
_BITS = ir.VectorType(ir.IntType(1), WIDTH)


class _Lane(types.Type):
    """One float of each design."""

    def can_convert_from(self, typingctx, other):
        """A float, or a whole number, stands for all lanes."""
        return Conversion.unsafe if isinstance(other, types.Float | types.Integer) else None

    def unify(self, typingctx, other):
        """A variable that is once a float and once a lane is a lane."""
        return self if isinstance(other, types.Float | types.Integer) else None


class _Mask(types.Type):
    """One truth of each design."""


lane, mask = _Lane(f"lane{WIDTH}"), _Mask(f"mask{WIDTH}")


@register_model(_Lane)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _DOUBLES)


@register_model(_Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _BITS)


def _spread(builder, value, kind):
    """The same number in all lanes."""
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    places = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), places)


@lower_cast(types.Float, _Lane)
@lower_cast(types.Integer, _Lane)
def _from_number(context, builder, fromty, toty, value):
    return _spread(builder, context.cast(builder, value, fromty, types.float64), _DOUBLES)


def _operation(function, count, result, build):
    """Teach Numba ``function`` of ``count`` lanes, one of which may be a number."""

    @infer_global(function)
    class Operation(AbstractTemplate):
        def generic(self, args, kws):
            lanes = [isinstance(kind, _Lane) for kind in args]
            numbers = all(isinstance(kind, _Lane | types.Float | types.Integer) for kind in args)
            return signature(result, *[lane] * count) if len(args) == count and any(lanes) and numbers else None

    lower_builtin(function, *[_Lane] * count)(lambda context, builder, sig, args: build(builder, *args))


def _intrinsic_call(name):
    """A call of one of LLVM's vector intrinsics."""

    def build(builder, *args):
        full = f"llvm.{name}.v{WIDTH}f64"
        function = builder.module.declare_intrinsic(full, (), ir.FunctionType(_DOUBLES, [_DOUBLES] * len(args)))
        return builder.call(function, args)

    return build


def _extreme(comparison):
    """``a`` where the comparison holds, else ``b``: a NaN gives ``b``, as in Python's min and max of (a, b)."""

    def build(builder, a, b):
        return builder.select(builder.fcmp_ordered(comparison, b, a), b, a)

    return build


for _function, _name in (
    (operator.add, "fadd"), (operator.iadd, "fadd"), (operator.sub, "fsub"), (operator.mul, "fmul"),
    (operator.truediv, "fdiv"),
):  # fmt: skip
    _operation(_function, 2, lane, lambda builder, a, b, name=_name: getattr(builder, name)(a, b, flags=FLAGS))
for _function, _sign in (
    (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
):  # fmt: skip
    _operation(_function, 2, mask, lambda builder, a, b, sign=_sign: builder.fcmp_ordered(sign, a, b))
_operation(operator.neg, 1, lane, lambda builder, a: builder.fneg(a))
_operation(math.sqrt, 1, lane, _intrinsic_call("sqrt"))
_operation(abs, 1, lane, _intrinsic_call("fabs"))
_operation(min, 2, lane, _extreme("<"))
_operation(max, 2, lane, _extreme(">"))


def _mask_operation(function, count, build):
    @infer_global(function)
    class Operation(AbstractTemplate):
        def generic(self, args, kws):
            fits = len(args) == count and all(isinstance(kind, _Mask) for kind in args)
            return signature(mask, *[mask] * count) if fits else None

    lower_builtin(function, *[_Mask] * count)(lambda context, builder, sig, args: build(builder, *args))


_mask_operation(operator.and_, 2, lambda builder, a, b: builder.and_(a, b))
_mask_operation(operator.or_, 2, lambda builder, a, b: builder.or_(a, b))
_mask_operation(operator.invert, 1, lambda builder, a: builder.not_(a))
_mask_operation(isnt, 1, lambda builder, a: builder.not_(a))


@infer_global(bool)
class _Condition(AbstractTemplate):
    def generic(self, args, kws):
        return signature(types.boolean, *args) if isinstance(args[0], _Mask) else None


def _any_lane(builder, where):
    bits = builder.bitcast(where, ir.IntType(WIDTH))
    return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))


lower_builtin(bool, _Mask)(lambda context, builder, sig, args: _any_lane(builder, args[0]))


@infer_global(some)
class _Some(AbstractTemplate):
    def generic(self, args, kws):
        return signature(types.boolean, *args) if isinstance(args[0], _Mask) else None


@infer_global(select)
class _Select(AbstractTemplate):
    def generic(self, args, kws):
        numbers = all(isinstance(kind, _Lane | types.Float | types.Integer) for kind in args[1:])
        return signature(lane, mask, lane, lane) if isinstance(args[0], _Mask) and numbers else None


lower_builtin(some, _Mask)(lambda context, builder, sig, args: _any_lane(builder, args[0]))
lower_builtin(select, _Mask, _Lane, _Lane)(lambda context, builder, sig, args: builder.select(*args))


def _row(context, builder, kind, array, index):
    """Address of the lanes in row ``index`` of a C-ordered (n, WIDTH) array."""
    struct = context.make_array(kind)(context, builder, array)
    start = builder.mul(index, ir.Constant(index.type, WIDTH))
    return builder.bitcast(builder.gep(struct.data, [start]), _DOUBLES.as_pointer())


@intrinsic
def get(typingctx, array, index):
    """The lanes in row ``index`` of an array of shape (n, WIDTH)."""

    def build(context, builder, sig, args):
        place = context.cast(builder, args[1], sig.args[1], types.intp)
        return builder.load(_row(context, builder, sig.args[0], args[0], place), align=8)

    return lane(array, index), build


@intrinsic
def put(typingctx, array, index, value):
    """Write the lanes of row ``index`` of an array of shape (n, WIDTH)."""

    def build(context, builder, sig, args):
        place = context.cast(builder, args[1], sig.args[1], types.intp)
        value = context.cast(builder, args[2], sig.args[2], lane)
        builder.store(value, _row(context, builder, sig.args[0], args[0], place), align=8)
        return context.get_dummy_value()

    return types.void(array, index, value), build


@intrinsic
def spread(typingctx, value):
    """A number in all lanes."""
    return lane(value), lambda context, builder, sig, args: context.cast(builder, args[0], sig.args[0], lane)


@intrinsic
def bits(typingctx, where):
    """The mask as a whole number: bit i is lane i."""

    def build(context, builder, sig, args):
        return builder.zext(builder.bitcast(args[0], ir.IntType(WIDTH)), ir.IntType(64))

    return types.int64(where), build


@intrinsic
def mask_of(typingctx, number):
    """The mask of a whole number: lane i is bit i."""

    def build(context, builder, sig, args):
        return builder.bitcast(builder.trunc(args[0], ir.IntType(WIDTH)), _BITS)

    return mask(types.int64), build


# a vector of one, for the first states of a process
stand_in("WIDTH", WIDTH, 1)
stand_in("get", get, lambda array, index: array[index, 0])
stand_in("put", put, lambda array, index, value: array.__setitem__((index, 0), value))
stand_in("spread", spread, np.float64)
stand_in("bits", bits, int)
stand_in("mask_of", mask_of, lambda number: bool(number & 1))
