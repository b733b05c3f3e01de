"""Every kernel that an atlas needs to measure itself, compiled before there is one: on an atlas of made-up numbers."""

import numpy as np

from ..atlas.schema import VARIABLES, without
from .answer import SORTED, Inquiry
from .family import FAMILIES, TOLD_FROM
from .measure import measured
from .physical_along import TOLD, slack_somewhere, worst_places
from .physical_tube import MOONEY_RIVLIN, YEOH, physical_states
from .query import Reader
from .reference import COLUMNS, LOADED, UNIFORM

AXES = {"alpha": [20.0, 30.0, 40.0], "beta": [-60.0, -50.0, -40.0], "pressure": [2e4, 4e4, 8e4]}
FIXED = {"length": 0.1, "radius": 5e-3, "fiber_radius": 5e-3, "wall": 1.5e-3, "c10": 2e5, "c01": 0.0}
KEYS = ("state", "locked")  # the families of variables in it; others need no other machine code
DESIGNS = 2  # which plain Python solves, as no kernel need be there for them


def compile_kernels():
    """Do once, in little, what measuring does."""
    with np.errstate(all="ignore"):  # warnings are not to be caught: that is no thread's own
        data = _made_up()
        measured(data, DESIGNS)
        many = {name: np.full(SORTED + 1, values[0]) for name, values in AXES.items()}
        Inquiry((reader := Reader(data)).table("state"), reader.complete(many, SORTED + 1))


def compile_physical(constants):
    """Compile what tells uniform physical tubes of the solver's columns of a rubber's ``constants``."""
    columns = YEOH if len(constants) > 1 else MOONEY_RIVLIN
    points, numbers = np.empty((0, len(COLUMNS))), np.empty(0)
    physical_states(LOADED, points, 1.0, 1.0, columns, np.empty((0, UNIFORM)))
    slack_somewhere(points, numbers, 1.0, 1.0, columns, np.empty(0, np.uint8))
    worst_places(points, numbers, np.empty((0, 2)), 1.0, 1.0, columns, np.empty((0, 3, TOLD)), np.empty((0, TOLD)))


def _read(array):
    """An array as a file gives it: not to be written to."""
    array.flags.writeable = False
    return array


def _made_up():
    """A Dataset as an atlas holds it: the same types."""
    import xarray as xr

    data = xr.Dataset(coords=AXES | FIXED | {"fiber_extension": 1.0, "force": 0.0, "torque": 0.0})
    for name in (name for key in KEYS for name in (*FAMILIES[key].variables, FAMILIES[key].status)):
        if name in TOLD_FROM:  # of physical tubes
            continue
        dims = [axis for axis in AXES if axis not in without(name)]
        shape = [len(AXES[axis]) for axis in dims]
        if name in VARIABLES:
            data[name] = dims, _read(np.ones(shape))
            data[f"{name}_error"] = dims, _read(np.full(shape, 1e-9, np.float32))
        else:
            data[name] = dims, _read(np.zeros(shape, np.int8))
    data["stable"] = data["status"]
    data["slack_fiber"] = data["status"] + (data["alpha"] > AXES["alpha"][1])  # cells with and without
    return data.assign_attrs(energy="full", accuracy=1e-6)
