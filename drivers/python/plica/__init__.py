# SPDX-License-Identifier: BSD-3-Clause
"""Plica: soft-tissue simulation with nonlinear tetrahedral finite elements, contact and surgical tools.

    import plica
    sim = plica.Simulation("ball.yaml", duration="0.5 s")
    for frame in sim.run(0.5, every=0.01):
        print(frame.time, frame.positions().mean(axis=0))

SI units; where a number is expected, text with a unit will do ("20 kPa"). Arrays are numpy's, in double precision, rows in the
order of the meshes' files.
"""

import atexit
import os

# Threads of GNU's OpenMP that wait sleep soon, so that a busy machine does not hold up those that work. Read when that library is loaded.
if not {"GOMP_SPINCOUNT", "OMP_WAIT_POLICY"} & set(os.environ):
    os.environ["GOMP_SPINCOUNT"] = "1000"

from . import _plica  # noqa: E402
from ._plica import Diagnosis, Energies, FileError, InputError
from .check import check, explain
from .mesh import Mesh, Surface
from .mesh import whole as _whole
from .scene import Scene, keys
from .quantities import Cavity, Cut, Obstacle, Reaction, Tool, Wrench
from .run import Diverged, Run
from .simulation import Simulation, close_all, report, solve, view
from .study import study

__version__ = _plica.version()
__all__ = ["Cavity", "Cut", "Diagnosis", "Diverged", "Energies", "FileError", "InputError", "Mesh", "Obstacle", "Reaction",
           "Run", "Scene", "Simulation", "Surface", "Tool", "Wrench", "check", "explain", "info", "init", "keys",
           "report", "solve", "study", "view"]


def init(threads: int = 0) -> None:
    """Start Kokkos with so many threads (0: as many as there are), before anything else does.

    Without it Kokkos starts when a simulation first needs it. InputError where it runs already with another number.
    """
    _plica.start(_whole("threads", threads))


def info() -> dict:
    """What runs here: version, revision, compiler, kokkos, backend, threads. Starts Kokkos."""
    return _plica.info()


def _end() -> None:
    _plica.end()
    close_all()
    _plica.finalize()


atexit.register(_end)
os.register_at_fork(after_in_child=_plica.after_fork)
