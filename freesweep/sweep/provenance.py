"""What an atlas says of where it comes from: its attributes."""

import platform

import numpy as np

from ..description.tube_model import ATTRIBUTES, attributes_of
from ..thick_wall import grid_attributes
from . import along
from .grid import coordinates
from .rubber import rubber_attributes

# only of some specifications
FOLLOWING = (
    *("interpolation_tolerance", "material", "material_source", "largest_stretch", *ATTRIBUTES.values()),
    *(f"{kind}_{name}" for kind in ("profile", "smooth", "rule", "family") for name in along.VARYING),
)


def specified(sweep) -> dict:
    """What follows from the specification alone."""
    tolerance = sweep.interpolation_tolerance
    return {
        "title": sweep.title,
        "specification": sweep.text,
        "specification_sha256": sweep.sha256,
        "energy": sweep.energy,
        "accuracy": sweep.accuracy,
        **along.attributes_of(sweep),
        **attributes_of(sweep.model),
        **({} if tolerance is None else {"interpolation_tolerance": tolerance}),
        **rubber_attributes(sweep),
    }


def _of_thick_walls(sweep):
    import xarray as xr

    return grid_attributes(xr.Dataset(coords=coordinates(sweep), attrs=specified(sweep)))


def provenance(sweep, tables, identity, started) -> dict:
    """All of it; ``identity`` of specification and code, ``started`` when the sweep was begun."""
    return {
        "title": sweep.title,
        "Conventions": "CF-1.11",
        "source": f"freesweep {identity['version']}",
        **specified(sweep),
        **_of_thick_walls(sweep),
        **identity,
        "started": started,
        "distinct_problems": sum(table.count for table in tables.values()),
        "distinct_equilibria": sum(table.equilibria for table in tables.values()),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }
