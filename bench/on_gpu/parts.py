# SPDX-License-Identifier: BSD-3-Clause
"""What a build of Plica needs besides a compiler, CUDA and CMake: where it comes from, and how it is built on the other machine."""
import os
import re
import shutil
import subprocess
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Built there: name of Debian's source package, where its CMakeLists.txt lies, options for it.
LIBRARIES = {
    "yaml-cpp": (".", ("YAML_CPP_BUILD_TESTS=OFF", "YAML_CPP_BUILD_TOOLS=OFF")),
    "fmtlib": (".", ("FMT_TEST=OFF", "FMT_DOC=OFF")),
    "pugixml": (".", ()),
    "zlib": (".", ()),
    "lz4": ("build/cmake", ("LZ4_BUILD_CLI=OFF", "LZ4_BUILD_LEGACY_LZ4C=OFF", "BUILD_STATIC_LIBS=ON")),
    "googletest": (".", ("BUILD_GMOCK=OFF",)),
    "benchmark": (".", ("BENCHMARK_ENABLE_TESTING=OFF", "BENCHMARK_ENABLE_GTEST_TESTS=OFF", "BENCHMARK_ENABLE_WERROR=OFF")),
}
# In place of its own, which names files that Debian leaves out.
ZLIB = """cmake_minimum_required(VERSION 3.25)
project(zlib C)
file(GLOB sources *.c)
add_library(z STATIC ${sources})
target_compile_definitions(z PRIVATE HAVE_UNISTD_H _LARGEFILE64_SOURCE=1)
install(TARGETS z)
install(FILES zlib.h zconf.h DESTINATION include)
"""
# Headers alone, with their files for CMake: Debian's packages. They are copied as they are installed.
HEADERS = ("libeigen3-dev", "nlohmann-json3-dev", "libcli11-dev", "libspectra-dev")
KOKKOS_OPTIONS = ("Kokkos_ENABLE_SERIAL=ON", "Kokkos_ENABLE_OPENMP=ON", "Kokkos_ENABLE_CUDA=ON", "Kokkos_ARCH_HOPPER90=ON",
                  "CMAKE_POSITION_INDEPENDENT_CODE=ON", "CMAKE_CXX_STANDARD=20")
KOKKOS_URL = "https://github.com/kokkos/kokkos/releases"
# CUDA 13 has other arguments for these, and no sm_70; Kokkos knows it from 4.7.1 on.
INSTANCE = "core/src/Cuda/Kokkos_Cuda_Instance.hpp"
CUDA_13 = (
    (INSTANCE, "cudaGraphAddDependencies(graph, from, to, numDependencies)", "cudaGraphAddDependencies(graph, from, to, nullptr, numDependencies)"),
    (INSTANCE, "cudaMemAdvise(devPtr, count, advice, device)", "cudaMemAdvise(devPtr, count, advice, cudaMemLocation{cudaMemLocationTypeDevice, device})"),
    (INSTANCE, "cudaMemPrefetchAsync(devPtr, count, dstDevice,", "cudaMemPrefetchAsync(devPtr, count, cudaMemLocation{cudaMemLocationTypeDevice, dstDevice}, 0,"),
)


class Missing(Exception):
    """Something that has to be there is not; the text is one sentence."""


def call(*words, **more):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True, **more).stdout


def extract(archive, folder):
    """Unpacks by Python alone: another machine may lack xz or bzip2."""
    with tarfile.open(archive) as files:
        files.extractall(folder, **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))


def size_of(folder, without=("work", "results")):
    """Bytes of what is to be carried of a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and path.relative_to(folder).parts[0] not in without)


def kokkos_version(folder):
    text = (folder / "CMakeLists.txt").read_text() if (folder / "CMakeLists.txt").exists() else ""
    numbers = [re.search(rf"set\(Kokkos_VERSION_{part} (\d+)\)", text, re.IGNORECASE) for part in ("MAJOR", "MINOR", "PATCH")]
    if not all(numbers):
        raise Missing(f"{folder} is no source tree of Kokkos: it has no CMakeLists.txt that names a version.")
    return tuple(int(number[1]) for number in numbers)


def unpacked_kokkos(source, scratch):
    """A folder with Kokkos' sources: of a folder, an archive, or a git repository with a tag (FOLDER@TAG)."""
    name, _, tag = str(source).partition("@")
    where = Path(name)
    if not where.exists():
        raise Missing(f"{where} is not there; KOKKOS_SOURCE or --kokkos names a folder, an archive or FOLDER@TAG of Kokkos' sources ({KOKKOS_URL}).")
    folder = Path(scratch) / "kokkos"
    folder.mkdir()
    if tag:
        archive = Path(scratch) / "kokkos.tar"
        try:
            call("git", "-C", where, "archive", "--format=tar", "-o", archive, tag)
        except (OSError, subprocess.CalledProcessError):
            raise Missing(f"git finds no {tag} in {where}.") from None
        where = archive
    if where.is_dir():
        shutil.copytree(where, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns(".git"))
    else:
        extract(where, folder)
        if not (folder / "CMakeLists.txt").exists():
            folder = next((path for path in folder.iterdir() if path.is_dir()), folder)
    return folder


