# SPDX-License-Identifier: BSD-3-Clause
"""The example that fits parameters to a measured force curve."""
import copy
import importlib.util
import os
from pathlib import Path

import numpy as np
import pytest


@pytest.fixture
def example(monkeypatch):
    file = Path(os.environ["PLICA_SOURCE_DIR"]) / "drivers" / "python" / "examples" / "fit.py"
    spec = importlib.util.spec_from_file_location("fit_example", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.SCENE = copy.deepcopy(module.SCENE)
    module.SCENE["body"]["levels"][0]["box"]["cells"] = [6, 6, 3]  # fast
    monkeypatch.setattr(module, "SPEED", 0.02)
    return module


def test_a_curve_without_scatter_gives_its_parameters_back(example):
    x = np.linspace(0.1, 1, 15)
    model = lambda p: p[0] * x * np.exp(p[1] * x)  # noqa: E731
    found, error = example.fit(model, [1.0, 1.0], model([30.0, 2.5]))
    assert found == pytest.approx([30, 2.5], rel=1e-4)
    assert (error < 1e-3).all()


def test_standard_errors_are_those_of_linear_least_squares(example):
    x = np.linspace(0, 1, 40)
    scatter = 0.05 * np.random.default_rng(3).standard_normal(40)
    measured = 2 + 3 * x + scatter
    found, error = example.fit(lambda p: p[0] + p[1] * x, [1.0, 1.0], measured)
    A = np.column_stack([np.ones(40), x])
    best, rest = np.linalg.lstsq(A, measured, rcond=None)[:2]
    deviation = np.sqrt(np.diag(np.linalg.inv(A.T @ A)) * rest[0] / 38)
    assert found == pytest.approx(best, rel=1e-4)
    assert error * found == pytest.approx(deviation, rel=0.03)  # slopes are differences over 2 %


def test_a_made_up_force_curve_gives_its_parameters_back(example):
    depth = np.linspace(1e-3, 10e-3, 15)
    measured = example.made_up(depth)
    found, error = example.fit(lambda parameters: example.forces(depth, parameters), example.START, measured)
    assert (error < 0.15).all()
    assert (np.abs(np.log(found / example.TRUTH)) < 3 * error + 0.005).all()
