#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the page of the Python package from its docstrings.

    reference.py            writes cmake/docs/reference/python.md
    reference.py --check    fails where the page differs from what it would write

It reads the sources and needs no build. Classes that C++ binds are read in bind_results.cpp.
"""
import ast
import re
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "cmake/docs/reference/python.md"
COMMAND = "drivers/python/reference.py"
BOUND = re.compile(r'(?:nb::class_<\w+>|\.def_(?:ro|prop_ro))\(\s*(?:m,\s*)?"(\w+)",(?:\s*&[\w:]+,)?\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)')


def text_of(docstring: str, names: set[str] = frozenset()) -> str:
    """A docstring as Markdown: lines `name: meaning` are a list, indented lines are code."""
    paragraphs = []
    for paragraph in re.split(r"\n\s*\n", docstring):
        if paragraph.startswith("    "):
            paragraphs.append(f"```python\n{textwrap.dedent(paragraph)}\n```")
            continue
        lines, within = [], False
        for line in paragraph.splitlines():
            name = line.partition(":")[0]
            if name in names:
                lines += [""] * (bool(lines) and not within)
                line, within = f"* `{name}`{line[len(name):]}", True
            elif within:
                line = "  " + line
            lines.append(line)
        paragraphs.append("\n".join(lines))
    return "\n\n".join(paragraphs)


def arguments_of(node: ast.FunctionDef | None) -> set[str]:
    return {one.arg for one in node.args.args + node.args.kwonlyargs} if node else set()


def signature(name: str, function: ast.FunctionDef, is_method: bool) -> str:
    arguments = ast.unparse(function.args)
    if is_method:
        arguments = re.sub(r"^(self|cls)(, )?", "", arguments)
    result = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"{name}({arguments}){result}"


def has(function: ast.FunctionDef, decorator: str) -> bool:
    return any(ast.unparse(one) == decorator for one in function.decorator_list)


def class_text(node: ast.ClassDef, nodes: dict) -> str:
    """The class, then each public member, those of its bases too."""
    bases = [nodes[ast.unparse(base)] for base in node.bases if ast.unparse(base) in nodes]
    members = [one for of in (node, *bases) for one in of.body if isinstance(one, ast.FunctionDef)]
    made = next((one for one in members if one.name == "__init__"), None)
    text = f"## {node.name}\n\n"
    if made:
        text += f"```python\n{signature(node.name, made, True)}\n```\n\n"
    fields = {one.target.id for one in node.body if isinstance(one, ast.AnnAssign)}
    text += text_of(ast.get_docstring(node), fields | arguments_of(made)) + "\n\n"
    values = [one for one in members if has(one, "property")]
    if values:
        text += "| value | meaning |\n|---|---|\n"
        text += "".join(f"| `{one.name}` | {cell(ast.get_docstring(one))} |\n" for one in values) + "\n"
    for one in members:
        if one.name.startswith("_") or one in values or not ast.get_docstring(one):
            continue
        text += f"**`{signature(one.name, one, True)}`**\n\n{text_of(ast.get_docstring(one), arguments_of(one))}\n\n"
    return text


def cell(words: str) -> str:
    return " ".join(words.split()).replace("|", "\\|")


def bound_classes() -> dict[str, str]:
    """Classes of bind_results.cpp with their values."""
    classes, name = {}, ""
    for match in BOUND.finditer((HERE / "bind_results.cpp").read_text()):
        words = cell("".join(ast.literal_eval(part) for part in re.findall(r'"(?:[^"\\]|\\.)*"', match[2])))
        if match[0].startswith("nb::class_"):
            name = match[1]
            classes[name] = f"## {name}\n\n{words}\n\n| value | meaning |\n|---|---|\n"
        elif name:
            classes[name] += f"| `{match[1]}` | {words} |\n"
    return {one: text + "\n" for one, text in classes.items()}


def page() -> str:
    package = ast.parse((HERE / "plica/__init__.py").read_text())
    names = next(ast.literal_eval(one.value) for one in package.body
                 if isinstance(one, ast.Assign) and one.targets[0].id == "__all__")
    nodes = {}
    for file in sorted((HERE / "plica").glob("*.py")):
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                nodes[node.name] = node
    bound = bound_classes()
    functions = [nodes[name] for name in names if isinstance(nodes.get(name), ast.FunctionDef)]
    rest = ast.get_docstring(package).partition("\n")[2]
    text = f"<!-- Written by {COMMAND} -->\n# Python\n\n{text_of(rest.strip(chr(10)))}\n\n"
    text += "How to begin: [tutorial](../tutorials/python.md); to install: [install](../how-to/install.md#python).\n\n"
    for name in sorted(names, key=lambda name: (name not in ("Scene", "Simulation"), name)):
        if isinstance(nodes.get(name), ast.ClassDef):
            text += class_text(nodes[name], nodes)
        elif name in bound:
            text += bound[name]
    text += "## Functions\n\n"
    for one in functions:
        text += f"**`plica.{signature(one.name, one, False)}`**\n\n"
        text += text_of(ast.get_docstring(one), arguments_of(one)) + "\n\n"
    text += ("## Errors\n\n| exception | base | when |\n|---|---|---|\n"
             "| `InputError` | `ValueError` | a scene, value or argument is wrong; the message names what was expected |\n"
             "| `FileError` | `OSError` | a file cannot be read or written |\n"
             "| `Diverged` | `RuntimeError` | a run cannot go on; `diagnosis` says why |\n")
    return text


def main() -> int:
    made = page()
    if sys.argv[1:] != ["--check"]:
        PAGE.write_text(made)
        return 0
    if PAGE.exists() and PAGE.read_text() == made:
        return 0
    print(f"{PAGE} differs from the docstrings; write it anew: {COMMAND}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
