"""What is asked beside numbers, read in one place: switches, names out of a few, counts and paths.

Each function gives what was asked for, or None after noting in ``faults`` what is wrong with it.
"""

import errno
import os
from numbers import Integral
from pathlib import Path

import numpy as np

from .given import described

NO_NAMES = (errno.ENAMETOOLONG, errno.ELOOP)  # what else a disk says is told by who opens the file


def read_switch(name, value, faults):
    """True or False."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    faults.append(f"{name}: found {described(value)}; give True or False")
    return None


def read_choice(name, value, allowed, faults):
    """One of the texts ``allowed``."""
    if isinstance(value, str) and value in allowed:
        return value
    faults.append(f"{name}: found {described(value)}; choose one of {', '.join(map(repr, allowed))}")
    return None


def read_count(name, value, faults):
    """A whole number, 1 or more."""
    if isinstance(value, Integral) and not isinstance(value, bool) and value >= 1:
        return int(value)
    faults.append(f"{name}: found {described(value)}; give a whole number, 1 or more")
    return None


def read_path(name, value, of, faults):
    """A path, ``of`` what, that may lead to a file or to nothing."""
    if not isinstance(value, (str, os.PathLike)) or not isinstance(os.fspath(value), str):
        faults.append(f"{name}: found {described(value)}; give the path of {of}")
        return None
    try:
        os.lstat(value)
    except ValueError:  # a zero byte, or what is no character
        faults.append(f"{name}: found {described(value)}; no file can have that name; give the path of {of}")
        return None
    except OSError as error:
        if error.errno in NO_NAMES:
            faults.append(f"{name}: found {described(value)}: {error.strerror}; give the path of {of}")
            return None
    return Path(value)
