"""The explorer in headless Chromium, the network blocked: what is shown is what the atlas answers; no error is told."""

import contextlib
import io
import shlex

import numpy as np
import pytest
from commands import run
from explored import AXES, at_rest, browser, missing_browser, small_atlas, until

import freesweep as fs
from freesweep.explorer import table
from freesweep.sweep.spec import parse

if reason := missing_browser():
    pytest.skip(reason, allow_module_level=True)

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

PIN = {"alpha": 30.0, "beta": -50.0, "radius": 5e-3}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    with small_atlas(tmp_path_factory.mktemp("explored")) as made:
        yield made


@pytest.fixture(scope="module")
def driver(tmp_path_factory):
    made = browser(tmp_path_factory.mktemp("profile"))
    yield made
    made.quit()


@pytest.fixture(scope="module")
def explorer(atlas):
    with fs.explore(atlas) as made:
        yield made


@pytest.fixture
def page(driver, explorer):
    driver.get("about:blank")
    driver.get(explorer.url + "#u=1&at=pressure:100000,radius:0.005")
    at_rest(driver)
    yield driver
    at_rest(driver)
    assert [one for one in driver.get_log("browser") if one["level"] in ("SEVERE", "WARNING")] == []
    reached = driver.execute_script("return performance.getEntriesByType('resource').map(one => one.name)")
    assert {one.partition("?")[0] for one in reached if not one.startswith(("data:", "blob:"))} <= {
        explorer.url + "ask"
    }


def change(driver, patch):
    driver.execute_script(f"freesweep.change({patch})")
    at_rest(driver)


def on_map(driver, alpha, beta):
    """Pixels of the map's element, from its middle, of a place."""
    x, y = driver.execute_script(
        """const { map } = freesweep.models, view = freesweep.viewOf(map), frame = view.frame;
        return [frame.x_scale.compute(arguments[0]), frame.y_scale.compute(arguments[1])];""",
        alpha, beta,
    )  # fmt: skip
    size = driver.find_element(By.ID, "map_place").size
    return round(x - size["width"] / 2), round(y - size["height"] / 2)


def put_pin(driver):
    driver.execute_script(f"freesweep.pin({{...freesweep.state.at, alpha: {PIN['alpha']}, beta: {PIN['beta']}}})")
    at_rest(driver)


def test_the_table_of_pins_fades_where_there_is_more_of_it(page):
    put_pin(page)
    pins = "document.getElementById('pins')"
    assert page.execute_script(f"return {pins}.scrollWidth > {pins}.clientWidth && {pins}.classList.contains('more')")
    page.execute_script(f"{pins}.scrollLeft = {pins}.scrollWidth")
    until(page, f"!{pins}.classList.contains('more')")


def test_hovering_and_clicking_tell_what_a_query_answers(page, atlas):
    place = page.find_element(By.ID, "map_place")
    ActionChains(page).move_to_element_with_offset(place, *on_map(page, 35.0, -55.0)).perform()
    until(page, "!document.getElementById('tip').hidden && freesweep.isIdle(false)")
    words = page.find_element(By.ID, "tip").text.replace("\N{MINUS SIGN}", "-")
    number, _, rest = words.partition("°")
    alpha, beta = (float(part.strip("°").split()[1]) for part in words.splitlines()[1].split(", "))
    true = atlas.query(["rotation"], alpha=alpha, beta=beta, radius=5e-3, pressure=1e5)
    assert abs(alpha - 35.0) < 1.0
    assert abs(beta + 55.0) < 1.0
    assert float(number) == pytest.approx(float(true["rotation"]), rel=2e-3)
    assert "±" in rest
    ActionChains(page).move_to_element_with_offset(place, *on_map(page, 30.0, -50.0)).click().perform()
    until(page, "freesweep.state.pins.length === 1")
    at_rest(page)
    pin = page.execute_script("return freesweep.state.pins[0]")
    true = atlas.query(["rotation", "deformed_length"], **pin, pressure=1e5)
    cell = page.find_element(By.CSS_SELECTOR, '#pins td[data-measure="rotation"]').text
    assert float(cell.split()[0].replace("\N{MINUS SIGN}", "-")) == pytest.approx(float(true["rotation"]), rel=1e-3)
    assert page.execute_script("return freesweep.pinned.pins[0].measures.deformed_length.value") == pytest.approx(
        float(true["deformed_length"]), rel=1e-12
    )
    curve = page.execute_script(
        "const { nodes, curves } = freesweep.pinned; return [[...nodes], [...curves[0].rotation.value]]"
    )
    line = atlas.query(["rotation"], **pin, pressure=curve[0])["rotation"].values
    both = np.isfinite(line)
    np.testing.assert_allclose(np.array(curve[1], float)[both], line[both], rtol=1e-9, atol=1e-9)


