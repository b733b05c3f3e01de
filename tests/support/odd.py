"""Odd values that a caller may hand in, and what may come of them: faults, and nothing else."""

import warnings
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import xarray as xr

import freesweep as fs

FACTORS = {"kPa": ("Pa", 1e3), "mm": ("m", 1e-3), "rad": ("degree", 180.0 / np.pi)}


class Quantity(np.ndarray):
    """What astropy's and unyt's arrays are: numbers with a unit, which NumPy drops."""

    def __new__(cls, values, unit):
        made = np.asarray(values, float).view(cls)
        made.unit = unit
        return made

    def __array_finalize__(self, other):
        self.unit = getattr(other, "unit", None)

    def to(self, target):
        kept, factor = FACTORS[self.unit]
        if target != kept:
            raise TypeError("units do not agree")
        return SimpleNamespace(value=np.asarray(self) * factor)


class Wrapped:
    """What pint's are: an object around numbers."""

    def __init__(self, magnitude, units):
        self.magnitude, self.units = magnitude, units

    def to(self, target):
        return SimpleNamespace(magnitude=Quantity(self.magnitude, self.units).to(target).value)


CYCLE = []
CYCLE.append(CYCLE)


class Hostile:
    """Everything about it fails."""

    def __array__(self, *_, **__):
        raise RuntimeError("no array")

    def __repr__(self):
        raise RuntimeError("no text")


ODD = [
    *(
        None,
        True,
        "",
        "x",
        "4 mm",
        "1 Pa",
        "nan",
        b"3",
        1j,
        0,
        -1,
        -0.0,
        1e-300,
        1e200,
        10**400,
        np.nan,
        np.inf,
        -np.inf,
    ),
    *(
        Fraction(1, 3),
        Fraction(10**400),
        np.float16(3),
        np.longdouble("1e400"),
        np.bool_(True),
        np.datetime64("2020-01-01"),
    ),
    *(
        [],
        [1],
        [1, 2],
        [[1], [1, 2]],
        [(0, 1), (1, 2)],
        [(0, 1), (0.5, 2), (np.nextafter(0.5, 1), 3), (1, 4)],
        (),
        {},
        {1: 2},
    ),
    *(
        CYCLE,
        {1: 2},
        {3},
        range(3),
        object(),
        Hostile(),
        float,
        np.sin,
        lambda share: None,
        lambda share: 1 / 0,
        iter([1.0]),
    ),
    *(
        np.zeros(0),
        np.zeros((2, 2)),
        np.array("x"),
        np.array([None]),
        np.array([1, "a"], object),
        np.ma.masked,
        slice(3),
    ),
    *(np.array([(1, 2.0)], dtype="i4,f8"), xr.DataArray([1.0], dims="x", attrs={"units": "furlong"}), xr.Dataset()),
    *(Quantity([1, 2], "kPa"), Quantity(1, "mm"), Wrapped(1, "kPa"), Wrapped("a", "kPa"), Wrapped(None, "mm")),
]


def only_clear_errors(call, given):
    """Call, and let nothing but ActuatorError out, every fault of which is a short line about an argument."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            call(**given)
        except fs.ActuatorError as error:
            for fault in error.faults:
                assert fault.isprintable(), fault
                assert len(fault) < 700, fault
                assert fault.partition(":")[2].strip(), fault
        except OSError:
            assert call is fs.read_measurements
