"""The command query: one point, or a CSV of points with units in its header; out as table, CSV or JSON."""

import sys

MAX_ROWS = 1_000_000  # of a CSV
FORMATS = ("table", "csv", "json")


def add_query(commands):
    """Add the command of this module to the command line."""
    from ..atlas.schema import PARAMETERS

    command = commands.add_parser("query", help="what an atlas says of any design within its grid")
    command.add_argument("atlas")
    for name, parameter in PARAMETERS.items():
        command.add_argument(
            f"--{name.replace('_', '-')}", metavar="Q", help=f"{parameter.long_name}, such as {_example(name)}"
        )
    command.add_argument("--design", metavar="NAME", help="of a list of named designs")
    command.add_argument(
        "--points", metavar="FILE.csv", help='many points: a header such as "alpha [deg], pressure [kPa]"'
    )
    command.add_argument("--variable", nargs="+", action="extend", metavar="NAME", help="which (default: all)")
    command.add_argument("--method", default="cubic", choices=("cubic", "linear"), help="default: cubic")
    command.add_argument("--refine", action="store_true", help="solve exactly what the atlas cannot answer")
    command.add_argument("--format", choices=FORMATS, help="default: by the suffix of FILE, else table")
    command.add_argument("--json", action="store_const", const="json", dest="format", help="the same as --format json")
    command.add_argument("-o", "--out", metavar="FILE", help="write there instead of to the screen")
    command.set_defaults(run=_run)


def _example(name):
    from ..atlas.schema import PARAMETERS

    return {"degree": "25deg", "m": "'4.76 mm'", "Pa": "'0.1 MPa'", "N": "'5 N'", "N m": "'0.1 N m'"}.get(
        PARAMETERS[name].units, "1.005"
    )


def _run(options):
    from pathlib import Path

    from ..atlas.files import write_whole
    from ..atlas.store import open_atlas

    form = options.format or {".csv": "csv", ".json": "json"}.get(Path(options.out or "").suffix.lower(), "table")
    with open_atlas(options.atlas) as atlas:
        axes, units = _axes(options)
        found = atlas.query(options.variable, options.method, options.refine, **axes)
    found = in_units(found, units) if form == "table" else found
    text = {"table": _table, "csv": as_csv, "json": _json}[form](found)
    if note := found.attrs.get("thin_wall_note"):
        print(f"freesweep: note: {note}", file=sys.stderr)
    if options.out:
        write_whole(options.out, (text + "\n").encode())
        print(options.out)
    else:
        print(text)


def _axes(options):
    """Axes from the options, and from the CSV if there is one, and the units in which they were asked by name; raises
    ValueError with every fault.
    """
    from ..atlas.schema import PARAMETERS
    from ..description.units import quantity, unit_of

    faults, axes, units = [], {}, {}
    for name in PARAMETERS:
        if (given := getattr(options, name)) is not None:
            try:
                quantity(given, PARAMETERS[name].units)
                axes[name] = given  # with its unit, in which faults are told
                units[name] = unit_of(given)
            except ValueError as error:
                faults.append(f"--{name.replace('_', '-')}: {error}")
    if options.design is not None:
        axes["design"] = options.design
    if options.points:
        columns = _read_points(options.points, faults, units)
        for name in sorted(set(columns) & set(axes)):
            faults.append(f"{name}: given as an option and in {options.points}; remove one")
        axes |= columns
    if faults:
        raise ValueError("\n".join(["cannot read this question:", *(f"  - {fault}" for fault in faults)]))
    return axes, {name: unit for name, unit in units.items() if unit}


def _read_points(path, faults, asked):
    """Columns of a file of points: name -> list of numbers in the units of the API; the units go into ``asked``. What was
    passed over is said.
    """
    from pathlib import Path

    from ..atlas.schema import PARAMETERS
    from ..description.faults import ActuatorError
    from ..table_file import read_columns
    from ..table_heads import TEXT, Known

    known = Known({name: parameter.units for name, parameter in PARAMETERS.items()} | {"design": TEXT}, {})
    try:
        found = read_columns(Path(path), known, plain=True)
    except FileNotFoundError:
        faults.append(f"--points: there is no file {path!r}")
        return {}
    except ActuatorError as error:
        faults += [f"--points: {path}: {fault}" for fault in error.faults]
        return {}
    if len(found.lines) > MAX_ROWS:
        faults.append(f"--points: {path} holds {len(found.lines):,} points; at most {MAX_ROWS:,} are answered")
        return {}
    for note in found.notes:
        print(f"freesweep: note: {path}: {note}", file=sys.stderr)
    asked |= {name: unit for name, unit in found.units.items() if name in PARAMETERS}
    return {name: list(values) for name, values in found.values.items()}


