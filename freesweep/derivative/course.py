"""What varies along a tube, at any places x/l: the course of the solver, read by place and not by cell."""

import numpy as np


class Course:
    """H, D and a along a tube, as :func:`freesweep.statics.read_course` gives them; ``places`` x/l where pieces meet."""

    def __init__(self, course, places):
        self.course, self.places = course, np.asarray(places) / places[-1]

    def at(self, share):
        """H, D and a at places x/l inside of segments, each (n,)."""
        segments, pieces = self.course.shape[:2]
        s = np.clip(np.searchsorted(self.places, share, side="right") - 1, 0, segments - 1)
        at = (share - self.places[s]) / (self.places[s + 1] - self.places[s]) * pieces
        piece = np.clip(at.astype(int), 0, pieces - 1)
        t = (at - piece)[:, None]
        a = self.course[s, piece]
        return tuple((a[..., 0] + t * (a[..., 1] + t * (a[..., 2] + t * a[..., 3]))).T)
