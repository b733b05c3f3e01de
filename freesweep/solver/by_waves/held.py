"""Held rotations of tubes that are their own mirror image, as waves: a body, which may have a neck towards each end.

From a state that meshes hold at a share of all loads, which rise in proportion, the branch is followed to all of them.
Fronts between body and neck, which get steeper all the way, need no mesh.
"""

import numpy as np

from ..lanes import waves
from ..problem import FORCE, GAMMA, LENGTH
from ..stability import PUSHED
from ..status import BEYOND_LIMIT, COMPRESSED, INACCURATE, OK, PENDING
from .branch import ALONG, Point, follow, toward
from .on_step import parts
from .states import SURE, doubt_of_turn, refined, told_of
from .waves import CENTER, DEEP_ENOUGH, PRESSURE, SIDES, Waves

LEAST_SHARE, TRIES = 1.0 / 128.0, 14  # of the loads, at which a branch is entered: the less of them, the less steep are fronts
STATIONS = np.linspace(0.0, 1.0, 129) ** 2  # of half a tube, at which its shape is looked at: necks are at its end
LEAST_NECK = 1e-2  # of the body's height: waves have hardly a digit of less
DEPTHS = 6.0, 12.0  # of a middle that is deep: two places tell how its wave grows with the depth
ALIKE = 1e-4  # scaled: by what a state may differ from that of meshes
PAST_CORNER, CORNERS = (1e-3, 4e-3, 1.6e-2), 20  # of the loads' logarithm; how many corners are passed
STRAY = 0.1  # of the way past a corner: how far off a middle may be
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


def seated(asked, train, wave, stretch, length):
    """The train with the middle of a wave that has about that stretch, and is about so long."""
    numbers, deep, uniform = train.numbers.copy(), train.deep.copy(), train.uniform.copy()
    loads = asked.loads(numbers)
    told = asked.ask(np.array([[*loads, stretch, depth] for depth in (np.nan, *DEPTHS)]), ALONG)
    numbers[wave] = np.log(abs(stretch - 1.0))
    if not told[0, waves.DEPTH] < DEEP_ENOUGH:
        slope = (DEPTHS[1] - DEPTHS[0]) / (told[2, waves.X] - told[1, waves.X])
        depth = DEPTHS[1] + slope * (length - told[2, waves.X])
        if depth > DEEP_ENOUGH:
            numbers[wave], deep[wave], uniform[wave] = depth, True, told[2, waves.UNIFORM]
    return train._replace(numbers=numbers, deep=deep, uniform=uniform)


def reach(asked, point):
    """``(step, None)``, on which all loads are come to, or ``(None, (Point, by how much it stands out))`` where they turn
    before; ``(None, None)`` where the branch is lost.
    """
    for _ in range(CORNERS):
        for step in follow(asked, point):
            for here, length, there, pieces, stands_out in parts(asked, *step):
                if there.pressure >= asked.most:
                    return (here, length, there, pieces), None
                if stands_out is not None:
                    return None, (there, stands_out)
            point = there
        point = past_corner(asked, point)
        if point is None:
            break
    return None, None


def past_corner(asked, point):
    """The next :class:`Point` behind a place where a family goes slack in a deep middle, along whose layer the depth is
    another one then; None where there is none.
    """
    look, along = point.look, np.zeros(len(point.toward))
    along[PRESSURE] = 1.0
    by_load = point.toward / look.pair.weights
    for part in PAST_CORNER:
        change = part * by_load / abs(by_load[PRESSURE])
        guess = look.pair.moved(change)
        for wave in np.flatnonzero(guess.deep):
            guess = seated(asked, guess, wave, look.told[wave, waves.UNIFORM], look.told[wave, waves.X])
        solved = asked.solve(guess, along, guess.numbers[PRESSURE], ALONG)
        if solved is None:
            continue
        there = solved[0]
        if np.all(np.abs(there.told[:, 4] - look.told[:, 4]) < STRAY * np.abs(look.told[:, 4] - 1.0)):
            ahead = toward(there, along * np.sign(by_load[PRESSURE]))
            return Point(there, ahead)
    return None


def held_of(problem, pressure, find, accuracy, stations):
    """``(status, State or None)`` of the tube whose rotation is held at none, PENDING where waves do not tell; ``find`` tells
    states by meshes, of a problem under a pressure, with profiles at stations.

    It is entered at the least share of the loads at which there are necks.
    """
    low, share, high = 0.0, LEAST_SHARE, np.inf
    for _ in range(TRIES):
        seed = find(at_share(problem, share), share * pressure, 0.5 * problem[LENGTH] * STATIONS)
        if seed.status[0] in (OK, INACCURATE):
            entered = enter(problem, pressure, share, seed)
            if entered is not None:
                return settled(*entered, accuracy, stations)
            low = share
        else:
            high = share
        share = min(2.0 * low, 1.0) if high == np.inf else 0.5 * (low + high)
        if not low < share < high:
            break
    return PENDING, None


def settled(asked, point, accuracy, stations):
    """The same, of the branch through a :class:`Point`."""
    step, turned = reach(asked, point)
    if step is not None:
        here, length, _, pieces = step
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
