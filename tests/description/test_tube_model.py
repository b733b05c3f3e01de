"""One word, or three, for what a tube is taken for: where its fibers lie, whether they push, whether its wall is thick."""

import copy
import pickle

import pytest

from freesweep import Actuator, ActuatorError, MooneyRivlin, inflate
from freesweep.cli import main

PAM = {
    "alpha": 30, "beta": -30, "length": 0.192, "radius": 4e-3, "wall": 2e-3, "material": MooneyRivlin(c10=1e5)
}  # fmt: skip


def test_the_physical_tube_is_thick_loose_and_bears_its_fibers_outside():
    source, physical = Actuator(**PAM, model="source"), Actuator(**PAM, model="physical")
    assert (source.is_thick, source.is_loose, source.fiber_surface) == (False, False, 4e-3)
    assert (physical.is_thick, physical.is_loose, physical.fiber_surface) == (True, True, 6e-3)
    part = Actuator(**PAM, model="physical", fibers="bonded", fiber_radius="middle")
    assert (part.is_thick, part.is_loose, part.fiber_surface) == (True, False, 5e-3)
    part = Actuator(**PAM, model="source", wall_model="thick", fiber_radius=4.5e-3)
    assert (part.is_thick, part.is_loose, part.fiber_surface) == (True, False, 4.5e-3)


def test_fibers_of_a_wall_that_varies_lie_where_it_is_thinnest():
    tube = Actuator(**PAM | {"wall": [(0, 2e-3), (1, 1e-3)]}, model="physical")
    assert tube.fiber_surface == pytest.approx(5e-3)


def test_models_survive_copies_and_tell_tubes_apart():
    tubes = [
        Actuator(**PAM, model=model, fibers=fibers) for model in ("source", "physical") for fibers in (None, "loose")
    ]
    assert len(set(tubes)) == len({repr(tube) for tube in tubes}) == 4
    for tube in tubes:
        assert pickle.loads(pickle.dumps(tube)) == copy.deepcopy(tube) == tube
        assert eval(repr(tube), {"Actuator": Actuator, "MooneyRivlin": MooneyRivlin}) == tube


def test_every_fault_of_the_words_is_named():
    with pytest.raises(ActuatorError) as error:
        Actuator(**PAM, model="thesis", wall_model=1, fibers="glued", fiber_radius="inside", energy="Full")
    assert [fault.split(":")[0] for fault in error.value.faults] == [
        "fiber_radius", "model", "wall_model", "fibers", "energy"
    ]  # fmt: skip
    assert error.value.faults[0].endswith("or one of 'inner', 'middle', 'outer'")
    for words in ({"model": "physical"}, {"model": "source", "fibers": "loose"}):
        with pytest.raises(ActuatorError, match="'principal' charges a twist nothing"):
            Actuator(**PAM, energy="principal", **words)
    assert Actuator(**PAM, model="physical", fibers="bonded", energy="principal").is_thick


def test_the_shell_takes_the_same_words(capsys):
    size = ["--alpha=30", "--beta=-30", "--length=192 mm", "--radius=4 mm", "--wall=2 mm", "--c10=100 kPa"]
    words = ["--model=source", "--fibers=bonded", "--wall-model=membrane", "--fiber-radius=inner"]
    assert main(["inflate", *size, *words, "--pressure=0"]) == 0
    plain = capsys.readouterr().out
    assert main(["inflate", *size, "--model=source", "--pressure=0"]) == 0
    assert capsys.readouterr().out == plain
    assert main(["inflate", *size, "--model=physical", "--energy=principal", "--pressure=0"]) == 2
    assert "'principal' charges a twist nothing" in capsys.readouterr().err


def test_the_shell_says_that_loose_fibers_hang_and_that_bonded_ones_would_push():
    from freesweep.report import table

    rubber = MooneyRivlin(c10=0.17e6, c01=0.08e6)
    state = inflate(Actuator(alpha=0, beta=30, length=0.131, radius=4.76e-3, wall=1.59e-3, material=rubber), 3e4)
    assert "would have to push" in table(state)
    said = table(state.assign_attrs(fibers="loose"))
    assert "hangs loose" in said
    assert "push" not in said
