"""What the explorer answers, without a browser: the numbers of a query, wishes as goals, one harmless page."""

import json
import re
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request

import numpy as np
import pytest
from commands import refused, run
from explored import AT, small_atlas
from grids import CHILD_ENVIRONMENT, SMALL, swept

import freesweep as fs
from freesweep.cli import ENVIRONMENT
from freesweep.explorer import table
from freesweep.explorer.desk import AskError, Desk, even
from freesweep.explorer.exact import shape, solved, tube_of
from freesweep.explorer.measures import COARSE_STATUS, system_units
from freesweep.explorer.polish import goals_of
from freesweep.explorer.wire import pack
from freesweep.inverse.outputs import output
from freesweep.query.family import FAMILY_OF
from freesweep.status import NOT_INTERPOLABLE, VALUED

pytest.importorskip("bokeh", reason="the explorer draws with Bokeh")
KINDS = {"float32": np.float32, "float64": np.float64, "uint8": np.uint8}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    with small_atlas(tmp_path_factory.mktemp("explored")) as made:
        yield made


@pytest.fixture(scope="module")
def desk(atlas):
    return Desk(atlas)


def unpacked(content):
    """What the page makes of an answer."""
    size = int.from_bytes(content[:4], "little")

    def walk(value):
        if isinstance(value, list):
            return [walk(one) for one in value]
        if not isinstance(value, dict):
            return value
        if "array" in value:
            return np.frombuffer(content, KINDS[value["array"]], value["length"], 4 + size + value["at"])
        return {key: walk(one) for key, one in value.items()}

    return walk(json.loads(content[4 : 4 + size]))


def asked(desk, **question):
    return unpacked(pack(desk.answer({"at": AT, **question})))


def test_a_map_shows_what_a_query_answers_between_the_nodes(atlas):
    atlas = fs.Atlas(atlas.data.assign_attrs(interpolation_tolerance=1e-5), atlas.path)  # too coarse for that in places
    desk = Desk(atlas)
    found = asked(desk, what="grid", x="alpha", y="beta", nx=33, ny=29, measures=["rotation", "length_change"])
    alpha, beta = np.meshgrid(np.linspace(0, 80, 33), np.linspace(-80, 60, 29))
    loads = {"radius": AT["radius"], "pressure": AT["pressure"]}
    for measure, variable in (("rotation", "rotation"), ("length_change", "deformed_length")):
        told = atlas.query([variable], alpha=alpha.ravel(), beta=beta.ravel(), **loads)
        true = told[variable].values / (1.0 if measure == "rotation" else 0.1) - (measure != "rotation")
        both = np.isfinite(true)
        assert 100 < both.sum() < len(true)
        np.testing.assert_allclose(found["values"][measure][both], true[both], rtol=1e-6, atol=1e-7)
        if measure == "rotation":
            given = np.isin(found["status"], (*VALUED, COARSE_STATUS))
            np.testing.assert_array_equal(given, np.isfinite(found["values"][measure]))
            refused_by_both = ~given & ~np.isin(found["status"], NOT_INTERPOLABLE)
            np.testing.assert_array_equal(found["status"][refused_by_both], told["status"].values[refused_by_both])
            assert given.sum() > both.sum()  # coarse places are shown, and marked
            assert np.all(given[both])


def test_one_measure_hides_no_other(desk):
    alone = asked(desk, what="grid", x="alpha", y="beta", nx=17, ny=17, measures=["rotation"])
    among = asked(desk, what="grid", x="alpha", y="beta", nx=17, ny=17, measures=["rotation", "strain_energy"])
    np.testing.assert_array_equal(alone["values"]["rotation"], among["values"]["rotation"])
    np.testing.assert_array_equal(alone["status"], among["status"])


def test_a_point_tells_value_error_and_status(atlas, desk):
    found = asked(desk, what="point", measures=["rotation", "outer_radius", "limit_pressure"])["measures"]
    told = atlas.query(["rotation", "mid_radius"], **AT)
    assert found["rotation"]["value"] == pytest.approx(float(told["rotation"]), rel=1e-12)
    assert found["rotation"]["error"] == pytest.approx(float(told["rotation_error"]), rel=1e-9)
    wide = {name: told[name].values for name in ("mid_radius", "mid_radius_error")}
    design = AT | {"wall": 1.59e-3, "fiber_extension": 1.0, "fiber_radius": AT["radius"]}
    assert found["outer_radius"]["value"] == pytest.approx(float(output("outer_radius", "free", wide, design)[0]))
    on_the_line = asked(desk, what="point", at=AT | {"beta": AT["alpha"]}, measures=["rotation"])["measures"][
        "rotation"
    ]
    assert on_the_line == {"value": None, "error": None, "status": 1}