def in_units(found, units):
    """An answer in the units of its question: each axis in its own, an output in the first that was used of its kind."""
    from ..atlas.schema import PARAMETERS
    from ..description.units import factor

    first = {}
    for name, unit in units.items():
        first.setdefault(PARAMETERS[name].units, unit)
    found = found.copy()
    for name in found.variables:
        kept = found[name].attrs.get("units")
        if unit := units.get(name, first.get(kept)):
            found[name] = (found[name] / factor(unit, kept)).assign_attrs(found[name].attrs | {"units": unit})
    return found


def _records(found):
    """One dictionary for each point: what was asked, then what was answered; statuses in words."""
    import numpy as np

    from ..status import STATUSES

    asked = [name for name in found.coords if found[name].ndim <= 1]
    points = [{}] if not found.dims else [{} for _ in range(int(np.prod(list(found.sizes.values()))))]
    for name in [*asked, *found.data_vars]:
        array = found[name].broadcast_like(next(iter(found.data_vars.values()))) if found.dims else found[name]
        for point, value in zip(points, array.values.ravel().tolist()):
            point[name] = STATUSES[value].meaning if name.endswith("status") else value
    return points


def as_csv(found) -> str:
    """One line for each point, in SI units and degrees, which its header names."""
    import csv
    import io

    records = _records(found)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units = {name: found[name].attrs.get("units", "") for name in records[0]}
    writer.writerow([f"{name} [{unit}]" if unit and unit != "1" else name for name, unit in units.items()])
    for record in records:
        writer.writerow(["" if value != value else value for value in record.values()])
    return text.getvalue().rstrip("\n")


def _json(found):
    import json

    records = [{key: None if value != value else value for key, value in record.items()} for record in _records(found)]
    units = {name: found[name].attrs["units"] for name in records[0] if "units" in found[name].attrs}
    return json.dumps({"units": units, "points": records}, indent=1)


def _shown(units):
    """Unit in which a table shows what is in ``units``, and the factor: an everyday one for those of SI."""
    from ..report import SHOWN

    return SHOWN.get(units, (units.removeprefix("1"), 1.0))


def _flag(found, name, record):
    """A flag in words: none, alpha family, stable; of what has no result there is none."""
    from ..query.family import FAMILIES
    from ..status import STATUSES, VALUED

    about = found[name].attrs
    own = next((family.answer_status for family in FAMILIES.values() if family.flag == name), "status")
    words = dict(zip(about["flag_values"], about["flag_meanings"].split()))
    told = [STATUSES[value].meaning for value in VALUED]
    return words[record[name]].replace("_", " ") if record.get(own, told[0]) in told else "-"


def _table(found):
    """Everyday units; one line for each variable of a single point, else one for each point."""
    from ..report import aligned, number
    from ..status import STATUSES

    records = _records(found)
    values = [name for name in found.data_vars if f"{name}_error" in found]
    statuses = [name for name in found.data_vars if name.endswith("status")]
    flags = [
        name for name in found.data_vars if name not in statuses and name not in values and not name.endswith("_error")
    ]
    shown = {name: _shown(found[name].attrs.get("units", "")) for name in [*found.coords, *values]}

    def cell(record, name):
        scale = shown[name][1]
        return number(record[name] * scale, record[f"{name}_error"] * scale)

    if len(records) == 1:
        record = records[0]
        rows = [("", "", "stated error")]
        for name in values:
            error = record[f"{name}_error"] * shown[name][1]
            rows.append((name, f"{cell(record, name)} {shown[name][0]}", "-" if error != error else f"{error:.1e}"))
        rows += [(name, record[name], "") for name in statuses]
        rows += [(name, _flag(found, name, record), "") for name in flags]
        lines = aligned(rows)
    else:
        varying = [name for name in found.coords if name in records[0] and found[name].ndim]
        heads = [f"{name} [{shown[name][0]}]" if shown[name][0] else name for name in [*varying, *values]]
        flags = [name for name in flags if name == "slack_fiber" and any(record[name] for record in records)]
        rows = [[*heads, *statuses, *flags]]
        for record in records:
            given = [f"{record[name] * shown[name][1]:.6g}" if name != "design" else record[name] for name in varying]
            rows.append([*given, *(cell(record, name) for name in values), *(record[name] for name in statuses),
                         *(_flag(found, name, record) for name in flags)])  # fmt: skip
        lines = aligned(rows)
    seen = sorted({record[name] for record in records for name in statuses} - {"ok"})
    told = (one for one in STATUSES if one.meaning in seen)
    lines += [f"{one.meaning}: {one.sentence.replace('refine=True', '--refine')}" for one in told]
    if "too_coarse" in found.attrs:
        lines += [f"nodes too far apart along (answers refused): {found.attrs['too_coarse']}"]
    return "\n".join(lines)
