"""What an atlas may be named: not as what it is not."""

TABLES = (".csv", ".npz", ".mat", ".h", ".json", ".xml", ".m")  # that are made of an atlas
OTHERS = (*TABLES, ".toml", ".txt", ".xlsx", ".parquet", ".png", ".svg", ".pdf", ".html")  # what no atlas is named


def named_otherwise(out) -> list:
    """A fault of a path whose suffix promises another format than an atlas has."""
    if out.suffix.lower() not in OTHERS:
        return []
    atlas = out.with_suffix(".nc").name
    table = f", which freesweep export {atlas} -o {out.name} makes a table of" if out.suffix.lower() in TABLES else ""
    return [f"out: found {str(out)!r}; an atlas is netCDF: give a name such as {atlas}{table}"]
