"""Kernels in plain Python, where their compilation would take a test longer than the few states that it solves."""

import numpy as np

from freesweep import interpret


def plain(*kernels):
    """Twins of kernels, or of modules of kernels: the same code, called from Python with functions of Python's."""
    return [interpret._plain(one) for one in kernels]


def as_kernels_divide():
    """As in machine code, a division by zero gives infinity or NaN and no warning."""
    return np.errstate(all="ignore")
