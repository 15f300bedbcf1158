# SPDX-License-Identifier: BSD-3-Clause
"""Simulated time, frame by frame."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

from . import _plica
from ._plica import Diagnosis, InputError

if TYPE_CHECKING:
    from .simulation import Simulation

rounding = 1e-9  # of a macro step


class Diverged(RuntimeError):
    """A run that cannot go on. `diagnosis` says why and where; the simulation is at its last good state."""

    def __init__(self, diagnosis: Diagnosis):
        super().__init__(str(diagnosis))
        self.diagnosis = diagnosis

    def __reduce__(self):
        return Diverged, (self.diagnosis,)


class Run:
    """The frames of a run, one after the other. len() is how many there are at most; each is the simulation itself, as it is then.

    Nothing runs before the first is asked for: one that is dropped before warns.
    """

    _length, _begun = 0, False

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
        return max(0, math.ceil(quotient - rounding))

    def __len__(self) -> int:
        return self._length

    def __iter__(self) -> Run:
        return self

    def __next__(self) -> Simulation:
        self._begun = True
        simulation = self._simulation
        slack = rounding * simulation.macro_step
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

    def __del__(self):
        if self._length and not self._begun:
            warnings.warn("run(every=...) has not run: go through its frames, as in `for frame in sim.run(...)`", RuntimeWarning, stacklevel=2)

    def _write(self, status: str, diagnosis: Diagnosis | None) -> None:
        if self._writes:
            self._simulation._open().write_frame(status, diagnosis)


def interval_of(value, name: str) -> tuple[float, int]:
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
