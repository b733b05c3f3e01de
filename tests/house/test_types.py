"""What editors and type checkers see: the stub, the annotations, the cookbook."""

import ast
import importlib.util
import inspect
import json
import pydoc
import subprocess
import sys
from pathlib import Path
from typing import get_args

import pytest
from blocks import BLOCK
from grids import CHILD_ENVIRONMENT

import freesweep as fs
from freesweep.plot import curve, map, motion, section, style, tubes, validity

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "freesweep"
UNSEEN = (
    "numba matplotlib scipy pandas sympy dask distributed netCDF4 h5py llvmlite PIL tqdm"  # not looked into: seconds
)
SETTINGS = f"""
[mypy]
ignore_missing_imports = True
follow_imports = silent
[mypy-{",".join(f"{name}.*" for name in UNSEEN.split())}]
follow_imports = skip
follow_imports_for_stubs = True
"""
GOOD = """
import numpy as np
import xarray as xr
import freesweep as fs

rubber = fs.NeoHookean("0.1 MPa")
tube = fs.Actuator(
    alpha=30, beta=[(0, "30 deg"), (1, 40)], length="131 mm", radius=np.float64(4.76e-3), wall=lambda u: u, material=rubber
)
twice: float = 2 * tube.length
locked: xr.Dataset = fs.lock(tube, x=["1 mm", 0.1])
held: xr.Dataset = fs.blocked_force(tube, np.linspace(0, 1e5, 5), derivatives="all")
atlas: fs.Atlas = fs.sweep(alpha=(0, 80, 10), beta=np.arange(3), length=["1 mm"], pressure={"start": 0}, out="a.nc")
answer: xr.Dataset = atlas.query("rotation", alpha="20 deg", pressure=xr.DataArray([1.0], dims="pressure"))
fs.Measurement(tube, [1e4, 2e4], deformed_length=["190 mm", 0.18])
fs.Goal("rotation", "90 deg", pressure="1 bar")
stretch = fs.closed_form.locked_stretch("30 deg", [-30, -40])
"""
BAD = """
import freesweep as fs
fs.Actuator(alpha=30, beta=40)
fs.inflate(presure=1e5)
fs.lock(3)
fs.sweeep
fs.material(3)
"""


FACE = """
# pyright: reportUnknownMemberType=error, reportUnknownVariableType=error, reportUnknownParameterType=error
import freesweep as fs

{names}

def use(
    atlas: fs.Atlas, fit: fs.Calibration, curves: fs.Measurement, tube: fs.Actuator, goal: fs.Goal, rubber: fs.Yeoh,
    wrong: fs.ActuatorError,
) -> None:
    {members}
    asked = atlas.interpolator("rotation")
    asked.axes, asked.names
    found = fs.calibrate(curves).tubes[0].material
    silicone = fs.material("dragon-skin-30").c2
"""
OWNERS = {
    "atlas": fs.Atlas, "fit": fs.Calibration, "curves": fs.Measurement, "tube": fs.Actuator, "goal": fs.Goal,
    "rubber": fs.Yeoh, "wrong": fs.ActuatorError,
}  # fmt: skip
PAGES = [
    "README.md",
    *(f"docs/{name}.md" for name in ("model", "sweeps", "designing", "derivatives", "threads", "gallery", "export")),
]


def written(folder):
    """The files that are checked: the cookbook, what is right, and what is wrong from line 3 to 7."""
    (folder / "cookbook.py").write_text(code_of("docs/cookbook.md"))
    (folder / "good.py").write_text(GOOD)
    (folder / "bad.py").write_text(BAD)


