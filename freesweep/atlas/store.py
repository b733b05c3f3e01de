"""Atlases as netCDF4 files: opened lazily, once they are known to be harmless."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..description.given import described
from ..description.options import read_choice, read_path
from ..description.quantities import Names, Quantities
from ..report import quantity
from ..status import STATUSES
from . import netcdf
from .content import faults
from .files import check_environment
from .guard import Unsafe, check_structure
from .schema import STATUS_OF
from .seal import has_seal

if TYPE_CHECKING:
    import xarray as xr

    from ..query.interpolator import Interpolator

FORMAT = "1"
MOST_FAULTS = 20  # listed of one file
READ_AT_ONCE = 1 << 22  # numbers
UNSEALED = (
    "has no seal: it was changed after it was written, or freesweep did not write it; no bound in it is vouched for"
)

SINGLE = (
    "is no atlas: it holds states of one actuator, as inflate, lock and block keep them; freesweep plot curve draws them,"
    " xarray.open_dataset reads them"
)


class AtlasError(ValueError):
    """A file that is no atlas, or not the one asked for."""


class UnsealedWarning(UserWarning):
    """An atlas was changed after it was written, or another program wrote it: its bounds are nobody's word."""


@dataclass(frozen=True)
class Atlas:
    """A design atlas: ``data`` is the xarray Dataset, ``path`` the file.

    Pickled, it is the path: it is opened anew where it arrives, once in a process.
    """

    data: xr.Dataset
    path: Path

    def __post_init__(self):
        import xarray as xr

        faults = []
        path = read_path("path", self.path, "an atlas", faults)
        if not isinstance(self.data, xr.Dataset):
            faults.append(f"data: found {described(self.data)}; give an xarray Dataset, or use open_atlas(path)")
        if faults:
            raise AtlasError("\n  - ".join(["this makes no atlas:", *faults]))
        object.__setattr__(self, "path", path)
        object.__setattr__(self, "_place", path.absolute())  # wherever the process goes

    def __reduce__(self):
        return _reopened, (self._place,)

    def __repr__(self):
        axes = ", ".join(f"{name} {size}" for name, size in self.data.sizes.items())
        counts = "; ".join(f"{meaning} {count:,}" for meaning, count in self.status_counts().items())
        return f"<Atlas {self.path.name}: {self.data.attrs.get('title', '')}\n  {axes}\n  {counts}>"

    def _repr_html_(self):
        from ..notebook import of_atlas

        return of_atlas(self)

    def status_counts(self, name: str = "status") -> dict[str, int]:
        """How many points of the grid have which status, of the equilibrium or of another state: meaning -> count.

        Raises :class:`AtlasError` for a ``name`` that is no status of this atlas.
        """
        faults = []
        if read_choice("name", name, [status for status in STATUS_OF if status in self.data], faults) is None:
            raise AtlasError(*faults)
        codes = self.data[name]
        rows = max(1, READ_AT_ONCE * len(codes) // codes.size) if codes.ndim else 1
        slabs = [codes[k : k + rows] for k in range(0, len(codes), rows)] if codes.ndim else [codes]
        counts = sum(np.bincount(slab.values.ravel(), minlength=len(STATUSES)) for slab in slabs)
        return {row.meaning: int(count) for row, count in zip(STATUSES, counts) if count}

    @functools.cached_property
    def _reader(self):
        from ..query.query import Reader

        return Reader(self.data)

    def query(
        self,
        variables: Names = None,
        method: str = "cubic",
        refine: bool = False,
        x: Quantities | None = None,
        **axes: Quantities,
    ) -> xr.Dataset:
        """What the atlas says of any design and load within its grid.

        Parameters
        ----------
        axes : one keyword for each axis, in the units of the API: a number, an array or a DataArray. Plain arrays
            broadcast as in NumPy, DataArrays by the names of their dimensions. Axes of one value may be left out
        variables : names of stored variables; default: all
        method : "cubic" (once continuously differentiable) or "linear"
        refine : solve exactly where the atlas cannot answer (status 9), with the solver's error bounds
        x : with ``refine``, stations [m] at which profiles along the tube are solved for and added

        Returns a Dataset: each ``<name>`` with ``<name>_error``, a bound on interpolation and discretization together, its
        status and flags. Angles that the grid lacks are answered by exchange of the fiber families and by the mirror.
        Cells that touch a failed node, a limit, the line alpha = beta or a change of stability are not interpolated
        (status 9), nor are points whose stated error exceeds the atlas' ``interpolation_tolerance``: the attribute
        ``too_coarse`` of the answer says along which axes the nodes lie too far apart, at how many points. Nothing is
        extrapolated (status 8). Raises :class:`freesweep.query.faults.QueryError`, which lists every fault.
        """
        from ..query.query import query

        return query(self._reader, axes, variables, method, refine, x)

    def curve(self, along: str, values: Quantities | None = None, **query: Any) -> xr.Dataset:
        """Answers along one axis, such as "pressure": :meth:`query` at ``values`` or at 201 of them over its range.

        A force-stroke or torque-rotation family is the curve of an atlas with held lengths or rotations along that axis.
        ``query`` holds the other axes, and ``variables``, ``method``, ``refine``. Raises QueryError.
        """
        from ..query.query import curve

        return curve(self._reader, along, values, query)

    def interpolator(self, names: str | Sequence[str]) -> Interpolator:
        """A callable for loops and optimizers: ``f(*values, gradient=False)``, see
        :class:`freesweep.query.interpolator.Interpolator`.

        ``names`` is a variable or a list of them; the values are given in the order of ``f.axes``. Raises QueryError.
        """
        from ..query.interpolator import Interpolator

        return Interpolator(self, names)

    def export(
        self,
        path: str | PathLike[str],
        to: str | None = None,
        variables: Names = None,
        derivatives: bool = False,
        **axes: Quantities,
    ) -> Path:
        """Write a slice as a table for another program, with unit, error and status of each number.

        Parameters
        ----------
        path : the file to make
        to : "csv", "npz", "mat", "c" (a header), "json", "mujoco" (a small model), "simulink" (a MATLAB script); default: by
            the suffix of ``path`` (.csv, .npz, .mat, .h, .json, .xml, .m)
        variables : names of stored variables; default: all
        derivatives : those of each variable by each axis, too (of the interpolant)
        axes : where: a number, or ascending numbers along which the table runs; ``design`` by its name. Axes left out run
            over their own nodes. Numbers at nodes are the stored ones, others those of :meth:`query`

        Returns the path. Raises QueryError, ExportError, EnvironmentFault.
        """
        from ..export.write import export

        return export(self, path, to, variables, derivatives, axes)

    def close(self) -> None:
        """Let go of the file."""
        self.data.close()

    def __enter__(self) -> Atlas:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_atlas(path: str | PathLike[str]) -> Atlas:
    """Open an atlas; its numbers are read when they are used.

    The file may be anybody's: nothing but this file is read, and it is refused with the reason unless it is an atlas in
    structure and content (:func:`freesweep.verification.verify.faults` says whether every bit is the one that was
    written). A file without a seal, as of tools that add an attribute or join atlases, gives an
    :class:`UnsealedWarning`. Raises FileNotFoundError, EnvironmentFault, or :class:`AtlasError` for what is no path, or
    no atlas of this program.
    """
    unread = []
    if (path := read_path("path", path, "an atlas", unread)) is None:
        raise AtlasError(*unread)
    if not path.exists():
        raise FileNotFoundError(f"no atlas at {path}; make one with: freesweep sweep SPEC -o {path.name}")
    data = open_results(path)
    try:
        found = data.attrs.get("freesweep_format")
        if found is None and "status" in data and "x" in data.dims:
            raise AtlasError(f"{path} {SINGLE}")
        if found != FORMAT or "status" not in data:
            raise AtlasError(f"{path} is no freesweep atlas of format {FORMAT} (found format {found!r:.40})")
        if wrong := [fault for fault, _ in zip(faults(data), range(MOST_FAULTS))]:
            raise AtlasError("\n  - ".join([f"{path} is no atlas:", *wrong]))
    except AtlasError:
        data.close()
        raise
    except Exception as error:  # the libraries raise many kinds for a damaged file
        data.close()
        check_environment(path, error)
        raise AtlasError(f"{path} is no readable atlas: {error}") from error
    if not has_seal(path):
        warnings.warn(f"{path} {UNSEALED}", UnsealedWarning, stacklevel=2)
    return Atlas(data, path)


def _reopened(path) -> Atlas:
    """An atlas that was pickled as its path."""
    there = path.stat() if path.exists() else None
    return _opened(path, there and (there.st_mtime_ns, there.st_size, there.st_ino))


@functools.lru_cache(maxsize=1)  # tasks of a worker that bring the same atlas share its tables
def _opened(path, _) -> Atlas:
    return open_atlas(path)


def open_results(path):
    """The Dataset in a file of this program, an atlas or the results of one actuator, read when it is used.

    Raises :class:`AtlasError` for a file that cannot be read, or that a stranger may have made to do harm.
    """
    try:
        check_structure(path)
    except Unsafe as refusal:
        raise AtlasError(f"{path} is no readable netCDF4 file: {refusal}") from refusal
    try:
        return netcdf.dataset(path)
    except Exception as error:
        check_environment(path, error)
        raise AtlasError(f"{path} is no readable netCDF4 file: {error}") from error


def describe(atlas) -> str:
    """What an atlas holds, in words: axes with ranges, variables with units, statuses, provenance."""
    data = atlas.data
    lines = [f"{atlas.path}: {data.attrs.get('title', '')}", "", "axes"]
    for name, size in data.sizes.items():
        values = data[name].values
        unit = data[name].attrs.get("units", "")
        ends = [quantity(values[k], unit) for k in (0, -1)] if values.dtype.kind == "f" else map(str, values)
        span = " .. ".join(ends) if values.dtype.kind == "f" else ", ".join(ends)
        lines.append(f"  {name:<18}{size:>6}  {span}")
    lines += ["", "fixed"]
    for name, value in data.coords.items():
        if value.ndim == 0:
            lines.append(f"  {name:<18}{'':>8}{quantity(float(value), value.attrs.get('units', ''))}")
    lines += ["", "variables, in units of the file"]
    for name, variable in data.data_vars.items():
        if not name.endswith("_error"):
            bound = ", with error bound" if f"{name}_error" in data else ""
            unit = variable.attrs.get("units")
            about = ("comment", "long_name") if unit else ("long_name",)  # comments of flags are long
            said = next((variable.attrs[each] for each in about if each in variable.attrs), "")
            lines.append(f"  {name:<28}{f'[{unit}]' if unit else '[flag]':<10}{said}{bound}")
    lines += ["", "statuses"]
    for status in (name for name in STATUS_OF if name in data):
        lines += [
            f"  {status}",
            *(f"    {meaning:<26}{count:>12,}" for meaning, count in atlas.status_counts(status).items()),
        ]
    from ..query.calibration import ATTRIBUTE, describe_measured

    lines += describe_measured(data)
    apart = ("specification", "title", ATTRIBUTE)
    seal = "there; freesweep verify holds it against every bit" if has_seal(atlas.path) else UNSEALED
    lines += ["", "provenance", f"  {'seal':<22}{seal}"]
    lines += [f"  {name:<22}{value}" for name, value in data.attrs.items() if name not in apart]
    return "\n".join(lines)
