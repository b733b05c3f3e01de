"""Held rotations of tubes that are their own mirror image, as waves: a body, which may have a neck towards each end.

From a state that meshes hold at a share of all loads, which rise in proportion, the branch is followed to all of them.
Fronts between body and neck, which get steeper all the way, need no mesh.
"""

import numpy as np

from ...interpret import foretell
from ..held.sought import FROM_REST, valued
from ..problem import FORCE, GAMMA, LENGTH
from ..stability import PUSHED
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, OK, PENDING
from .branch import ALONG, Point, toward
from .held_branch import reach, seated
from .told import SURE, doubt_of_turn, refined, told_of
from .waves import CENTER, PRESSURE, SIDES, Waves

# of the loads, at which a branch is entered: the less of them, the less steep are fronts; how often an interval is halved
LEAST_SHARE, HALVINGS = 1.0 / 128.0, 4
STATIONS = np.linspace(0.0, 1.0, 129) ** 2  # of half a tube, at which its shape is looked at: necks are at its end
TALL = 3.0  # times the fibers' extension, to which a body without necks is otherwise alike
LEAST_NECK = 1e-2  # of the body's height: waves have hardly a digit of less
ALIKE = 1e-4  # scaled: by what a state may differ from that of meshes
FAINT, SURE_LIMIT = 1e-3, 1e-2  # a wave that is next to none; how far off a limit may be


class Held(Waves):
    """Waves of a tube whose rotation is held at none, while pressure, force and fiber extension - 1 rise in proportion, to
    the pressure ``most``: a body on the first of the ``sides``, with necks on the other one. The torque counts in a
    ``unit``, to the other loads.
    """

    counts, order, centered = np.array([1.0, 2.0]), (1, 0), False

    def __init__(self, problem, most, sides, unit):
        super().__init__(problem, 0.0)
        self.most, self.sides, self.unit = most, sides, unit
        foretell(self.measure)

    def train(self, numbers):
        return super().train(numbers)._replace(sides=self.sides, centered=False)

    def loads(self, numbers):
        p = np.exp(numbers[PRESSURE])
        share = p / self.most
        f = share * self.problem[FORCE]
        return p, f, 1.0 + share * (self.problem[GAMMA] - 1.0), numbers[CENTER] * self.unit * max(p, abs(f))


def at_share(problem, share):
    """The problem with that share of its loads and of its fiber extension."""
    part = problem.copy()
    part[FORCE], part[GAMMA] = share * part[FORCE], 1.0 + share * (part[GAMMA] - 1.0)
    return part


def enter(problem, pressure, share, seed):
    """``(waves, first Point)`` of the branch through a state at that share of the loads, of which meshes told the ``seed``;
    None where waves have no such state.
    """
    y, values, torque = seed.profiles[0, 0], seed.states.values[0], seed.loads[0]
    side = 0 if values[4] > 1.0 else 1
    outward = SIDES[side]
    neck = np.argmin(outward * y)
    if outward * (1.0 - y[neck]) < LEAST_NECK * abs(values[4] - 1.0):
        return None
    p = share * pressure
    number = torque / max(p, share * abs(problem[FORCE]))
    unit = max(abs(number), 1.0)
    asked = Held(problem, pressure, SIDES[[side, 1 - side]], unit)
    after = neck + np.argmax(outward * (y[neck:] - 1.0) > 0.0)
    part = (y[after] - 1.0) / (y[after] - y[after - 1])
    crossing = asked.half * (STATIONS[after] - part * (STATIONS[after] - STATIONS[after - 1]))
    train = asked.train([0.0, 0.0, number / unit, np.log(p)])
    train = seated(asked, train, 0, values[4], asked.half - crossing)
    train = seated(asked, train, 1, y[neck], 0.5 * crossing)
    along = np.zeros(len(train.numbers))
    along[PRESSURE] = 1.0
    solved = asked.solve(train, along, np.log(p), ALONG)
    if solved is None:
        return None
    look, _ = solved
    found = np.array([*look.values[:4], look.told[0, 4], look.values[4]])
    known = np.array([*values[:5], torque])
    scales = np.array([asked.half, values[1], 1.0, max(abs(values[3]), p * values[1]), 1.0, max(p, abs(torque))])
    if not np.all(np.abs(found - known) <= ALIKE * scales):
        return None
    return asked, Point(look, toward(look, along))


def held_of(problem, pressure, find, accuracy, stations):
    """``(status, State or None, by which way meshes came to the branch)`` of the tube whose rotation is held at none,
    PENDING where waves do not tell; ``find`` tells states by meshes, of a problem under a pressure, with profiles at
    stations.

    The branch is entered at about the least share of the loads at which there are necks. Where none comes before meshes
    have trouble, what gives it is no neck: nor does one come soon where a body alone is much higher than fibers extend, as
    it may be where they are slack.
    """
    low, share, high, halvings, tall = 0.0, LEAST_SHARE, np.inf, 0, False
    while halvings <= HALVINGS and low < share < high:
        part = at_share(problem, share)
        seed = find(part, share * pressure, 0.5 * problem[LENGTH] * STATIONS)
        if valued(seed.status[0]):
            entered = enter(problem, pressure, share, seed)
            if entered is not None:
                return *settled(*entered, accuracy, stations), seed.paths[0]
        if seed.status[0] == OK:
            low, tall = share, abs(seed.states.values[0, 4] - 1.0) > TALL * (part[GAMMA] - 1.0)
        elif seed.status[0] == INACCURATE or tall:
            break
        else:
            high = share
        halvings += high < np.inf
        share = min(2.0 * low, 1.0) if high == np.inf else 0.5 * (low + high)
    return PENDING, None, FROM_REST


def settled(asked, point, accuracy, stations):
    """Status and State, or None, of the branch through a :class:`Point`."""
    last, turned = reach(asked, point)
    if last is not None:
        here, length, _, pieces = last
        state = told_of(asked, refined(asked, here, length, pieces, asked.most), accuracy, stations)
        return (PENDING if state is None else state.status), state
    if turned is not None:
        top, stands_out = turned
        doubt = doubt_of_turn(top.look) + (stands_out + SURE) * top.pressure
        if top.look.pair.near > FAINT and doubt < SURE_LIMIT * top.pressure and top.pressure + doubt < asked.most:
            return (COMPRESSED if pushed(asked, top.look) else BEYOND_LIMIT), None
    return PENDING, None


def pushed(asked, look):
    """Whether the meridional resultant p y^2 + f has all but vanished in some middle."""
    p, force, _, _ = asked.loads(look.pair.numbers)
    part = p * np.square(np.append(look.told[:, 4], 1.0))
    return np.any(part + force < PUSHED * np.maximum(part, abs(force)))
