# SPDX-License-Identifier: BSD-3-Clause
"""A scene in motion."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import os
import warnings
import weakref
import webbrowser
from collections.abc import Callable
from pathlib import Path

import numpy as np

from . import _plica
from ._plica import Diagnosis, Energies, InputError
from .mesh import checked, needed, whole
from .quantities import Cavity, Tool, Wrench
from .scene import made

_all: weakref.WeakSet = weakref.WeakSet()
_rounding = 1e-9  # of a macro step
_forever = 2**62


def close_all() -> None:
    """Closes every simulation: none may outlive Kokkos."""
    for simulation in list(_all):
        simulation.close()


class Diverged(RuntimeError):
    """A run that cannot go on. `diagnosis` says why and where; the simulation is at its last good state."""

    def __init__(self, diagnosis: Diagnosis):
        super().__init__(str(diagnosis))
        self.diagnosis = diagnosis


def report(folder, *, frames: int = 200) -> Path:
    """Writes FOLDER/report.html of what a run or a study left there, as `plica report` does. Its path.

    frames: of a run, at most so many, evenly.
    """
    file, notes = _plica.report(os.fspath(folder), whole("frames", frames, 2))
    for note in notes:
        warnings.warn(note, stacklevel=2)
    return Path(file)


def view(scene=None, *, port: int = 8642, browser: bool = True, precision: str = "double", set: dict | None = None, **overrides) -> Simulation:
    """Simulates a scene while a page in a browser shows it, until Ctrl-C; see Simulation.view(). Returns the simulation.

    scene: a plica.Scene, or what makes one.
    """
    taken = _plica.Port(whole("port", port))  # before the set-up, which may take long
    return Simulation(scene, precision=precision, set=set, **overrides)._view(taken, browser)


def _invite(browser: bool, address: str) -> None:
    opened = browser and webbrowser.open(address)
    print(f"{address} {'is open in the browser' if opened else ': open it in a browser on this machine'}; Ctrl-C ends it", flush=True)


class Run:
    """The frames of a run, one after the other. len() is how many there are at most; each is the simulation itself."""

    def __init__(self, simulation: Simulation, end: float, every: float, steps: int, writes: bool):
        self._simulation, self._start, self._end, self._every, self._steps = simulation, simulation.time, end, every, steps
        self._writes = writes
        macro_steps = self._count((end - simulation.time) / simulation.macro_step)
        self._length = macro_steps
        if steps:
            self._length = math.ceil(macro_steps / steps)
        elif every > simulation.macro_step:
            self._length = self._count((end - simulation.time) / every)

    @staticmethod
    def _count(quotient: float) -> int:
        return max(0, math.ceil(quotient - _rounding))

    def __len__(self) -> int:
        return self._length

    def __iter__(self) -> Run:
        return self

    def __next__(self) -> Simulation:
        simulation = self._simulation
        slack = _rounding * simulation.macro_step
        if simulation.time >= self._end - slack:
            raise StopIteration
        try:
            if self._steps:
                simulation._advance(self._end, self._steps)
            else:
                frame = math.floor((simulation.time - self._start + slack) / self._every) + 1
                simulation._advance(min(self._start + frame * self._every, self._end))
        except Diverged as error:
            self._write("diverged", error.diagnosis)
            raise
        self._write("running" if simulation.time < self._end - slack else "completed", None)
        return simulation

    def _write(self, status: str, diagnosis: Diagnosis | None) -> None:
        if self._writes:
            self._simulation._open().write_frame(status, diagnosis)


class Simulation:
    """A scene in motion.

    scene: a plica.Scene, or what makes one: the name of a YAML file or a dict, with `set` and keyword arguments as for Scene.
    precision: "double" or "float", of the computation; arrays are in double anyway.

    positions(), velocities(), surface_positions() and surface_velocities() return arrays that follow the simulation: they lie in
    memory that C++ writes after every frame for as long as somebody holds them. Copy what is to stay as it is. They outlive the
    simulation, and hand themselves to other libraries by DLPack. A simulation is for one thread at a time; while it steps, other
    threads of Python run. Use it in a `with` statement, or close() it, to free its memory at once.
    """

    scene = _simulation = _folder = None  # until they are made

    def __init__(self, scene=None, *, precision: str = "double", set: dict | None = None, **overrides):
        self.scene = made("Simulation", scene, set, overrides)
        self._simulation = _plica.simulate(self.scene._scene, precision)
        _all.add(self)

    # -- stepping

    def run(self, duration: float | str | None = None, *, every: float | str | None = None, folder=None, force: bool = False):
        """Goes on for so long [s]; left out, for the scene's duration.

        Without `every` it runs at once and returns the simulation. With it, it returns the frames to go through: after each of
        these intervals (seconds, "10 ms" or "5 steps") the simulation itself, at the first macro step that reaches it.

            for frame in tqdm(sim.run(0.5, every="10 ms")): ...

        Where the scene leaves the macro step open, the last one ends exactly then; macro steps of a given size are whole. The
        states are those of `plica run`, bit for bit. Diverged where the run cannot go on. Ctrl-C ends it: between two macro steps, or
        within one that takes long, and then the state is the last one that was kept.

        folder: the state now and each frame are written there, as `plica run` does, for report(), ParaView and the like. One that
        holds a run already is refused, unless `force` says to replace it.
        """
        simulation = self._open()
        seconds = self.scene.duration if duration is None else _interval(duration, "duration")[0]
        end = self.time + seconds
        if self.scene._scene.automatic_step:
            simulation.end_at(end)
        if every is None:
            if folder is not None:
                raise InputError("folder: frames are written only where `every` says when")
            self._advance(end)
            return self
        interval, steps = _interval(every, "every")
        if folder is not None:
            self._start_files(folder, force)
        return Run(self, end, interval, steps, folder is not None)

    def _start_files(self, folder, force: bool) -> None:
        there = _plica.former_run(os.fspath(folder))
        if there and not force:
            raise InputError(f"folder: {folder} holds a run already ({', '.join(there)}); expected another one, or force=True")
        self._open().start_files(os.fspath(folder))
        self._folder = Path(folder)
        self._open().write_frame("running", None)

    def step(self, macro_steps: int = 1) -> Simulation:
        """So many macro steps."""
        count = whole("macro_steps", macro_steps)
        self._open().end_at(math.inf)
        return self._advance(math.inf, count)

    def _advance(self, until: float, at_most: int = _forever) -> Simulation:
        diagnosis = self._open().advance(until, at_most)
        if diagnosis is not None:
            raise Diverged(diagnosis)
        return self

    # -- what there is

    @property
    def time(self) -> float:
        """Simulated [s]."""
        return self._open().time

    @property
    def macro_step(self) -> float:
        """Of every level together [s]."""
        return self._open().macro_step

    @property
    def macro_steps(self) -> int:
        """Done so far; one that was cut short to end in time does not count."""
        return self._open().macro_steps

    @property
    def precision(self) -> str:
        """double or float."""
        return self._open().precision

    @property
    def levels(self) -> list[dict]:
        """Of each level in use, the finest first: vertices, tets, critical_step [s], share, substeps, integrator ..."""
        return json.loads(self._open().levels)

    @property
    def counters(self) -> dict:
        """Force evaluations, solver iterations and the like."""
        return self._open().counters

    def positions(self, level: int = 0) -> np.ndarray:
        """[vertices, 3] m, of a level; follows the simulation."""
        return self._open().positions(whole("level", level))

    def velocities(self, level: int = 0) -> np.ndarray:
        """[vertices, 3] m/s, of a level; follows the simulation."""
        return self._open().velocities(whole("level", level))

    def surface_positions(self) -> np.ndarray:
        """[points, 3] m, of the embedded surface; no rows without one; follows the simulation."""
        return self._open().surface_positions()

    def surface_velocities(self) -> np.ndarray:
        """[points, 3] m/s, likewise."""
        return self._open().surface_velocities()

    def von_mises(self, level: int = 0) -> np.ndarray:
        """Equivalent stress now [Pa]: [vertices] of a level with nodal elements, [tetrahedra] with linear ones."""
        return self._open().element_fields(whole("level", level))[1]

    def J(self, level: int = 0) -> np.ndarray:
        """Volume ratio now: [vertices] of a level with nodal elements, [tetrahedra] with linear ones."""
        return self._open().element_fields(whole("level", level))[2]

    def energies(self) -> Energies:
        """Of level 0 now [J]: kinetic, elastic, potential, contact, total."""
        return self._open().energies

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

    def cavities(self) -> dict[int, Cavity]:
        """How each load with `enclosed_volume` is now, by its number among body.loads: of level 0."""
        return {load: Cavity(volume, pressure) for load, volume, pressure in self._open().cavities()}

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

    def report(self, *, frames: int = 200) -> Path:
        """Writes the page of the last run that had a `folder`: one file that a browser opens without a network. Its path."""
        if self._folder is None:
            raise InputError("report: nothing was written; expected run(..., every=..., folder=...) before")
        return report(self._folder, frames=frames)

    def view(self, *, port: int = 8642, browser: bool = True) -> Simulation:
        """Goes on from here while a page in a browser shows it: the mouse pulls the body and pushes it with a ball, sliders change
        gravity, stiffness and speed. Until Ctrl-C (in a notebook: interrupt the kernel).

        port: of the page's address on this machine; 0: any free one.
        browser: whether one is opened.
        """
        return self._view(_plica.Port(whole("port", port)), browser)

    def _view(self, port: _plica.Port, browser: bool) -> Simulation:
        self._open().end_at(math.inf)
        with contextlib.suppress(KeyboardInterrupt):
            self._open().show_live(port, functools.partial(_invite, browser))
        return self

    def to_pyvista(self, level: int = 0):
        """A pyvista.UnstructuredGrid of a level as it is now, with displacement [m], velocity [m/s], von_mises [Pa] and J."""
        pyvista = needed("pyvista", "to_pyvista")
        mesh = self.scene.mesh(whole("level", level))
        cells = np.hstack([np.full((len(mesh.tets), 1), 4), mesh.tets])
        grid = pyvista.UnstructuredGrid(cells.ravel(), np.full(len(cells), pyvista.CellType.TETRA), self.positions(level).copy())
        grid.point_data["displacement"] = self.positions(level) - (mesh.points + self.scene._scene.placement)
        grid.point_data["velocity"] = self.velocities(level).copy()
        per_vertex, von_mises, J = self._open().element_fields(whole("level", level))
        for name, values in (("von_mises", von_mises), ("J", J)):
            (grid.point_data if per_vertex else grid.cell_data)[name] = values
        return grid

    # -- what may be changed

    def set_state(self, positions, velocities=None) -> None:
        """Replaces level 0's state: [vertices, 3] m and m/s (left out: at rest). The next cycle takes it to the other levels."""
        shape = (self.levels[0]["vertices"], 3)
        x = checked("positions", positions, shape)
        v = np.zeros(shape) if velocities is None else checked("velocities", velocities, shape)
        self._open().set_state(x, v)

    def set_forces(self, forces: Callable | None) -> None:
        """Asks forces(level, time, positions, velocities, out) for more forces at every state about to be integrated, on each
        level; None ends that.

        Add to `out`, [vertices, 3] N; positions [m] and velocities [m/s] are alike. All three are for the call alone. On explicit
        levels such forces are stable up to a stiffness of about 4 m/h^2 of the vertices they act on. What it raises ends the step,
        which is taken back.
        """
        if forces is not None and not callable(forces):
            raise InputError(f"forces: expected a function, or None, got {type(forces).__name__}")

        def added(level, time, positions, velocities, out):
            if (answer := forces(level, time, positions, velocities, out)) is not None and answer is not out:
                raise InputError(f"forces: expected it to add to `out` and return nothing, got {type(answer).__name__}")

        self._open().set_forces(forces and added)

    def save(self) -> bytes:
        """All that is needed to go on from here with the same bits; for restore() of the same scene."""
        return self._open().save()

    def restore(self, saved: bytes) -> None:
        """Goes back to what save() has returned. InputError for a state of other sizes, precision or macro step."""
        self._open().restore(saved)

    # -- life

    def close(self) -> None:
        """Frees it. Arrays that were handed out stay."""
        if self._simulation is not None:
            self._simulation.close()
        self._simulation = None

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def _open(self):
        if self._simulation is None:
            raise RuntimeError("this simulation is closed")
        return self._simulation

    def __repr__(self):
        if self.scene is None:
            return "<plica.Simulation: refused>"
        if self._simulation is None:
            return f"<plica.Simulation of {self.scene.name!r}: closed>"
        return f"<plica.Simulation of {self.scene.name!r}: at {self.time:g} s, macro step {self.macro_step:g} s>"


def _interval(value, name: str) -> tuple[float, int]:
    """Seconds, or else macro steps, from a number or text with a unit."""
    if isinstance(value, str):
        seconds, steps = _plica.parse_every(name, value)
        if steps and name != "every":
            raise InputError(f"{name}: expected a time, got {value!r}; step() takes macro steps")
    else:
        try:
            seconds, steps = float(value), 0
        except (TypeError, ValueError):
            raise InputError(f"{name}: expected a number of seconds or text such as '10 ms', got {value!r}") from None
    if not steps and not (0 < seconds < math.inf):
        raise InputError(f"{name}: expected a time (s) > 0, got {value!r}")
    return seconds, steps
