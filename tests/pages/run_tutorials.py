#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs what the tutorials say: their fenced blocks in order, page by page, in an empty folder that shows the source tree.

    run_tutorials.py BUILD [PAGE...]

BUILD is the folder with bin/plica. A page is a name such as first_simulation; without one, all are run. Of a page
  * a block after a line that is a file's name in backquotes and a colon is that file;
  * other blocks of sh and python are run; those of a page share a folder, and its variables in Python;
  * a block of cpp must stand in the file that the line before it links to;
  * a block of text must be in the output of the block of sh before it, line by line; ... in it stands for anything;
  * a live view is ended, as by Ctrl-C, when it has said its address.
A comment above a block tells more: <!-- status: 2 -->, <!-- needs: meshio --> a module without which the block is left out, or
<!-- not run: why -->. Blocks of Python are left out where plica cannot be imported.
"""
import importlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = ROOT / "cmake/docs/tutorials"
BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^ *```$", re.M | re.S)
FILE = re.compile(r"^`([\w.-]+)`:$")
MARK = re.compile(r"<!-- (status|needs|not run): (.*) -->$")


class Block:
    """A fenced block with its language, its text and what the lines above it say."""

    def __init__(self, page: str, match: re.Match):
        self.line = page[: match.start()].count("\n") + 1
        self.language = match[2]
        self.text = textwrap.dedent(match[3])
        above = [line.strip() for line in page[: match.start()].splitlines() if line.strip()]
        mark = MARK.match(above[-1]) if above else None
        self.marks = {mark[1]: mark[2]} if mark else {}
        self.above = above[-1] if above else ""

    def named_file(self) -> str | None:
        found = FILE.match(self.above)
        return found[1] if found else None


class Fault(Exception):
    pass


def has(module: str) -> bool:
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True


def folder_of_tree(folder: Path, build: Path) -> None:
    """Links to the source tree, so that commands of its root work and write nothing there."""
    for entry in ROOT.iterdir():
        if not entry.name.startswith((".git", "build", "out")):
            (folder / entry.name).symlink_to(entry)
    (folder / "build").symlink_to(build)


def view(command: str, folder: Path) -> None:
    """Starts a live view, waits for its address and ends it."""
    words = ["bash", "-c", f"exec {command} --no-browser --port 0"]
    with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        said = ""
        for line in process.stdout:
            said += line
            if "http://" in line:
                process.send_signal(signal.SIGINT)
        if process.wait(60) != 0 or "http://" not in said:
            raise Fault(f"the live view ended with {process.returncode}:\n{said}")


def run_shell(block: Block, folder: Path) -> str:
    """Runs a block of sh and returns its output."""
    lines = block.text.splitlines()
    views = [line.split("  #")[0] for line in lines if " view " in line.split("#")[0]]
    script = "\n".join(line for line in lines if line.split("  #")[0] not in views)
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    expected = int(block.marks.get("status", 0))
    if done.returncode != expected:
        raise Fault(f"expected status {expected}, got {done.returncode}:\n{done.stdout}")
    for command in views:
        view(command, folder)
    return done.stdout


def compare_output(expected: str, output: str) -> None:
    """Raises a Fault where a line is not in the output."""
    for line in filter(None, (line.strip() for line in expected.splitlines())):
        if not re.search(re.escape(line).replace(r"\.\.\.", ".*"), output):
            raise Fault(f"expected in the output: {line}\ngot:\n{output}")


def compare_source(block: Block) -> None:
    """Raises a Fault where the block is no part of the source that the line above it links to."""
    link = re.search(r"\]\(([^)]+)\)", block.above)
    if not link:
        raise Fault("expected a link to its source in the line before")
    source = [line.strip() for line in (TUTORIALS / link[1]).read_text().splitlines() if line.strip()]
    shown = [line.strip() for line in block.text.splitlines() if line.strip()]
    if not any(source[i : i + len(shown)] == shown for i in range(len(source))):
        raise Fault(f"these lines are not in {link[1]}")


def run_page(page: Path, build: Path) -> list[str]:
    """Runs a page and returns what was left out."""
    left_out = []
    text = page.read_text()
    with tempfile.TemporaryDirectory(prefix="plica_tutorial_") as scratch:
        folder = Path(scratch)
        folder_of_tree(folder, build)
        os.chdir(folder)
        variables = {"__name__": page.stem}
        output = ""
        for match in BLOCK.finditer(text):
            block = Block(text, match)
            where = f"{page.relative_to(ROOT)}:{block.line}"
            runs_here = block.language == "python" and not block.named_file()
            needs = block.marks.get("needs", "plica" if runs_here else "")
            if "not run" in block.marks:
                left_out.append(f"{where}: {block.marks['not run']}")
                continue
            if needs and not (has(needs) and has("plica")):
                left_out.append(f"{where}: needs {needs}")
                continue
            try:
                if file := block.named_file():
                    (folder / file).write_text(block.text)
                elif block.language == "sh":
                    output = run_shell(block, folder)
                elif block.language == "python":
                    exec(compile("\n" * block.line + block.text, str(page), "exec"), variables)
                elif block.language == "text":
                    compare_output(block.text, output)
                elif block.language == "cpp":
                    compare_source(block)
            except Exception as fault:
                raise Fault(f"{where}: {fault}") from fault
        for simulation in variables.values():
            if hasattr(simulation, "close"):
                simulation.close()
        os.chdir(ROOT)
    return left_out


def main(arguments: list[str]) -> int:
    if not arguments:
        print(__doc__, file=sys.stderr)
        return 2
    build = Path(arguments[0]).resolve()
    pages = [TUTORIALS / f"{name}.md" for name in arguments[1:]] or sorted(TUTORIALS.glob("*.md"))
    sys.path.insert(0, str(build / "python"))
    wrong = 0
    for page in pages:
        try:
            left_out = run_page(page, build)
        except Fault as fault:
            print(fault)
            wrong += 1
        else:
            print("\n".join([f"{page.stem}: ran", *(f"  left out: {one}" for one in left_out)]), flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
