"""Kernels hand tuples of arrays on, to one another and back: the numbers are those of Python, and no array stays behind.

What one entry point made of a kernel is its own.
"""

import sys
from typing import NamedTuple

import numba
import numpy as np
from numba.core.runtime import _nrt_python, rtsys

from freesweep.interpret import _twin
from freesweep.jit import kernel


class Pair(NamedTuple):
    one: np.ndarray
    other: np.ndarray


@kernel
def grown(pair, count):
    """A pair with an array of its own, and a part of what it was given."""
    one, other = pair
    made = np.zeros(count)
    made[0] = one[0] + pair.other[1]
    return Pair(made, pair.one), other


@kernel
def exchanged(both, turned):
    """Arguments that are given a new value, parts of parts, arrays that loops replace."""
    pair, (left, right) = both
    if turned:
        pair = Pair(right, left)
    now = pair
    for k in range(3):
        new, kept = grown(now, 4 + k)
        now = new
    return now, kept, both[1]


@kernel
def followed(one, other, out):
    pair = Pair(one, other)
    for k in range(len(out)):
        now, kept, both = exchanged((pair, (one, other)), k % 2 == 0)
        part = now.one[1:]
        out[k] = now.one[0] + now.other[0] + kept[0] + both[1][0] + part[0]
        pair = Pair(now.one, kept) if k == 2 else Pair(kept, other)


def held():
    """Blocks of memory that compiled code holds."""
    now = rtsys.get_allocation_stats()
    return now.alloc - now.free, now.mi_alloc - now.mi_free


def test_kernels_count_the_holders_of_arrays_right():
    one, other, out, plain = np.arange(4.0) + 1.0, np.arange(3.0) + 10.0, np.zeros(5), np.zeros(5)
    _twin(followed.py_func)(one, other, plain)
    followed(one, other, out)
    holders = sys.getrefcount(one), sys.getrefcount(other)
    _nrt_python.memsys_enable_stats()
    try:
        before = held()
        for _ in range(100):
            followed(one, other, out)
        assert held() == before
    finally:
        _nrt_python.memsys_disable_stats()
    assert (sys.getrefcount(one), sys.getrefcount(other)) == holders
    assert np.array_equal(out, plain)
    assert out[0] > 0.0


@kernel
def total(values, first, unused):
    """LLVM drops what is not used, and cannot put in everywhere what calls itself."""
    return 0.0 if first == len(values) else values[first] + total(values, first + 1, unused)


@kernel
def asked(values):
    return total(values, 0, 7.0)


@numba.njit
def asked_by_another(values):
    return total(values, 0, 7.0)


def test_what_an_entry_point_made_of_a_kernel_no_other_code_calls():
    values = np.arange(9.0)
    assert asked(values) == asked_by_another(values) == 36.0
