"""Random states of all kinds, told by the words of a kind: "physical varying held length"; what derivatives are asked of.

A state "at a change" is one near a load at which loose fibers go slack anywhere, or everywhere, or where they go taut again,
or where their slack end passes the middle of the tube: a node, where a profile jumps there.
"""

import numpy as np

import freesweep as fs

C10 = 0.11e6
LOADS = ("pressure", "force", "torque", "deformed_length", "rotation")
SEEN, HALVED, FARTHEST, CLOSEST = (
    9,
    40,
    0.5,
    4.0,
)  # loads looked at; halvings; decades of a state's distance from a change
AT_NODE = 1e-9  # of the length


def along(state, rng):
    """The angle or the wall of a state, with a slope or a jump."""
    name = rng.choice([name for name in ("alpha", "beta", "wall") if state[name] is not None])
    at = state[name]
    other = (
        at * rng.uniform(0.7, 1.3)
        if name == "wall"
        else at + np.sign(at - (state["beta" if name == "alpha" else "alpha"] or 0.0)) * 5
    )
    pairs = [(0, at), (1, other)], [(0, at), (0.5, at), (0.5, other), (1, other)]
    return state | {name: pairs[rng.integers(2)] if abs(other) < 85 or name == "wall" else at}


def random_design(kind, rng):
    """Name -> value of an actuator and its rubber."""
    alpha, beta = rng.uniform(0, 85), rng.uniform(-85, 85)
    if abs(alpha - beta) < 3.0:
        return random_design(kind, rng)
    r = rng.uniform(3e-3, 12e-3)
    state = {
        "alpha": alpha,
        "beta": beta,
        "length": r * rng.uniform(5, 60),
        "radius": r,
        "wall": r * rng.uniform(0.05, 0.4),
    }
    rubber = {"c10": C10 * rng.uniform(0.5, 2), "c01": C10 * rng.uniform(0.1, 1)}
    if "yeoh" in kind:
        rubber = {"c1": C10, "c2": C10 * rng.uniform(0.02, 0.3), "c3": C10 * rng.uniform(0.001, 0.02)}
    state |= rubber
    if kind.startswith("physical"):
        state["model"] = "physical"
    if kind.startswith("thick"):
        state |= {"wall_model": "thick", "fiber_radius": str(rng.choice(["inner", "middle", "outer"]))}
    if kind.startswith("loose membrane"):
        state["fibers"] = "loose"
    if "balloon" in kind or "single" in kind:
        none = ("alpha", "beta") if "balloon" in kind else (str(rng.choice(["alpha", "beta"])),)
        state |= dict.fromkeys(none)
    if "extension" in kind:
        state["fiber_extension"] = rng.uniform(1.001, 1.03)
    if "varying" in kind:
        state = along(state, rng)
    if "body" in kind:
        state |= {"taper": rng.uniform(-0.3, 0.3), "bulge": rng.uniform(-0.2, 0.4)}
    return state


def random_state(kind, rng):
    """``(way, state)``: name -> value of the actuator and its loads."""
    state = random_design(kind, rng)
    r = state["radius"]
    if "locked" in kind:
        return "lock", state
    if kind == "buckled":
        return buckled(state, rng)
    state["pressure"] = 10 ** rng.uniform(3.5, 5.3)
    pull, twist = state["pressure"] * np.pi * r**2, state["pressure"] * np.pi * r**3
    if "length" in kind:
        held = {"deformed_length": state["length"] * rng.uniform(0.8, 1.1), "torque": twist * rng.uniform(-0.3, 0.3)}
        way, state, load = "blocked_force", state | held, ("torque", twist)
    elif "rotation" in kind:
        turn = np.degrees(0.2 * state["length"] / r)
        held = {"rotation": turn * rng.uniform(-1, 1), "force": pull * rng.uniform(-0.3, 0.5)}
        way, state, load = "blocked_torque", state | held, ("force", pull)
    else:
        way, load = "inflate", ("force", pull)
        if "loads" in kind:
            state |= {"force": pull * rng.uniform(-0.3, 0.8), "torque": twist * rng.uniform(-0.3, 0.3)}
    return (way, at_change(way, state, *load, rng)) if "at a change" in kind else (way, state)


