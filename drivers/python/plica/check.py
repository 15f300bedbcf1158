# SPDX-License-Identifier: BSD-3-Clause
"""What a scene comes to, before it runs."""

from __future__ import annotations

import json

from . import _plica
from .scene import made


def check(scene=None, *, precision: str = "double", set: dict | None = None, **overrides) -> dict:
    """Sets a scene up and simulates nothing, as `plica check` does: its levels with their steps, and warnings. InputError says what is
    wrong with it.

    scene: a plica.Scene, or what makes one.
    """
    return json.loads(_plica.check(made("check", scene, set, overrides)._scene, precision))


def explain(scene=None, *, precision: str = "double", set: dict | None = None, **overrides) -> str:
    """What a run of a scene would do, for each level and each part, as `plica explain` prints it.

    scene: a plica.Scene, or what makes one.
    """
    return _plica.explain(made("explain", scene, set, overrides)._scene, precision)
