"""The notebooks under docs/: every cell runs, and every plot is seen."""

import warnings
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))
PLOTS = {
    "1-first-muscle": 2,
    "2-design-a-rotator": 1,
    "3-fit-a-bench": 1,
    "4-explore-an-atlas": 2,
    "5-a-papers-figure": 1,
}


@pytest.fixture(scope="module")
def executed(tmp_path_factory):
    """All notebooks, run one after the other in one kernel: name -> its cells of code with what they show."""
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed")
    books = {path.stem: nbformat.read(path, as_version=4) for path in NOTEBOOKS}
    cells = [cell for book in books.values() for cell in book.cells]
    whole = nbformat.v4.new_notebook(cells=cells, metadata=next(iter(books.values())).metadata)
    folder = tmp_path_factory.mktemp("notebooks")
    with warnings.catch_warnings(), pytest.MonkeyPatch.context() as patch:
        warnings.simplefilter("ignore")  # of Jupyter's own parts
        patch.delenv("MPLBACKEND", raising=False)  # a notebook's own
        nbclient.NotebookClient(whole, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    return {name: [cell for cell in book.cells if cell.cell_type == "code"] for name, book in books.items()}


def outputs(cells, kind):
    return [output for cell in cells for output in cell.outputs if kind in output.get("data", {})]


def test_every_plot_of_a_notebook_is_seen(executed):
    """The first plot imported pyplot within settings that were restored: all later ones vanished."""
    assert {name: len(outputs(cells, "image/png")) for name, cells in executed.items()} == PLOTS


def test_actuators_and_atlases_are_shown_as_tables(executed):
    assert any("192 mm" in output["data"]["text/html"] for output in outputs(executed["1-first-muscle"], "text/html"))
    assert any(
        "Atlas quick.nc" in one["data"]["text/html"] for one in outputs(executed["4-explore-an-atlas"], "text/html")
    )


def test_notebooks_say_what_they_found(executed):
    def text(name):
        return "".join(one["text"] for cell in executed[name] for one in cell.outputs if one.get("name") == "stdout")

    assert text("1-first-muscle").startswith("35.6 N at 1 bar; never shorter than 129 mm")
    assert "fs.Actuator(alpha=" in text("2-design-a-rotator")
    assert "kPa (the truth is 200)" in text("3-fit-a-bench")
    assert text("4-explore-an-atlas").startswith("beta [degree],")


def test_what_notebooks_hold_is_source_alone():
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    assert len(NOTEBOOKS) == 5
    for path in NOTEBOOKS:
        book = nbformat.read(path, as_version=4)
        assert not any(cell.get("outputs") for cell in book.cells), path