def code_of(page):
    return "\n".join(block[1] for block in BLOCK.finditer((ROOT / page).read_text(encoding="utf-8")))


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_a_type_checker_reads_the_cookbook_and_sees_what_is_wrong(tmp_path):
    written(tmp_path)
    (tmp_path / "mypy.ini").write_text(SETTINGS)
    words = ["--config-file", "mypy.ini", "--cache-dir", "cache", "cookbook.py", "good.py", "bad.py"]
    environment = {"MYPYPATH": str(ROOT), "PATH": "", "HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *words], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert not [line for line in errors if not line.startswith("bad.py")], done.stdout
    assert {int(line.split(":")[1]) for line in errors} == {3, 4, 5, 6, 7}, done.stdout + done.stderr


@pytest.mark.skipif(importlib.util.find_spec("pyright") is None, reason="pyright is not installed")
def test_what_editors_run_reads_every_page_and_knows_every_public_type(tmp_path):
    """Pyright, basic: the pages' code is clean, faults are seen, and no public name or member is "partially unknown"."""
    written(tmp_path)
    for page in PAGES:
        (tmp_path / f"{Path(page).stem.lower()}.py").write_text(code_of(page))
    members = [
        f"{owner}.{name}"
        for owner, kind in OWNERS.items()
        for name in sorted({*vars(kind), *getattr(kind, "__annotations__", ())})
        if name[0] != "_"
    ]
    face = FACE.format(names=", ".join(f"fs.{name}" for name in sorted(fs.__all__)), members=", ".join(members))
    (tmp_path / "face.py").write_text(face)
    settings = {"typeCheckingMode": "basic", "extraPaths": [str(ROOT)], "include": ["."]}
    settings |= {"reportAttributeAccessIssue": "error", "reportUnusedExpression": "none"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    done = subprocess.run(
        [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable, "-p", "."],
        cwd=tmp_path, capture_output=True, text=True, env=CHILD_ENVIRONMENT,
    )  # fmt: skip
    found = json.loads(done.stdout)["generalDiagnostics"]
    told = [f"{Path(one['file']).name}:{one['range']['start']['line'] + 1}: {one['message']}" for one in found]
    assert not [line for line in told if not line.startswith("bad.py")], "\n".join(told)
    assert {int(line.split(":")[1]) for line in told} == {3, 4, 5, 6, 7}, done.stdout + done.stderr


def test_editors_complete_the_names_of_the_rubbers():
    from freesweep.description.material_library import Latex, Silicone

    for names, kind in ((Latex, fs.MooneyRivlin), (Silicone, fs.Yeoh)):
        assert [name for name, rubber in fs.materials.items() if type(rubber) is kind] == [*get_args(names)]


def test_the_stub_names_what_the_package_hands_out():
    imports = [
        node for node in ast.parse((PACKAGE / "__init__.pyi").read_text()).body if isinstance(node, ast.ImportFrom)
    ]
    told = {name.name: node.module for node in imports for name in node.names}
    assert all(name.name == name.asname for node in imports for name in node.names)  # else they are private there
    rooms = {name for name, module in told.items() if module is None}
    assert rooms | {"sweep"} == set(fs._ROOMS)
    homes = {name: module for name, module in told.items() if module is not None}
    assert homes == fs._HOMES | {"sweep": "sweep.from_python"}
    assert (PACKAGE / "py.typed").exists()


def test_help_is_short_enough_to_be_read():
    """Types are named, not spelled out; what is called and a room at once explains how it is called."""
    for name, function in public():
        told = str(inspect.signature(function))
        assert not [word for word in ("Union[", "ForwardRef") if word in told], name
    for one in (fs.Goal, fs.Limit, fs.Actuator, fs.Measurement, fs.Calibration):
        assert "freesweep." not in str(inspect.signature(one))
    assert "out : path of the atlas to make" in pydoc.plain(pydoc.render_doc(fs.sweep))


def test_objects_say_what_they_are_in_a_line():
    tube = fs.Actuator(alpha=30, beta=-30, length=0.2, radius=5e-3, wall=1e-3, material=fs.NeoHookean(1e5))
    assert (
        repr(fs.Goal("rotation", "90 deg", pressure="1 bar"))
        == "Goal(output='rotation', value='90 deg', pressure='1 bar')"
    )
    assert repr(fs.Limit("stroke", at_most=0.1)) == "Limit(output='stroke', at_most=0.1)"
    curve = fs.Measurement(tube, [1e4, 2e4], deformed_length=[0.19, 0.18])
    assert repr(curve) == f"<Measurement of deformed_length: 2 states at 10 kPa to 20 kPa of {tube}>"
    with fs.example_atlas() as atlas:
        asked = atlas.interpolator(["rotation", "volume"])
        assert repr(asked) == "<Interpolator of rotation, volume over alpha, beta, length, radius, pressure>"


def test_kinds_of_pictures_are_there_without_an_import():
    code = "import freesweep as fs; assert fs.plot.map.design_map and fs.plot.style.save; print(*dir(fs.plot))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=CHILD_ENVIRONMENT)
    assert done.stdout == "curve map motion section style tubes validity\n", done.stderr
    with pytest.raises(AttributeError, match="it has curve, map"):
        fs.plot.maps  # noqa: B018


def test_dir_shows_what_is_public():
    assert set(dir(fs)) == {*fs.__all__, "__version__", "plot", "status"}
    assert all(hasattr(fs, name) for name in dir(fs))


def public():
    """Every public function, and every public method of a public class."""
    plots = [map.design_map, section.section_map, section.multiples, curve.curve, tubes.shape_plot, motion.save_motion]
    yield from ((plot.__name__, plot) for plot in (*plots, validity.validity_map, validity.validity_maps, style.save))
    for name in [*fs.__all__, "closed_form"]:
        one = getattr(fs, name)
        if inspect.isclass(one) and not issubclass(one, Exception):
            methods = {key: value for key, value in vars(one).items() if key[0] != "_"}
            for key, value in methods.items():
                plain = value.__func__ if isinstance(value, classmethod) else value
                if inspect.isfunction(plain):
                    yield f"{name}.{key}", plain
        elif inspect.ismodule(one):
            yield from (
                (f"{name}.{key}", value)
                for key, value in vars(one).items()
                if key[0] != "_" and inspect.isfunction(value) and value.__module__ == one.__name__
            )
        elif inspect.isfunction(one):
            yield name, one


def test_every_public_function_is_annotated():
    seen = 0
    for name, function in public():
        signature = inspect.signature(function)
        given = [one for key, one in signature.parameters.items() if key not in ("self", "cls")]
        missing = [one.name for one in given if one.annotation is one.empty]
        assert not missing, f"{name}: {missing}"
        assert signature.return_annotation is not signature.empty, name
        seen += 1
    assert seen > 30
