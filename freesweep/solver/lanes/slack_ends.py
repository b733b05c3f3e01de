"""Where along half a tube families of fibers go slack, or would have to push, for a vector of designs.

A family pulls at one place and not at the next: between them its pull is followed to where it ends, by the regula falsi of
Anderson and Bjorck. What it would push by, were it taut, goes on behind its pull, by the same slope.
"""

from ...jit import kernel
from ..along.slack import NOTHING, TENSIONLESS
from ..physics.wall import may_go_slack
from .meridian import handed_on, look
from .vector import WIDTH, bits, get, isnt, mask_of, put, select, some, spread

MOST = 8  # ends in half a tube; more are left to finer parts
STEPS, CLOSE, SURE = 48, 1e-9, 3e-8  # of the search, its last step [of the depth], and how exactly an end is known
WIDER = 4.0  # times what a middle has moved: where an end is looked for beside the one before
PATIENT, ENOUGH = 10, 1e-5  # steps, from which on each other one halves the bracket; an end known so well is not lost
# what brackets an end, and did at first
ENDS = LEFT, RIGHT, BEFORE, BEHIND, FAMILY, FIRST, LAST = range(7)


@kernel
def pulls(at, load):
    """By how much both families pull more than what counts as none; not more than 0 where they are slack, or push."""
    least = NOTHING if may_go_slack(load.wall) else -TENSIONLESS * (load.p + abs(load.f))
    return at.a - least, at.b - least


@kernel
def bracket(first, width, places, pull, family, last, seen, ends, counts, starts):
    """Write where the ``pull`` of a family changes its sign, at the ``places`` 0 to ``last`` of a part of that ``width``, to
    ``ends`` (7, MOST, WIDTH), of which each lane has ``counts`` (WIDTH,); what was ``seen`` (4, ...) before to ``starts``.
    """
    for k in range(last):
        changes = bits(get(pull, k) > 0.0) ^ bits(get(pull, k + 1) > 0.0)
        if changes == 0:
            continue
        for lane in range(WIDTH):
            j = counts[lane]
            if (changes >> lane) & 1 and j < MOST:
                ends[LEFT, j, lane], ends[RIGHT, j, lane] = first + width * places[k], first + width * places[k + 1]
                ends[FIRST, j, lane], ends[LAST, j, lane] = ends[LEFT, j, lane], ends[RIGHT, j, lane]
                ends[BEFORE, j, lane], ends[BEHIND, j, lane] = pull[k, lane], pull[k + 1, lane]
                ends[FAMILY, j, lane] = family
                for i in range(4):
                    starts[i, j, lane] = seen[i, k, lane]
                counts[lane] = j + 1


@kernel
def same_sign(before, here, after):
    """Where three pulls are all positive, or all negative."""
    return ((before > 0.0) & (here > 0.0) & (after > 0.0)) | ((before < 0.0) & (here < 0.0) & (after < 0.0))


@kernel
def passed_over(pull, other, lengths, last):
    """How long the places are beside which a pull may have ended, and begun again, or the other way round, unseen. What a
    slack family would push by jumps where the ``other`` one goes slack.
    """
    total = spread(0.0)
    for k in range(1, last):
        before, here, after = get(pull, k - 1), get(pull, k), get(pull, k + 1)
        bend, half = before - 2.0 * here + after, 0.5 * (after - before)
        alike = same_sign(before, here, after) & same_sign(get(other, k - 1), get(other, k), get(other, k + 1))
        turns = alike & (abs(here) <= abs(before)) & (abs(here) <= abs(after)) & (bend * here > 0.0)
        vertex = here - half * half / select(turns, 2.0 * bend, 1.0)
        total = total + select(turns & (vertex * here < 0.0), get(lengths, k), 0.0)
    return total


@kernel
def trial(i, far, last, of_far, of_last, going):
    """The next share t of a bracket at whose ends, the ``last`` trial and a ``far`` one, a pull is known: by the regula
    falsi, which halves it from some steps on, as where a pull ends without a slope.
    """
    new = last - of_last * (last - far) / select(going, of_last - of_far, 1.0)
    halved = mask_of(-1 if i > PATIENT and i % 2 == 0 else 0)
    return select(((new - far) * (new - last) <= 0.0) & isnt(halved), new, 0.5 * (far + last))


