"""Each Python program of the documentation runs in an empty folder and prints what its page shows.

A ```text block after a ```python block is the expected output; ... in it matches anything."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"


def programs():
    """Each ```python block: its page and number, its text, and the ```text block after it or None."""
    for page in sorted(DOCS.rglob("*.md")):
        blocks = re.finditer(r"^```python\n(.*?)^```\n(?:\n*```text\n(.*?)^```$)?", page.read_text(), re.M | re.S)
        for number, block in enumerate(blocks, 1):
            yield pytest.param(block[1], block[2], id=f"{page.relative_to(DOCS).with_suffix('')}-{number}")


def pattern(text):
    """Matches the text, with anything in place of ``...``."""
    lines = (".*".join(map(re.escape, line.rstrip().split("..."))) for line in text.rstrip("\n").split("\n"))
    return "\n".join(lines)


@pytest.mark.parametrize("text, printed", programs())
def test_program(text, printed, tmp_path):
    (tmp_path / "program.py").write_text(text)
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    ran = subprocess.run(
        [sys.executable, "program.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120
    )
    assert ran.returncode == 0, ran.stderr
    if printed is not None:
        out = "\n".join(line.rstrip() for line in ran.stdout.rstrip("\n").split("\n"))
        assert re.fullmatch(pattern(printed), out, re.S), f"printed:\n{out}\n\nexpected:\n{printed}"


def test_the_documentation_has_programs():
    assert len(list(programs())) >= 22
