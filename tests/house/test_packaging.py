"""What is built and handed out: version, citation, recipe, examples."""

import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

from commands import refused, run

import freesweep as fs
from freesweep import example
from freesweep.sweep.spec import read_file
from freesweep.verification import cross_check, verify

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_version_stands_in_one_place():
    assert PROJECT["project"]["dynamic"] == ["version"]
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "freesweep.__version__"}
    assert f"\nversion: {fs.__version__}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_the_recipe_asks_for_what_the_package_asks_for():
    recipe = (ROOT / "docs" / "packaging" / "meta.yaml").read_text(encoding="utf-8")
    run_time = recipe.partition("  run:\n")[2].partition("\ntest:")[0]
    asked = {line.strip("- ").replace(" ", "") for line in run_time.splitlines() if line.strip()} - {"python>=3.11"}
    names = {"netcdf4": "netCDF4", "matplotlib-base": "matplotlib"}
    asked = {re.sub("^[a-z0-9-]+", lambda found: names.get(found[0], found[0]), one) for one in asked}
    assert asked == set(PROJECT["project"]["dependencies"])


def test_the_example_atlas_is_that_of_its_specification_and_holds_its_bounds():
    path = ROOT / "freesweep" / "examples" / "quick.nc"
    assert verify.faults(path) == []
    with fs.example_atlas() as atlas:
        asked = read_file(example.specification("quick"))
        assert atlas.data.attrs["specification"] == asked.text
        comparisons, _ = cross_check.resolve(cross_check.draw(atlas.data, 20))  # by the second method
        assert len(comparisons) > 5
        assert not any(compared.broken.any() for compared in comparisons)
    assert path.stat().st_size < 1.5e6


def test_examples_are_named_and_found(tmp_path, capsys):
    assert run("sweep", "--example", "quick", "--dry-run", "-o", str(tmp_path / "quick.nc")) == 0
    assert "25,092" in capsys.readouterr().out
    assert "did you mean 'quick'?" in refused(capsys, "sweep", "--example", "quik")
    assert "give SPEC" in refused(capsys, "sweep")


def test_what_is_built_contains_what_the_commands_of_the_readme_need(tmp_path):
    source = tmp_path / "source"
    shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns(".git", "*.nc.parts", "build", "dist", "*.egg-info"))
    build = [
        sys.executable,
        "-c",
        "import sys; from setuptools.build_meta import *; out = sys.argv[1]; build_wheel(out); build_sdist(out)",
    ]
    subprocess.run([*build, str(tmp_path)], cwd=source, check=True, capture_output=True)
    (wheel,), (sdist,) = tmp_path.glob("*.whl"), tmp_path.glob("*.tar.gz")
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    files = [f"freesweep/examples/{path.relative_to(ROOT)}" for path in (ROOT / "sweeps").rglob("*.toml")]
    for name in (*files, "freesweep/examples/quick.nc", "freesweep/py.typed", "freesweep/__init__.pyi"):
        assert name in names, name
    with tarfile.open(sdist) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "sweeps/quick.toml",
        "sweeps/wishes/rotator.toml",
        "CITATION.cff",
        "tests/support/grids.py",
    } <= inside


def test_building_needs_setuptools_alone():
    """An isolated environment is made for each ``pip install .``: what else it holds is downloaded for nothing."""
    assert [re.split("[<>=]", one)[0] for one in PROJECT["build-system"]["requires"]] == ["setuptools"]