def for_cuda_13(folder, version):
    """Edits sources of Kokkos before 4.7.1, whose calls CUDA 13 does not know. Returns what was edited."""
    wrapper = folder / "bin/nvcc_wrapper"
    wrapper.write_text(re.sub(r'^default_arch=.*', 'default_arch="sm_90"', wrapper.read_text(), count=1, flags=re.MULTILINE))
    edited = ["bin/nvcc_wrapper"]
    if version < (4, 7, 1):
        for file, old, new in CUDA_13:
            text = (folder / file).read_text()
            if old not in text:
                raise Missing(f"Kokkos {'.'.join(map(str, version))} is not one that CUDA 13 compiles: {file} has no '{old}'; take Kokkos 5 ({KOKKOS_URL}).")
            (folder / file).write_text(text.replace(old, f"\n#if CUDART_VERSION >= 13000\n{new}\n#else\n{old}\n#endif\n"))
            edited += [file] if file not in edited else []
    return edited


def pack(folder, target):
    """A .tar.xz of a folder, which stands in it under the archive's own name."""
    def entry(info):
        info.uid = info.gid = 0
        info.uname = info.gname = ""
        return info
    with tarfile.open(target, "w:xz") as archive:
        archive.add(folder, target.name.removesuffix(".tar.xz"), filter=entry)


def take_kokkos(source, parts):
    """Kokkos into parts/kokkos-VERSION.tar.xz. Returns its version and what was edited."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = unpacked_kokkos(source, scratch)
        version = kokkos_version(folder)
        if not (4, 6, 0) <= version < (6, 0, 0):
            raise Missing(f"Kokkos {'.'.join(map(str, version))} does not fit: expected 4.6 to 5.")
        edited = for_cuda_13(folder, version)
        text = ".".join(map(str, version))
        pack(folder, parts / f"kokkos-{text}.tar.xz")
    return text, edited


def archive_of(name, archives):
    """A source archive of that name in a folder, None where there is none. Debian's and GitHub's names of files fit."""
    found = sorted(path for path in Path(archives).glob(f"{name.removesuffix('lib') if name == 'fmtlib' else name}*.tar*")
                   if ".debian." not in path.name and not path.name.endswith(".asc"))
    return found[-1] if found else None


def fetch_sources(names, folder):
    """Source archives of Debian's packages, by an apt-get with lists of its own: the system's need not know sources."""
    for name in ("lists/partial", "archives/partial"):
        (folder / name).mkdir(parents=True)
    try:
        release = re.search(r"VERSION_CODENAME=(\w+)", Path("/etc/os-release").read_text())[1]
        targets = call("apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages", f"Release: {release}").split()
        mirror = next(uri for uri in targets if "security" not in uri)
    except (OSError, TypeError, StopIteration, subprocess.CalledProcessError):
        raise Missing(f"There is no apt-get with a mirror here; --archives names a folder with source archives of {', '.join(names)}.") from None
    (folder / "sources.list").write_text(f"deb-src {mirror} {release} main\n")
    options = [f"-o{key}={value}" for key, value in {
        "Dir::State": folder, "Dir::State::Lists": folder / "lists", "Dir::State::status": "/dev/null", "Dir::Cache": folder,
        "Dir::Etc::SourceList": folder / "sources.list", "Dir::Etc::SourceParts": "/dev/null", "Acquire::Languages": "none",
        "APT::Sandbox::User": ""}.items()]
    subprocess.run(["apt-get", "-qq", *options, "update"], check=False, capture_output=True)
    for name in names:
        subprocess.run(["apt-get", "-qq", *options, "source", "--download-only", name], check=False, capture_output=True, cwd=folder)
    return folder


def take_libraries(archives, parts):
    """Source archives of LIBRARIES into parts/. Returns {name: file}."""
    files = {name: archive_of(name, archives) if archives else None for name in LIBRARIES}
    with tempfile.TemporaryDirectory() as scratch:
        wanted = [name for name, file in files.items() if file is None]
        if wanted:
            folder = fetch_sources(wanted, Path(scratch))
            files.update({name: archive_of(name, folder) for name in wanted})
        missing = [name for name, file in files.items() if file is None]
        if missing:
            raise Missing(f"No source archive of {', '.join(missing)} could be fetched; put them into a folder and name it by --archives.")
        for file in files.values():
            shutil.copy(file, parts / file.name)
    return {name: file.name for name, file in files.items()}


def installed_headers():
    """{package: its headers and files for CMake, absolute}."""
    result = {}
    for package in HEADERS:
        try:
            files = call("dpkg", "-L", package, env={**os.environ, "LC_ALL": "C"}).splitlines()
        except (OSError, subprocess.CalledProcessError):
            raise Missing(f"The package {package} is not installed; cmake/setup installs it.") from None
        result[package] = [Path(name) for name in files if re.search(r"/include/|/cmake/", name) and Path(name).is_file()]
    return result


def take_headers(parts):
    """Headers into parts/headers.tar.xz, with the paths that they have below /usr. Returns the number of files."""
    count = 0
    with tarfile.open(parts / "headers.tar.xz", "w:xz") as archive:
        for files in installed_headers().values():
            for file in files:
                archive.add(file.resolve(), "headers/" + str(file.relative_to("/usr")))
                count += 1
    return count
