"""The first states of a process without machine code: plain Python, the same numbers, nothing compiled."""

import json
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numba
import numpy as np
import pytest

import freesweep as fs
from freesweep import interpret, jit
from freesweep.solver import batch

ROOT = Path(__file__).parents[2]


def first_states():
    """A loaded tube, a locked one and a held one: numbers and error bounds."""
    rubber = fs.MooneyRivlin(c10=3e5, c01=1e5)
    tube = fs.Actuator(alpha=30, beta=-40, length=0.2, radius=5e-3, wall=1e-3, material=rubber, fiber_extension=1.004)
    loaded, locked, held = fs.inflate(tube, [5e4, 1e5], 1.0), fs.lock(tube), fs.blocked_force(tube, 1e5)
    return [
        [*dataset[name].values.ravel(), *dataset[f"{name}_error"].values.ravel()]
        for dataset, name in ((loaded, "deformed_length"), (locked, "rotation"), (held, "force"))
    ]


@jit.kernel
def inverse(number):
    return 1.0 / number


def invert(numbers):
    for i in range(len(numbers)):
        numbers[i] = inverse(numbers[i])


invert.__module__ = "freesweep.solver.invert"  # kernels live in a room


@pytest.fixture
def entry(monkeypatch, tmp_path):
    """A fresh installation, and an entry point."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(interpret, "_spent", {})
    return numba.njit(invert)


def test_first_states_of_a_fresh_installation_need_no_compiler(tmp_path):
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    script = (
        "import json, sys; sys.path[:0] = ['tests/solver', 'tests/support']; import test_interpret;"
        " print(json.dumps(test_interpret.first_states()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    assert not any(tmp_path.rglob("*.nbc"))
    assert not done.stderr
    for plain, compiled in zip(json.loads(done.stdout), first_states()):
        count = len(plain) // 2
        np.testing.assert_array_less(np.abs(np.subtract(plain, compiled))[:count], compiled[count:])
        assert 0.0 < max(plain[count:]) < 1e-5 * max(plain[:count])


def test_plain_python_computes_what_the_machine_code_does(entry):
    numbers = np.array([1.0, 3.0])
    assert interpret.at_once(2, entry, entry, numbers)
    assert not entry.signatures
    np.testing.assert_array_equal(numbers, [1.0, 1.0 / 3.0])


def test_an_error_of_plain_python_leaves_everything_as_it_was(entry):
    def fails(numbers):
        numbers[0] = 5.0
        numbers[1] = inverse(float(numbers[1]))

    fails.__module__ = invert.__module__
    fails = jit.kernel(fails)
    numbers = np.array([1.0, 0.0])
    assert not interpret.at_once(2, fails, fails, numbers)
    np.testing.assert_array_equal(numbers, [1.0, 0.0])


def test_many_states_are_worth_the_compiler(entry, capsys):
    numbers = np.ones(2)
    for _ in range(interpret.FEW // 2):
        assert interpret.at_once(2, entry, entry, numbers)
    assert not interpret.at_once(2, entry, entry, numbers)
    assert "compiling the kernels" in capsys.readouterr().err
    assert not interpret.at_once(1, entry, entry, numbers)
    assert not capsys.readouterr().err  # said once


def test_machine_code_is_used_where_it_exists(entry):
    entry(np.ones(1))
    assert not interpret.at_once(1, entry, entry, np.ones(1))


@jit.kernel
def rest(number):
    return number


def dawdle(numbers):
    numbers[0] = 7.0
    while numbers[0] > 0.0:
        numbers[0] = rest(numbers[0])


dawdle.__module__ = invert.__module__


def test_plain_python_gives_up_in_time(entry, monkeypatch, capsys):
    """A state that never ends: arguments as they were, the compiler is announced, and no second try is made."""
    monkeypatch.setattr(interpret, "SECONDS", 0.2)
    slow, numbers = jit.kernel(dawdle), np.ones(1)
    begun = time.thread_time()
    assert not interpret.at_once(1, slow, slow, numbers)
    assert 0.2 <= time.thread_time() - begun < 2.0
    assert numbers == 1.0
    assert "compiling the kernels" in capsys.readouterr().err
    begun = time.thread_time()
    assert not interpret.at_once(1, slow, slow, numbers)
    assert time.thread_time() - begun < 0.1
    assert interpret.at_once(1, entry, entry, numbers)  # another kernel has a time of its own


def doze(numbers):
    for _ in range(5):
        time.sleep(0.1)
        numbers[0] = rest(numbers[0])


doze.__module__ = invert.__module__


def test_time_in_which_others_had_the_processor_does_not_count(entry, monkeypatch):
    """A busy machine: half a second on the wall, next to none of this thread's."""
    monkeypatch.setattr(interpret, "SECONDS", 0.2)
    kernel = jit.kernel(doze)
    assert interpret.at_once(1, kernel, kernel, np.ones(1))


