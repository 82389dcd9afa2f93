"""The guide's programs in Python run as they stand, each alone in an empty folder, and print what the guide says.

A ```text block behind a ```python block is what the program prints; ... in it stands for anything."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

GUIDE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "guide"


def programs():
    """Each ```python block: its page and number, its text, and the ```text block behind it or None."""
    for page in sorted(GUIDE.glob("*.md")):
        blocks = re.finditer(r"^```python\n(.*?)^```\n(?:\n*```text\n(.*?)^```$)?", page.read_text(), re.M | re.S)
        for number, block in enumerate(blocks, 1):
            yield pytest.param(block[1], block[2], id=f"{page.stem}-{number}")


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
        assert re.fullmatch(pattern(printed), out, re.S), f"printed:\n{out}\n\nthe guide says:\n{printed}"


def test_the_guide_has_programs():
    assert len(list(programs())) >= 15
