"""The rules that keep the rooms of the package apart, run as tests."""

import ast
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from grids import CHILD_ENVIRONMENT, SMALL, make, spec

from freesweep.sweep.spec import parse

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def program(name):
    """Path of a program installed beside the running Python, or on the path; skips the test where there is none."""
    found = shutil.which(name, path=str(Path(sys.executable).parent)) or shutil.which(name)
    return found or pytest.skip(f"{name} is not installed")


def run(*words):
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, env=CHILD_ENVIRONMENT)


def test_import_contracts_are_kept():
    contracts = PROJECT["tool"]["importlinter"]["contracts"]
    assert contracts
    done = run(program("lint-imports"), "--no-cache")
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"Contracts: {len(contracts)} kept, 0 broken." in done.stdout


@pytest.mark.parametrize("words", [("check",), ("format", "--check")], ids=" ".join)
def test_source_follows_the_style(words):
    done = run(program("ruff"), *words, "freesweep", "tests")
    assert done.returncode == 0, done.stdout + done.stderr


READING = """
import sys
from freesweep.atlas.store import describe, open_atlas
with open_atlas(sys.argv[1]) as atlas:
    assert "A sweep" in describe(atlas) and "ok 2" in repr(atlas)
    assert atlas.data["status"].values.ravel().tolist() == [0, 0]
import freesweep.sweep.plan, freesweep.statics, freesweep.closed_form, freesweep.plot.map
loaded = sorted(name for name in sys.modules if name.startswith(("freesweep.solver", "numba", "llvmlite")))
assert not loaded, loaded
"""


def test_reading_an_atlas_needs_no_solver(tmp_path):
    make(tmp_path / "atlas.nc", parse(spec(SMALL)))
    done = run(sys.executable, "-c", READING, str(tmp_path / "atlas.nc"))
    assert done.returncode == 0, done.stderr


def test_importing_the_package_loads_nothing_heavy():
    code = (
        "import sys, freesweep; print(sorted({'numpy', 'numba', 'xarray', 'matplotlib', 'scipy'} & set(sys.modules)))"
    )
    done = run(sys.executable, "-c", code)
    assert done.stdout == "[]\n", done.stderr


def test_every_public_name_is_there_and_documented():
    import freesweep

    assert len(freesweep.__all__) == len(set(freesweep.__all__))
    assert set(freesweep.__all__) <= set(dir(freesweep))
    for name in freesweep.__all__:
        assert getattr(freesweep, name).__doc__, name
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        freesweep.nonsense  # noqa: B018


def test_what_is_imported_at_run_time_is_declared():
    """Third-party modules that the package names in its import statements."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in (ROOT / "freesweep").rglob("*.py")]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    modules = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    modules += [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 0]
    named = {name.split(".")[0] for name in modules}
    extras = PROJECT["project"]["optional-dependencies"]
    extra = [*extras["dask"], *extras["completion"], *extras["explore"]]
    declared = {text.split(">")[0] for text in [*PROJECT["project"]["dependencies"], *extra]}
    ours = {name for name in named if name not in sys.stdlib_module_names} - {"freesweep"}
    ours = {{"PIL": "pillow"}.get(name, name) for name in ours}
    assert ours <= declared
    assert {"numpy", "numba", "xarray"} <= ours
