"""netCDF4 files as xarray Datasets, on any file system.

The HDF5 library locks what it opens, even to read it, and refuses a file where there are no locks, as on some network
disks; Python's netCDF4 cannot tell it not to. There the file is read into memory, which needs no lock.
"""

from pathlib import Path

from .files import NO_LOCKS


def dataset(path):
    """The Dataset in the file at ``path``, its numbers read when they are used; raises what the libraries raise."""
    import xarray as xr

    if _has_locks(path):
        return xr.open_dataset(path, engine="netcdf4", decode_times=False)
    import netCDF4

    store = xr.backends.NetCDF4DataStore(netCDF4.Dataset(Path(path).name, memory=Path(path).read_bytes()))
    return xr.open_dataset(store, decode_times=False)


def _has_locks(path):
    try:
        import fcntl
    except ImportError:  # not a POSIX system
        return True
    with Path(path).open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError as error:
            return error.errno not in NO_LOCKS  # locked by another: HDF5 shall say so
    return True
