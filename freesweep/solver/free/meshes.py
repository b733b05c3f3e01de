"""The mesh of a branch, graded by the state that stands on it."""

from ...jit import kernel
from ..numerics import base_mesh, newton
from ..numerics.bordered import CORRECTED, FOLLOWED, correct
from ..numerics.continuation import make_unit
from ..numerics.path import load_at, size_of
from ..numerics.properties_along import fill
from ..of_tube import of_tube
from ..physics.wall import may_go_slack

GRADINGS = 3  # of the first mesh


@kernel
def regrade(track, tube, path, mu, work):
    """Move the nodes to where the state bends, and carry it over: whether that fits, else all is as it was. The old nodes
    are left in ``track.spare``.
    """
    n = len(track.x) - 1
    for i in range(n + 1):
        track.spare[i], track.other[i] = track.x[i], track.y[i]
    now = load_at(path, track.y, n, mu)
    if base_mesh.adapt(of_tube(), track.x, track.y, n, tube, now, work):
        return True
    for i in range(n + 1):
        track.x[i], track.y[i] = track.spare[i], track.other[i]
    return False


@kernel
def stand(track, tube, path, mu, sense, gradings, work):
    """The state at ``mu`` near the one in ``track``, on a mesh that it graded itself so many times, and the tangent in this
    ``sense`` of mu: ``(status, negative pivots, the tangent's mu)``.
    """
    n = len(track.x) - 1
    course, edges, cells, _, _, _ = tube
    for i in range(n + 1):
        track.normal[i] = 0.0
    made = 0
    while True:
        own = fill(course, edges, track.x, n, n, cells)
        for i in range(len(track.y)):
            track.next_y[i] = track.y[i]
        status, negative, _, tangent_mu = correct(
            of_tube(), track, track.y, mu, n, own, path, sense, track.tangent, work
        )
        if (
            status != FOLLOWED
            and not path.held.any
            and may_go_slack(path.origin.wall)
            and settle(track, tube, path, mu, own, work)
        ):
            status, negative, _, tangent_mu = correct(
                of_tube(), track, track.y, mu, n, own, path, sense, track.tangent, work
            )
        if status != FOLLOWED or made == gradings or not regrade(track, tube, path, mu, work):
            return status, negative, make_unit(track, n, mu, tangent_mu, path)
        made += 1


@kernel
def settle(track, tube, path, mu, own, work):
    """Whether shortened steps lead from the shape in ``track.next_y`` to the state at ``mu``, into ``track.y``: full ones
    may go to and fro between shapes at which other places of loose fibers are slack.
    """
    n = len(track.x) - 1
    for i in range(len(track.y)):
        track.y[i] = track.next_y[i]
    on, now = newton.Mesh(track.x, n, tube.half, own), load_at(path, track.y, n, mu)
    return newton.solve(of_tube().density, track.y, on, now, newton.UNKNOWN, CORRECTED, work)[0] == newton.CONVERGED


@kernel
def take(track, tube, path, mu, tangent_mu, work):
    """Stand on the state a step ahead, on a mesh graded by it, on the plane normal to the branch: ``(mu, the tangent's mu)``
    there.
    """
    n = len(track.x) - 1
    course, edges, cells, _, _, _ = tube
    for i in range(len(track.y)):
        track.y[i], track.tangent[i] = track.next_y[i], track.next_tangent[i]
    tangent_mu = make_unit(track, n, mu, tangent_mu, path)
    if not regrade(track, tube, path, mu, work):
        return mu, tangent_mu
    j = 0
    for i in range(n + 1):
        while j < n - 1 and track.spare[j + 1] < track.x[i]:
            j += 1
        share = (track.x[i] - track.spare[j]) / (track.spare[j + 1] - track.spare[j])
        slope = track.tangent[j] + share * (track.tangent[j + 1] - track.tangent[j])
        track.next_y[i], track.normal[i] = track.y[i], slope / (n * track.y[i] * track.y[i])
    for i in range(n + 1, len(track.y)):
        track.next_y[i] = track.y[i]
    unit = size_of(mu, path)
    own = fill(course, edges, track.x, n, n, cells)
    normal_mu = tangent_mu / (unit * unit)
    status, _, new_mu, new_tangent_mu = correct(
        of_tube(), track, track.next_y, mu, n, own, path, normal_mu, track.next_tangent, work
    )
    if status != FOLLOWED:
        for i in range(n + 1):
            track.x[i], track.y[i] = track.spare[i], track.other[i]
        return mu, tangent_mu
    for i in range(len(track.y)):
        track.y[i], track.tangent[i] = track.next_y[i], track.next_tangent[i]
    return new_mu, make_unit(track, n, new_mu, new_tangent_mu, path)
