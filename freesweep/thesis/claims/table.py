"""All claims of the source in the order of its sections, judged."""

from . import kinematics, muscles, rotating, sleeve, varying
from .claim import Row, judge

CLAIMS = (*kinematics.CLAIMS, *muscles.CLAIMS, *rotating.CLAIMS, *varying.CLAIMS, *sleeve.CLAIMS)
COLUMNS = ("where", "figures", "claim", "principal", "full", "verdict", "physical tube", "remark")


def judged(figures=None) -> list[Row]:
    """Every claim, or those that belong to some ``figures``, computed with both strain energies."""
    wanted = [claim for claim in CLAIMS if figures is None or set(claim.figures) & set(figures)]
    return [judge(claim) for claim in wanted]


def rows_of(judged) -> list[tuple]:
    """The table as texts, one tuple of COLUMNS for each claim."""
    return [(row.where, " ".join(row.figures), *row[2:]) for row in judged]