def test_curves_of_pinned_designs_are_those_of_the_atlas(atlas, desk):
    pins = [{"alpha": 33.0, "beta": -47.0, "radius": 4.6e-3}, {"alpha": 20.0, "beta": -60.0, "radius": 5e-3}]
    found = asked(desk, what="pins", pins=pins, measures=["rotation"], curves=["rotation"], n=21)
    for pin, curve, told in zip(pins, found["curves"], found["pins"]):
        line = atlas.query(["rotation"], **pin, pressure=found["nodes"])
        both = np.isfinite(line["rotation"].values)
        assert both.sum() > 10
        np.testing.assert_allclose(
            curve["rotation"]["value"][both], line["rotation"].values[both], rtol=1e-9, atol=1e-9
        )
        assert told["measures"]["rotation"]["value"] == pytest.approx(
            float(atlas.query(["rotation"], **pin, pressure=AT["pressure"])["rotation"])
        )


def test_clouds_cover_all_axes_of_design_evenly(atlas, desk):
    found = asked(desk, what="cloud", n=512, measures=["rotation"])
    assert set(found["designs"]) == {"alpha", "beta", "radius"}
    told = atlas.query(["rotation"], **found["designs"], pressure=np.full(512, AT["pressure"]))["rotation"].values
    both = np.isfinite(told)
    assert both.sum() > 30
    np.testing.assert_allclose(found["values"]["rotation"][both], told[both], rtol=1e-6, atol=1e-6)
    counts, _ = np.histogramdd(even(4096, 3), bins=4, range=[(0, 1)] * 3)
    assert counts.min() > 45
    assert counts.max() < 83  # 64 on the average


def test_questions_with_faults_are_refused_with_the_reason(desk):
    grid = {"what": "grid", "x": "alpha", "y": "beta", "nx": 3, "ny": 3, "at": AT, "measures": ["rotation"]}
    for change, words in (
        ({"what": "code"}, "known: grid, point"), ({"x": "colour"}, "no axis of this atlas"), ({"nx": 10**6}, "give 1 to"),
        ({"nx": 2000, "ny": 2000}, "at most 400,000"), ({"measures": ["taste"]}, "unknown measures"),
        ({"at": AT | {"radius": "1"}}, "finite number"), ({"at": []}, "lacks"), ({"measures": []}, "known"),
    ):  # fmt: skip
        with pytest.raises(AskError, match=words):
            desk.answer(grid | change)
    with pytest.raises(AskError, match="unknown question"):
        desk.answer([])


def test_an_atlas_of_one_axis_is_no_map(tmp_path):
    with swept(tmp_path, SMALL) as atlas, pytest.raises(AskError, match=r"two axes of numbers or more; .*pressure"):
        Desk(atlas)


def test_units_are_those_of_the_table_of_units():
    inch, psi = dict(system_units("m"))["in"], dict(system_units("Pa"))["psi"]
    assert inch * 0.0254 == pytest.approx(1.0, rel=1e-15)
    assert psi * 6894.757293168361 == pytest.approx(1.0, rel=1e-15)
    assert [name for name, _ in system_units("N m")] == ["N m", "mN m", "lbf in"]
    assert dict(system_units("J"))["mJ"] == 1e3


