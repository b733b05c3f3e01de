"""Figures 2-2 and 2-3: locked shapes, undeformed in blue, locked in red."""

from ..plot.tubes import shape_plot, size_of
from ..statics import lock
from .drawing import Drawing, Numbers, panels
from .prototypes import RADIUS, RUBBER, WALL, muscle, source_tube

TEN_RADII = 10.0 * RADIUS  # [m]: the length at which a uniform tube turns 15 % too far, as the source reports

PROFILES = ("axial_position", "deformed_radius", "twist", "alpha_deformed", "beta_deformed")


def shapes(tube, states, titles):
    """A figure of the undeformed tube above its states."""
    figure, ax = panels(*size_of(tube, *states))
    shape_plot(tube, *states, titles=titles, ax=ax)
    return figure


def profile_rows(numbers: Numbers, state, **of):
    """Adds the profiles of one state along x."""
    numbers.add(**of, x=state["x"].values, **{name: state[name].values for name in PROFILES})


def figure_2_2() -> Drawing:
    """Locked shape of the conventional muscle of 30 degrees."""
    return _locked(muscle(30), "The 30 degree prototype, 192 mm long.")


def figure_2_3() -> Drawing:
    """Locked shape of a contracting and rotating actuator of 0 and 30 degrees."""
    tube = source_tube(alpha=0.0, beta=30.0, length=TEN_RADII, radius=RADIUS, wall=WALL, material=RUBBER)
    return _locked(tube, "The length is not printed; here 10 radii, for which a uniform tube turns 15 % too far.")


def _locked(tube, note):
    state, numbers = lock(tube), Numbers()
    profile_rows(numbers, state)
    return Drawing(shapes(tube, [state], ["locked"]), numbers, note)
