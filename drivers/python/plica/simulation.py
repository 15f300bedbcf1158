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
from typing import overload

import numpy as np

from . import _plica
from ._plica import Energies, InputError
from .mesh import checked, needed, whole
from .obstacles import Obstacles
from .quantities import Cavity, Cut, Reaction
from .run import Diverged, Run, interval_of
from .scene import Scene, made

_all: weakref.WeakSet = weakref.WeakSet()
_forever = 2**62


def close_all() -> None:
    """Closes every simulation: none may outlive Kokkos."""
    for simulation in list(_all):
        simulation.close()


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


def solve(scene=None, *, precision: str = "double", tolerance: float | None = None, set: dict | None = None, **overrides) -> Simulation:
    """The equilibrium of a scene under its loads: a simulation at rest, with everything a Simulation has, such as `residual`.

    scene: a YAML file or a dict, or a plica.Scene whose integration.cycle is rest. Of a scene with another cycle, all of
        `integration` is left out; loads without a time function grow from zero within the duration.
    tolerance: the norm of the forces that may stay unbalanced, over that of all forces; left out, integration.rest.tolerance.

    Diverged where there is no equilibrium, or none is found: `diagnosis` says where forces are not balanced, and `simulation` is the
    last load step at rest. For the states on the way go through Simulation(...).run(every="1 step") of a scene with cycle rest.
    """
    if isinstance(scene, Scene):
        if set or overrides or tolerance is not None or scene._scene.cycle != "rest":
            raise InputError("solve: the scene is made already; expected one with integration.cycle rest and nothing to change, or what makes one")
        return _at_rest(Simulation(scene, precision=precision))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cycle = Scene(scene, set=set, **overrides)._scene.cycle
    changes = {"integration": {"cycle": "rest"}} if cycle != "rest" else {}
    overrides = {key: value for key, value in overrides.items() if cycle == "rest" or key != "integration"}
    changes |= {path: value for path, value in (set or {}).items() if cycle == "rest" or not path.startswith("integration")}
    if tolerance is not None:
        changes["integration.rest.tolerance"] = tolerance
    return _at_rest(Simulation(scene, precision=precision, set=changes, **overrides))


def _at_rest(simulation: Simulation) -> Simulation:
    try:
        return simulation.run()
    except Diverged as error:
        error.simulation = simulation
        raise


def _invite(browser: bool, address: str) -> None:
    opened = browser and webbrowser.open(address)
    print(f"{address} {'is open in the browser' if opened else ': open it in a browser on this machine'}; Ctrl-C ends it", flush=True)


