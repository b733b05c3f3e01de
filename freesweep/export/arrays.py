"""Tables as arrays: NumPy's .npz, MATLAB's .mat."""

import io

import numpy as np

from .table import Grid, meanings


def as_npz(grid: Grid, _) -> bytes:
    """Arrays by name; ``order`` names the axes of the variables, ``units`` (n, 2) holds names and units; nothing pickled."""
    file = io.BytesIO()
    np.savez_compressed(
        file,
        **grid.axes,
        **grid.columns,
        **grid.fixed,
        order=np.array(list(grid.axes), dtype=str),
        units=np.array(list(grid.units.items()), dtype=str),
        statuses=np.array(list(meanings().values()), dtype=str),
        title=np.array(grid.attrs.get("title", "")),
    )
    return file.getvalue()


def as_mat(grid: Grid, _) -> bytes:
    """MATLAB variables by name; ``order`` is a cell of the axes' names, ``units`` a structure, ``statuses`` a cell."""
    from scipy.io import savemat

    content = dict(grid.axes) | dict(grid.columns) | dict(grid.fixed)
    content |= {
        "order": np.array(list(grid.axes), dtype=object),
        "units": grid.units,
        "statuses": np.array(list(meanings().values()), dtype=object),
        "title": grid.attrs.get("title", ""),
    }
    file = io.BytesIO()
    savemat(file, content, long_field_names=True, oned_as="column", do_compression=True)
    return file.getvalue()
