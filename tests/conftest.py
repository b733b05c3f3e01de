"""Fixtures that several files of tests share."""

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