class Simulation(Obstacles):
    """A scene in motion.

    scene: a plica.Scene, or what makes one: the name of a YAML file or a dict, with `set` and keyword arguments as for Scene.
    precision: "double" or "float", of the computation; arrays are in double anyway.

    positions(), velocities(), surface_positions(), surface_velocities() and surface_normals() return arrays that follow the
    simulation: they lie in memory that C++ writes after every frame for as long as somebody holds them. They cannot be written to: copy what is to stay as
    it is, or to be changed. They outlive the simulation, and their `base` hands the memory to other libraries by DLPack.

    One thread at a time computes. Another one that asks for something waits until the macro step is done; while a simulation
    steps, other threads of Python run. Use it in a `with` statement, or close() it, to free its memory at once.
    """

    scene = _simulation = _folder = _forces = None  # until they are made

    def __init__(self, scene=None, *, precision: str = "double", set: dict | None = None, **overrides):
        self.scene = made("Simulation", scene, set, overrides)
        self._simulation = _plica.simulate(self.scene._scene, precision)
        _all.add(self)

    # -- stepping

    @overload
    def run(self, duration: float | str | None = None, *, every: None = None) -> Simulation: ...

    @overload
    def run(self, duration: float | str | None = None, *, every: float | str, folder: str | os.PathLike | None = None,
            force: bool = False) -> Run: ...

    def run(self, duration=None, *, every=None, folder=None, force=False) -> Simulation | Run:
        """Goes on for so long [s]; left out, for the scene's duration.

        Without `every` it runs at once and returns the simulation. With it, it returns the frames to go through: after each of
        these intervals (seconds, "10 ms" or "5 steps") the simulation itself, at the first macro step that reaches it. A list of
        them is the simulation many times, as it is at the end: keep what you want of each.

            for frame in tqdm(sim.run(0.5, every="10 ms")): ...

        Where the scene leaves the macro step open, the last one ends exactly then; macro steps of a given size are whole. The
        states are those of `plica run`, bit for bit. Diverged where the run cannot go on. Ctrl-C ends it: between two macro steps, or
        within one that takes long, and then the state is the last one that was kept.

        folder: the state now and each frame are written there, as `plica run` does, for report(), ParaView and the like. One that
        holds a run already is refused, unless `force` says to replace it.
        """
        simulation = self._open()
        seconds = self.scene.duration if duration is None else interval_of(duration, "duration")[0]
        end = self.time + seconds
        if self.scene._scene.automatic_step:
            simulation.end_at(end)
        if every is None:
            if folder is not None:
                raise InputError("folder: frames are written only where `every` says when")
            self._advance(end)
            return self
        interval, steps = interval_of(every, "every")
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

    @property
    def residual(self) -> float:
        """The largest part of the forces that the last macro step left unbalanced, of an implicit level. With cycle rest: the norm of the
        forces that are not balanced, over that of all forces."""
        return self._open().residual

    def positions(self, level: int = 0) -> np.ndarray:
        """[vertices, 3] m, of a level; follows the simulation. Rows: see Scene.rows()."""
        return _read_only(self._open().positions(whole("level", level)))

    def velocities(self, level: int = 0) -> np.ndarray:
        """[vertices, 3] m/s, of a level; follows the simulation."""
        return _read_only(self._open().velocities(whole("level", level)))

    def surface_positions(self) -> np.ndarray:
        """[points, 3] m, of the embedded surface; no rows without one; follows the simulation."""
        return _read_only(self._open().surface_positions())

    def surface_velocities(self) -> np.ndarray:
        """[points, 3] m/s, likewise."""
        return _read_only(self._open().surface_velocities())

    def surface_normals(self) -> np.ndarray:
        """[points, 3] unit normals of the embedded surface where it is now, outwards; likewise. A normal is the mean of those of the
        triangles around the point, weighted by their angles there; 0 where all of these are flat."""
        return _read_only(self._open().surface_normals())

    def von_mises(self, level: int = 0) -> np.ndarray:
        """Equivalent stress now [Pa]: [vertices] of a level with nodal elements, [tetrahedra] with linear ones."""
        return self._open().element_fields(whole("level", level))[1]

    def J(self, level: int = 0) -> np.ndarray:
        """Volume ratio now: [vertices] of a level with nodal elements, [tetrahedra] with linear ones."""
        return self._open().element_fields(whole("level", level))[2]

    def stress(self, level: int = 0) -> np.ndarray:
        """Cauchy stress now [Pa], without that of damping: [n, 6] xx yy zz xy yz xz, n as of von_mises()."""
        return self._open().tensor_fields(whole("level", level))[0]

    def pressure(self, level: int = 0) -> np.ndarray:
        """Minus a third of the trace of stress() [Pa]: [n], above zero in compression."""
        return self._open().tensor_fields(whole("level", level))[1]

    def principal_stretches(self, level: int = 0) -> np.ndarray:
        """Stretches along the principal directions now: [n, 3], the largest first; n as of von_mises()."""
        return self._open().tensor_fields(whole("level", level))[2]

    def contact_pressure(self) -> np.ndarray:
        """Normal force of contact over the area now, at each point of surface_positions() [Pa]: 0 where nothing touches; empty
        without contact. It is that of the last sub-step of level 0."""
        return self._open().contact_pressure()

    def energies(self) -> Energies:
        """Of level 0 now [J]: kinetic, elastic, potential, contact, total."""
        return self._open().energies

    def reactions(self) -> dict[str, Reaction]:
        """What each entry of body.fixed and body.prescribed does to the body now, by its name: "fixed_0", "prescribed_0". Elastic
        forces are computed anew for it; forces of one's own on these vertices are left out."""
        return {name: Reaction(*rest) for name, *rest in self._open().reactions()}

    def cavities(self) -> dict[int, Cavity]:
        """How each load with `enclosed_volume` is now, by its number among body.loads: of level 0."""
        return {load: Cavity(volume, pressure) for load, volume, pressure in self._open().cavities()}

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
        mesh, in_points, in_cells = self._fields(level)
        cells = np.hstack([np.full((len(mesh.tets), 1), 4), mesh.tets])
        grid = pyvista.UnstructuredGrid(cells.ravel(), np.full(len(cells), pyvista.CellType.TETRA), self.positions(level).copy())
        grid.point_data.update(in_points)
        grid.cell_data.update(in_cells)
        return grid

    def to_meshio(self, level: int = 0):
        """A meshio.Mesh of a level as it is now, with what to_pyvista() has; `region` numbers the regions, as Scene.mesh() names them."""
        meshio = needed("meshio", "to_meshio")
        mesh, in_points, in_cells = self._fields(level)
        if mesh.region.size:
            in_cells["region"] = mesh.region
        sets = {name: np.asarray(points) for name, points in mesh.vertex_sets.items()}
        return meshio.Mesh(self.positions(level).copy(), [("tetra", mesh.tets)], point_data=in_points,
                           cell_data={name: [values] for name, values in in_cells.items()}, point_sets=sets)

    def _fields(self, level: int):
        """A level's mesh at rest, and what there is per point and per cell now."""
        mesh = self.scene.mesh(whole("level", level))
        in_points = {"displacement": self.positions(level) - (mesh.points + self.scene._scene.placement), "velocity": self.velocities(level).copy()}
        per_vertex, von_mises, J = self._open().element_fields(level)
        stress = {"von_mises": von_mises, "J": J}
        return (mesh, in_points | stress, {}) if per_vertex else (mesh, in_points, stress)

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
        which is taken back. It may read the simulation; what changes it is for between steps.
        """
        if forces is not None and not callable(forces):
            raise InputError(f"forces: expected a function, or None, got {type(forces).__name__}")

        owner = weakref.ref(self)  # C++ holds what Python's collector does not see: only this

        def added(level, time, positions, velocities, out):
            forces = owner()._forces
            if (answer := forces(level, time, positions, velocities, out)) is not None and answer is not out:
                raise InputError(f"forces: expected it to add to `out` and return nothing, got {type(answer).__name__}")

        self._open().set_forces(forces and added)
        self._forces = forces

    def cut(self, triangles) -> Cut:
        """Cuts the body along faces of level 0, where triangles [n, 3, 3] m pass between tetrahedra now.

        Faces open and vertices split; mass and momentum stay, and the critical step is found again. New vertices come after the
        others. Arrays from before the cut stay as they were: ask for new ones. Cycles single and him can follow a cut; InputError
        says what cannot.
        """
        rows = checked("triangles", triangles, (-1, 3, 3)).reshape(-1, 9).tolist()
        return Cut(*self._open().cut(rows))

    def set_gravity(self, gravity) -> None:
        """Sets gravity from now on: [3] m/s^2. Neither save() nor reset() stores it."""
        self._open().set_gravity(checked("gravity", gravity, (3,)).tolist())

    def changed(self, *, set: dict | None = None, **overrides) -> Simulation:
        """A simulation of the scene with other values put over it, see Scene.changed(), which goes on from here: with this time, this
        state of level 0 and these places of obstacles; those with mass begin at rest. It is for what a simulation has fixed, such as
        materials.

            softer = sim.changed(body={"material": {"young_modulus": "5 kPa"}})
        """
        other = Simulation(self.scene.changed(set=set, **overrides), precision=self.precision)
        self._lead(other)
        other.set_state(self.positions(), self.velocities())
        return other

    def reset(self) -> Simulation:
        """Goes back to the start, with the same bits: obstacles move as the scene says, what they hold is let go. set_forces() and
        set_gravity() stay. Where something has happened before the first call, this sets the scene up once more."""
        self._open().reset()
        return self

    def save(self) -> bytes:
        """All that is needed to go on from here with the same bits, also how obstacles are moved; for restore() of the same scene."""
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

    def __reduce__(self):
        raise TypeError("a simulation does not pickle; its scene does, and what save() returns")

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


def _read_only(array: np.ndarray) -> np.ndarray:
    view = array.view()
    view.flags.writeable = False
    return view
