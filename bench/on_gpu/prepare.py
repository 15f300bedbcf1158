# SPDX-License-Identifier: BSD-3-Clause
"""Makes the folder that is carried to a machine with a GPU and without a network."""
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from parts import HEADERS, KOKKOS_URL, LIBRARIES, ROOT, Missing, archive_of, call, extract, installed_headers, size_of, take_headers, take_kokkos, take_libraries
from stages import SCENES, STAGES, scene_files

LIMIT = 60e6  # [bytes]
NEEDED = ("CMakeLists.txt", "tests/CMakeLists.txt", "tests/main.cpp", "tests/on_device/test_parity.cpp", "tests/like_device/step_problems.hpp", "bench/gpu",
          "bench/parity.py", "bench/scale.cpp", "bench/on_gpu/build.py", "bench/on_gpu/parts.py", "bench/on_gpu/stages.py", "bench/on_gpu/summary.py",
          "cmake/FindLZ4.cmake", "cmake/revision.cmake")
SCRIPT = """#!/usr/bin/env bash
# Builds Plica for the GPU of this machine, or takes the programs of built.tar.xz, and runs the stages that are not done yet, for at most nine
# minutes. Call it again to go on. Arguments are those of plica/bench/gpu: --list, --stage NAME, -o FOLDER, --minutes N.
set -u
here=$(cd "$(dirname "$0")" && pwd)
if ! command -v python3 > /dev/null; then echo "There is no python3, which runs the stages." >&2; exit 2; fi
if ! python3 -c 'import sys; sys.exit(sys.version_info < (3, 9))'; then echo "python3 is too old: 3.9 or newer is needed." >&2; exit 2; fi
exec python3 "$here/plica/bench/gpu" "$@"
"""


def git(*words):
    return call("git", "-C", ROOT, *words).strip()


def sources():
    """The files of this commit."""
    return git("ls-tree", "-r", "--name-only", "HEAD").splitlines()


def references(program, folder, scenes=SCENES):
    """Frames of the CPU's runs, which bench/parity.py compares with. Returns what was left out."""
    left_out = []
    for scene in scenes:
        for precision in ("double", "float"):
            with tempfile.TemporaryDirectory() as run:
                done = subprocess.run([program, "run", ROOT / f"drivers/scenes/{scene}.yaml", "-o", run, "--force", "--quiet", "--precision", precision, "--duration",
                                       "10 ms", "--set", "output.volume=true", "--set", "output.every=5 ms"], capture_output=True, text=True, check=False)
                frames = sorted(Path(run).glob("frames/volume_*.vtu"))
                if done.returncode or len(frames) < 2:
                    left_out.append(f"{scene} in {precision}: {' '.join(done.stderr.split())[:200]}")
                    continue
                target = folder / f"{scene}-{precision}"
                target.mkdir(parents=True)
                shutil.copy(frames[0], target / "start.vtu")
                shutil.copy(frames[-1], target / "end.vtu")
    return left_out


def plan(args):
    """Prints what would be carried, each with its size where it is known. Returns an exit status: 1 where something is not there."""
    bad = 0
    known = set(sources()) if (ROOT / ".git").exists() else {str(path.relative_to(ROOT)) for path in ROOT.rglob("*") if path.is_file()}
    for name in sorted({*known, *NEEDED, *(str(path.relative_to(ROOT)) for path in scene_files())}):
        there = (ROOT / name).exists()
        bad |= not there and name in NEEDED
        print(f"plica/{name}" + ("" if there else "  MISSING"))
    try:
        for package, files in installed_headers().items():
            print(f"parts/headers.tar.xz  {package}: {len(files)} files, {sum(file.stat().st_size for file in files) / 1e6:.1f} MB")
    except Missing as error:
        print(f"parts/headers.tar.xz  {error}")
    for name in LIBRARIES:
        file = archive_of(name, args.archives) if args.archives else None
        print(f"parts/{file.name if file else name + '_*'}  {f'{file.stat().st_size / 1e6:.2f} MB' if file else 'source package of this system, by apt-get'}")
    kokkos = f"from {args.kokkos}" if args.kokkos else f"NOT KNOWN: --kokkos or KOKKOS_SOURCE names Kokkos' sources ({KOKKOS_URL})"
    print(f"parts/kokkos-*.tar.xz  {kokkos}\nreference/  {', '.join(SCENES)}: the CPU's frames, by {args.build}/bin/plica\nbuild-and-run\ncontents.json")
    print(f"stages: {', '.join(stage.name for stage in STAGES)}")
    return bad


def prepare(args):
    """Makes args.prepare. Returns an exit status."""
    if args.dry_run:
        return plan(args)
    if not args.kokkos:
        raise Missing(f"--kokkos or KOKKOS_SOURCE has to name Kokkos' sources, a folder, an archive or FOLDER@TAG ({KOKKOS_URL}); 5 or newer, so that launches become graphs.")
    target = Path(args.prepare).resolve()
    if target.exists() and any(target.iterdir()) and not (target / "contents.json").exists():
        raise Missing(f"{target} is there and is not of --prepare: it is left as it is.")
    # a build tree that is there is kept
    for name in ("parts", "plica", "reference"):
        shutil.rmtree(target / name, ignore_errors=True)
    parts = target / "parts"
    parts.mkdir(parents=True)
    (target / "contents.json").write_text("{}\n")
    commit = git("describe", "--always", "--tags")
    (target / "plica").mkdir()
    with tempfile.TemporaryDirectory() as scratch:
        archive = Path(scratch) / "plica.tar"
        call("git", "-C", ROOT, "archive", "--format=tar", "-o", archive, "HEAD")
        extract(archive, target / "plica")
    missing = [name for name in NEEDED if not (target / "plica" / name).exists()]
    if missing:
        raise Missing(f"The commit {commit} has no {', '.join(missing)}: what is to be carried has to be committed.")
    revision = target / "plica/cmake/revision.cmake"
    revision.write_text(revision.read_text().replace("$Format:%h$", commit))
    version, edited = take_kokkos(args.kokkos, parts)
    libraries = take_libraries(args.archives, parts)
    headers = take_headers(parts)
    program = args.build / "bin/plica"
    left_out = references(program, target / "reference") if program.exists() else [f"there is no {program}"]
    script = target / "build-and-run"
    script.write_text(SCRIPT)
    script.chmod(0o755)
    contents = {"commit": commit, "changed": git("status", "--porcelain", "--untracked-files=no").splitlines(), "kokkos": version,
                "edited_in_kokkos": edited, "libraries": libraries, "headers": {"packages": HEADERS, "files": headers}, "reference_left_out": left_out,
                "cpu": re.sub(r"\s+", " ", call(program, "--version")).strip() if program.exists() else ""}
    (target / "contents.json").write_text(json.dumps(contents, indent=1) + "\n")
    size = size_of(target)
    print(f"{target}: {size / 1e6:.1f} MB, commit {commit}" + (", without the changes of the work tree" if contents["changed"] else ""))
    if tuple(map(int, version.split("."))) < (5, 0, 0):
        print(f"Kokkos {version} launches one by one: graphs need 5 or newer.")
    for words in left_out:
        print(f"reference left out: {words}")
    if size > LIMIT:
        print(f"That is more than {LIMIT / 1e6:.0f} MB.")
    return int(size > LIMIT)


def source_of_kokkos(given):
    return given or os.environ.get("KOKKOS_SOURCE")