@kernel
def narrowed(pull, far, last, of_far, of_last):
    """``(far, of_far)`` of a bracket where the ``pull`` at one more trial is known: an end that stays far once more counts
    for less (Anderson and Bjorck).
    """
    stays = pull * of_last > 0.0
    share = 1.0 - pull / select(stays, of_last, 1.0)
    share = select(share > 0.0, share, 0.5)
    return select(stays, far, last), select(stays, of_far * share, of_last)


@kernel
def search(ends, j, going, mid, cell, load, near, scratch):
    """``(t, doubt)``: the share of the depth at which the end j of the lanes that are ``going`` lies, each within its
    bracket, and by how much it may be off.
    """
    far, last, of_alpha = get(ends[LEFT], j), get(ends[RIGHT], j), get(ends[FAMILY], j) < 0.5
    of_far, of_last = get(ends[BEFORE], j), get(ends[BEHIND], j)
    t = select(going, last + 1.0, 1.0)
    for i in range(STEPS):
        new = trial(i, far, last, of_far, of_last, going)
        moved, t = abs(new - t), select(going, new, t)
        going = going & (moved > CLOSE)
        if not some(going):
            break
        here = look(t, mid, cell, load, near, scratch)
        near, (alpha, beta) = handed_on(here.y, here.at, near, load.wall), pulls(here.at, load)
        pull = select(of_alpha, alpha, beta)
        far, of_far = narrowed(pull, far, last, of_far, of_last)
        last, of_last = t, pull
    return t, select(going, abs(last - far), SURE)


@kernel
def reopen(shift, moved, mid, cell, load, room):
    """Brackets of the ends that a trial before has left in a :class:`.sums.Room`, in the lanes whose middle has ``moved`` by
    the share ``shift`` of its depth: close beside them, or those that they had at first. Returns the lanes in which these
    hold them.
    """
    held, (ends, starts, scratch) = moved, (room.ends, room.starts, room.scratch)
    for j in range(MOST):
        todo = moved & mask_of(lanes_with(room.counts, j))
        if not some(todo):
            break
        t, width, near = get(ends[LEFT], j), WIDER * shift + SURE, start_of(starts, j)
        of_alpha, ended = get(ends[FAMILY], j) < 0.5, get(ends[BEFORE], j) > 0.0
        left, right = max(t - width, 0.0), min(get(ends[RIGHT], j) + width, 1.0)
        for _ in range(2):
            first = pulls(look(left, mid, cell, load, near, scratch).at, load)
            last = pulls(look(right, mid, cell, load, near, scratch).at, load)
            before, behind = select(of_alpha, first[0], first[1]), select(of_alpha, last[0], last[1])
            same = (ended & (before > 0.0) & (behind <= 0.0)) | (isnt(ended) & (before <= 0.0) & (behind > 0.0))
            found = todo & same
            put(ends[LEFT], j, select(found, left, get(ends[LEFT], j)))
            put(ends[RIGHT], j, select(found, right, get(ends[RIGHT], j)))
            put(ends[BEFORE], j, select(found, before, get(ends[BEFORE], j)))
            put(ends[BEHIND], j, select(found, behind, get(ends[BEHIND], j)))
            todo = todo & isnt(found)
            if not some(todo):
                break
            left, right = get(ends[FIRST], j), get(ends[LAST], j)
        held = held & isnt(todo)
    return held


@kernel
def lanes_with(counts, j):
    """The lanes that have an end j, as bits."""
    there = 0
    for lane in range(WIDTH):
        there |= (1 if j < counts[lane] else 0) << lane
    return there


@kernel
def start_of(starts, j):
    """What may be handed on to the search for the end j."""
    zero = spread(0.0)
    return get(starts[0], j), get(starts[1], j), zero, get(starts[2], j), zero, zero, get(starts[3], j), zero, zero


@kernel
def sort(edges, counts):
    """Put each lane's edges 1 to its count in order."""
    for lane in range(WIDTH):
        for j in range(2, counts[lane] + 1):
            t, i = edges[j, lane], j
            while i > 1 and edges[i - 1, lane] > t:
                edges[i, lane] = edges[i - 1, lane]
                i -= 1
            edges[i, lane] = t
