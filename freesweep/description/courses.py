"""The courses of designs that vary along their length, each followed once."""

import numpy as np

from .impossible import APART
from .profiles import ProfileError, together
from .revolution import resolved
from .splines import SENSITIVITY, follow

SHARE = 0.03  # of the accuracy that the splines of one of many courses may use: they are short, and soon made


def distinct(columns, names):
    """What of designs (name -> (n,)) is told by ``names``, each once, (k, names), and which is whose (n,)."""
    count = len(next(iter(columns.values())))
    return np.unique(
        np.column_stack([columns.get(name, np.zeros(count)) for name in names]), axis=0, return_inverse=True
    )


def followed(tube, accuracy, ruled=False):
    """``(course, error)`` of a tube as :func:`.splines.follow` gives them, None of one that there is not; where its angles
    follow rules (``ruled``) they are not known to stay apart.
    """
    try:
        if ruled:
            parts = resolved(tube)
            alpha, beta = together(parts.first, parts.second)
            if np.abs(alpha - beta).min() < APART or len(set(np.sign(alpha - beta))) > 1:
                return None
        return follow(tube, accuracy, SHARE * accuracy / SENSITIVITY)
    except ProfileError:
        return None
