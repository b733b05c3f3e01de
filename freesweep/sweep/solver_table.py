"""Reads the table [solver] of a specification: what is solved, how exactly, and how far its axes may grow."""

from ..atlas.schema import HELD, HELD_LENGTHS
from ..description.units import quantity, shown
from ..scaling import ACCURACIES
from .designs import AT_REST

MAX_POINTS = 2_000_000_000  # 16 GB for each variable of the atlas
BUDGET = 5_000_000  # points to which axes may grow
TOLERANCES = (1e-7, 0.1)  # of answers between nodes, relative


def read_blocked(faults, solver, given):
    """Which held states are solved, and which held quantities are those of the undeformed tube."""
    asked = {"blocked_force": [name for name in HELD_LENGTHS if name in given]}
    asked["blocked_torque"] = [name for name in HELD if name in given and name not in HELD_LENGTHS]
    if len(asked["blocked_force"]) > 1:
        first, second = (given[name] for name in asked["blocked_force"])
        faults.add(first, f"the held length is given twice, also as {second}; remove one")
    blocked = solver.get("blocked")
    if blocked is not None and not isinstance(blocked, bool):
        faults.add("solver.blocked", f"found {shown(blocked)}; write true or false")
    if blocked is False and any(asked.values()):
        held = given[next(name for names in asked.values() for name in names)]
        faults.add("solver.blocked", f"found false, but {held} is given; remove one of the two")
    kinds = tuple(kind for kind, names in asked.items() if names or blocked is True)
    rest = dict(zip(asked, AT_REST))
    return kinds, tuple(rest[kind] for kind in kinds if not asked[kind])


def read_accuracy(faults, solver):
    """Accuracy of every number, None where it cannot be read; notes unknown keys of the table."""
    faults.unknown_keys(solver, ("accuracy", "blocked", "interpolation_tolerance", "budget"), "solver")
    low, high = ACCURACIES
    try:
        accuracy = quantity(solver.get("accuracy", 1e-6), "1")
    except ValueError as error:
        faults.add("solver.accuracy", str(error))
        return None
    if not low <= accuracy <= high:
        faults.add("solver.accuracy", f"found {accuracy:g}, allowed is {low:g} to {high:g}; 1e-6 suits most sweeps")
    return accuracy


def read_tolerance(faults, solver):
    """Tolerance of answers between the nodes, None without, and the points to which axes may grow for it."""
    tolerance, budget = solver.get("interpolation_tolerance"), solver.get("budget", BUDGET)
    if tolerance is None and "budget" in solver:
        faults.add("solver.budget", "is for axes that grow; give interpolation_tolerance, too")
    if isinstance(budget, bool) or not isinstance(budget, int) or not 1 <= budget <= MAX_POINTS:
        faults.add("solver.budget", f"found {shown(budget)}, allowed is a whole number from 1 to {MAX_POINTS:,}")
        budget = BUDGET
    if tolerance is None:
        return None, budget
    low, high = TOLERANCES
    try:
        number = quantity(tolerance, "1")
    except ValueError as error:
        faults.add("solver.interpolation_tolerance", str(error))
        return None, budget
    if not low <= number <= high:
        faults.add("solver.interpolation_tolerance", f"found {number:g}, allowed is {low:g} to {high:g}")
    return number, budget
