"""Draws ``fold.png`` of algorithm.md: one continuation, step by step, through a limit pressure: ``python docs/fold.py``.

The solver's own functions, in plain Python: a tube whose fibers lean the same way swells until its pressure falls.
"""

import os
import sys
from pathlib import Path

os.environ["NUMBA_DISABLE_JIT"] = "1"

import numpy as np

import freesweep as fs
from freesweep.plot import style
from freesweep.scaling import problem_rows
from freesweep.solver.free.meshes import take
from freesweep.solver.free.space import make_room
from freesweep.solver.free.way import begin
from freesweep.solver.load import Load, by
from freesweep.solver.numerics.bordered import FOLLOWED
from freesweep.solver.numerics.continuation import CHANGE, FIRST_STEP, advance, is_stable, last_alike
from freesweep.solver.numerics.path import NOTHING
from freesweep.solver.numerics.path import Path as Loads
from freesweep.solver.numerics.properties_along import Tube
from freesweep.solver.of_tube import of_tube
from freesweep.solver.problem import SOURCE, rubber_of, wall_of

CELLS, BEHIND = 48, 17  # of half the tube; steps that are drawn behind the fold
TUBE = fs.Actuator(
    alpha=60, beta=55, length=0.06, radius=5e-3, wall=1.67e-3, material=fs.MooneyRivlin(2e5, 1e5), energy="principal",
    model="source",
)  # fmt: skip


def branch():
    """Stretches in the middle and pressures [Pa] of the steps, how many lie before the fold, and those of the fold."""
    design = {name: np.full(1, value) for name, value in TUBE.design().items()} | {
        "force": np.zeros(1),
        "torque": np.zeros(1),
    }
    problem = problem_rows(design, TUBE.energy)[0]
    course, half = np.zeros((1, 1, 3, 4)), 0.5 * TUBE.length / TUBE.fiber_surface
    course[0, 0, :, 0] = problem[:3]
    cells, edges, places = problem[None, :3].copy(), np.array([0, CELLS]), np.array([0.0, half])
    tube = Tube(course, edges, cells, True, CELLS, places)
    rest = Load(1.0, rubber_of(problem), wall_of(problem, SOURCE), 0.0, 0.0, 0.0, 1.0)
    path = Loads(rest, by(1.0, 0.0, 0.0), 0.0, False, NOTHING)
    room = make_room(CELLS, True, False, 1)
    space, track = room.space, room.track
    how = of_tube(), track, CELLS, cells, path
    _, mu, slope = begin(room, tube, path)
    states, step, before, fold = [(track.y[-1], mu)], FIRST_STEP * CHANGE, None, None
    while before is None or len(states) < before + BEHIND:
        status, negative, ahead, next_slope, made, step = advance(*how, (mu, slope), step, space.work)
        if status != FOLLOWED:
            break
        if before is None and not is_stable(negative, next_slope, 1.0):
            top, _, _ = last_alike(*how, (mu, slope), made, 1.0, True, space.work)
            fold, before = (track.next_y[-1], top), len(states)
            advance(*how, (mu, slope), made, space.work)
        mu, slope = take(track, tube, path, ahead, next_slope, space.work)
        states.append((track.y[-1], mu))
    unit = np.array([1.0, TUBE.material.c10])
    return np.array(states) * unit, before, np.array(fold) * unit


def draw(out):
    """The picture; returns the pressure at the fold [Pa]."""
    states, before, fold = branch()
    with style.context():
        ax = style.new_axes(style.COLUMN * 1.4, 75.0)
        stretch, pressure = states.T
        ax.plot(stretch[:before], pressure[:before] / 1e3, "o-", color=style.INK, markersize=2.4, linewidth=style.THIN)
        ax.plot(
            stretch[before:], pressure[before:] / 1e3, "o--", color=style.QUIET, markersize=2.4, linewidth=style.THIN
        )
        ax.plot(fold[0], fold[1] / 1e3, "D", color=style.SERIES[1], markersize=5.0)
        ax.annotate(
            "fold: the limit pressure", (fold[0], fold[1] / 1e3), xytext=(0, 7), textcoords="offset points", ha="center"
        )
        ax.set_ylim(0.0, 1.15 * fold[1] / 1e3)
        ax.set_xlabel("stretch in the middle")
        ax.set_ylabel("pressure [kPa]")
        ax.figure.savefig(out, dpi=150)
    return fold[1]


if __name__ == "__main__":
    print(draw(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "fold.png"))
