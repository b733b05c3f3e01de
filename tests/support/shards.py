"""A sweep of a score of shards, for tests of how sweeps are cut, interrupted and put together again."""

from grids import spec

from freesweep.sweep.spec import parse

SHARD = 12  # equilibria
SWEEP = parse(
    spec(
        {
            "alpha": [-20.0, 5.0, 40.0],
            "beta": [-50.0, -30.0, 20.0, 70.0],
            "length": [0.05, 0.1],
            "pressure": [0.0, 2e4, 1e5],
        }
    )
)


def same_bits(first, second):
    first, second = (data.assign_attrs(started=None) for data in (first, second))
    assert first.identical(second)
    assert list(first.variables) == list(second.variables)
    for name, variable in first.variables.items():
        assert variable.dtype == second[name].dtype, name
        assert variable.values.tobytes() == second[name].values.tobytes(), name
