"""The one table of statuses: value, CF meaning, cause and remedy; and of the flags beside it, which blank nothing."""

from typing import NamedTuple


class Status(NamedTuple):
    """One row of the table."""

    value: int
    meaning: str
    sentence: str


STATUSES = (
    Status(0, "ok", "solved to the accuracy asked for"),
    Status(
        1,
        "degenerate",
        "alpha = beta, or a family missing: such fibers leave the shape free; choose angles that differ",
    ),
    Status(
        2,
        "beyond_limit_pressure",
        "the branch from zero pressure ended at a lower pressure (limit_pressure; NaN: at part of the other loads): the tube"
        " snaps there, and no rising pressure leads to the locked shape without that snap",
    ),
    Status(
        3,
        "meridional_compression",
        "the wall would have to be pushed along its length (p y^2 + f <= 0): it wrinkles; raise the pressure or the axial"
        " force (a held length that needs a push at any pressure, as the undeformed one of fibers that both lean the same"
        " way, has no result)",
    ),
    Status(
        4,
        "held_impossible",
        "the held length or rotation cannot be reached, or is none (straight fibers, alpha = -beta); hold another",
    ),
    Status(5, "inaccurate", "solved, but the error bound misses the accuracy asked for; the value and its bound stand"),
    Status(
        6,
        "not_converged",
        "no state was found: where the pressure is 1e4 times the rubber's c10 or more look at their units (the shape is the"
        " locked one there), else a defect of the solver: please report the design",
    ),
    Status(7, "invalid", "a parameter lies outside the domain of the model"),
    Status(8, "outside_atlas", "the point lies beyond the grid; no extrapolation is made"),
    Status(
        9,
        "not_interpolable",
        "the cell touches a failed node, a limit or a change of validity, or nodes lie too far apart for the tolerance;"
        " refine=True answers it",
    ),
)
(
    OK,
    DEGENERATE,
    BEYOND_LIMIT,
    COMPRESSED,
    HELD_IMPOSSIBLE,
    INACCURATE,
    NOT_CONVERGED,
    INVALID,
    OUTSIDE,
    NOT_INTERPOLABLE,
) = (s.value for s in STATUSES)
VALUED = (OK, INACCURATE)  # the statuses whose outputs are numbers; all others' are NaN

FLAGS = {
    "stable": {0: "unstable", 1: "stable"},
    "limit_found": {0: "none_up_to_the_largest_pressure", 1: "found"},
    "held_path": {0: "from_rest", 1: "from_free_state"},
    "slack_fiber": {0: "none", 1: "alpha_family", 2: "beta_family", 3: "both_families"},
}


FLAG_COMMENTS = {
    "stable": "0 also where there is no result: read the status first. The smallest disturbance ends an unstable state",
    "limit_found": "0 also where no branch was followed: read the status first. Beyond a limit pressure the tube snaps",
    "held_path": "0 also where there is no result. From rest: what is held is kept at its undeformed value while the loads"
    " rise, then changed; where the wall would have to be pushed on that way, it is changed from where nothing was held",
    "slack_fiber": "0 also where there is no result. A family that would have to push cannot: the tube deforms otherwise."
    " Slack over more than 1e-6 of the length (slack_alpha, slack_beta); a pull that ends at a single place is none",
}


def status_attributes() -> dict:
    """CF attributes of a status variable."""
    return {"flag_values": [s.value for s in STATUSES], "flag_meanings": " ".join(s.meaning for s in STATUSES)}


def flag_attributes(name: str) -> dict:
    """CF attributes of one of FLAGS."""
    meanings = " ".join(FLAGS[name].values())
    return {"flag_values": list(FLAGS[name]), "flag_meanings": meanings, "comment": FLAG_COMMENTS[name]}