def test_wishes_are_goals_in_the_state_of_the_sliders(desk):
    tube, loads = tube_of(desk, AT), {"pressure": 7.1e4, "force": 0.0, "torque": 0.0}
    sizes = {"length": 0.1, "radius": 4.6e-3, "wall": 1.59e-3}
    assert tube == fs.Actuator(alpha=33.0, beta=-47.0, **sizes, material=fs.MooneyRivlin(0.17e6, 0.08e6))
    wishes = [
        {"measure": "rotation", "low": 80.0, "high": 100.0}, {"measure": "length_change", "low": -0.03, "high": 0.02},
        {"measure": "outer_radius", "low": None, "high": 7.5e-3}, {"measure": "locked_rotation", "low": 5.0, "high": None},
        {"measure": "blocked_force", "low": 1.0, "high": None}, {"measure": "volume", "low": None, "high": None},
    ]  # fmt: skip
    made = [goal.wishes([])[0] for goal in goals_of(wishes, tube, loads)]
    assert [(one.output, one.low, one.high) for one in made] == [
        ("rotation", 80.0, 100.0), ("stroke", -0.02, 0.03),
        ("outer_radius", -np.inf, 7.5e-3), ("rotation", 5.0, np.inf), ("force", 1.0, np.inf),
    ]  # fmt: skip
    assert [dict(one.conditions)["pressure"] for one in made] == [7.1e4, 7.1e4, 7.1e4, np.inf, 7.1e4]
    with pytest.raises(AskError, match="ideal_blocked_force: no output that designs are looked for by"):
        goals_of([{"measure": "ideal_blocked_force", "low": 1.0, "high": None}], tube, loads)
    with pytest.raises(AskError, match="no wish has a range"):
        goals_of(wishes[-1:], tube, loads)


def test_pinned_designs_are_solved_to_what_the_atlas_states(atlas, desk):
    told, found = atlas.query(["rotation"], **AT), unpacked(pack(solved(desk, {"at": AT})))["measures"]
    assert abs(found["rotation"]["value"] - float(told["rotation"])) <= float(told["rotation_error"])
    force = float(fs.blocked_force(tube_of(desk, AT), AT["pressure"])["force"])
    assert found["blocked_force"]["value"] == pytest.approx(force, rel=1e-6)
    drawn = unpacked(pack(shape(desk, {"at": AT})))
    assert drawn["status"] == ""
    ends = drawn["state"]["radius"][[0, -1]]
    assert ends == pytest.approx([4.6, 4.6], rel=1e-9)  # [mm], clamped
    assert np.degrees(drawn["state"]["twist"][-1]) == pytest.approx(found["rotation"]["value"], rel=1e-6)
    assert drawn["rest"]["position"][-1] == pytest.approx(100.0)


def test_the_smaller_table_keeps_to_the_deviation_it_states(desk, monkeypatch):
    monkeypatch.setattr(table, "SAMPLE", 4000)
    made = table.small_table(desk)
    axes, own = made["axes"], made["tables"]["rotation"]
    assert [axes[name]["kind"] for name in ("alpha", "radius", "pressure")] == ["linear", "log", "sqrt"]
    numbers = table.decoded(own["values"], [len(axes[name]["nodes"]) for name in own["axes"]])
    rng = np.random.default_rng(7)
    places = {name: rng.uniform(*desk.reader.frame.ranges[name], 500) for name in axes}
    read = table.read(axes, own["axes"], numbers, places) * table.size_of(own["scale"], places)
    true = desk.atlas.query(["rotation"], **places)["rotation"].values
    both = np.isfinite(read) & np.isfinite(true)
    assert both.sum() > 50
    far = np.abs(read - true)[both] / np.maximum(np.abs(true[both]), 0.1)
    assert np.quantile(far, 0.9) <= max(own["deviation"])
    at_nodes = {name: np.array([float(axes[name]["nodes"][2])]) for name in axes}
    value = table.read(axes, own["axes"], numbers, at_nodes) * table.size_of(own["scale"], at_nodes)
    assert value == pytest.approx(
        float(desk.atlas.query(["rotation"], **{k: v[0] for k, v in at_nodes.items()})["rotation"]), rel=1e-4
    )


def test_what_a_page_holds_is_made_step_by_step(desk, monkeypatch):
    monkeypatch.setattr(table, "SAMPLE", 500)
    told = []
    table.small_table(Desk(desk.atlas), lambda: told.append(0))
    assert len(told) == table.steps(desk)


def test_the_first_view_is_read_while_the_browser_opens(desk):
    own = Desk(desk.atlas)
    own.begin()
    assert own._made == {one.source for one in own.measures.values() if one.source in FAMILY_OF}


