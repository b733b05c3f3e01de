"""Whatever is given to sweeps and atlases, they answer, or their own error says what is wrong: none comes from inside.

What describes tubes and loads is tried in test_given.
"""

import contextlib
import inspect
import warnings
from pathlib import Path

import pytest
from grids import SMALL, swept
from odd import ODD, only_clear_errors

import freesweep as fs
from freesweep.atlas.files import EnvironmentFault
from freesweep.atlas.store import AtlasError
from freesweep.query.faults import QueryError
from freesweep.sweep.shards import SweepError
from freesweep.sweep.spec import SpecificationError

OWN = (fs.ActuatorError, AtlasError, QueryError, SweepError, SpecificationError, EnvironmentFault, FileNotFoundError)


class Unwilling:
    """Refuses whatever any object may be asked for."""

    __hash__ = None

    def __repr__(self):
        raise RuntimeError("no text")

    def __bool__(self):
        raise RuntimeError("no truth")

    def __eq__(self, other):
        raise RuntimeError("no likeness")

    def __iter__(self):
        raise RuntimeError("no parts")


ODDER = (*ODD, Unwilling(), "\ud800", "a\0b", "x" * 5000, b"x", Path("no/such/file"), Path("/"))


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    with swept(tmp_path_factory.mktemp("odd"), SMALL) as atlas:
        yield atlas


def tried(function, right):
    """One argument odd at a time."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # slips of units
        for name in right:
            default = inspect.signature(function).parameters.get(name)
            for odd in ODDER:
                if odd is not None or default is None or default.default is not None:
                    with contextlib.suppress(*OWN):
                        function(**right | {name: odd})


def test_an_odd_question_is_refused_or_answered(atlas):
    place = {name: values[0] for name, values in SMALL.items()}
    tried(fs.open_atlas, {"path": atlas.path})
    tried(fs.Atlas, {"data": atlas.data, "path": atlas.path})
    tried(atlas.status_counts, {"name": "status"})
    tried(atlas.query, place | {"variables": "rotation", "method": "cubic", "refine": False, "x": None})
    tried(atlas.query, {"refine": True, "x": [0.0], **place, "variables": "rotation"})
    tried(atlas.curve, {"along": "pressure", "values": [1e4], "variables": "rotation"})
    tried(atlas.interpolator, {"names": "rotation"})
    rotation = atlas.interpolator("rotation")
    tried(lambda pressure, gradient: rotation(pressure, gradient=gradient), {"pressure": 1e4, "gradient": True})


def test_an_odd_sweep_is_refused_as_long_as_nothing_is_solved(tmp_path):
    names = ("spec", "out", "threads", "executor", "progress", "overwrite")
    tried(fs.run_sweep, dict(zip(names, (tmp_path / "none.toml", tmp_path / "a.nc", 1, None, False, False))))
    assert not list(tmp_path.iterdir())


def test_each_fault_of_a_call_is_told_at_once():
    with pytest.raises(SweepError) as caught:
        fs.run_sweep(5, b"a.nc", threads=0, executor="dask", progress="no", overwrite=1)
    found = str(caught.value).splitlines()[1:]
    names = [line.split(":")[0].strip(" -") for line in found]
    assert names == ["spec", "out", "threads", "executor", "progress", "overwrite"]
    assert "give the path of a TOML specification" in found[0]
    with pytest.raises(AtlasError, match="path: found int 3; give the path of an atlas"):
        fs.open_atlas(3)


def test_a_folder_is_no_csv_file(tmp_path):
    with pytest.raises(fs.ActuatorError, match="is a folder; give the paths of CSV files"):
        fs.read_measurements(tmp_path)
    for path in ("\ud800", "a\0b", "x" * 5000, b"m.csv", 3):
        only_clear_errors(fs.read_measurements, {"paths": path})
