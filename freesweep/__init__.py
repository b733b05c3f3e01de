"""freesweep: the statics of fiber-reinforced soft actuators, solved exactly and swept over the design space.

``actuator`` describes a tube, ``statics`` solves one under loads, ``holding`` one that is
blocked, ``sleeve`` one wound around an arm, ``closed_form`` holds the formulas of the uniform tube, ``sweep``
solves grids of designs into atlases, ``atlas`` stores and opens them, ``plot`` draws them. ``solver`` holds the Numba
kernels, dimensionless; nothing else compiles. Lengths in metres, pressures in pascals, angles in degrees.
"""

import importlib

__version__ = "0.1.0"

_HOMES = {
    "Actuator": "description.actuator",
    "ActuatorError": "description.faults",
    "MooneyRivlin": "description.elastomer",
    "NeoHookean": "description.elastomer",
    "Yeoh": "description.elastomer",
    "material": "description.material_library",
    "materials": "description.material_library",
    "lock": "statics",
    "inflate": "statics",
    "blocked_force": "holding",
    "blocked_torque": "holding",
    "corrected_torque": "holding",
    "tolerance": "spread",
    "Helix": "sleeve",
    "constriction": "sleeve",
    "Measurement": "calibration.measured",
    "read_measurements": "calibration.csv_file",
    "Calibration": "calibration.calibration",
    "calibrate": "calibration.fit",
    "design": "inverse.designing",
    "Goal": "inverse.wishes",
    "Limit": "inverse.wishes",
    "Profile": "description.along",
    "run_sweep": "sweep.run",
    "to_dataframe": "export.frame",
    "example_atlas": "example",
    "open_atlas": "atlas.store",
    "Atlas": "atlas.store",
    "UnsealedWarning": "atlas.store",
    "explore": "explorer.notebook",
}
_ROOMS = ("closed_form", "plot", "status", "sweep")
__all__ = [*_HOMES, "closed_form", "sweep"]


def __getattr__(name):
    if name in _HOMES:
        return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
    if name in _ROOMS:
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'freesweep' has no attribute {name!r}")


def __dir__():
    return sorted({*__all__, *_ROOMS, "__version__"})
