"""All outputs of states on meshes: what they integrate, and what is largest and least along them.

Middles of cells tell of a place by stretch and slope; ends of pieces, where profiles jump, by the flux through the node
there, which follows from the cell beside it, and needs no slope.
"""

from itertools import pairwise

import numpy as np

from .dual import Dual
from .equilibrium import NotFound, carried, cells_of, full, outputs_after, responses, sums
from .extremes import Piece, extremes, fields, unknown
from .physics import OWN

INSIDE = 1e-9  # of half a cell: the profiles at its end


def outputs(physics, meshes, y, ends, segments):
    """The outputs in SI units and degrees, dual numbers over the meshes with their derivatives by the parameters of
    ``physics``, and the doubts of :func:`extremes`: between ``ends`` all is smooth, where ``segments`` meet
    profiles jump. Raises :class:`NotFound`.
    """
    found = sums(physics, meshes, y)
    moved, step = responses(found, meshes)
    made = outputs_after(physics, meshes, y, moved, step)
    try:
        with np.errstate(all="ignore"):
            pieces = pieces_of(physics, meshes, y, (found, moved, step), ends, segments)
            along, doubts = extremes(physics, pieces, segments, 2.0 if meshes.free else 1.0)
    except NotFound:  # where fibers settle at an end
        along, doubts = unknown(len(physics.parameters), len(meshes.starts))
    return made | along, doubts


def pieces_of(physics, meshes, y, answers, ends, segments):
    """The :class:`.extremes.Piece` of each mesh between ``ends``, with what :func:`.extremes.fields` tells; those ends are
    places of it, too, where ``segments`` meet. ``answers``: sums, how nodes move, and the last step.
    """
    found, moved, step = answers
    stretch, slope, _ = cells_of(physics, meshes, y)
    count = OWN + len(physics.parameters)
    seen = fields(physics, stretch, physics.place(stretch, slope, meshes.share), meshes.share)
    rows = np.stack([full(one, count, len(meshes.step)) for one in seen])
    fluxes = np.stack([found.left, found.right])
    rows = carried(physics, meshes, np.concatenate([rows, fluxes]), moved, step)
    cells, nodes, parts = [], [], []
    for mesh in range(len(meshes.starts)):
        x, first = meshes.x[meshes.nodes(mesh)], meshes.cells(mesh).start
        at = [int(np.argmin(np.abs(x - end))) for end in ends]
        for a, b in pairwise(at):
            cells += [first + a, first + b - 1]
            nodes += [meshes.starts[mesh] + a, meshes.starts[mesh] + b]
            parts.append((mesh, slice(first + a, first + b), (x[a], x[b])))
    cells, nodes = np.array(cells), np.array(nodes)
    at_ends = at_nodes(physics, meshes, y, (rows[-2:], moved, step), cells, nodes)
    pieces = [[] for _ in meshes.starts]
    for k, (mesh, own, (low, high)) in enumerate(parts):
        stay = [end for end, place in ((0, low), (1, high)) if np.any(segments == place)]
        told = np.insert(rows[:-2, :, own], [0, own.stop - own.start], at_ends[..., 2 * k : 2 * k + 2], axis=-1)
        x = np.concatenate([[low], meshes.share[own], [high]])
        beside = np.clip(np.arange(own.start - 1, own.stop + 1), own.start, own.stop - 1)
        keep = slice(0 if 0 in stay else 1, None if 1 in stay else -1)
        pieces[mesh].append(Piece(x[keep], told[..., keep], (low, high), beside[keep]))
    return pieces


def at_nodes(physics, meshes, y, answers, cells, nodes):
    """What :func:`.extremes.fields` tells of nodes, (fields, 1 + parameters, nodes), by the flux through them, which a cell
    beside each tells: its first node, or its last one, in turn.
    """
    fluxes, moved, step = answers
    none = np.zeros((OWN, len(nodes)))

    def number(values):
        return Dual(values[0], np.concatenate([none, values[1:]]))

    flux = np.where(np.arange(len(nodes)) % 2 == 0, fluxes[0][:, cells], fluxes[1][:, cells])
    all_moved = np.vstack([y + step, moved])[:, nodes]
    share = meshes.x[nodes] + INSIDE * (meshes.share[cells] - meshes.x[nodes])
    stretch = number(all_moved)
    here, count = physics.in_cells(cells), OWN + len(physics.parameters)
    seen = fields(here, stretch, here.at_flux(stretch, number(flux), share), share)
    return np.stack([full(one, count, len(nodes)) for one in seen])[:, [0, *range(1 + OWN, 1 + count)]]
