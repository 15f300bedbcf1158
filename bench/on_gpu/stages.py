# SPDX-License-Identifier: BSD-3-Clause
"""What is done on a machine with a GPU, in this order. A stage is a list of commands with the seconds that each may take."""
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ("smallest", "press", "two_balls", "beam", "grasp")
SANITIZED = (("smallest", "5 ms"), ("press", "2 ms"), ("two_balls", "2 ms"))
PROGRAMS = ("plica", "plica_bench", "plica_on_device")
LAWS = "(neo_hookean|st_venant_kirchhoff|corotational|holzapfel_gasser_ogden)"


@dataclass
class Part:
    """A command. `needs`: a program without which it is left out. `writes`: files besides its log, of which the summary reads."""
    name: str
    command: list
    seconds: int
    needs: str = ""
    environment: dict = field(default_factory=dict)


@dataclass
class Place:
    """Where things lie on this machine."""
    folder: Path    # what --prepare made, or None: a build tree of this checkout
    binaries: Path  # of the programs
    results: Path

    def program(self, name):
        return str(self.binaries / name)

    @property
    def reference(self):
        return self.folder / "reference" if self.folder else None


def build(place):
    return [Part("build", [sys.executable, str(ROOT / "bench/on_gpu/build.py"), str(place.folder)], 535)] if place.folder else []


def doctor(place):
    return [Part("gpu", ["nvidia-smi", "-q"], 30, "nvidia-smi"), Part("cuda", ["nvcc", "--version"], 20, "nvcc"),
            Part("version", [place.program("plica"), "--version"], 30), Part("doctor", [place.program("plica"), "doctor", "--json"], 240)]


def on_cuda(place):
    """The filter of googletest for tests that are typed by a backend on a GPU. Raises ValueError where there are none."""
    said = subprocess.run([place.program("plica_on_device"), "--gtest_list_tests"], capture_output=True, text=True, check=False).stdout
    suites = re.findall(r"^(\S+)\.  # TypeParam = .*Kokkos::Cuda", said, re.MULTILINE)
    if not suites:
        raise ValueError("plica_on_device lists no tests on Kokkos::Cuda")
    return ":".join(f"{suite}.*" for suite in suites)


def device_tests(place, name, chosen, seconds):
    return Part(name, [place.program("plica_on_device"), f"--gtest_filter={chosen}", f"--gtest_output=json:{place.results / name}.tests.json"], seconds)


def tests(place):
    return [device_tests(place, "on_cuda", on_cuda(place), 500)]


def parity(place):
    parts = [device_tests(place, "parity_of_forces", "OnDevice*.ForcesAreTheHosts", 90), device_tests(place, "parity_of_steps", "OnDevice*.StepsAreTheHosts", 120),
             device_tests(place, "parity_of_graphs", "OnDevice*.GraphsKeepTheBits", 120)]
    if place.reference and place.reference.exists():
        parts += [Part(f"parity_{scene}_{precision}", [sys.executable, str(ROOT / "bench/parity.py"), str(place.reference), place.program("plica"),
                                                       f"drivers/scenes/{scene}.yaml", precision], 30)
                  for scene in SCENES for precision in ("double", "float")]
    return parts


def sanitizer(tool):
    def parts(place):
        begin = ["compute-sanitizer", "--tool", tool, "--error-exitcode", "9", "--print-limit", "20"]
        scenes = [Part(f"{tool}_{scene}", [*begin, place.program("plica"), "run", f"drivers/scenes/{scene}.yaml", "-o", str(place.results / "run"), "--force",
                                           "--quiet", "--duration", duration], 120, "compute-sanitizer") for scene, duration in SANITIZED]
        return [*scenes, Part(f"{tool}_forces", [*begin, place.program("plica_on_device"), "--gtest_filter=OnDevice/0.ForcesAreTheHosts"], 150, "compute-sanitizer")]
    return parts


def measured(place, name, names, seconds, shortest=0.2):
    return Part(name, [place.program("plica_bench"), f"--benchmark_filter={names}", f"--benchmark_min_time={shortest}",
                       f"--benchmark_out={place.results / name}.bench.json", "--benchmark_out_format=json"], seconds)


