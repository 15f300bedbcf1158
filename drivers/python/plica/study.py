# SPDX-License-Identifier: BSD-3-Clause
"""Methods compared."""

from __future__ import annotations

import io

from . import _plica
from .mesh import needed
from .scene import made
from .run import interval_of


def study(scene=None, *, budget: float | str | None = None, set: dict | None = None, **overrides):
    """Measures methods' errors against their run times, as `plica study` does: a pandas.DataFrame, a row per method and macro step.

    scene: a plica.Scene, or what makes one; its section `study` says what is compared.
    budget: wall time of all of it, seconds or "60 s"; what does not fit is left out.

    Columns are those of study.csv: method, macro_step [s], error, wall_time [s], status, pareto ... Ctrl-C stops it.
    """
    scene = made("study", scene, set, overrides)
    pandas = needed("pandas", "plica.study")
    seconds = None if budget is None else interval_of(budget, "budget")[0]
    return pandas.read_csv(io.StringIO(_plica.study(scene._scene, seconds)))
