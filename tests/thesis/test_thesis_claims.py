"""Claims of the source: every one of the theory's list is there, verdicts follow from numbers, the page holds them all."""

import csv
from html.parser import HTMLParser

import matplotlib
import pytest

matplotlib.use("Agg")

from commands import refused, run

from freesweep.thesis.claims import claim, table
from freesweep.thesis.claims.claim import NO, PARTLY, UNKNOWN, YES, Claim, Found
from freesweep.thesis.figures import FIGURES
from freesweep.thesis.make import make, names_of


def only(words):
    (found,) = [one for one in table.CLAIMS if words in one.text]
    return claim.judge(found)


# what the theory's list of claims says of each, as a piece of the text, verdict, and numbers
KNOWN = [
    ("converge to the locked manifold", "principal agrees in part, full agrees", "meet a limit pressure"),
    ("also for the curvilinear shape", YES, "off in the middle"),
    ("15 % further", PARTLY, "34.6 %, 14.8 %, 3.3 %"),
    ("Fiber extension of 0.5 %", PARTLY, "6.99, 14.02, 31.61 N with, 10.68, 17.80, 35.59 N without"),
    ("first extends, then contracts", YES, "kPa: +1.97 mm"),
    ("Prototype B contracts by less", YES, "% at 100 kPa"),
    ("Prototype C contracts by less", "agrees with full only", "% at 200 kPa"),
    ("corrected torque of B", YES, "1.166, 1.306, 1.747"),
    ("also seen in C", NO, "0.991, 0.982"),
    ("turns by 220°", NO, "°"),
    ("changes by 1.5 mm at most", YES, "mm"),
    ("thinner wall deforms first", YES, "kPa"),
    ("kinematics alone", YES, "differ"),
    ("zero at 54.7°", YES, "zero at 54.7°"),
    ("independent of the length", YES, "%"),
    ("increases with the radius", YES, "2.00"),
    ("almost 50 %", UNKNOWN, "N/m"),
    ("(Eq. 3.4)", PARTLY, "1.2 %"),
    ("falls exponentially", NO, "times 0.58"),
    ("less than 0.5 % of its length", NO, "0.75 %"),
]  # fmt: skip


def test_known_claims():
    rows = table.judged()
    for row in rows:
        assert row.principal
        assert row.full
        assert row.verdict != UNKNOWN or row.remark, "why it cannot be checked"
    for words, verdict, numbers in KNOWN:
        (row,) = [row for row in rows if words in row.text]
        assert row.verdict == verdict, words
        assert numbers in row.principal
        assert numbers in row.full


def test_numbers_of_the_two_energies():
    row = only("Prototype C contracts")
    assert (row.principal, row.full) == ("10.1 % at 200 kPa", "4.4 % at 200 kPa")
    assert only("turns by 220°").principal.startswith("142.7°")
    row = only("lets the torque of B exceed")
    assert "up to 205 kPa" in row.principal
    assert "up to 222 kPa" in row.full


def test_threads_that_cannot_push_decide_what_the_text_says_of_torque():
    said = {
        "(Eq. 2.20).": "disagrees: B 0.26, 0.41, 1.12 times",
        "exceed Eq. 2.20 at higher": "agrees: 13.5 % shorter at 100 kPa, more torque than Eq. 2.20 from 95 kPa",
        "also seen in C": "agrees: 2.37",
        "nearly no torque": "agrees: 0.26 times Eq. 2.20 at 30 kPa without any extension",
    }
    for words, found in said.items():
        assert only(words).physical.startswith(found)


def test_every_section_with_claims_is_there():
    sections = {one.where for one in table.CLAIMS}
    assert {"2.2", "2.3.3", "2.3.4", "2.3.5", "2.4.1", "2.4.2", "2.5.1", "2.5.2", "3.4", "3.5", "3.3"} <= sections
    for one in table.CLAIMS:
        assert set(one.figures) <= set(FIGURES)


@pytest.mark.parametrize(
    ("principal", "full", "wanted"),
    [
        (YES, YES, YES), (NO, NO, NO), (UNKNOWN, UNKNOWN, UNKNOWN), (NO, YES, "agrees with full only"),
        (YES, NO, "agrees with principal only"), (PARTLY, YES, "principal agrees in part, full agrees"),
    ],
)  # fmt: skip
def test_verdicts_follow_from_both_energies(principal, full, wanted):
    made = Claim("2.2", (), "It is so.", lambda energy: Found(energy, principal if energy == "principal" else full))
    assert claim.judge(made).verdict == wanted


class Page(HTMLParser):
    """Collects what a page links to, and fails on tags that do not close."""

    def __init__(self, text):
        super().__init__()
        self.open, self.files, self.rows = [], [], 0
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.files += [found[key] for key in ("href", "src") if found.get(key)]
        self.rows += tag == "tr"
        if tag not in ("meta", "br", "img", "!doctype"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_some_figures_their_claims_and_the_page(tmp_path):
    seen = []
    index = make(["figure-3-7", "2-4", "Table-1"], tmp_path / "new", seen.append)
    assert seen == ["figure 2-4", "figure 3-7", "claims"]
    page = Page(index.read_text(encoding="utf-8"))
    files = {file for file in page.files if not file.startswith("#")}
    assert {"figure-2-4.png", "figure-2-4.svg", "figure-2-4.csv", "figure-3-7.csv", "table-1.csv"} <= files
    assert all((index.parent / file).stat().st_size > 0 for file in files)
    with (index.parent / "claims.csv").open(encoding="utf-8", newline="") as file:
        table_rows = list(csv.DictReader(file))
    assert {row["claim"] for row in table_rows} == {
        one.text for one in table.CLAIMS if {"2-4", "3-7"} & set(one.figures)
    }
    assert page.rows == len(table_rows) + 1 + 4  # and Table 1
    first = {path.name: path.read_bytes() for path in index.parent.iterdir()}
    make(["2-4", "3-7", "table-1"], index.parent)
    assert {path.name: path.read_bytes() for path in index.parent.iterdir()} == first


def test_names():
    assert names_of([])[:3] == ["1-2", "2-2", "2-3"]
    assert names_of(["3.7", "figure-2-7"]) == ["2-7", "3-7"]
    with pytest.raises(ValueError, match=r"no figure '2-6' .*, '9'; there are 1-2, 2-2"):
        names_of(["2-6", "2-7", "9"])


def test_command(tmp_path, capsys):
    assert run("thesis", "table-1", "--out", str(tmp_path / "t"), "--quiet") == 0
    assert capsys.readouterr().out == f"{tmp_path / 't' / 'index.html'}\n"
    assert "no figure '2-1'" in refused(capsys, "thesis", "2-1", "--out", str(tmp_path))
