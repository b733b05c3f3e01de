"""Every figure of the source with content of the model, by its number; beyond it one "found", two of "physical" tubes."""

from . import locked, muscles, physical, rotating, sleeve, space, torque, varying

FIGURES = {
    "1-2": space.figure_1_2,
    "2-2": locked.figure_2_2,
    "2-3": locked.figure_2_3,
    "2-4": space.figure_2_4,
    "2-5": muscles.figure_2_5,
    "2-7": muscles.figure_2_7,
    "2-8": muscles.figure_2_8,
    "2-9": muscles.figure_2_9,
    "2-10": rotating.figure_2_10,
    "2-11": rotating.figure_2_11,
    "2-12": torque.figure_2_12,
    "2-12-physical": physical.figure_2_12,
    "2-13": torque.figure_2_13,
    "2-13-physical": physical.figure_2_13,
    "2-14": varying.figure_2_14,
    "2-15": varying.figure_2_15,
    "2-16": varying.figure_2_16,
    "2-16-found": varying.figure_2_16_found,
    "2-17": varying.figure_2_17,
    "3-6": sleeve.figure_3_6,
    "3-7": sleeve.figure_3_7,
    "3-8": sleeve.figure_3_8,
    "3-9": sleeve.figure_3_9,
    "3-11": sleeve.figure_3_11,
    "3-13": sleeve.figure_3_13,
}


def title(name: str) -> str:
    """What a figure shows, in one sentence."""
    return FIGURES[name].__doc__
