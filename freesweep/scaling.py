"""From designs in SI units to dimensionless problems and back: the one place where scales are known.

Lengths by the fiber surface's radius r0, pressure by C10, force by pi r0^2 C10, torque by pi r0^3 C10. A problem is a row of
``solver.problem.PROBLEM_SIZE`` numbers: H, D, a, gamma, C01/C10, shear, f, m, Lambda, C20/C10, C30/C10; of a
physical tube also the inner radius squared, 0 for a membrane, and which fibers there are and whether they may push.
"""

import numpy as np

ACCURACIES = (1e-10, 1e-2)  # error bounds that may be asked for, scaled: below lies rounding
OUTPUTS = ("deformed_length", "volume", "rotation", "strain_energy", "mid_radius")  # order of the kernels' columns
SLACK, PULLS = ("slack_alpha", "slack_beta"), ("least_tension_alpha", "least_tension_beta")
ALONG = (*SLACK, *PULLS, "outer_radius", "largest_stretch")  # and behind them those of physical tubes
OF_MEMBRANES = (*SLACK, *PULLS)  # of which a membrane is only told these


def problem_rows(design, energy, thick=False, threads=0.0) -> np.ndarray:
    """Dimensionless problems (n, 11), or (n, 13) where the wall is ``thick`` or the ``threads`` are not two bonded families
    (:data:`.description.tube_model.THREADS`), of a ``design``: name -> array (n,), in SI units and degrees, loads among
    them.
    """
    return np.column_stack(problem_columns(design, energy, thick, threads))


def problem_columns(design, energy, thick=False, threads=0.0) -> tuple:
    """The columns of :func:`problem_rows`, in plain arithmetic: of arrays, or of dual numbers."""
    ta, tb = np.tan(np.radians(design["alpha"])), np.tan(np.radians(design["beta"]))
    r, c10 = design["fiber_radius"], design["c10"]
    inner = design["radius"]
    area = ((inner + design["wall"]) ** 2 - inner**2) / r**2
    columns = (
        0.5 * (ta + tb),
        0.5 * (ta - tb),
        area,
        design["fiber_extension"],
        design["c01"] / c10,
        0.0 * area + float(energy == "full"),
        design["force"] / (np.pi * r**2 * c10),
        design["torque"] / (np.pi * r**3 * c10),
        design["length"] / r,
        design.get("c20", 0.0) / c10,
        design.get("c30", 0.0) / c10,
    )
    if thick or np.any(threads):
        columns += ((inner / r) ** 2 * float(thick), 0.0 * area + threads)
    return columns


def output_scales(design) -> dict:
    """SI units of one dimensionless output of half a tube, by name; rotation in degrees."""
    r, c10 = design["fiber_radius"], design["c10"]
    one = 0.0 * r + 1.0
    return {
        "deformed_length": 2.0 * r,
        "volume": 2.0 * np.pi * r**3,
        "rotation": one * np.degrees(2.0),
        "strain_energy": 2.0 * np.pi * r**3 * c10,
        "mid_radius": r,
        **dict.fromkeys(SLACK, one),
        **dict.fromkeys(PULLS, 2.0 * np.pi * r**2 * c10),
        "outer_radius": r,
        "largest_stretch": one,
    }


def wall_volume_inside(design):
    """Volume between the cavity and the fiber surface [m3]: an incompressible wall keeps it."""
    return np.pi * (design["fiber_radius"] ** 2 - design["radius"] ** 2) * design["length"]
