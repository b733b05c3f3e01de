"""The source reproduced: every figure and table with content of the model, recomputed, and its claims checked.

``prototypes`` holds the actuators it describes; ``space``, ``locked``, ``muscles``, ``rotating``, ``torque``, ``varying``
and ``sleeve`` each draw the figures of one section; ``claims`` compares what the text says with both strain energies;
``make`` writes it all, ``index`` the page that leads to it. The markers of the source's experiments were never published as
numbers: they are left out, not invented.
"""