def test_a_map_without_any_value_says_so(page):
    """Of tubes that have no limit pressure; without a bar of colours that stand for nothing."""
    title = page.find_element(By.ID, "map_title")
    change(page, "{m: 'limit_pressure'}")
    assert title.text == "Limit pressure [kPa] no value on this map"
    assert page.execute_script("return freesweep.models.map_bar.major_label_text_alpha") == 0
    change(page, "{m: 'rotation'}")
    assert title.text == "Rotation [°]"
    assert page.execute_script("return freesweep.models.map_bar.major_label_text_alpha") == 1


def test_names_of_regions_stay_on_the_map(page):
    places = page.execute_script("const { x, y } = freesweep.models.map_labels.data; return [[...x], [...y]]")
    for name, found in zip(("alpha", "beta"), places):
        assert AXES[name][0] < min(found) < max(found) < AXES[name][-1]


def test_maps_follow_a_dragged_slider_between_the_nodes(page, atlas):
    put_pin(page)
    page.execute_script("freesweep.frames.length = 0")
    slider = page.find_element(By.CSS_SELECTOR, '[data-axis="pressure"] input[type="range"]')
    drag = ActionChains(page, duration=15).move_to_element_with_offset(slider, 0, 0).click_and_hold()
    for _ in range(24):
        drag.move_by_offset(2, 0)
    drag.perform()
    frames = page.execute_script("return [...freesweep.frames]")
    ActionChains(page).release().perform()
    at_rest(page)
    assert len(frames) >= 3  # how many a second is a matter of the machine
    pressure, nx, ny = page.execute_script("return [freesweep.grid.at.pressure, freesweep.grid.nx, freesweep.grid.ny]")
    assert pressure == page.execute_script("return freesweep.state.at.pressure")
    assert np.abs(atlas.data["pressure"].values - pressure).min() > 1.0  # no node
    shown = page.execute_script("return Array.from(freesweep.grid.values.rotation)")
    alpha, beta = np.meshgrid(np.linspace(0, 80, nx), np.linspace(-80, 60, ny))
    true = atlas.query(["rotation"], alpha=alpha.ravel(), beta=beta.ravel(), radius=5e-3, pressure=pressure)
    both = np.isfinite(true["rotation"].values)
    np.testing.assert_allclose(np.array(shown, float)[both], true["rotation"].values[both], rtol=1e-6, atol=1e-6)


