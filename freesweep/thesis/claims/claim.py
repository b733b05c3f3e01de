"""One claim of the source: the text, a computation for each strain energy, and the verdict that follows from both."""

from collections.abc import Callable
from typing import NamedTuple

YES, PARTLY, NO, UNKNOWN = "agrees", "agrees in part", "disagrees", "cannot be checked"


class Found(NamedTuple):
    """What one strain energy says: numbers in words, and whether the claim holds (one of the four words above)."""

    value: str
    holds: str


class Claim(NamedTuple):
    """``where`` in the source, the ``figures`` it belongs to, its ``text``, ``check(energy)``, a ``remark``; ``physical()``
    says it of threads that cannot push.
    """

    where: str
    figures: tuple
    text: str
    check: Callable
    remark: str = ""
    physical: Callable | None = None


class Row(NamedTuple):
    """A checked claim."""

    where: str
    figures: tuple
    text: str
    principal: str
    full: str
    verdict: str
    physical: str
    remark: str


def judge(claim: Claim) -> Row:
    """Computes a claim with both strain energies of the source's tube, and with the physical tube."""
    principal, full = claim.check("principal"), claim.check("full")
    physical = claim.physical() if claim.physical else None
    return Row(
        claim.where, claim.figures, claim.text, principal.value, full.value, verdict(principal, full),
        f"{physical.holds}: {physical.value}" if physical else "", claim.remark,
    )  # fmt: skip


def verdict(principal: Found, full: Found) -> str:
    """One verdict of two: the common one, or each by name."""
    if principal.holds == full.holds:
        return principal.holds
    if {principal.holds, full.holds} == {YES, NO}:
        return f"agrees with {'principal' if principal.holds == YES else 'full'} only"
    return f"principal {principal.holds}, full {full.holds}"


def holds(condition) -> str:
    """The word for a condition that is met or not."""
    return YES if condition else NO
