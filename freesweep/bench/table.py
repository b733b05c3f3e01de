"""The figures of the benchmark as one table that is read in a minute."""

NOTE = """error: in deformed length per undeformed length and in rotation per radian (relative beyond one), the larger one,
against quadrature of the first integral, of what did not fail. Equal error: the loosest accuracy at which 95 % err by at
most 1e-6, as for solve_bvp, which gets analytic Jacobians, compiled right-hand sides, half of the tube, a graded mesh and
a warm start."""


def table(found) -> str:
    """The benchmark of the solver in words and columns."""
    machine, designs, pressures = found["machine"], found["designs"], found["pressures"]
    rows = [
        ("on one core", "setting", "equilibria/s", "us each", "error of 95 %", "largest", "failed", "times solve_bvp")
    ]
    for row in found["rows"]:
        exact = row["setting"] == "the reference"
        errors = ("-", "-") if exact else (f"{row['error']:.1e}", f"{row['largest']:.1e}")
        rates = (f"{row['rate']:,.0f}", f"{1e6 / row['rate']:.3g}")
        rows.append((row["method"], row["setting"], *rates, *errors, str(row["failed"]), f"{row['times_scipy']:,.1f}"))
    alone = found["threads"][0]["rate"]
    lines = [
        f"{designs} random designs at {pressures} pressures: {designs * pressures:,} distinct equilibria,"
        f" medians of {found['repeats']}",
        f"{machine['processor']}, {machine['cores']} cores, {machine['doubles_per_vector']} doubles a vector; numba"
        f" {machine['numba']}, scipy {machine['scipy']}",
        "",
        *aligned(rows),
        "",
        "scaling of this solver [equilibria/s]",
        _line(
            "threads", ((row["threads"], f"{row['rate']:,.0f} ({row['rate'] / alone:.2f})") for row in found["threads"])
        ),
        _line("equilibria", ((f"{row['equilibria']:,}", f"{row['rate']:,.0f}") for row in found["grid"])),
        _line("accuracy", map(_with_error, found["accuracy"])),
        _line("base cells, scalar", map(_with_error, found["cells"])),
        "",
        *_passes(found["newton_passes"]),
        "",
        *_models(found["models"]),
        NOTE,
    ]
    return "\n".join(lines)


def _with_error(row):
    return row["setting"], f"{row['rate']:,.0f} (error {row['error']:.0e})"


def _passes(costs):
    """What a Newton pass costs, and the density in vectors, against the machine's peak."""
    most = costs[0]["peak_flops_per_second"]
    peak = f"this core's multiply-add peak of {most / 1e9:.1f} Gflop/s"
    lines = [f"a Newton pass on meshes, and the density in vectors, beside {peak}"]
    for cost in costs:
        name = "one design" if cost["designs"] == 1 else f"{cost['designs']} designs"
        rate = cost["flops_per_cell"] / cost["seconds_per_cell"]
        lines.append(
            f"  {name:<20}{1e9 * cost['seconds_per_cell']:.2f} ns a cell or place, {cost['flops_per_cell']} flops:"
            f" {rate / 1e9:.1f} Gflop/s, {100 * cost['share_of_peak']:.1f} % of the peak"
        )
    return lines


def _models(rows):
    """What each model of a tube costs."""
    if not rows:
        return []
    lines = ["models of a tube, by vectors"]
    for row in rows:
        times = f"{1e6 * row['seconds']:.3g} us a state, {row['times_source']:.3g} times the source's"
        lines.append(f"  {row['model']:<20}{times}, {100 * row['solved']:.1f} % solved")
    return [*lines, ""]


def _line(name, pairs):
    return f"  {name:<20}" + "   ".join(f"{key}: {value}" for key, value in pairs)


def aligned(rows) -> list:
    """Rows of texts in columns: the first two to the left, the rest to the right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  ".join(
            cell.ljust(width) if k < 2 else cell.rjust(width) for k, (cell, width) in enumerate(zip(row, widths))
        ).rstrip()
        for row in rows
    ]
