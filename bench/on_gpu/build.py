# SPDX-License-Identifier: BSD-3-Clause
"""Builds what `bench/gpu --prepare` carried, without a network: libraries, Kokkos for CUDA, then the programs, those first that most of the stages use.

    build.py FOLDER [--pack]

What is there already is kept: a call that was cut off is gone on with by the next. --pack also puts the programs into FOLDER/built.tar.xz, for
another machine; the build then lies in FOLDER-work.
"""
import os
import re
import shutil
import subprocess
import sys
import tarfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from parts import KOKKOS_OPTIONS, LIBRARIES, ROOT, ZLIB, Missing, archive_of, extract, size_of  # noqa: E402
from stages import PROGRAMS  # noqa: E402

TARGETS = (("plica_program", "plica_bench"), ("plica_on_device",))
OPTIONS = ("PLICA_BACKENDS=float;double;OpenMP;Cuda", "PLICA_BUILD_BENCH=ON", "PLICA_BUILD_TESTS=ON", "PLICA_NATIVE=OFF",
           "CMAKE_DISABLE_PRECOMPILE_HEADERS=ON", "CMAKE_DISABLE_FIND_PACKAGE_Doxygen=ON", "CMAKE_DISABLE_FIND_PACKAGE_Git=ON")


def cuda_root():
    nvcc = shutil.which("nvcc") or next((str(path) for path in sorted(Path("/usr/local").glob("cuda*/bin/nvcc"))), None)
    return Path(nvcc).resolve().parent.parent if nvcc else None


def missing_tools():
    """A sentence for each tool that a build needs and this machine lacks."""
    said = []
    if cuda_root() is None:
        said.append("There is no nvcc, neither in PATH nor in /usr/local/cuda*/bin: a build for a GPU needs the CUDA toolkit.")
    if not shutil.which("g++"):
        said.append("There is no g++, which nvcc compiles host code with.")
    if not (shutil.which("cc") or shutil.which("gcc")):
        said.append("There is no C compiler, for zlib and LZ4.")
    if not (shutil.which("ninja") or shutil.which("make")):
        said.append("There is neither ninja nor make.")
    if not shutil.which("cmake"):
        return [*said, "There is no cmake: 3.25 or newer is needed."]
    version = re.search(r"(\d+)\.(\d+)", subprocess.run(["cmake", "--version"], capture_output=True, text=True, check=False).stdout)
    if not version or tuple(map(int, version.groups())) < (3, 25):
        said.append(f"cmake is {version[0] if version else 'of an unknown version'}: 3.25 or newer is needed.")
    return said


