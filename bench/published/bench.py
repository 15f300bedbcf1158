# SPDX-License-Identifier: BSD-3-Clause
"""Runs the programs that tables are measured with, and formats what comes out."""
import importlib
import json
import os
import re
import resource
import subprocess
import tempfile
from decimal import Decimal
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


class Failed(Exception):
    """A program ended with another status than 0; the text is what it said."""


class Bench:
    """`small`: a quick try, with the smallest bodies. Every program runs on one thread unless it is told otherwise."""

    def __init__(self, build, small, scratch):
        self.build, self.small, self.scratch = Path(build), small, Path(scratch)

    def call(self, program, *words, threads=1, limit=None):
        """What a program of the build tree prints. `limit` [s]: a run that takes longer fails."""
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OMP_PROC_BIND": "false", "GOMP_SPINCOUNT": "1000", "NO_COLOR": "1"}
        command = [str(word) for word in (self.build / "bin" / program, *words)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=ROOT, timeout=limit)
        except subprocess.TimeoutExpired:
            raise Failed(f"more than {limit:g} s") from None
        if done.returncode != 0:
            raise Failed(" ".join(done.stderr.split())[-300:] or f"exit {done.returncode}")
        return done.stdout

    def scene(self, scene):
        """A file of that scene: of the repository's by its path, of a text a new one."""
        if "\n" not in str(scene):
            return ROOT / scene
        handle, name = tempfile.mkstemp(".yaml", dir=self.scratch)
        os.write(handle, scene.encode())
        os.close(handle)
        return Path(name)

    def run(self, scene, *settings, threads=1, precision="double", limit=None):
        """The summary of a `plica run`, with its folder under "folder"."""
        folder = Path(tempfile.mkdtemp(dir=self.scratch))
        sets = [word for setting in settings for word in ("--set", setting)]
        self.call("plica", "run", self.scene(scene), "-o", folder, "--force", "--quiet", "--threads", threads,
                  "--precision", precision, *sets, threads=threads, limit=limit)
        return {**json.loads((folder / "summary.json").read_text()), "folder": str(folder)}

    def study(self, scene, *settings, methods, budget=None, truth=False):
        """What a `plica study` found. `methods`: as `study.methods` takes them."""
        folder = Path(tempfile.mkdtemp(dir=self.scratch))
        sets = [word for setting in (f"study.methods=[{methods}]", *settings) for word in ("--set", setting)]
        more = ["--truth"] * truth + (["--budget", f"{budget:g}s"] if budget else [])
        self.call("plica", "study", self.scene(scene), "-o", folder, "--quiet", "--threads", 1, *more, *sets)
        return json.loads((folder / "study.json").read_text())

    def steps(self, scene, *settings, threads=1, precision="double", limit=20.0):
        """Wall times [s] of a scene's macro steps ("wall"), those without what they waited for a core ("working"), and what plica_step_times says
        besides."""
        sets = [word for setting in settings for word in ("--set", setting)]
        said = self.call("plica_step_times", self.scene(scene), "--threads", threads, "--precision", precision, "--limit", limit, *sets,
                         threads=threads)
        result = json.loads(said)
        result["working"] = [wall - waited for wall, waited in zip(result["wall"], result["waited"])]
        return result

    def kernels(self, names, seconds=0.5, threads=1):
        """{name: row} of the benchmarks whose name matches a regular expression: seconds of an iteration (CPU time of one thread) and their median
        (wall time), bytes or flops a second, and the share of the machine's limit, where there are such."""
        said = json.loads(self.call("plica_bench", f"--benchmark_filter={names}", f"--benchmark_min_time={0.05 if self.small else seconds}",
                                    "--benchmark_format=json", threads=threads))
        units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
        return {re.sub("/(min_time|iterations|repeats).*", "", b["name"]): {"seconds": b["cpu_time"] * units[b["time_unit"]], "median": b.get("median"),
                                                       "share": b.get("fraction_of_limit"), "rate": b.get("bytes_per_second") or b.get("flops_per_second")}
                for b in said["benchmarks"] if not b.get("error_occurred")}


def installed(name):
    """The module of that name; None where it, or what it needs, is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def cpu_of_programs():
    """CPU time [s] of all programs that have been called and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def table(heads, rows, left=1):
    """A table of Markdown; its first `left` columns are words, the others numbers."""
    lines = [heads, ["---"] * left + ["---:"] * (len(heads) - left), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def number(value, digits=2):
    """With so many digits, never by a power of ten."""
    return f"{Decimal(f'{value:.{digits}g}'):,f}"


def percent(share):
    """Such as 2.5 %. What is smaller than rounding in a run is 0."""
    if share is None:
        return ""
    return f"{number(100 * share) if share > 1e-9 else 0} %"


def seconds(time):
    """Such as 14 ms."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if time >= size:
            return f"{number(time / size, 3)} {unit}"
    return f"{number(time / 1e-9, 3)} ns"
