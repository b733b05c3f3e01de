"""What is kept of each distinct state, dimensionless: one record, the same in memory and on disk."""

import numpy as np

FREE_STATE = np.dtype([("values", "<f8", 5), ("bounds", "<f4", 5), ("status", "i1"), ("slack", "i1")])
LIMIT = np.dtype([("limit", "<f8"), ("bound", "<f8")])  # of each problem
HELD_STATE = np.dtype([("value", "<f8"), ("bound", "<f4"), ("status", "i1"), ("stable", "i1")])


def state(kind) -> np.dtype:
    """The record of a state of one kind."""
    return FREE_STATE if kind == "free" else HELD_STATE


def upward(bound):
    """An error bound in single precision, rounded up: it still holds."""
    single = bound.astype(np.float32)
    single.view(np.int32)[...] += single < bound  # the next number up, of positive ones
    return single


def unsolved(dtype, status):
    """A record of nothing but its status."""
    record = np.zeros((), dtype)
    for name in set(dtype.names) & {"values", "bounds", "value", "bound", "limit"}:
        record[name] = np.nan
    if "status" in dtype.names:
        record["status"] = status
    return record
