"""A table of force over length, or torque over rotation, and pressure as a small MuJoCo model that runs as it is."""

from xml.sax.saxutils import escape, quoteattr

import numpy as np

from .table import ExportError, Grid

GRAVITY = 9.81  # [m/s2]
DAMPED = 1.0  # of critical, at the mean stiffness of the table
RADIAN = np.pi / 180.0

MODEL = """<mujoco model={model}>
  <!-- {title}; {source}
       {name}_table: {quantity} [{unit}] over {name}_{place} [{place_unit}] and {name}_pressure [Pa], row-major.
       The control of the actuator is the pressure [Pa]; a callback reads what it exerts from the table: docs/export.md -->
  <option gravity="0 0 -{gravity}" timestep="0.001" integrator="implicitfast"/>
  <custom>
    <numeric name="{name}_{place}" data="{places}"/>
    <numeric name="{name}_pressure" data="{pressures}"/>
    <numeric name="{name}_table" data="{table}"/>
    <numeric name="{name}_error" data="{error}"/>
  </custom>
{world}
</mujoco>
"""
MUSCLE = """  <worldbody>
    <site name="{name}_top"/>
    <body name="load" pos="0 0 -{rest}">
      <joint name="lift" type="slide" axis="0 0 1" damping="{damping}"/>
      <geom type="sphere" size="0.02" mass="{mass}"/>
      <site name="{name}_bottom"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="{name}">
      <site site="{name}_top"/>
      <site site="{name}_bottom"/>
    </spatial>
  </tendon>
  <actuator>
    <general name="{name}" tendon="{name}" gainprm="0" biastype="user" ctrllimited="true" ctrlrange="{range}"/>
  </actuator>"""
ROTATOR = """  <worldbody>
    <body name="load">
      <joint name="turn" type="hinge" axis="0 0 1" damping="{damping}"/>
      <geom type="box" size="0.05 0.01 0.01" mass="{mass}"/>
    </body>
  </worldbody>
  <actuator>
    <general name="{name}" joint="turn" gainprm="0" biastype="user" ctrllimited="true" ctrlrange="{range}"/>
  </actuator>"""


def as_mujoco(grid: Grid, name: str) -> bytes:
    """The model; what it holds begins with ``name``. Raises :class:`ExportError`."""
    variable, place, places, faults = _read(grid)
    if faults:
        raise ExportError(faults)
    force = variable == "blocked_force"
    order = [list(grid.axes).index(place), list(grid.axes).index("pressure")]
    table, error = (grid.columns[each].transpose(order) for each in (variable, f"{variable}_error"))
    pressure = grid.axes["pressure"]
    slope = float(np.mean(np.abs(np.diff(table[:, -1]) / np.diff(places))))  # [N/m] or [N m/rad]
    mass = float(f"{np.max(np.abs(table)) / GRAVITY / 4:.2g}") if force else 0.1
    inertia = mass if force else mass / 3.0 * (0.05**2 + 0.01**2)  # of the box about its axis [kg m2]
    world = (MUSCLE if force else ROTATOR).format(
        name=name,
        rest=f"{places[-1]:.6g}",
        mass=f"{mass:.6g}",
        damping=f"{2.0 * DAMPED * np.sqrt(slope * inertia):.3g}",
        range=_numbers(pressure[[0, -1]]),
    )
    text = MODEL.format(
        model=quoteattr(name),
        name=name,
        title=_comment(grid.attrs.get("title", "")),
        source=_comment(grid.attrs.get("source", "freesweep")),
        quantity="the tension at a length" if force else "the torque that holds a rotation",
        unit=grid.units[variable],
        place="length" if force else "rotation",
        place_unit="m" if force else "rad",
        gravity=GRAVITY,
        places=_numbers(places),
        pressures=_numbers(pressure),
        table=_numbers(table),
        error=_numbers(error),
        world=world,
    )
    return text.encode()


def _read(grid):
    """Variable, its axis beside the pressure, that axis [m] or [rad], faults."""
    own = [name for name in ("blocked_force", "blocked_torque") if name in grid.columns]
    if len(own) != 1:
        return None, None, None, ["choose one of blocked_force and blocked_torque; MuJoCo's actuator exerts either"]
    force = own[0] == "blocked_force"
    allowed = ("held_length", "held_length_ratio") if force else ("held_rotation",)
    place = next((name for name in allowed if name in grid.axes), None)
    if place is None or set(grid.axes) != {place, "pressure"} or min(grid.shape) < 2:
        wanted = " or ".join(allowed)
        return (
            own[0],
            None,
            None,
            [f"its axes are {', '.join(grid.axes) or 'none'}; give {wanted} and pressure, two values or more"],
        )
    faults = []
    if missing := int(np.sum(~np.isfinite(grid.columns[own[0]]))):
        faults.append(
            f"{missing} of {grid.columns[own[0]].size} numbers are missing; choose a part of {place} and pressure without"
        )
    scale = RADIAN if not force else grid.fixed["length"] if place == "held_length_ratio" else 1.0
    return own[0], place, grid.axes[place] * scale, faults


def _numbers(array):
    return " ".join(map(repr, np.ravel(array).tolist()))


def _comment(text):
    return escape(str(text)).replace("--", "- -").replace("\n", " ")