@pytest.mark.parametrize("columns", [11, 13], ids=["source", "physical"])
def test_a_vector_of_one_tells_in_plain_python_what_compiled_ones_tell(columns, monkeypatch):
    """Free, loaded and locked states, one beyond its limit, and profiles: numbers differ by rounding."""
    problems = np.array([
        [0.11, 0.73, 0.5, 1.0, 0.5, 1.0, 0.0, 0.0, 30.0, 0.0, 0.0, 0.6, 1.0],
        [0.11, 0.73, 0.5, 1.01, 0.5, 1.0, 0.3, 0.1, 30.0, 0.0, 0.0, 0.6, 1.0],
        [1.58, 0.15, 0.78, 1.01, 0.5, 0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.6, 0.0],
    ])[:, :columns]  # fmt: skip
    pressures, first = np.tile([0.4, 1.2, np.inf], 3), np.arange(4) * 3
    asked = problems, first, pressures, batch.uniform(24), 1e-6, np.linspace(0.0, 4.0, 5)
    compiled, ran = batch.walk_all(*asked), []
    monkeypatch.setattr(interpret, "_kinds", lambda *_: None)  # no machine code is at hand
    monkeypatch.setattr(interpret, "_is_kept", lambda *_: False)
    monkeypatch.setattr(interpret, "_spent", {})
    done = interpret._is_done
    monkeypatch.setattr(interpret, "_is_done", lambda entry, *more: ran.append(entry) or done(entry, *more))
    plain = batch.walk_all(*asked, soon=True)
    assert {entry.py_func.__name__.split("_")[0] for entry in ran} >= {"carry", "solve", "draw"}
    np.testing.assert_array_equal(plain.status, compiled.status)
    np.testing.assert_array_less(np.abs(plain.values - compiled.values), np.fmax(compiled.bounds, 1e-12))
    fields = compiled.profiles.shape[1] // 2
    apart = np.abs(plain.profiles - compiled.profiles)[:, :fields]
    np.testing.assert_array_less(apart, np.fmax(compiled.profiles[:, fields:], 1e-12))


def test_twins_are_whole_whichever_thread_asks_first():
    """Threads ask for the twin of one kernel at once, which takes a while to make: each gets one that knows all names."""
    names = "".join(f"    x = inverse_{k}(x)\n" for k in range(400))
    go, interval = threading.Event(), sys.getswitchinterval()

    def ask(kernel):
        while not go.is_set():
            pass
        return interpret._twin(kernel)(2.0)

    sys.setswitchinterval(1e-6)
    try:
        for _ in range(8):
            room = {f"inverse_{k}": numba.njit(lambda x: 1.0 / x) for k in range(400)}
            exec(f"def chain(x):\n{names}    return x\n", room)
            with ThreadPoolExecutor(8) as pool:
                asked = [pool.submit(ask, room["chain"]) for _ in range(8)]
                go.set()
                assert [each.result() for each in asked] == [2.0] * 8
            go.clear()
    finally:
        sys.setswitchinterval(interval)


def test_machine_code_for_other_kinds_of_arguments_is_not_at_hand(entry, capsys):
    """What a tube was solved with is not what a body, with one more number along it, is solved with: its first states need
    no compiler, either.
    """
    entry(np.ones(2))
    other = np.full(2, 2.0, np.float32)
    assert not interpret.at_once(1, entry, entry, np.ones(2))
    assert interpret.at_once(2, entry, entry, other)
    np.testing.assert_array_equal(other, [0.5, 0.5])
    assert not capsys.readouterr().err
    assert not interpret.at_once(interpret.FEW, entry, entry, other)
    assert "compiling the kernels" in capsys.readouterr().err
    entry(other)
    assert not interpret.at_once(1, entry, entry, other)
    assert not capsys.readouterr().err


def test_vectors_are_not_compiled_for_a_few_states_of_another_rubber(entry, capsys):
    """The scalar kernel's machine code, which serves every rubber, solves them meanwhile."""
    awaited, other = numba.njit(invert), np.ones(1, np.float32)
    awaited(np.ones(1))
    numbers = np.array([4.0])
    assert not interpret.at_once(1, awaited, entry, numbers, instead=(np.ones(1),))
    assert interpret.at_once(1, awaited, entry, numbers, instead=(other,))
    entry(np.ones(1))
    assert interpret.at_once(1, awaited, entry, numbers, instead=(other,))
    assert numbers == 4.0
    assert len(awaited.signatures) == 1
    assert not capsys.readouterr().err
    assert not interpret.at_once(interpret.FEW, awaited, entry, numbers, instead=(other,))
