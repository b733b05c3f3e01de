"""Files of strangers: refused with a reason, in little time and memory, and nothing but the file itself is read."""

import json
import shutil
import subprocess
import sys

import h5py
import numpy as np
import pytest
import xarray as xr
from commands import refused
from grids import CHILD_ENVIRONMENT, SMALL, make, spec
from hostile import MAKERS, SECRET

from freesweep.atlas.seal import SIZE, sealed
from freesweep.sweep.spec import parse

SECONDS, MEMORY = 5.0, 600e6  # of one file; of all of them [bytes]

CHILD = """
import json, os, resource, sys, time
from freesweep.atlas.store import AtlasError, open_atlas
from freesweep.verification.verify import faults
resource.setrlimit(resource.RLIMIT_CPU, (120, 120))
def refusal(path):
    try:
        open_atlas(path).close()
    except AtlasError as error:
        return str(error)
for path in sys.stdin.read().splitlines():
    begun = time.process_time()
    said = [refusal(path), "; ".join(faults(path))]
    took = time.process_time() - begun
    memory = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    if os.path.exists("/proc/self/status"):  # on Linux ru_maxrss counts the parent's before exec
        with open("/proc/self/status") as file:
            memory = 1024 * int(next(line.split()[1] for line in file if line.startswith("VmHWM")))
    print(json.dumps([path, *said, took, memory]), flush=True)
"""


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    path = tmp_path_factory.mktemp("good") / "atlas.nc"
    make(path, parse(spec(SMALL)))
    return path


@pytest.fixture(scope="module")
def files(atlas, tmp_path_factory):
    """Name -> path of a hostile file; "none" of an atlas that nobody changed."""
    root, made = tmp_path_factory.mktemp("hostile"), {}
    (root / "secret").write_bytes(SECRET)
    for name, (_, maker) in [*MAKERS.items(), ("none", (None, lambda _: None))]:
        made[name] = root / f"{name}.nc"
        shutil.copyfile(atlas, made[name])
        maker(made[name])
        if made[name].is_file() and made[name].stat().st_size < 1 << 30 and name != "none":
            made[name].write_bytes(sealed(made[name].read_bytes()))
    return made


@pytest.fixture(scope="module")
def answers(files):
    """Name -> (what open_atlas said, what verify said, seconds, bytes of memory so far), in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-P", "-c", CHILD],
        input="\n".join(map(str, files.values())), capture_output=True, text=True, env=CHILD_ENVIRONMENT, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = {path: rest for path, *rest in map(json.loads, done.stdout.splitlines())}
    return {name: said[str(path)] for name, path in files.items()}


def test_there_are_many_kinds_of_harm():
    assert len(MAKERS) >= 60


@pytest.mark.parametrize("name", MAKERS)
def test_a_hostile_file_is_refused_with_its_reason(name, answers, files):
    words, _ = MAKERS[name]
    opened, verified, took, memory = answers[name]
    assert opened is not None
    assert str(files[name]) in opened
    assert words in opened
    assert words in verified
    assert took < SECONDS
    assert memory < MEMORY


def test_the_atlas_from_which_they_were_made_is_accepted(answers):
    """The control: it is the harm that is refused."""
    assert answers["none"][:2] == [None, ""]


def test_the_harm_is_real(files):
    """The control: readers that trust a file read what is not in it, or take what is no number for one."""
    with h5py.File(files["external_storage"]) as file:
        assert file["c01"][:].tobytes() == SECRET[:8]
    with xr.open_dataset(files["numbers_that_are_scaled"]) as scaled, xr.open_dataset(files["none"]) as plain:
        assert np.allclose(scaled["rotation"], 2.0 * plain["rotation"], equal_nan=True)
    with xr.open_dataset(files["deflate_bomb"]) as bomb:
        assert bomb["extra"].nbytes > 500 * (files["deflate_bomb"].stat().st_size - SIZE)


@pytest.mark.parametrize("command", [["info"], ["verify"], ["plot", "map"], ["query"]], ids=" ".join)
def test_commands_refuse_in_words(command, files, capsys):
    for name in ("pipe_that_never_ends", "external_link", "status_outside_the_table"):
        at = ["--alpha", "20"] if command == ["query"] else []
        assert MAKERS[name][0] in refused(capsys, *command, str(files[name]), *at)
