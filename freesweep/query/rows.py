"""Weighted sums of rows of a table, eight numbers at a time: LLVM makes no vectors of such short loops by itself."""

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

ROW = 8  # numbers: two nodes of four
FLAGS = ("contract",)  # fused multiply-add, as in every kernel
_ROW = ir.VectorType(ir.DoubleType(), ROW)


@intrinsic
def weigh_rows(typingctx, table, offsets, weights, count, near_offsets, near_weights, near, apart, out):
    """Sum of rows of ``table`` and of those ``apart`` from them, weighed, into ``out`` (2 ROW,).

    Rows begin at each of ``offsets`` (count,) plus each of ``near_offsets`` (near,); their weights are multiplied. All
    arrays are contiguous, offsets whole numbers of 64 bits.
    """

    def build(context, builder, sig, args):
        table, offsets, weights, near_offsets, near_weights, out = (
            context.make_array(sig.args[k])(context, builder, args[k]).data for k in (0, 1, 2, 4, 5, 8)
        )
        count, near, apart = args[3], args[6], args[7]
        zero = ir.Constant(_ROW, [0.0] * ROW)
        sums = [cgutils.alloca_once_value(builder, zero) for _ in range(2)]
        parts = [cgutils.alloca_once(builder, _ROW) for _ in range(2)]

        def add(total, weight, numbers):
            first = builder.insert_element(ir.Constant(_ROW, ir.Undefined), weight, ir.Constant(ir.IntType(32), 0))
            places = ir.Constant(ir.VectorType(ir.IntType(32), ROW), [0] * ROW)
            all_equal = builder.shuffle_vector(first, ir.Constant(_ROW, ir.Undefined), places)
            product = builder.fmul(all_equal, numbers, flags=FLAGS)
            builder.store(builder.fadd(builder.load(total), product, flags=FLAGS), total)

        def item(array, index):
            return builder.load(builder.gep(array, [index]))

        with cgutils.for_range(builder, count) as outer:
            begin = item(offsets, outer.index)
            for part in parts:
                builder.store(zero, part)
            with cgutils.for_range(builder, near) as inner:
                place, weight = builder.add(begin, item(near_offsets, inner.index)), item(near_weights, inner.index)
                for part in parts:
                    row = builder.bitcast(builder.gep(table, [place]), _ROW.as_pointer())
                    add(part, weight, builder.load(row, align=8))
                    place = builder.add(place, apart)
            for total, part in zip(sums, parts, strict=True):
                add(total, item(weights, outer.index), builder.load(part))
        for k, total in enumerate(sums):
            row = builder.bitcast(builder.gep(out, [ir.Constant(ir.IntType(64), k * ROW)]), _ROW.as_pointer())
            builder.store(builder.load(total), row, align=8)
        return context.get_dummy_value()

    return types.void(table, offsets, weights, count, near_offsets, near_weights, near, apart, out), build
