"""Kernels in plain Python, where their compilation would take a test longer than the few states that it solves."""

import numpy as np

from freesweep import interpret


def plain(*kernels):
    """Twins of kernels, or of modules of kernels: the same code, called from Python with functions of Python's."""
    return [interpret._plain(one) for one in kernels]


def as_kernels_divide():
    """As in machine code, a division by zero gives infinity or NaN and no warning."""
    return np.errstate(all="ignore")


def by_what_there_is(entry, arguments):
    """A call of an entry point by its machine code, if there is any for such arguments, else in plain Python."""
    if interpret._has_code(entry, interpret._kinds(entry, arguments)):
        entry(*arguments)
        return True
    return interpret._is_done(entry, arguments, [0, 0.0], 3000.0)
