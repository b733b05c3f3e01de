"""Pictures: each kind has a module of its own, loaded when it is first asked for, as in ``fs.plot.map.design_map(...)``."""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import curve as curve
    from . import map as map
    from . import motion as motion
    from . import section as section
    from . import style as style
    from . import tubes as tubes
    from . import validity as validity

_ROOMS = ("curve", "map", "motion", "section", "style", "tubes", "validity")


def __getattr__(name):
    if name in _ROOMS:
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(_ROOMS)}")


def __dir__():
    return [*_ROOMS]
