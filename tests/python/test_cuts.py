# SPDX-License-Identifier: BSD-3-Clause
"""Cuts of a body in motion."""

import numpy as np
import plica
import pytest


def test_a_cut_adds_vertices_and_leaves_earlier_arrays():
    bar = {"duration": 1, "body": {"levels": [{"box": {"size": [0.2, 0.1, 0.1], "cells": [8, 4, 4]}}]}, "integration": {"cycle": "single"}}
    sim = plica.Simulation(bar, gravity=[0, 0, -9.81]).step(3)
    before = sim.positions()
    kept = before.copy()
    a, b, c, d = [0.1, -1, -1], [0.1, 1, -1], [0.1, 1, 1], [0.1, -1, 1]
    cut = sim.cut([[a, b, c], [a, c, d]])
    assert (cut.opened_faces, cut.new_vertices, cut.pieces) == (32, 25, 2) and cut.seconds > 0
    x = sim.positions()
    assert x.shape == (10 * 25, 3) and np.array_equal(x[: len(kept)], kept) and np.array_equal(before, kept)
    saved = sim.save()
    sim.step(3)
    other = plica.Simulation(bar, gravity=[0, 0, -9.81])
    other.restore(saved)
    assert np.array_equal(other.step(3).positions(), sim.positions()) and not np.array_equal(sim.positions(), x)
    assert sim.cut([[a, b, b]]).opened_faces == 0
    with pytest.raises(plica.InputError, match=r"triangles: expected an array \[n, 3, 3\]"):
        sim.cut([a, b, c])
