"""Whether the compiler is at work: what a page that waits for the solver says."""

import time

from numba.core import event

EVENT = "numba:compile"  # not of code that is only loaded
PAUSE = 2.0  # [s]: what begins again sooner goes on


class Compiling(event.Listener):
    """Hears of the compiler in this process until it is closed; ``seconds`` it has been at work, None while it is not."""

    def __init__(self):
        self._depth, self._begun, self._ended = 0, 0.0, -PAUSE
        event.register(EVENT, self)

    def on_start(self, _):
        """Called under the compiler's lock, one of a nest of kernels after the other."""
        if not self._depth and time.monotonic() - self._ended > PAUSE:
            self._begun = time.monotonic()
        self._depth += 1

    def on_end(self, _):
        """Called under the same lock."""
        self._depth -= 1
        self._ended = time.monotonic()

    @property
    def seconds(self) -> float | None:
        """How long the compiler has been at work [s]."""
        now = time.monotonic()
        return now - self._begun if self._depth or now - self._ended < PAUSE else None

    def close(self):
        """Hear no more."""
        event.unregister(EVENT, self)
