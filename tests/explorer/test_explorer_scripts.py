"""The explorer's scripts in Node, without a page: what leaves it makes the same tube, quantities are read as in Python."""

import json
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from explored import AXES

import freesweep as fs
from freesweep.cli import _joined, parser
from freesweep.cli.single import tube_of as tube_of_words
from freesweep.description.units import quantity
from freesweep.explorer.desk import Desk
from freesweep.explorer.exact import tube_of
from freesweep.explorer.page import SCRIPTS, facts
from freesweep.sweep.spec import parse

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="node is not here")
PAGE = Path(fs.__file__).parent / "explorer" / "page"
ALONE = """
const location = { hash: "", href: "" }, history = { replaceState() {} }, matchMedia = () => ({ matches: false });
const window = { freesweepFacts: JSON.parse(require("fs").readFileSync(0, "utf8")) };
"""
SIZES = {"wall": 1e-3, "c10": 0.17e6, "c01": 0.08e6, "pressure": [0.0, 5e3], "progress": False}
ATLASES = {  # arguments of a sweep, and a design that is pinned in it
    "bodies": (
        {"alpha": [10, 15, 20], "beta": "geodesic -45 deg", "length": 0.1, "radius": 6e-3, "taper": [0, 0.1], "bulge": 0.2,
         "wall": "constant volume 1 mm"},
        {"alpha": 15, "taper": 0.1},
    ),
    "balloons": (
        {"alpha": "none", "beta": "none", "length": [0.1, 0.2], "radius": [6e-3, 7e-3]}, {"length": 0.1, "radius": 6e-3}
    ),
    "a single family": (
        {"alpha": "none", "beta": [30.0, 40.0], "length": [0.1, 0.2], "radius": 6e-3, "model": "physical"},
        {"beta": 30, "length": 0.1},
    ),
    "named designs": (
        {"designs": [{"name": "A", "alpha": 10, "beta": -40}, {"name": "B", "alpha": 20, "beta": -50}], "radius": 6e-3,
         "length": [0.1, 0.2]},
        {"design": 1, "length": 0.1},
    ),
}  # fmt: skip


def told(known, expression, scripts=("state", "units", "export")):
    """What a script's expression is, with an atlas' facts."""
    code = "\n".join([ALONE, *((PAGE / f"{name}.js").read_text(encoding="utf-8") for name in scripts)])
    code += f"\nconsole.log(JSON.stringify({expression}));"
    done = subprocess.run([NODE, "-e", code], input=json.dumps(known), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_scripts_are_scripts(tmp_path):
    whole = tmp_path / "page.js"
    whole.write_text("\n".join((PAGE / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS))
    done = subprocess.run([NODE, "--check", str(whole)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("kind", ATLASES)
def test_what_is_pinned_leaves_as_the_tube_that_it_is(kind, tmp_path):
    """Bodies with what their threads and walls follow, families that there are not, designs of a list."""
    given, pin = ATLASES[kind]
    with fs.sweep(**SIZES | given, out=tmp_path / "atlas.nc") as atlas:
        desk = Desk(atlas)
        made = told(facts(desk), f"(state.pins = [{json.dumps(pin)}], [asPython(), asShell(), asToml()])")
        tube = tube_of(desk, {name: desk.reader.frame.ranges[name][0] for name in desk.axes} | pin)
    python, shell, toml = made
    names = {}
    exec(python, names)
    assert names["tubes"] == [tube]
    assert tube_of_words(parser().parse_args(_joined(shlex.split(shell)[1:]))) == tube
    sweep = parse(toml)
    assert (sweep.families, sweep.model.fibers == "loose") == (tuple(atlas_families(tube)), tube.is_loose)
    numbers = sweep.fixed | {name: column[0] for name, column in sweep.designs["columns"].items()}
    assert {name: numbers.get(name, 0.0) for name in ("taper", "bulge")} == {"taper": tube.taper, "bulge": tube.bulge}
    for name in atlas_families(tube):
        assert numbers[name] == float(str(getattr(tube, name)).removeprefix("geodesic ").removesuffix(" deg"))


def test_a_sketch_of_a_body_has_its_taper_and_bulge(tmp_path):
    """Till the solver has spoken, and on a page without one: the outline at rest was that of a tube."""
    given, pin = ATLASES["bodies"]
    with fs.sweep(**SIZES | given, out=tmp_path / "atlas.nc") as atlas:
        known = facts(Desk(atlas))
        tube = tube_of(Desk(atlas), pin | {"pressure": 0.0})
    scripts = ("state", "units", "provider", "export", "shape")
    script = f"all = whole({json.dumps(pin)}), sketch(all, all.length, fiberRadius(all), 0).radius"
    radius = told(known, f"(() => {{ let all; return ({script}); }})()", scripts)
    share = np.linspace(0.0, 1.0, len(radius))
    np.testing.assert_allclose(radius, 1e3 * tube.fiber_surface_at(share), rtol=1e-12)


def atlas_families(tube):
    return [name for name in ("alpha", "beta") if getattr(tube, name) is not None]


def test_quantities_are_read_in_every_unit_that_python_reads(tmp_path):
    with fs.example_atlas() as atlas:
        known = facts(Desk(atlas))
    texts = [
        ("pressure", "1 bar", "Pa"),
        ("pressure", "14.5 psi", "Pa"),
        ("length", "7.5cm", "m"),
        ("alpha", "0.5 rad", "degree"),
    ]
    read = told(known, f"{json.dumps(texts)}.map(([name, text]) => readShown(name, text))")
    assert read == pytest.approx([quantity(text, unit) for _, text, unit in texts], rel=1e-12)
    assert told(known, "[readShown('length', '3 psi'), readShown('pressure', '5'), readShown('length_change', '5 %')]") == [
        None, 5000, 0.05
    ]  # fmt: skip


def test_curves_run_over_the_whole_of_an_axis_that_changes_sign(tmp_path):
    """An atlas without pressures to run along: the last axis is that of the curves."""
    angles = {"alpha": AXES["alpha"], "beta": AXES["beta"]}
    with fs.sweep(
        **SIZES | angles | {"length": 0.1, "radius": 5e-3, "pressure": 1e4}, out=tmp_path / "flat.nc"
    ) as atlas:
        desk = Desk(atlas)
        assert desk.along == "beta"
        np.testing.assert_allclose(desk.curve_nodes(5), np.linspace(-80.0, 60.0, 5))


def test_fibers_without_a_pull_are_called_what_they_are():
    with fs.example_atlas() as atlas:
        known = facts(Desk(atlas))
    assert known["slack"] == ["taut", "alpha would push", "beta would push", "both would push"]
    assert known["slack_sentence"].endswith("fibers cannot")
