"""A small atlas for the tests of the explorer, and a browser that reaches nothing but this machine."""

import shutil
import time

from grids import spec

from freesweep import run_sweep
from freesweep.sweep.spec import parse

AXES = {
    "alpha": [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0],
    "beta": [-80.0, -70.0, -60.0, -50.0, -40.0, -30.0, -20.0, -10.0, 0.0, 20.0, 40.0, 60.0],
    "radius": [4e-3, 5e-3, 6e-3],
    "pressure": [0.0, 1e3, 4e3, 9e3, 1.6e4, 2.5e4, 3.6e4, 4.9e4, 6.4e4, 8.1e4, 1e5, 1.2e5, 1.45e5, 1.7e5, 2e5, 2.3e5],
}
AT = {"alpha": 33.0, "beta": -47.0, "radius": 4.6e-3, "pressure": 7.1e4}
ARGUMENTS = [
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"),
]
BLOCKED = "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1"


def small_atlas(folder):
    """5184 equilibria of tubes of 0.1 m: enough for an atlas that measures its own error."""
    title = "Tubes </script><b>small</b>"
    return run_sweep(parse(spec(AXES, title=title)), folder / "small.nc", threads=2, progress=False)


def missing_browser():
    """Why there is no browser here, or nothing."""
    try:
        import bokeh  # noqa: F401
        import selenium  # noqa: F401
    except ImportError as error:
        return f"{error.name} is not installed"
    missing = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    return f"{' and '.join(missing)} not here: apt-get install chromium chromium-driver" if missing else ""


def browser(profile, width=1280, height=720):
    """Headless Chromium with a fresh profile."""
    from selenium.webdriver import Chrome
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service

    options = Options()
    options.binary_location = shutil.which("chromium")
    for argument in (*ARGUMENTS, BLOCKED, f"--user-data-dir={profile}", f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = Chrome(options=options, service=Service(shutil.which("chromedriver")))
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    driver.set_script_timeout(60)
    return driver


def until(driver, script, seconds=60.0):
    """Wait until a script is true; raises AssertionError."""
    end = time.monotonic() + seconds
    while not driver.execute_script(f"return Boolean({script})"):
        assert time.monotonic() < end, f"never: {script}; {driver.get_log('browser')}"
        time.sleep(0.02)


def at_rest(driver):
    """Wait until the page has drawn what it was asked for; what the solver is at may take its time."""
    until(driver, "window.freesweep?.ready && freesweep.grid && !freesweep.grid.drag && freesweep.isIdle(false)")