def test_brushed_wishes_light_up_the_designs_that_do_it(page, atlas):
    change(page, "{wishes: [{measure: 'rotation', low: null, high: null}]}")
    strip = page.find_element(By.CSS_SELECTOR, "#wishes svg")
    brush = ActionChains(page, duration=20).move_to_element_with_offset(strip, 20, 0).click_and_hold()
    brush.move_by_offset(20, 0).move_by_offset(30, 0).release().perform()
    at_rest(page)
    (wish,) = page.execute_script("return freesweep.state.wishes")
    assert wish["low"] < wish["high"]
    change(page, f"{{taut: true, wishes: [{{measure: 'rotation', low: {wish['low']}, high: {wish['high']}}},"
                 " {measure: 'length_change', low: -0.05, high: 0.02}]}")  # fmt: skip
    nx, ny, lit = page.execute_script(
        "return [freesweep.grid.nx, freesweep.grid.ny, Array.from(freesweep.margins(freesweep.grid), one => one >= 0)]"
    )
    alpha, beta = np.meshgrid(np.linspace(0, 80, nx), np.linspace(-80, 60, ny))
    places = {"alpha": alpha.ravel(), "beta": beta.ravel(), "radius": 5e-3, "pressure": 1e5}
    turn, length = (atlas.query([name], **places) for name in ("rotation", "deformed_length"))
    both = np.isfinite(turn["rotation"].values) & np.isfinite(length["deformed_length"].values)
    change_of_length = length["deformed_length"].values / 0.1 - 1.0
    meets = (turn["rotation"].values >= wish["low"]) & (turn["rotation"].values <= wish["high"])
    meets &= (change_of_length >= -0.05) & (change_of_length <= 0.02) & (turn["slack_fiber"].values == 0)
    assert 0 < meets[both].sum() < both.sum()
    assert (np.array(lit)[both] != meets[both]).sum() <= 2  # the ends of ranges travel in single precision
    front = page.find_element(By.CSS_SELECTOR, "#panel_front .figure")
    box = ActionChains(page, duration=30).move_to_element_with_offset(front, -30, -30).click_and_hold()
    box.move_by_offset(30, 30).move_by_offset(40, 30).release().perform()
    until(
        page, "freesweep.state.wishes.some(one => one.measure === 'rotation' && one.low !== " + repr(wish["low"]) + ")"
    )
    assert {one["measure"] for one in page.execute_script("return freesweep.state.wishes")} == {
        "rotation",
        "length_change",
    }


def test_pinned_designs_leave_as_python_shell_toml_and_csv(page, capsys):
    put_pin(page)
    text = {
        kind: page.execute_script(f"return freesweep.exports.{kind}[0]()")
        for kind in ("python", "shell", "toml", "csv")
    }
    names = {}
    exec(text["python"].replace("states =", "later = lambda:"), names)
    tube = fs.Actuator(**PIN, length=0.1, wall=1.59e-3, material=fs.MooneyRivlin(0.17e6, 0.08e6))
    assert names["tubes"] == [tube]
    sweep = parse(text["toml"])
    assert sweep.designs["names"] == ("pin 1",)
    assert {name: column[0] for name, column in sweep.designs["columns"].items()} == PIN
    assert (sweep.fixed["length"], sweep.fixed["wall"], sweep.fixed["c10"]) == (0.1, 1.59e-3, 0.17e6)
    with contextlib.redirect_stdout(io.StringIO()):
        assert run(*shlex.split(text["shell"])[1:]) == 0
    head, line = text["csv"].splitlines()
    row = dict(zip(head.split(","), line.split(",")))
    assert float(row["radius [mm]"]) == 5.0
    assert float(row["pressure [kPa]"]) == 100.0
    told = page.execute_script("return freesweep.pinned.pins[0].measures.rotation.value")
    assert float(row["rotation [degree]"]) == pytest.approx(told, rel=1e-11)
    for kind, begin in (("png", b"\x89PNG"), ("svg", b"<svg")):
        content = page.execute_async_script(
            "const [panel, kind, done] = arguments; freesweep.pictureOf(panel, kind).then(async blob => done([...new"
            " Uint8Array(await blob.arrayBuffer())]))", "map", kind,
        )  # fmt: skip
        assert bytes(content[:2000]).lstrip()[: len(begin)] == begin
        assert len(content) > 5000


def test_what_leaves_is_the_design_that_is_shown_to_the_last_digit(page):
    change(page, "{pins: [{alpha: 100 / 3, beta: -50 - 1e-14, radius: 0.001 * Math.sqrt(20)}]}")
    names = {}
    exec(page.execute_script("return freesweep.exports.python[0]()").replace("states =", "later = lambda:"), names)
    (pin,) = page.execute_script("return freesweep.state.pins")
    assert {name: getattr(names["tubes"][0], name) for name in pin} == pin
    assert pin["beta"] == -50.0


