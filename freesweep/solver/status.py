"""Status of one equilibrium as the kernels write it; ``freesweep.status`` holds the sentences for people."""

OK = 0
DEGENERATE = 1
BEYOND_LIMIT = 2
COMPRESSED = 3
HELD_IMPOSSIBLE = 4
INACCURATE = 5
NOT_CONVERGED = 6
INVALID = 7

PENDING = -1  # not looked at yet; never in a result