def test_large_axes_are_thinned_between_their_ends():
    axes = {"alpha": np.linspace(0, 85, 35), "beta": np.linspace(-85, 85, 69), "pressure": np.linspace(0, 1, 400)}
    kept = table.thinned(axes)
    assert np.prod([len(nodes) for nodes in kept.values()]) <= table.NODES
    assert len(kept["beta"]) == 69
    assert all(kept[name][[0, -1]].tolist() == axes[name][[0, -1]].tolist() for name in axes)


def test_the_server_answers_its_own_page_alone(atlas):
    with fs.explore(atlas) as explorer:
        page = urllib.request.urlopen(explorer.url).read().decode()
        assert explorer.server_address[0] == "127.0.0.1"
        assert explorer.url in explorer._repr_html_()
        token = re.search(r'"token": "([^"]+)"', page).group(1)
        body = json.dumps({"what": "point", "at": AT, "measures": ["rotation"]}).encode()

        def post(body=body, path="ask", **headers):
            return urllib.request.urlopen(urllib.request.Request(explorer.url + path, body, headers)).read()

        value = unpacked(post(**{"X-Freesweep": token}))["measures"]["rotation"]["value"]
        assert value == pytest.approx(float(atlas.query(["rotation"], **AT)["rotation"]))
        for wrong in (
            {}, {"X-Freesweep": "guess"}, {"X-Freesweep": token, "Host": "elsewhere.example"},
            {"X-Freesweep": token, "path": "other"}, {"X-Freesweep": token, "body": b"[]"},
            {"X-Freesweep": token, "body": b"{"},
        ):  # fmt: skip
            with pytest.raises(urllib.error.HTTPError, match=r"40[03]"):
                post(**wrong)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(explorer.url, timeout=1)


def test_a_page_that_is_closed_before_its_answer_comes_says_nothing_in_the_terminal(atlas, capsys):
    with fs.explore(atlas) as explorer:
        for error in (BrokenPipeError(), ValueError("a fault")):
            try:
                raise error
            except Exception:
                explorer.handle_error(None, ("127.0.0.1", 1))
            assert ("Traceback" in capsys.readouterr().err) == isinstance(error, ValueError)


def test_a_page_that_waits_hears_how_long_the_compiler_has_been_at_work(atlas):
    from numba import njit

    with fs.explore(atlas) as explorer:
        assert explorer.ask({"what": "busy"}) == {"compiling": None}
        heard = []

        @njit
        def plain(x):
            return x + 1

        def listening(*args, compiled=plain._compiler.compile):
            heard.append(explorer.ask({"what": "busy"})["compiling"])
            return compiled(*args)

        plain._compiler.compile = listening
        plain(1)
        assert heard[0] >= 0.0


def test_the_page_loads_nothing_and_no_title_ends_its_script(atlas, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(table, "SAMPLE", 4000)
    assert run("explore", str(atlas.path), "--html", str(tmp_path / "page.html")) == 0
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<b>small</b>" not in page
    assert r"Tubes \u003c/script>" in page
    assert not re.findall(r"<(?:script|link|img|iframe)[^>]*(?:src|href)=[\"'](?!data:)", page)
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page).group(1)
    assert "default-src 'none'" in policy
    assert "connect-src" not in policy
    assert capsys.readouterr().out == f"{tmp_path / 'page.html'}\n"


def test_the_command_serves_until_it_is_interrupted(atlas):
    words = [sys.executable, "-m", "freesweep", "explore", str(atlas.path), "--no-browser"]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=CHILD_ENVIRONMENT
    ) as child:
        address = child.stdout.readline().split()[0]
        assert b"freesweep" in urllib.request.urlopen(address).read()
        child.send_signal(signal.SIGINT)
        assert child.wait(20) == 0
        assert child.stderr.read() == ""


def test_faults_of_the_command_are_told(atlas, tmp_path, capsys):
    assert "the suffix must be .html" in refused(capsys, "explore", str(atlas.path), "--html", "page.txt")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert run("explore", str(atlas.path), "--no-browser", "--port", str(port)) == ENVIRONMENT
        assert f"port {port} of 127.0.0.1: Address already in use; give another" in capsys.readouterr().err
    assert "give 0 to 65535" in refused(capsys, "explore", str(atlas.path), "--port", "70000")
    assert "no atlas at" in refused(capsys, "explore", str(tmp_path / "none.nc"))
    with pytest.raises(fs.ActuatorError, match=r"give what freesweep\.open_atlas opens"):
        fs.explore(3)
