"""The pages under docs/: every block of Python runs, and prints what the page says it prints."""

import contextlib
import importlib.util
import io
import re
import subprocess
import sys
from pathlib import Path

import pytest
from blocks import BLOCK
from grids import CHILD_ENVIRONMENT

import freesweep as fs

DOCS = Path(__file__).parents[2] / "docs"
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?")


def unit_of_last_digit(number):
    mantissa, _, exponent = number.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def same(found, expected):
    """Texts alike, numbers to the last digit that is printed (and one unit of it)."""
    numbers = list(zip(NUMBER.findall(found), NUMBER.findall(expected)))
    close = all(abs(float(a) - float(b)) < 1.01 * unit_of_last_digit(b) for a, b in numbers)
    return close and NUMBER.sub("#", found) == NUMBER.sub("#", expected)


@pytest.mark.parametrize("page", ["model.md", "cookbook.md", "sweeps.md", "designing.md", "derivatives.md"])
def test_blocks_of_a_page_run_and_print_what_it_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (DOCS / page).read_text(encoding="utf-8")
    blocks = list(BLOCK.finditer(text))
    assert len(blocks) == text.count("```python") > 1
    names = {}
    for block in blocks:
        code, expected = block.groups()
        line = text[: block.start(1)].count("\n")
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile("\n" * line + code, page, "exec"), names)
        assert same(out.getvalue(), expected or ""), f"line {line}:\n{out.getvalue()}"


def test_the_comparison_can_fail():
    assert same("a 1.234 mm, -20%", "a 1.235 mm, -20%")
    assert not same("a 1.234 mm", "a 1.237 mm")
    assert not same("a 1.234 mm", "b 1.234 mm")
    assert not same("a 1.2 mm, 3", "a 1.2 mm")


def test_pages_link_to_what_is_there():
    for page in DOCS.glob("*.md"):
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
            assert (DOCS / target).exists(), f"{page.name}: {target}"


@pytest.mark.skipif(importlib.util.find_spec("myst_nb") is None, reason="Sphinx and MyST are not installed")
def test_the_site_is_built_offline_without_a_warning(tmp_path):
    """Warnings are errors: dead links, names that are none, docstrings that cannot be read. Notebooks are run elsewhere."""
    words = ["-m", "sphinx", "-q", "-W", "--keep-going", "-D", "nb_execution_mode=off", str(DOCS), str(tmp_path)]
    done = subprocess.run([sys.executable, *words], capture_output=True, text=True, env=CHILD_ENVIRONMENT)
    assert done.returncode == 0, done.stderr
    reference = (tmp_path / "api.html").read_text(encoding="utf-8")
    for name in set(fs.__all__) - {"sweep", "closed_form", "materials"}:
        assert f'id="freesweep.{name}"' in reference, name
    assert 'id="freesweep.sweep.from_python.sweep"' in reference
    assert not [name for name in re.findall(r'(?:src|href)="(https?:[^"]+)"', reference) if "sphinx-doc" not in name
                and "alabaster" not in name]  # fmt: skip


def test_the_fold_that_is_drawn_is_the_limit_pressure(tmp_path):
    """As the second method has it: p = 1.220586 for 60/55 degrees, 12 radii long."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", DOCS / "fold.py", tmp_path / "fold.png"], capture_output=True, text=True,
        env=CHILD_ENVIRONMENT,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "fold.png").stat().st_size > 5000
    assert float(done.stdout) == pytest.approx(1.220586 * 2e5, rel=1e-4)
