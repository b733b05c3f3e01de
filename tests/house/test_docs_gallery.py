"""The gallery: its commands are commands, its pictures are small enough for a page and are made by them."""

import re
import shlex
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot

from freesweep.cli import parser

DOCS = Path(__file__).parents[2] / "docs"
LARGEST = 300_000  # bytes of a picture
TEXT = (DOCS / "gallery.md").read_text(encoding="utf-8")


def commands():
    for block in re.findall(r"^```sh\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE):
        for line in block.strip().splitlines():
            yield shlex.split(line)


def test_commands_are_understood_and_name_their_pictures():
    made = set()
    for words in commands():
        assert words[0] == "freesweep"
        options = parser().parse_args(words[1:])
        assert callable(options.run)
        if words[1] == "thesis":
            made |= {f"gallery/figure-{name}.png" for name in options.figures}
        elif words[1] == "plot":
            made.add(options.out.removeprefix("docs/"))
    assert made == set(re.findall(r"!\[[^]]+\]\(([^)]+)\)", TEXT))


def test_sweeps_are_there():
    for words in commands():
        if words[1] == "sweep":
            assert (DOCS.parent / words[2]).exists()


def test_pictures_are_small():
    for path in (DOCS / "gallery").iterdir():
        assert path.stat().st_size <= LARGEST, path.name


def test_python_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"^```python\n(.*?)^```", TEXT, re.DOTALL | re.MULTILINE)
    exec(compile(code, "gallery.md", "exec"), {})
    pyplot.close("all")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["locked.png", "rotation.svg"]
