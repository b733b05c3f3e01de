"""The line of Python that makes a tube."""

from dataclasses import fields

KEPT = ("model",)  # what is usual may be another one in a later version


def python_line(tube) -> str:
    """Such a line of an actuator, after ``import freesweep as fs``; what is as usual is left out."""
    parts = []
    for field in fields(tube):
        value = getattr(tube, field.name)
        if field.name in KEPT or type(value) is not type(field.default) or value != field.default:
            ours = "fs." if type(value).__module__.startswith("freesweep.") else ""
            parts.append(f"{field.name}={ours}{value!r}")
    return f"fs.Actuator({', '.join(parts)})"
