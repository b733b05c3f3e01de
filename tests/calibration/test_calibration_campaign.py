"""Campaigns of synthetic benches: intervals hold the truth as often as they say, a wrong model is called wrong."""

from dataclasses import replace

import numpy as np
import pytest
from benches import FIT, NOISE, TIES, bench, muscle, values

from freesweep import calibrate


def covered(seeds):
    """Whether intervals hold the truth (benches, 3), and whether the model was said to fit (benches,)."""
    held, fits = [], []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        truth, guess = muscle(rng)
        found = calibrate(bench(truth, guess, rng), FIT, ties=TIES)
        low, high = found.intervals.T
        held.append((values(truth) >= low) & (values(truth) <= high))
        fits.append(found.fits)
    return np.array(held), np.array(fits)


def refuted(seeds):
    """Whether a membrane was said not to fit readings of thick tubes (benches,)."""
    said = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        truth, guess = muscle(rng, model="physical", fibers="bonded")
        wall = rng.uniform(0.33, 0.67) * truth.radius  # from the section of the source on
        truth, guess = replace(truth, wall=wall), replace(guess, wall=wall, wall_model="membrane")
        found = calibrate(bench(truth, guess, rng, noise=0.5 * NOISE), FIT, ties=TIES)
        said.append(not found.fits)
    return np.array(said)


def test_intervals_hold_the_truth():
    held, fits = covered(range(8))
    assert held.mean() >= 0.8  # 24 numbers
    assert fits.sum() >= 7


@pytest.mark.long
def test_intervals_hold_the_truth_in_nine_of_ten():
    held, fits = covered(range(200))
    print("coverage", held.mean(axis=0), "said to fit", fits.mean())
    assert np.all((held.mean(axis=0) >= 0.9) & (held.mean(axis=0) <= 0.985))
    assert fits.mean() >= 0.95


@pytest.mark.long
def test_a_membrane_is_refuted_by_thick_tubes():
    said = refuted(range(60))
    print("refuted", said.mean())
    assert said.mean() >= 0.9
