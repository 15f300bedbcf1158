# SPDX-License-Identifier: BSD-3-Clause
"""The notebook of the first hour runs, and shows what it showed."""
import os
from pathlib import Path

import pytest

NOTEBOOK = Path(os.environ["PLICA_SOURCE_DIR"]) / "cmake" / "docs" / "tutorials" / "first_hour.ipynb"
for package in ("ipykernel", "matplotlib", "pandas"):
    pytest.importorskip(package)
nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")


def kinds_of(notebook):
    """Of each cell of code, what it shows: names of streams, and the kinds of what is displayed."""
    def shown(output):
        return [output.name] if output.output_type == "stream" else sorted(output.data)

    return [[kind for output in cell.outputs for kind in shown(output)] for cell in notebook.cells if cell.cell_type == "code"]


def test_the_notebook_runs_and_shows_what_it_showed():
    stored = nbformat.read(NOTEBOOK, as_version=4)
    kinds = kinds_of(stored)
    assert sum(kind == "image/png" for cell in kinds for kind in cell) == 3
    assert ["text/html", "text/plain"] in kinds, "the table"
    assert NOTEBOOK.stat().st_size < 500_000
    anew = nbclient.NotebookClient(nbformat.read(NOTEBOOK, as_version=4), timeout=600, resources={"metadata": {"path": str(NOTEBOOK.parent)}})
    anew.execute()
    assert kinds_of(anew.nb) == kinds
