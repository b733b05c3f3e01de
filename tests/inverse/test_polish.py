"""The way down from starts: bounded steps that learn from those that did not help."""

from types import SimpleNamespace

import numpy as np

from freesweep.inverse.polish import polish
from freesweep.inverse.predict import Predicted


class Cliff:
    """A misfit in one number whose slope leads over a cliff: beyond ``edge`` there is no state."""

    space = SimpleNamespace(is_source=True)
    is_quick = True

    def __init__(self, edge):
        self.edge, self.seen = edge, []

    def at(self, u, choice, thorough=True, near=None):
        self.seen += [x for x in u[:, 0].tolist() if x not in self.seen]  # what is asked again is no new step
        values = np.where(u < self.edge, 10.0 * (self.edge - u) + 1.0, np.nan)
        none = np.zeros_like(values)
        return Predicted(values, none, none, none, np.ones_like(values), none[:, 0]), values

    def slopes(self, u, choice, found, on_meshes=None):
        return np.full((len(u), 1, 1), -10.0)

    def ahead(self, found, slopes, step):
        return found


def test_a_step_that_leads_nowhere_is_halved():
    """One that is cut to the longest one would be cut to it again, however damped it is."""
    cliff = Cliff(edge=0.351)
    u, *_ = polish(cliff, np.array([[0.1]]), np.zeros(1, int))
    beyond = np.array(cliff.seen[1:])  # the first step leads to 0.3
    turn = np.flatnonzero(beyond < cliff.edge)[0]
    assert turn < 4
    assert 0.35 < u.item() < 0.351


class Shallow(Cliff):
    """As that, of which vectors tell nothing beyond 0.15."""

    def __init__(self):
        super().__init__(edge=1.0)
        self.quick = []

    def at(self, u, choice, thorough=True, near=None):
        found, missed = super().at(u, choice)
        if not thorough:
            self.quick += u[:, 0].tolist()
            found.values[u > 0.15] = np.nan
        return found, np.where(np.isnan(found.values), np.nan, missed)


def test_vectors_do_not_search_again_for_what_they_did_not_tell():
    """In vain they take a hundred times as long as meshes."""
    shallow = Shallow()
    u, *_ = polish(shallow, np.array([[0.1], [0.2]]), np.zeros(2, int))
    assert np.all(u > 0.99)
    assert [x > 0.15 for x in shallow.quick].count(True) == 2  # once for each design