def test_keys_units_and_a_link_that_restores_the_view(page, explorer):
    place = page.find_element(By.ID, "map_place")
    place.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_DOWN, Keys.ENTER)
    at_rest(page)
    (pin,) = page.execute_script("return freesweep.state.pins")
    assert pin["alpha"] == pytest.approx(40.0 + 80.0 / 170.0)
    page.find_element(By.TAG_NAME, "body").send_keys("u")
    field = page.find_element(By.CSS_SELECTOR, '[data-axis="radius"] input[type="text"]')
    assert float(field.get_attribute("value")) == pytest.approx(5.0 / 25.4, rel=1e-3)
    field.clear()
    field.send_keys("4.5 mm", Keys.ENTER)
    at_rest(page)
    assert page.execute_script("return freesweep.state.at.radius") == pytest.approx(4.5e-3, rel=1e-12)
    page.find_element(By.TAG_NAME, "body").send_keys("d")
    change(
        page,
        "{m: 'volume', x: 'radius', y: 'alpha', wishes: [{measure: 'rotation', low: 1.5, high: null}], taut: true}",
    )
    before = page.execute_script("return JSON.stringify(freesweep.state)")
    link = page.execute_script("return location.hash")
    page.get("about:blank")
    page.get(explorer.url + link)
    at_rest(page)
    assert page.execute_script("return JSON.stringify(freesweep.state)") == before
    assert page.execute_script("return [freesweep.grid.x, freesweep.grid.y, freesweep.grid.measure]") == [
        "radius",
        "alpha",
        "volume",
    ]
    change(page, "{dark: false, x: 'alpha', y: 'beta'}")


def test_one_file_shows_the_same_without_a_server(driver, atlas, tmp_path, monkeypatch):
    monkeypatch.setattr(table, "SAMPLE", 4000)
    path = fs.explore(atlas, html=tmp_path / "page.html")
    driver.get("about:blank")
    driver.get(path.as_uri() + "#u=1&at=pressure:71000,radius:0.0046&pins=alpha:30,beta:-50,radius:0.0046")
    at_rest(driver)  # questions that came while the table was unpacked waited for it
    assert driver.find_element(By.ID, "said").text == ""
    told = driver.execute_script("return freesweep.pinned.pins[0].measures.rotation")
    true = float(atlas.query(["rotation"], **(PIN | {"radius": 4.6e-3}), pressure=7.1e4)["rotation"])
    assert abs(told["value"] - true) <= max(told["error"], 0.01 * abs(true))
    nx, ny, shown = driver.execute_script(
        "return [freesweep.grid.nx, freesweep.grid.ny, [...freesweep.grid.values.rotation]]"
    )
    alpha, beta = np.meshgrid(np.linspace(0, 80, nx), np.linspace(-80, 60, ny))
    places = {"alpha": alpha.ravel(), "beta": beta.ravel(), "radius": 4.6e-3, "pressure": 7.1e4}
    true = atlas.query(["rotation"], **places)["rotation"].values
    shown = np.array([np.nan if one is None else one for one in shown], float)
    both = np.isfinite(shown) & np.isfinite(true)
    assert both.sum() > 500
    assert np.quantile(np.abs(shown - true)[both] / np.maximum(np.abs(true[both]), 1.0), 0.9) < 0.05
    change(driver, "{cloud: 'all', wishes: [{measure: 'rotation', low: 10, high: 90}]}")
    assert driver.execute_script("return freesweep.cloud.values.rotation.length") == 6000
    assert not driver.find_element(By.ID, "polish").is_displayed()
    assert [one for one in driver.get_log("browser") if one["level"] in ("SEVERE", "WARNING")] == []
    assert driver.execute_script("return performance.getEntriesByType('resource').length") == 0
