"""Fixtures that several files of tests share, and the machine code that all of them need."""

import signal
import subprocess
import sys

import pytest
from grids import make
from shards import SHARD, SWEEP

from freesweep.sweep import run


@pytest.fixture
def small_shards(monkeypatch):
    monkeypatch.setattr(run, "SHARD_EQUILIBRIA", SHARD)


@pytest.fixture(scope="session")
def reference(tmp_path_factory):
    """The atlas of shards.SWEEP, made by one thread without interruption."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "SHARD_EQUILIBRIA", SHARD)
        return make(tmp_path_factory.mktemp("reference") / "atlas.nc", SWEEP, threads=1)


STATES = """
import numpy as np
import freesweep as fs
from freesweep import interpret
from freesweep.sweep import kernels
interpret.FEW = interpret.FEWER = -1
sections = dict(length=0.1, radius=5e-3, wall=1.5e-3, material=fs.MooneyRivlin(1e5, 5e4))
alike, varying = fs.Actuator(alpha=40, beta=-20, **sections), fs.Actuator(alpha=[(0, 40), (1, 41)], beta=-20, **sections)
physical = fs.Actuator(alpha=30, beta=-30, model="physical", **sections)
body = fs.Actuator(alpha=40, beta=-20, taper=0.2, **sections)
"""
TAUT = """
fs.blocked_force(varying, 1e4)
fs.inflate(varying, 1e4)
fs.inflate(alike, np.linspace(1e4, 2e4, 70), derivatives="alpha")
kernels.compile_idle(["Mooney-Rivlin", "measure_physical"])
"""
PHYSICAL = """
fs.inflate(physical, 1e4)
fs.inflate(body, 1e4)
names = [f"{does}_{tubes}" for does in ("carry", "solve", "start", "move") for tubes in ("lanes", "physical")]
kernels.compile_idle(["Mooney-Rivlin", "query", "physical_states", *names])
"""


def pytest_configure():
    """What a shell starts in the background ignores interrupts, under nohup that its terminal closes: so would the commands
    on which tests try both.
    """
    for number, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, lambda *_: None)):
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, handler)


DEAREST = """
verify inverse branch physical_branches thesis_claims calibration_scalars calibration first_integral lanes newton
loose_states lanes_physical docs notebooks explorer_browser atlas_objects hard_states profiles explorer sweep_faults
hostile_files calibration_campaign plot_map sweep_resume statics_shape holding_states types interpret elastomer
sweep_kernels derivatives holding_buckled yeoh
"""
ORDER = {f"test_{name}": place for place, name in enumerate(DEAREST.split())}


def pytest_collection_modifyitems(items):
    """The files that take longest come first: at the end no worker waits for a long one."""
    items.sort(key=lambda item: ORDER.get(item.path.stem, len(ORDER)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """A file's tests go to one worker: its fixtures are made once."""
    from xdist.scheduler import LoadFileScheduling

    config.option.loadscopereorder = False  # that would be by the number of tests
    return LoadFileScheduling(config, log)


def pytest_sessionstart(session):
    """Before the whole suite: processes compile side by side, or each worker would compile the same for itself."""
    options = session.config.option
    whole = [*session.config.args] in ([], ["tests"], ["tests/"])
    if whole and not hasattr(session.config, "workerinput") and not options.collectonly and not options.keyword:
        parts = [subprocess.Popen([sys.executable, "-c", STATES + part]) for part in (TAUT, PHYSICAL)]
        for part in parts:
            part.wait()
