# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles of a simulation."""

from __future__ import annotations

import numpy as np

from ._plica import InputError
from .mesh import checked
from .quantities import Obstacle, Tool, Wrench
from .scene import words


class Obstacles:
    """What a Simulation says of its obstacles, and how they are moved."""

    def wrenches(self) -> dict[str, Wrench]:
        """What each obstacle does to the body, by its name: the mean over the last macro step."""
        return {name: Wrench(force, torque) for name, force, torque in self._open().wrenches()}

    def contact_depths(self) -> dict[str, float]:
        """How deep the surface is in each obstacle at its deepest place [m], by its name: 0 outside; points that it holds are
        left out."""
        return dict(zip(self.wrenches(), self._open().contact_depths()))

    def tools(self) -> dict[str, Tool]:
        """Where each obstacle with mass is now, by its name."""
        return {name: Tool(*rest) for name, *rest in self._open().tools()}

    def move_obstacle(self, name: str, displacement, rotation=None) -> None:
        """Moves an obstacle straight from where it is to a displacement within the next macro step. There it stays, and no longer
        follows the scene; one with mass follows by its coupling.

        displacement: [3] m, from where its shape says. To lead it along a path, call this before every step.
        rotation: [3] rad, its direction the axis and its length the angle: it turns there in the same time, about the point of its
        `turn`, or its origin. Left out: it turns as it did.
        """
        number = self._number("move_obstacle", name)
        turned = None if rotation is None else checked("rotation", rotation, (3,)).tolist()
        self._open().move_obstacle(number, checked("displacement", displacement, (3,)).tolist(), turned)

    def set_obstacle_motion(self, name: str, motion: dict | None = None, turn: dict | None = None) -> None:
        """Sets how an obstacle moves and turns from now on, instead of as the scene says.

        motion: with `velocity`, `curve` or `sine`, as in a scene; displacements are from where its shape says. Left out: as it does.
        turn: with `axis`, `about`, `angular_velocity` and so on, as in a scene. Left out: as it does.
        """
        given = [("motion", motion), ("turn", turn)]
        for what, value in given:
            if value is not None and not isinstance(value, dict):
                raise InputError(f'set_obstacle_motion: expected {what} as a dict such as {{"velocity": [0, 0, "1 mm/s"]}}, got {type(value).__name__}')
        self._open().set_obstacle_motion(self._number("set_obstacle_motion", name), *("" if value is None else words(value) for _, value in given))

    def obstacles(self) -> dict[str, Obstacle]:
        """Where each obstacle is now, by its name. One with mass follows by its coupling: see tools()."""
        return {name: Obstacle(*rest) for name, *rest in self._open().obstacles()}

    def grasp(self, name: str) -> None:
        """An obstacle with `grasp` takes hold of the surface points that touch it now, or are within its reach, besides those that it
        holds: springs tie them to where they are relative to it."""
        self._open().grasp(self._number("grasp", name))

    def release(self, name: str) -> None:
        """It lets go of all that it holds."""
        self._open().release(self._number("release", name))

    def held(self) -> dict[str, np.ndarray]:
        """The surface points that each obstacle with `grasp` holds, by its name."""
        return {name: np.array(points, int) for name, points in self._open().held()}

    def _number(self, asked: str, name: str) -> int:
        names = list(self.wrenches())
        if name not in names:
            raise InputError(f"{asked}: unknown obstacle {name!r} (choices: {', '.join(names) or 'none'})")
        return names.index(name)

    def _lead(self, other: Obstacles) -> None:
        """Takes the other one, which is at its start, to this time, with its obstacles where these are."""
        start = other.obstacles()
        other._open().set_time(self.time)
        there = other.obstacles()
        for name, place in self.obstacles().items():
            if name not in there or (np.array_equal(place.origin, there[name].origin) and np.array_equal(place.rotation, there[name].rotation)):
                continue
            if start[name].rotation.any():
                raise InputError(f"changed: obstacle {name!r} is turned at the start, and was moved since; expected one of the two")
            way = place.origin - (start[name].origin - start[name].displacement)
            turned = place.rotation.any() or there[name].rotation.any()
            other.set_obstacle_motion(name, {"curve": [{"time": 0, "displacement": way}]}, {"rotation": place.rotation} if turned else None)
