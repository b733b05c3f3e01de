"""The uniform tube as a guide: what each place along the tube would do if all of it were like that place.

One number for a tube that is the same all along, else one for each of some places; first guesses of mesh and shape.
"""

from math import exp, sqrt

from ..jit import kernel
from .numerics import mesh
from .numerics.properties_along import at_point
from .physics import lagrangian, uniform_tube

PLACES = 33  # along a tube that varies
FAR_FROM = 0.25  # share of 1 - u by which the middle of a tube drawn in may miss u, whose end is far


@kernel
def cell_along(tube, share):
    """What varies along the tube at a ``share`` (0 to 1) of its length; of a body, as the cylinder of the radius there."""
    course, places = tube.course, tube.places
    at = share * places[len(places) - 1]
    segment = 0
    while segment < len(places) - 2 and places[segment + 1] <= at:
        segment += 1
    return upright(at_point(course, segment, (at - places[segment]) / (places[segment + 1] - places[segment])))


@kernel
def upright(cell):
    """A cell whose radius does not change along the axis."""
    if len(cell) == 3:
        return cell
    return cell[0], cell[1], cell[2], cell[3], 0.0, cell[5]


@kernel
def near_rest(tube, load, u):
    """The uniform stretches ``u`` under a load; whether it is so small that they are all next to 1."""
    for k in range(len(u)):
        u[k], met = uniform_tube.near_rest(lagrangian.density, cell_along(tube, k / max(len(u) - 1, 1)), load)
        if not met:
            return False
    return True


@kernel
def locked(tube, gamma, u):
    """The uniform locked stretches."""
    for k in range(len(u)):
        u[k] = lagrangian.locked_stretch(cell_along(tube, k / max(len(u) - 1, 1)), gamma)


@kernel
def stretch_at(u, share):
    """The uniform stretch at a share of the length."""
    at = min(max(share, 0.0), 1.0) * (len(u) - 1)
    k = min(int(at), max(len(u) - 2, 0))
    return u[k] + (at - k) * (u[min(k + 1, len(u) - 1)] - u[k])


@kernel
def start(tube, u, load, x, y):
    """Mesh and first shape: exponential end layers, whose slope can be met, on the uniform stretches."""
    _, edges, _, free, _, places = tube
    rates = (0.0, 0.0)
    for end in range(2):
        cell, stretch = cell_along(tube, 1.0 * end), u[0 if end == 0 else len(u) - 1]
        _, _, _, L_yy, _, L_vv = lagrangian.density(stretch, 0.0, cell, load)
        rate = sqrt(max(L_yy / L_vv, 1e-12))
        rates = (rate, rates[1]) if end == 0 else (rates[0], rate)
    segments = len(edges) - 1
    for s in range(segments):
        a, n, length = edges[s], edges[s + 1] - edges[s], places[s + 1] - places[s]
        own = x[a : a + n + 1]
        at_end = s == segments - 1 and not free
        mesh.layer_mesh(length, rates[0] if s == 0 else rates[1] if at_end else 0.0, n, own)
        if at_end and s > 0:  # the layer lies at the other end
            for i in range(n // 2 + 1):
                own[i], own[n - i] = length - own[n - i], length - own[i]
        for i in range(n + 1):
            own[i] += places[s]
        own[n] = places[s + 1]
    total = places[segments]
    largest = 1e-9
    for k in range(len(u)):
        largest = max(largest, abs(u[k] - 1.0))
    near, far = min(rates[0], 0.9 / largest), min(rates[1], 0.9 / largest)
    for i in range(len(x)):
        layer = 1.0 - exp(-near * x[i])
        if not free:
            layer *= 1.0 - exp(-far * (total - x[i]))
        y[i] = 1.0 + (stretch_at(u, x[i] / total) - 1.0) * layer
