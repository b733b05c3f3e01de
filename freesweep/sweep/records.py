"""What is kept of each distinct state, dimensionless: one record, the same in memory and on disk."""

import numpy as np

from ..scaling import ALONG, OUTPUTS, SLACK
from ..status import NOT_CONVERGED


def _free_state(count):
    return np.dtype([("values", "<f8", count), ("bounds", "<f4", count), ("status", "i1"), ("slack", "i1")])


FREE_STATE, PHYSICAL_STATE = _free_state(len(OUTPUTS)), _free_state(len(OUTPUTS) + len(ALONG))
LIMIT = np.dtype([("limit", "<f8"), ("bound", "<f8")])  # of each problem
HELD_STATE = np.dtype([("value", "<f8"), ("bound", "<f4"), ("status", "i1"), ("stable", "i1")])
PHYSICAL_HELD = np.dtype([*HELD_STATE.descr, ("slack", "<f8", len(SLACK)), ("slack_bound", "<f4", len(SLACK))])


def state(kind, physical) -> np.dtype:
    """The record of a state of one kind, of the source's tubes or of physical ones."""
    if kind != "free":
        return PHYSICAL_HELD if physical else HELD_STATE
    return PHYSICAL_STATE if physical else FREE_STATE


def upward(bound):
    """An error bound in single precision, rounded up: it still holds."""
    single = bound.astype(np.float32)
    single.view(np.int32)[...] += single < bound  # the next number up, of positive ones
    return single


def unsolved(dtype, status):
    """A record of nothing but its status."""
    record = np.zeros((), dtype)
    for name in set(dtype.names) & {"values", "bounds", "value", "bound", "slack_bound", "limit"}:
        record[name] = np.nan
    if "status" in dtype.names:
        record["status"] = status
    return record


class Records:
    """Records of one type, read from its shards where they are needed.

    ``parts`` are the problems (first, last + 1) of each shard, ``first`` where each problem's states begin, ``paths`` the
    files, None where a shard killed its workers; ``contents`` gives the bytes of a file.
    """

    def __init__(self, dtype, parts, first, paths, contents):
        self.dtype, self.paths, self.contents = dtype, paths, contents
        self.problems = np.array([a for a, _ in parts] + [parts[-1][1] if parts else 0], np.int64)
        self.rows = first[self.problems]

    def states(self, rows):
        """Records of states ``rows``, of any shape."""
        return self._read(rows, self.rows, self.dtype, np.zeros(len(self.paths), np.int64))

    def limits(self, problems):
        """Records of the limits of ``problems`` (n,)."""
        return self._read(problems, self.problems, LIMIT, np.diff(self.rows) * self.dtype.itemsize)

    def _read(self, numbers, edges, dtype, starts):
        """Records of that type with those ``numbers``; a shard holds those between two ``edges``, from a byte on."""
        wanted, index = np.unique(numbers, return_inverse=True)
        whole = np.dtype((np.void, dtype.itemsize))  # records move as a whole: field by field takes ten times as long
        found = np.empty(len(wanted), whole)
        cuts = np.searchsorted(wanted, edges)
        for shard in np.flatnonzero(np.diff(cuts)).tolist():
            mine = slice(cuts[shard], cuts[shard + 1])
            if self.paths[shard] is None:
                found[mine] = unsolved(dtype, NOT_CONVERGED).view(whole)
                continue
            count = int(edges[shard + 1] - edges[shard])
            content = self.contents[self.paths[shard]]
            found[mine] = np.frombuffer(content, whole, count, int(starts[shard]))[wanted[mine] - edges[shard]]
        return found[index.reshape(np.shape(numbers))].view(dtype)
