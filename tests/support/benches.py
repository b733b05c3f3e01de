"""Synthetic benches whose truth is known: random muscles, noisy readings, slack zeros."""

from dataclasses import replace

import numpy as np

from freesweep import Actuator, Measurement, MooneyRivlin
from freesweep.calibration.parameters import Setup
from freesweep.calibration.predicted import Predictor

RATIO = 0.5  # c01 over c10, of all of them
FIT = ["c10", "alpha", "fiber_extension"]
TIES = {"c01": "0.5*c10"}
NOISE = 0.01  # of the largest force, and of the largest shortening


def muscle(rng, **model):
    """A muscle at random, and its first guess."""
    alpha, c10 = rng.uniform(22.0, 32.0), rng.uniform(0.1e6, 0.3e6)
    radius = rng.uniform(5e-3, 10e-3)
    truth = Actuator(
        alpha=alpha, beta=-alpha, length=rng.uniform(0.2, 0.4), radius=radius, wall=rng.uniform(0.15, 0.3) * radius,
        material=MooneyRivlin(c10, RATIO * c10), fiber_extension=rng.uniform(1.002, 1.01), **model,
    )  # fmt: skip
    guess = replace(
        truth, alpha=alpha + rng.uniform(-2.0, 2.0), beta=-truth.alpha, fiber_extension=1.004,
        material=MooneyRivlin(0.15e6, RATIO * 0.15e6),
    )  # fmt: skip
    return truth, replace(guess, beta=-guess.alpha)


def exact(measurements, tube):
    """The same readings as the model of a tube has them: slack where it would have to be pushed."""
    setups = [Setup(tube, tube.length, 0.0, 0.0) for _ in measurements]
    (found,) = Predictor(measurements).predict([setups])
    return [np.nan_to_num(values[:, 0]).clip(min=0.0) for values in found]


def bench(truth, guess, rng, noise=NOISE, forces=True, states=(10, 8)):
    """A free curve over pressure, and forces over contraction at three pressures, with noise and slack zeros; ``states`` of
    the one, and of each of the others.
    """
    top = rng.uniform(2.0, 4.0) * 1e5
    many, each = states
    pressure = np.linspace(0.15, 1.0, many) * top
    free = Measurement(guess, pressure, stroke=np.full(many, 1e-3))
    held = [np.repeat([0.35, 0.7, 1.0], each) * top, np.tile(np.linspace(0.0, 0.24, each), 3)]
    pulled = Measurement(guess, held[0], contraction=held[1], force=np.ones(3 * each), measured="force")
    length, force = exact([free, pulled], truth)
    stroke = truth.length - length
    stroke = stroke + noise * stroke.max() * rng.standard_normal(many)
    spread = noise * force.max()
    force = np.where(force > 2.0 * spread, force + spread * rng.standard_normal(3 * each), 0.0)
    made = [Measurement(guess, pressure, stroke=stroke)]
    if forces:
        made.append(Measurement(guess, held[0], contraction=held[1], force=force, measured="force"))
    return made


def half_of(measurement, rest):
    """Every second state."""
    given = {name: getattr(measurement, name) for name in ("pressure", "deformed_length", "force")}
    given = {name: array[rest::2] for name, array in given.items() if array is not None}
    return Measurement(measurement.tube, **given, measured=measurement.measured)


def values(tube):
    """What is fitted, of a tube."""
    return np.array([tube.material.c10, tube.fiber_extension, tube.alpha])