class Builder:
    def __init__(self, folder, work):
        self.parts, self.work = folder / "parts", work
        self.prefix, self.cuda = self.work / "prefix", cuda_root()
        self.cores = str(os.cpu_count() or 1)
        generator = "Ninja" if shutil.which("ninja") else "Unix Makefiles"
        # of another machine's shell nothing but the tools is to matter
        self.environment = {**{key: value for key, value in os.environ.items() if not key.startswith(("Kokkos_", "CMAKE_"))}, "CMAKE_GENERATOR": generator,
                            "CMAKE_POLICY_VERSION_MINIMUM": "3.5", "NVCC_WRAPPER_DEFAULT_COMPILER": "g++", "CUDA_ROOT": str(self.cuda),
                            "PATH": f"{self.cuda}/bin:{os.environ['PATH']}", "OMP_PROC_BIND": "false"}
        static = next((str(path) for name in ("lib64", "lib", "targets/x86_64-linux/lib") if (path := self.cuda / name / "libcudart_static.a").exists()), None)
        # the run time of CUDA goes into the programs, so that they need the driver alone
        self.for_cuda = [f"-DCUDA_cudart_LIBRARY={static}"] if static else []

    def call(self, *words):
        done = subprocess.run([str(word) for word in words], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            raise Missing(f"{' '.join(map(str, words))}:\n{done.stdout[-6000:]}")
        return done.stdout

    def unpacked(self, archive):
        """The one folder that is in an archive, or that all of it is put into."""
        target = self.work / "sources" / archive.name.split(".tar")[0]
        if not target.exists():
            beside = target.with_name(target.name + ".part")
            shutil.rmtree(beside, ignore_errors=True)
            beside.mkdir(parents=True)
            extract(archive, beside)
            beside.rename(target)
        inside = list(target.iterdir())
        return inside[0] if len(inside) == 1 and inside[0].is_dir() else target

    def install(self, name, source, options, compiler=None):
        """Builds a library by its CMake into the prefix, once."""
        done = self.work / f"{name}.done"
        if done.exists():
            return f"{name}: there"
        started, tree = time.time(), self.work / "trees" / name
        common = ["CMAKE_BUILD_TYPE=Release", "BUILD_SHARED_LIBS=OFF", "BUILD_TESTING=OFF", "CMAKE_POSITION_INDEPENDENT_CODE=ON", f"CMAKE_INSTALL_PREFIX={self.prefix}",
                  "CMAKE_INSTALL_LIBDIR=lib"]
        if compiler:
            common.append(f"CMAKE_CXX_COMPILER={compiler}")
        else:
            common.append("CMAKE_CXX_FLAGS=-include cstdint")  # which older ones of them forget, and newer compilers want
        if name == "zlib":
            (source / "CMakeLists.txt").write_text(ZLIB)
        self.call("cmake", "-S", source, "-B", tree, *(f"-D{option}" for option in (*common, *options)), *(self.for_cuda if compiler else ()))
        self.call("cmake", "--build", tree, "--target", "install", "-j", self.cores)
        done.touch()
        return f"{name}: {time.time() - started:.0f} s"

    def libraries(self):
        self.unpacked_headers()
        kokkos = self.unpacked(next(self.parts.glob("kokkos-*.tar.xz")))
        jobs = [("kokkos", kokkos, KOKKOS_OPTIONS, kokkos / "bin/nvcc_wrapper")]
        for name, (folder, options) in LIBRARIES.items():
            jobs.append((name, self.unpacked(archive_of(name, self.parts)) / folder, options, None))
        with ThreadPoolExecutor(len(jobs)) as pool:
            for said in pool.map(lambda job: self.install(*job), jobs):
                print(said, flush=True)

    def unpacked_headers(self):
        headers = self.unpacked(self.parts / "headers.tar.xz")
        if not (self.work / "headers.done").exists():
            shutil.copytree(headers, self.prefix, dirs_exist_ok=True)
            (self.work / "headers.done").touch()

    def programs(self):
        tree = self.work / "build"
        if not (tree / "configured").exists():
            self.call("cmake", "-S", ROOT, "-B", tree, "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                      f"-DKokkos_ROOT={self.prefix}", f"-DCMAKE_CXX_COMPILER={self.prefix}/bin/nvcc_wrapper", *self.for_cuda,
                      *(f"-D{option}" for option in OPTIONS))
            (tree / "configured").touch()
        for targets in TARGETS:
            started = time.time()
            self.call("cmake", "--build", tree, "-j", self.cores, "--target", *targets)
            print(f"{', '.join(targets)}: {time.time() - started:.0f} s", flush=True)
        return tree / "bin"


def pack(programs, folder):
    """The programs into folder/built.tar.xz, without symbols."""
    built = programs.parent / "built"
    built.mkdir(exist_ok=True)
    for name in PROGRAMS:
        shutil.copy(programs / name, built / name)
        subprocess.run(["strip", built / name], check=True)
    with tarfile.open(folder / "built.tar.xz", "w:xz") as archive:
        archive.add(built, built.name)
    print(f"built.tar.xz: {(folder / 'built.tar.xz').stat().st_size / 1e6:.1f} MB; the folder: {size_of(folder) / 1e6:.1f} MB, of which 60 may be carried")


def main(folder, *more):
    folder = Path(folder).resolve()
    said = missing_tools()
    for sentence in said:
        print(sentence, file=sys.stderr)
    if said:
        return 2
    # what is to be carried stays small: for that, the build lies beside it
    builder = Builder(folder, folder.with_name(folder.name + "-work") if "--pack" in more else folder / "work")
    builder.work.mkdir(exist_ok=True)
    try:
        builder.libraries()
        programs = builder.programs()
    except Missing as error:
        print(error, file=sys.stderr)
        return 1
    if "--pack" in more:
        pack(programs, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
