"""The branch of a tube whose rotation is held, to all loads: round no turn, and past corners where a family goes slack."""

import numpy as np

from ..lanes import waves
from .branch import ALONG, Point, follow, step, toward
from .on_step import parts
from .waves import DEEP_ENOUGH, PRESSURE

DEPTHS = 6.0, 12.0  # of a middle that is deep: two places tell how its wave grows with the depth
PAST_CORNER, CORNERS = (1e-3, 4e-3, 1.6e-2), 20  # of the loads' logarithm; how many corners are passed
STRAY = 3.0  # times as much as the loads may heights of waves change there
UNEVEN, SHORTEST = 0.25, 1e-3  # of a step's slope: what may be uneven; the shortest one that is parted


def reach(asked, point):
    """``(step, None)``, on which all loads are come to, or ``(None, (Point, by how much it stands out))`` where they turn
    before; ``(None, None)`` where the branch is lost.
    """
    for _ in range(CORNERS):
        for whole in follow(asked, point):
            for short in shorter(asked, *whole):
                if short is None:
                    return None, None
                for here, length, there, pieces, stands_out in parts(asked, *short):
                    if there.pressure >= asked.most:
                        return (here, length, there, pieces), None
                    if stands_out is not None:
                        return None, (there, stands_out)
            point = there
        point = past_corner(asked, point)
        if point is None:
            break
    return None, None


def shorter(asked, here, length, there, pieces):
    """Yield the step, in parts where the pressure does not rise on it as its slopes at both ends say: twice it may turn on
    one that is too long. None where it does on the shortest.
    """
    slopes = here.toward[PRESSURE], there.toward[PRESSURE]
    rise = (there.look.pair.numbers[PRESSURE] - here.look.pair.numbers[PRESSURE]) * here.look.pair.weights[PRESSURE]
    even = abs(rise / length - 0.5 * sum(slopes)) <= UNEVEN * min(slopes)
    if even or slopes[0] * slopes[1] < 0.0 or (length < SHORTEST and rise > 0.0):
        yield here, length, there, pieces
        return
    middle = step(asked, here, 0.5 * length, pieces) if length >= SHORTEST else None
    if middle is None:
        yield None
        return
    yield from shorter(asked, here, 0.5 * length, middle, pieces)
    rest = there.look.pair.numbers - middle.look.pair.numbers
    yield from shorter(asked, middle, middle.toward @ (rest * middle.look.pair.weights), there, pieces)


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
        if np.all(np.abs(there.told[:, 4] - look.told[:, 4]) < STRAY * part * np.abs(look.told[:, 4] - 1.0)):
            ahead = toward(there, along * np.sign(by_load[PRESSURE]))
            return Point(there, ahead)
    return None


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
