"""What notebooks and terminals show of actuators, rubbers and atlases."""

from html.parser import HTMLParser
from pathlib import Path

import xarray as xr

import freesweep as fs

TUBE = fs.Actuator(
    alpha=[(0, 20), (1, 60)], beta=-89, length=0.2, radius=5e-3, wall=1e-3, material=fs.material("ecoflex-00-30")
)


class Balanced(HTMLParser):
    """Every tag that opens is closed, in order; what stands between is kept."""

    def __init__(self, text):
        super().__init__()
        self.open, self.texts = [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def test_an_actuator_is_shown_in_everyday_units_with_its_threads():
    shown = TUBE._repr_html_()
    texts = Balanced(shown).texts
    for text in (
        "20 deg to 60 deg, varies along the tube",
        "-89 deg",
        "200 mm",
        "7.93 kPa",
        "membrane, bonded fibers at 5 mm",
    ):
        assert text in texts, text
    assert 10 < shown.count("<line ") < 200  # steep threads, too


def test_the_library_is_a_table_with_source_and_range(capsys):
    print(fs.materials)
    told = capsys.readouterr().out
    texts = Balanced(fs.materials._repr_html_()).texts
    for name, rubber in fs.materials.items():
        assert f"{name:<18}" in told
        assert f"to a stretch of {rubber.largest_stretch:g}" in told
        assert rubber.source.split()[-1] in told
        assert {name, rubber.source, f"{rubber.largest_stretch:g}"} <= set(texts)
        assert rubber.source in Balanced(rubber._repr_html_()).texts


def test_a_figure_is_seen_without_pyplot():
    """What small multiples are: a figure that no window knows, of which a notebook showed its size."""
    with fs.example_atlas() as atlas:
        figure = fs.plot.section.multiples(atlas.data, over="length")
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_an_atlas_of_a_stranger_shows_no_markup_of_its_own():
    with fs.example_atlas() as atlas:
        texts = Balanced(atlas._repr_html_()).texts
        assert "0 kPa to 300 kPa" in texts
        assert f"{atlas.status_counts()['ok']:,}" in texts
        evil = fs.Atlas(atlas.data.assign_attrs(title="<script>alert(1)</script>"), Path("<b>.nc"))
        assert "<script>" not in evil._repr_html_()
        assert isinstance(evil.data, xr.Dataset)
