"""What a plot command is given: a file of results, and where in its other axes (``--at NAME=VALUE``)."""


def read(path):
    """The Dataset of an atlas, or of one actuator as ``--out`` keeps it; a context manager."""
    from ..atlas.store import AtlasError, open_atlas, open_results

    try:
        return open_atlas(path).data
    except AtlasError:
        data = open_results(path)
        if "status" in data and "x" in data.dims:
            return data
        data.close()
        raise


def selection(items):
    """Values of ``--at`` by name: quantities in stored units, the name of a design as it is."""
    from ..atlas.schema import PARAMETERS, attributes
    from ..description.units import quantity
    from ..plot.choice import DESIGN, HELD

    select = {}
    for item in items:
        name, equals, value = item.partition("=")
        if not equals:
            raise ValueError(f'--at: found {item!r}; give NAME=VALUE, such as pressure="0.1 MPa"')
        known = name in PARAMETERS or name in HELD
        select[name] = value if name == DESIGN or not known else quantity(value, attributes(name)["units"])
    return select
