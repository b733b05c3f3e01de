"""What the machine itself can do: multiplications and additions per second, and what one cell of the solver's mesh costs.

The peak is that of a loop of multiply-adds on independent vector registers, nothing else. A Newton pass is what the
solver repeats: on each cell the density and its derivatives, their assembly, and the factors of a tridiagonal matrix.
"""

import time

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from ..jit import kernel
from ..solver.lanes.vector import WIDTH
from ..solver.load import Load
from ..solver.numerics import newton
from ..solver.physics import lagrangian

CHAINS = (
    12  # independent multiply-adds under way: more than latency times units of any machine yet, fewer than registers
)
CELLS, PASSES = 96, 500  # of a mesh, timed at once
TUBE, RUBBER = (0.1, 0.6, 0.7), (0.5, 0.0, 0.0)  # any: a pass takes the same time
LOAD = Load(1.0, RUBBER, (1.0,), 1.0, 0.0, 0.0, 1.0)
EXTRA = 36  # flops of a cell beside its density: newton.assemble, factor, substitute


def vector_width() -> int:
    """Doubles in one register of the processor that is compiled for: vectors of designs take two."""
    return WIDTH // 2


@intrinsic
def multiply_add_loop(typingctx, count, factor, term):
    """``count`` times CHAINS vectors ``v = v factor + term``; returns one of their numbers."""
    width = vector_width()
    vector = ir.VectorType(ir.DoubleType(), width)

    def build(context, builder, sig, args):
        count, factor, term = args

        def spread(number):
            value = ir.Constant(vector, ir.Undefined)
            for k in range(width):
                value = builder.insert_element(value, number, ir.Constant(ir.IntType(32), k))
            return value

        factors, terms = spread(factor), spread(term)
        # fused where the target's processor fuses
        fma = builder.module.declare_intrinsic(f"llvm.fmuladd.v{width}f64", (), ir.FunctionType(vector, [vector] * 3))
        before, loop = builder.block, builder.append_basic_block("loop")
        after = builder.append_basic_block("after")
        builder.branch(loop)
        builder.position_at_end(loop)
        index = builder.phi(count.type)
        index.add_incoming(ir.Constant(count.type, 0), before)
        chains = [builder.phi(vector) for _ in range(CHAINS)]
        for chain in chains:
            chain.add_incoming(terms, before)
            chain.add_incoming(builder.call(fma, [chain, factors, terms]), loop)
        following = builder.add(index, ir.Constant(count.type, 1))
        index.add_incoming(following, loop)
        builder.cbranch(builder.icmp_signed("<", following, count), loop, after)
        builder.position_at_end(after)
        total = chains[0]
        for chain in chains[1:]:
            total = builder.fadd(total, chain)
        return builder.extract_element(total, ir.Constant(ir.IntType(32), 0))

    return types.float64(types.int64, types.float64, types.float64), build


@kernel
def multiply_adds(count):
    """Work for the peak: 2 CHAINS width flops, ``count`` times."""
    return multiply_add_loop(count, 0.999999, 1e-6)


def peak(seconds=0.05, repeats=5) -> float:
    """Flops per second of one core, a multiply-add counted as two; the best of the repeats."""
    count, taken = 1000, 0.0
    while taken < seconds:
        count *= 4
        taken = _time(multiply_adds, count)
    return 2.0 * CHAINS * vector_width() * count / min(_time(multiply_adds, count) for _ in range(repeats))


def _time(run, *arguments):
    begun = time.thread_time()
    run(*arguments)
    return time.thread_time() - begun


@kernel
def passes(count, x, y, cells, load, work):
    """That many Newton passes at the same state."""
    n, own = len(x) - 1, newton.system_in(work)
    total = 0.0
    for _ in range(count):
        newton.assemble(lagrangian.density, x, y, n, cells, load, False, own)
        newton.factor(own.d, own.e, 1, n, own.inverse)
        newton.substitute(own.inverse, own.e, 1, n, own.g, own.step)
        total += own.step[n]
    return total


def cell_time(repeats=5) -> float:
    """Seconds for one cell in one Newton pass of the scalar kernel."""
    x = np.linspace(0.0, 10.0, CELLS + 1)
    y, work = 1.0 + 0.2 * (1.0 - np.exp(-x)), np.zeros((13, CELLS + 2))
    return median_time(passes, repeats, x, y, np.array([TUBE]), LOAD, work) / (PASSES * CELLS)


def median_time(run, repeats, *arguments) -> float:
    """Median seconds of PASSES Newton passes."""
    run(1, *arguments)  # compiles
    return float(np.median([_time(run, PASSES, *arguments) for _ in range(repeats)]))
