"""From outputs as dual numbers to a table of outputs and derivatives, where a load holds something, too."""

import numpy as np

from .physics import OWN


def rows_of(made, names, count):
    """Values and parts (outputs, 1 + count, n) of dual numbers over n states, by name."""
    rows = []
    for name in names:
        value, parts = made[name].value, made[name].parts
        n = len(value) if parts is None else max(len(value), parts.shape[1])
        own = np.zeros((count, n)) if parts is None else np.broadcast_to(parts[OWN:], (count, n))
        rows.append(np.concatenate([np.broadcast_to(value, (1, n)), own]))
    return np.array(rows)


class Held:
    """What an output that is ``held`` makes of derivatives with nothing held: the load that holds it, ``unknown``, whose own
    derivatives come first, changes with each parameter so that what is held stays, or moves as ``tied`` says.
    """

    def __init__(self, held, unknown, parameters, names, seeds, tied):
        self.parameters, self.names, self.seeds = parameters, names, seeds
        self.held, self.unknown, self.tied = held, unknown, tied
        self.outputs = [unknown, *(name for name in names if name != held)]

    def at(self, rows):
        """Value of what is held, and its derivative by the load that holds it, (n,) each."""
        own = rows[self.names.index(self.held)]
        return own[0], own[1]

    def load_by(self, rows, bounds):
        """Derivatives of the load by each parameter, and their bounds: name -> (n,)."""
        own, doubt = (array[self.names.index(self.held)] for array in (rows, bounds))
        by, about = {self.held: 1.0 / own[1]}, {self.held: doubt[1] / own[1] ** 2}
        for k, name in enumerate(self.seeds[1:]):
            by[name] = (float(self.tied and name == "length") - own[2 + k]) / own[1]
            about[name] = (doubt[2 + k] + np.abs(by[name]) * doubt[1]) / np.abs(own[1])
        return by, about

    def table(self, load, rows, bounds):
        """``rows`` and ``bounds`` (outputs, 1 + seeds, n) of states under the ``load`` (n,) become those of the held ones:
        (outputs, 1 + parameters, n).
        """
        by, about = self.load_by(rows, bounds)
        values, doubts = [], []
        for output in self.outputs:
            if output == self.unknown:
                values.append([load, *(by[name] for name in self.parameters)])
                doubts.append([0.0 * load, *(about[name] for name in self.parameters)])
                continue
            own, doubt = (array[self.names.index(output)] for array in (rows, bounds))
            value, unsure = [own[0]], [doubt[0]]
            for name in self.parameters:
                k = None if name == self.held else 1 + self.seeds.index(name)
                value.append((0.0 if k is None else own[k]) + own[1] * by[name])
                unsure.append(
                    (0.0 if k is None else doubt[k]) + np.abs(own[1]) * about[name] + doubt[1] * np.abs(by[name])
                )
            values.append(value)
            doubts.append(unsure)
        return np.array(values), np.array(doubts)
