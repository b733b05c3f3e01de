"""What commands print as tables, as JSON: numbers in SI units and degrees, null where there is none."""

import json
import math
import sys


def _plain(value):
    """Python's own types, NaN and infinities as None."""
    if isinstance(value, dict):
        return {str(name): _plain(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def text(content) -> str:
    """Indented JSON."""
    return json.dumps(_plain(content), indent=1, ensure_ascii=False, allow_nan=False)


def tell_kept(path, is_json) -> None:
    """Prints where something was kept; beside JSON, which programs read to its end, on standard error."""
    print(path, file=sys.stderr if is_json else sys.stdout)


def of_states(dataset) -> str:
    """States of one actuator: units by name, and one record for each point; statuses in words."""
    from .query import _json

    return _json(dataset.drop_dims("x"))


def of_atlas(atlas) -> str:
    """Axes, fixed values, variables, statuses and attributes of an atlas."""
    from ..atlas.schema import STATUS_OF

    data = atlas.data
    about = {name: {"values": data[name].values, **_units(data[name])} for name in data.sizes}
    fixed = {name: {"value": one.values, **_units(one)} for name, one in data.coords.items() if one.ndim == 0}
    held = {
        name: {"long_name": one.attrs.get("long_name", ""), "dimensions": list(one.dims), **_units(one)}
        for name, one in data.data_vars.items()
    }
    statuses = {name: atlas.status_counts(name) for name in STATUS_OF if name in data}
    return text(
        {"axes": about, "fixed": fixed, "variables": held, "statuses": statuses, "attributes": dict(data.attrs)}
    )


def _units(variable):
    return {"units": variable.attrs["units"]} if "units" in variable.attrs else {}


def of_candidates(found) -> str:
    """Candidates of a design, best first, with the line of Python that makes each."""
    from ..inverse.report import columns_of

    named = {heading: values.tolist() for heading, values in columns_of(found)} | {
        "python": found["python"].values.tolist()
    }
    rows = [dict(zip(named, values)) for values in zip(*named.values())]
    said = {name: found.attrs[name] for name in ("summary", "prices") if found.attrs.get(name)}
    said |= {"notes": found.attrs["notes"].splitlines()} if "notes" in found.attrs else {}
    return text(said | {"candidates": rows})


def of_calibration(found) -> str:
    """Parameters with their uncertainties, in SI units and degrees, how well what was measured is met, and the notes."""
    from ..calibration.measured import COLUMNS
    from ..calibration.report import CONSTANTS, kept_in

    rows = zip(found.names, found.values, found.standard_errors, found.intervals, found.profile_intervals)
    parameters = {
        name: {
            "value": value, "standard_error": error, "interval": interval, "profile_interval": profiled,
            "units": {CONSTANTS: "Pa", None: "1"}.get(kept := kept_in(name), kept),
        }
        for name, value, error, interval, profiled in rows
    }  # fmt: skip
    measured = {
        name: {"standard_uncertainty": sigma, "unseen_curves": found.leave_one_out.get(name), "units": COLUMNS[name]}
        for name, sigma in found.sigma.items()
    }
    about = {"fits": bool(found.fits), "chi_square": found.chi_square, "notes": found.notes}
    return text({"parameters": parameters, "measured": measured, **about, "material": repr(found.material)})


def of_comparisons(path, comparisons, faults=()) -> str:
    """What is wrong with an atlas, and its largest differences from the second method, beside the stored bounds."""
    from ..atlas.schema import VARIABLES

    rows = {}
    for one in comparisons:
        worst = int(one.difference.argmax()) if one.difference.size else None
        rows[one.name] = {
            "judged": one.difference.size,
            "unjudged": one.unjudged,
            "largest_difference": None if worst is None else one.difference[worst],
            "its_bound": None if worst is None else one.bound[worst],
            "broken": one.broken.sum(),
            "units": VARIABLES[one.name].units,
        }
    return text({"atlas": str(path), "whole": not faults, "faults": list(faults), "resolved": rows})
