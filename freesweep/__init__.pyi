from . import closed_form as closed_form
from . import plot as plot
from . import status as status
from .atlas.store import Atlas as Atlas
from .atlas.store import UnsealedWarning as UnsealedWarning
from .atlas.store import open_atlas as open_atlas
from .calibration.calibration import Calibration as Calibration
from .calibration.csv_file import read_measurements as read_measurements
from .calibration.fit import calibrate as calibrate
from .calibration.measured import Measurement as Measurement
from .description.actuator import Actuator as Actuator
from .description.along import Profile as Profile
from .description.elastomer import MooneyRivlin as MooneyRivlin
from .description.elastomer import NeoHookean as NeoHookean
from .description.elastomer import Yeoh as Yeoh
from .description.faults import ActuatorError as ActuatorError
from .description.material_library import material as material
from .description.material_library import materials as materials
from .example import example_atlas as example_atlas
from .explorer.notebook import explore as explore
from .export.frame import to_dataframe as to_dataframe
from .holding import blocked_force as blocked_force
from .holding import blocked_torque as blocked_torque
from .holding import corrected_torque as corrected_torque
from .inverse.designing import design as design
from .inverse.wishes import Goal as Goal
from .inverse.wishes import Limit as Limit
from .sleeve import Helix as Helix
from .sleeve import constriction as constriction
from .spread import tolerance as tolerance
from .statics import inflate as inflate
from .statics import lock as lock
from .sweep.from_python import sweep as sweep
from .sweep.run import run_sweep as run_sweep

__version__: str
__all__: list[str]
