"""Small sweeps for tests, written as a person would write them."""

import os
from pathlib import Path

import xarray as xr

import freesweep
from freesweep import run_sweep
from freesweep.atlas import schema
from freesweep.atlas.files import write_whole
from freesweep.atlas.seal import sealed
from freesweep.atlas.store import FORMAT
from freesweep.sweep.spec import parse

# for child processes, wherever they start: the package under test, and these modules
CHILD_ENVIRONMENT = os.environ | {
    "PYTHONPATH": os.pathsep.join([str(Path(freesweep.__file__).parents[1]), str(Path(__file__).parent)])
}

FIXED = {"length": 0.1, "radius": 4.76e-3, "wall": 1.59e-3, "c10": 0.17e6, "c01": 0.08e6}
GRID = {
    "alpha": [-25.0, 10.0, 30.0],
    "beta": [-30.0, 30.0, 30.25, 50.0],
    "fiber_radius": [4.76e-3, 5.5e-3],
    "c10": [0.1e6, 0.2e6],
    "force": [-0.4, 0.0, 2.0],
    "torque": [-5e-3, 0.0, 8e-3],
    "pressure": [0.0, 2e4, 1e5],
}
SMALL = {"alpha": [20.0], "beta": [-50.0], "pressure": [0.0, 5e4]}


def spec(axes, designs=(), fixed=None, title="A sweep", energy="full"):
    """The text of a specification: numbers in SI units and degrees."""
    own = set.intersection(*map(set, designs)) if designs else set()
    fixed = {name: value for name, value in (FIXED | (fixed or {})).items() if name not in {*axes, *own}}
    lines = [f'title = "{title}"', "[actuator]", f'energy = "{energy}"']
    lines += [f"{name} = {value!r}" for name, value in fixed.items() if name != "pressure"]
    lines += ["[load]", f"pressure = {fixed['pressure']!r}"] if "pressure" in fixed else []
    lines += ["[axes]", *(f"{name} = {values}" for name, values in axes.items())]
    for design in designs:
        lines += ["[[designs]]", *(f"{name} = {value!r}" for name, value in design.items())]
    return "\n".join(lines)


def swept(folder, *arguments, threads=2, **more):
    sweep = parse(spec(*arguments, **more))
    return run_sweep(sweep, folder / "atlas.nc", threads=threads, progress=False)


def make(out, sweep, threads=2, **more):
    """The dataset of a sweep, read and closed."""
    with run_sweep(sweep, out, threads=threads, progress=False, **more) as atlas:
        return atlas.data.load()


def only(folder, *names):
    assert sorted(path.name for path in folder.iterdir()) == sorted(names)


def completed(made):
    """A made-up Dataset with what it lacks of an atlas: coordinates, attributes, bounds, statuses of locked shapes."""
    made = made.sortby([name for name in made.dims if name != "design"])
    fixed = FIXED | {"pressure": 1e5}
    made = made.assign_coords({name: value for name, value in fixed.items() if name not in made.coords})
    of_locked = [name for name in made.dims if name not in schema.without("locked_status")]
    made["locked_status"] = xr.zeros_like(
        made["status"].isel({name: 0 for name in {*made.dims} - {*of_locked}}, drop=True)
    )
    for name in [name for name in schema.VARIABLES if name in made]:
        made[f"{name}_error"] = made[name] * 0.0
    for name in made.variables:
        made[name].attrs = schema.attributes(name) if name != "design" else {}
    texts = {name: "made up" for name in ("title", "specification", "specification_sha256", "code_sha256", "version")}
    return made.assign_attrs(texts | {"energy": "full", "accuracy": 1e-6} | made.attrs)


def store(dataset, path):
    """Write a Dataset as if it were an atlas, seal and all: for files that no sweep makes."""
    encoding = {
        name: {"zlib": True, "complevel": 1, "shuffle": True, "_FillValue": None}
        for name, variable in dataset.variables.items()
        if variable.ndim > 0 and variable.dtype.kind in "fiu"
    }
    content = dataset.assign_attrs(freesweep_format=FORMAT).to_netcdf(engine="netcdf4", encoding=encoding)
    write_whole(path, sealed(content))