def kernels(place):
    return [measured(place, "limits", "^limit/", 60), measured(place, "forces", f"^(nodal_)?force/{LAWS}/float/", 180),
            measured(place, "forces_double", f"^(nodal_)?force/{LAWS}/double/(101802|1018686)", 120),
            measured(place, "other_kernels", "^(tangent/neo_hookean|transfer|contact|block_product/neo_hookean|cg_iteration/neo_hookean)/.*float", 120)]


def steps(place):
    return [measured(place, "explicit", "^scale/explicit/float/[0-9]{3,6}(/|$)", 60), measured(place, "explicit_1m", "^scale/explicit/(float|double)/1018686", 120),
            measured(place, "explicit_double", "^scale/explicit/double/[0-9]{3,6}(/|$)", 60), measured(place, "explicit_10m", "^scale/explicit/float/1012", 240)]


def cycles(place):
    return [measured(place, "main_scene", "^cycle/", 90), measured(place, "rsv", "^scale/rsv/float/", 120), measured(place, "him", "^scale/him/float/", 120),
            measured(place, "tool", "^scale/tool/float/", 100), measured(place, "cycles_double", "^scale/(rsv|him|tool)/double/101802", 90)]


def implicit(place):
    return [measured(place, "sofa_beam", "^scale/sofa_beam/", 90), measured(place, "sofa_beam_converged", "^scale/sofa_beam_converged/", 120),
            measured(place, "multigrid", "^scale/multigrid/float/", 180), measured(place, "multigrid_double", "^scale/multigrid/double/101802", 120)]


def where(place):
    """Which kernels a step's time goes to. Counters of one kernel need launches one by one."""
    one = "^scale/explicit/float/1018686/one_by_one"
    bench = [place.program("plica_bench"), "--benchmark_min_time=0.01"]
    report = str(place.results / "steps")
    return [Part("stages", [place.program("plica"), "run", "drivers/scenes/press.yaml", "-o", str(place.results / "run"), "--force", "--time-stages", "--duration",
                            "50 ms", "--precision", "float"], 60),
            Part("nsys", ["nsys", "profile", "--force-overwrite=true", "--stats=true", "-o", report, *bench,
                          "--benchmark_filter=^scale/(explicit|rsv|him)/float/1018686"], 180, "nsys"),
            Part("ncu", ["ncu", "--clock-control", "none", "--set", "basic", "--section", "MemoryWorkloadAnalysis", "--launch-skip", "60", "--launch-count", "24",
                         *bench, f"--benchmark_filter={one}"], 150, "ncu"),
            Part("ncu_multigrid", ["ncu", "--clock-control", "none", "--set", "basic", "--launch-skip", "400", "--launch-count", "60", *bench,
                                   "--benchmark_filter=^scale/multigrid/float/101802/one_by_one"], 130, "ncu")]


@dataclass
class Stage:
    name: str
    words: str
    parts: object  # of a Place


STAGES = (
    Stage("build", "libraries, Kokkos, programs; a call that was cut off goes on in the next", build),
    Stage("doctor", "what this machine is and can do", doctor),
    Stage("tests", "tests of kernels and solvers on the GPU", tests),
    Stage("parity", "forces of each material, like-device's steps, scenes: as on the CPU, in float and double; with graphs and without", parity),
    Stage("memcheck", "compute-sanitizer: accesses outside of memory", sanitizer("memcheck")),
    Stage("racecheck", "compute-sanitizer: races in shared memory", sanitizer("racecheck")),
    Stage("initcheck", "compute-sanitizer: memory that is read before it is written", sanitizer("initcheck")),
    Stage("kernels", "kernels beside the bandwidth of copying", kernels),
    Stage("steps", "explicit steps of 960 to 10 million tetrahedra", steps),
    Stage("cycles", "rsv and him of four levels, contact of a tool", cycles),
    Stage("implicit", "implicit steps with multigrid, the beam of SOFA's CUDA plugin", implicit),
    Stage("where", "which kernels a step's time goes to", where),
)


def scene_files():
    return [ROOT / f"drivers/scenes/{scene}.yaml" for scene in dict.fromkeys([*SCENES, *(scene for scene, _ in SANITIZED)])]


def found(program):
    return shutil.which(program) or (os.access(program, os.X_OK) and program)
