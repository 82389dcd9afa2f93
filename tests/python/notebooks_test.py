"""The notebooks run from top to bottom, print what they should, and are stored without outputs."""

import json
import pathlib
import re
import sys

import nbclient
import nbformat
import pytest

NOTEBOOKS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "notebooks"

# What each prints, a number, what it should be, and how near.
RESULTS = {
    "liquid": [
        # Verlet, Phys. Rev. 165, 201 (1968): near the triple point the first shell is at 1.07 to 1.09, 2.6 to 3 high.
        (r"first shell at ([\d.]+)", 1.08, 0.03),
        (r", ([\d.]+) times the mean", 2.9, 0.25),
        (r"([\d.]+) neighbours", 12, 1),
    ],
    "two-streams": [(r"grows with ([\d.]+)", 8**-0.5, 0.005), (r"differ by ([\d.]+) %", 0, 2)],
    "shock-tube": [(r"falls as N\^-([\d.]+)", 0.8, 0.06)],
    "sweep": [(r"D gamma = ([\d.]+)", 1, 0.04)],
    "own-law": [(r"T a = ([\d.]+)", 7.41630, 0.0003)],
}


@pytest.fixture(autouse=True)
def kernel(tmp_path, monkeypatch):
    """A kernel of this Python, whatever else is installed, called boltzmann-test."""
    folder = tmp_path / "jupyter" / "kernels" / "boltzmann-test"
    folder.mkdir(parents=True)
    command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    (folder / "kernel.json").write_text(json.dumps({"argv": command, "display_name": "test", "language": "python"}))
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path / "jupyter"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("PYDEVD_DISABLE_FILE_VALIDATION", "1")


def printed(cell):
    return "".join(out.text for out in cell.get("outputs", ()) if out.output_type == "stream" and out.name == "stdout")


@pytest.mark.parametrize("name", RESULTS)
def test_notebook(name, tmp_path):
    book = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    where = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(book, timeout=60, kernel_name="boltzmann-test", resources=where).execute()
    out = "".join(printed(cell) for cell in book.cells)
    for pattern, expected, margin in RESULTS[name]:
        found = re.search(pattern, out)
        assert found, f"{pattern!r} is not in:\n{out}"
        assert float(found[1]) == pytest.approx(expected, abs=margin), pattern
    assert any("image/png" in data.get("data", ()) for cell in book.cells for data in cell.get("outputs", ()))


def test_each_notebook_is_tested():
    assert {path.stem for path in NOTEBOOKS.glob("*.ipynb")} == set(RESULTS)


@pytest.mark.parametrize("name", RESULTS)
def test_it_is_stored_without_outputs_and_ends_with_exercises(name):
    book = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    nbformat.validate(book)
    assert all(not cell.outputs and cell.execution_count is None for cell in book.cells if cell.cell_type == "code")
    assert "**Question.**" in book.cells[0].source
    assert "## Exercises" in book.cells[-1].source