def buckled(state, rng):
    """A state beside the straight cylinder, beyond the pressure from which that buckles."""
    of = {name: state[name] for name in ("alpha", "beta", "length", "radius", "wall", "c10", "c01")}
    critical = float(fs.closed_form.critical_pressure(**of))
    if not 0.0 < critical < 10.0 * state["c10"]:
        raise fs.ActuatorError(["it never buckles"])
    turn = np.degrees(0.02 * state["length"] / state["radius"]) * rng.choice([0.0, 1.0])
    own = {"pressure": critical * rng.uniform(1.02, 1.6), "rotation": turn * rng.uniform(-1, 1), "force": 0.0}
    return "blocked_torque", state | own | {"buckled": True}


def at_change(way, state, load, unit, rng):
    """The state under another ``load``, near one at which its families' slack shares change their kind."""

    def kind_at(amount):
        found = solved(way, state | {load: amount * unit})
        if int(found["status"]) != 0:
            return None
        shares = [found[name].item() for name in ("slack_alpha", "slack_beta") if name in found]
        return tuple(
            k for share in shares for k in (share > 0.0, share < 1.0, np.sign(np.round((share - 0.5) / AT_NODE)))
        )

    amounts = np.linspace(-0.6, 1.2, SEEN) + rng.uniform(-0.1, 0.1)
    seen = [kind_at(amount) for amount in amounts]
    changes = [k for k in range(SEEN - 1) if seen[k] != seen[k + 1] and None not in seen[k : k + 2]]
    if not changes:
        raise fs.ActuatorError(["no family goes slack"])
    k = rng.choice(changes)
    (low, high), of_low = amounts[k : k + 2], seen[k]
    for _ in range(HALVED):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if kind_at(middle) == of_low else (low, middle)
    away = 10.0 ** -rng.uniform(FARTHEST, CLOSEST)
    return state | {load: unit * (low + rng.choice([-1.0, 1.0]) * away)}


def solved(way, state, **more):
    """The Dataset of a state."""
    design = {name: value for name, value in state.items() if name not in (*LOADS, "buckled")}
    rubber = [design.pop(name) for name in ("c10", "c01", "c1", "c2", "c3") if name in design]
    material = (fs.MooneyRivlin if len(rubber) == 2 else fs.Yeoh)(*rubber)
    loads = {name: state[name] for name in (*LOADS, "buckled") if name in state}
    return getattr(fs, way)(fs.Actuator(**design, material=material), **loads, x=[0.0], **more)


def parameters_of(way, state):
    """Names of all that derivatives are asked by: of numbers, loads and what is held."""
    loads = {"lock": (), "inflate": LOADS[:3], "blocked_force": ("pressure", "torque", "deformed_length")}
    own = [
        name for name, value in state.items() if name not in (*LOADS, "buckled") and not isinstance(value, str | None)
    ]
    return sorted({*own, "fiber_extension", *loads.get(way, ("pressure", "force", "rotation"))})


def moved(value, by):
    """A number, or a profile all along, that changed."""
    return [(share, number + by) for share, number in value] if isinstance(value, list) else value + by


def size_of(name, state):
    """What a step is a part of."""
    r, pressure = state["radius"], state.get("pressure", 0.0)
    size = {"alpha": 25.0, "beta": 25.0, "fiber_extension": 1.0, "rotation": 60.0, "taper": 0.5, "bulge": 0.5}
    size |= {"force": pressure * np.pi * r**2, "torque": pressure * np.pi * r**3}
    at = state.get(name)
    return size.get(name) or (at[0][1] if isinstance(at, list) else at)
