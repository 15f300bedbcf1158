# SPDX-License-Identifier: BSD-3-Clause
"""What a simulation says of obstacles, supports and loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Wrench:
    """What an obstacle does to the body. The obstacle feels the opposite.

    force: [3] N.
    torque: [3] N m, about the obstacle's origin, which moves with it.
    """

    force: np.ndarray
    torque: np.ndarray


@dataclass(frozen=True)
class Reaction:
    """What holds vertices, or moves them as given, does to the body. Outside, the opposite is felt.

    force: [3] N.
    torque: [3] N m, about `about`.
    about: [3] m, the centre of the vertices' box at rest, or the point that they turn about.
    """

    force: np.ndarray
    torque: np.ndarray
    about: np.ndarray


@dataclass(frozen=True)
class Cut:
    """What a cut came to.

    opened_faces: number of faces between tetrahedra that have opened; 0: it has met nothing.
    new_vertices: number of vertices that are new where others have split.
    pieces: number of pieces of the body after it.
    seconds: wall time that it took.
    """

    opened_faces: int
    new_vertices: int
    pieces: int
    seconds: float


@dataclass(frozen=True)
class Cavity:
    """How a load with `enclosed_volume` is.

    volume: of the cavity [m^3].
    pressure: of the fluid in it [Pa].
    """

    volume: float
    pressure: float


@dataclass(frozen=True)
class Obstacle:
    """Where the motion of an obstacle has it.

    displacement: [3] m, from where its shape says.
    rotation: [3] rad, its direction the axis and its length the angle.
    origin: [3] m, of the point that torques on it are about, where it is now.
    """

    displacement: np.ndarray
    rotation: np.ndarray
    origin: np.ndarray


@dataclass(frozen=True)
class Tool:
    """Where an obstacle with mass is.

    displacement: [3] m, of its centre of mass from where its shape says.
    velocity: [3] m/s.
    rotation: [3] rad, its direction the axis and its length the angle; 0 without inertia.
    angular_velocity: [3] rad/s; 0 without inertia.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    angular_velocity: np.ndarray
