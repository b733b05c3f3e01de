"""Held states: the deformed length or the rotation of the free end is given, the force or the torque that keeps it unknown.

The state meant is the one on the branch that begins without load: pressure, the other load and fiber extension - 1 rise in
proportion while the undeformed length (no rotation) is held, then what is held changes to its target. The straight cylinder
y = 1 of a tube that is the same all along is an equilibrium on this way under the load that makes L_y(1, 0) = 0: the way
may begin there at once, as long as no state on it is unstable. Else all of it is gone, as by a tube that varies.

Where the wall would have to be pushed on that way, or it leads nowhere (another length or rotation than the undeformed one
is not come to, or steps die out where no turn is, or none begins: loose fibers), the other is gone: the loads rise with
nothing held, then what is held changes from what was found. A tube that snaps on that way may not do so where the load that
will hold it, as large as all others, rises as well. Without pressure neither
way begins; they go to a pressure like the wall's stiffness, which is lowered at the end.

Where loose fibers of that cylinder are slack it may lie on another branch: such tubes always begin from rest.

A tube that is the same all along, or its own mirror image, keeps a symmetric state. Beyond a critical pressure of blocked
torque an antisymmetric mode makes it unstable, which is no obstacle on the way; somewhat later, with fiber extension, the
branch turns back, at most designs for good: BEYOND_LIMIT.
"""

from ...jit import kernel
from ..load import SPARED
from ..physics import lagrangian
from ..physics.wall import may_go_slack
from ..status import BEYOND_LIMIT, COMPRESSED, NOT_CONVERGED, OK, PENDING
from . import ways
from .settle import finish, settle
from .sought import (  # noqa: F401
    FROM_FREE,
    FROM_REST,
    HELD_LENGTH,
    HELD_ROTATION,
    Sought,
    describe,
    failed,
    load_of,
    mirrored,
    refused,
    valued,
)
from .ways import EVERY, cylinder_multiplier, held_at

PULLS = 0.0, 4.0, -4.0, 16.0, -16.0  # of the load that holds, as others rise: a tube may snap without it


@kernel
def find(problem, asked, tube, accuracy, room):
    """One held state on one base mesh. Which way is gone must not hang on the accuracy: the other one is not, where only
    finer meshes have no state that the base mesh has come to.
    """
    load, target, kind = load_of(problem, asked), asked.target, asked.kind
    status = refused(load, target, kind, tube)
    if status != PENDING:
        return failed(status, load)
    sought = describe(load, target, kind, tube)
    found, came_to = failed(COMPRESSED, load), False
    if sought.stands:
        end = first_way(room, tube, sought)
        came_to = end.status == OK
        found = settle(room, tube, end, sought, FROM_REST, accuracy)
    lost = (sought.wanted != sought.natural or not found.sure) and not (came_to and found.status == NOT_CONVERGED)
    if found.status == COMPRESSED or (lost and not valued(found.status)):
        snaps = True
        for pull in PULLS:
            if snaps:
                end = ways.from_free(room, tube, sought.with_pressure, sought.unit, borne(pull, sought), sought.wanted)
                again = settle(room, tube, end, sought, FROM_FREE, accuracy)
                done = valued(again.status)
                found = again if done else found
                snaps = not done and (pull != 0.0 or (end.status == BEYOND_LIMIT and not end.path.held.any))
    return finish(room, tube, sought, found) if valued(found.status) else found


@kernel
def borne(pull, sought):
    """The same pull, in units of what holds; of pushes as much as the pressure bears, and the less is left of it the
    stronger they are.
    """
    unit = sought.unit.f
    return -(1.0 + SPARED / pull) * sought.with_pressure.p / unit if pull < 0.0 < unit else pull


@kernel
def first_way(room, tube, sought):
    """The way from rest, as far as it goes: by a tube that is the same all along from the straight cylinder, if it may."""
    there, unit, natural, wanted = sought.with_pressure, sought.unit, sought.natural, sought.wanted
    if not (sought.varies or may_go_slack(there.wall)):
        end = from_cylinder(room, tube, sought)
        if end.status == OK or end.status == COMPRESSED:
            return end
    allowed = 1 if sought.varies and mirrored(tube) else 0
    end = ways.from_rest(room, tube, sought.cell, there, held_at(unit, natural, natural, allowed))
    if end.status == OK and wanted != natural:
        end = ways.go(room, tube, ways.moving(there, held_at(unit, natural, wanted, EVERY)))
    return end


@kernel
def from_cylinder(room, tube, sought):
    """From the straight cylinder to what is wanted, through stable states."""
    track, x, load, unit = room.track, tube.places, sought.with_pressure, sought.unit
    ways.make_straight(track, tube, cylinder_multiplier(sought.cell, load, unit))
    first = lagrangian.conjugate(1.0, 0.0, sought.cell, load, unit)[0] * x[len(x) - 1]
    return ways.go(room, tube, ways.moving(load, held_at(unit, first, sought.wanted, 0)))
