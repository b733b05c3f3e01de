"""The explorer's picture, in headless Chromium: ``python docs/explorer.py atlases/design-space.nc docs/explorer.png``."""

import sys
import tempfile
import time
from pathlib import Path

from PIL import Image

import freesweep as fs

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))
from explored import at_rest, browser, until

VIEW = (
    "u=1&cloud=all&fx=rotation&fy=length_change&dx=1&dy=1&taut=1&active=2&at=length:0.15,radius:0.005,pressure:100000"
    "&pins=alpha:14,beta:-72,length:0.15,radius:0.005;alpha:84,beta:-24,length:0.15,radius:0.005;"
    "alpha:40,beta:-40,length:0.12,radius:0.0065&wishes=rotation:60:110;length_change:-0.05:0.02;outer_radius::0.0075"
)
POINTER = (17.0, -59.0)  # alpha, beta

atlas, picture = sys.argv[1:]
with fs.explore(fs.open_atlas(atlas)) as explorer, tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
    driver = browser(profile)
    try:
        driver.get(explorer.url + "#" + VIEW)
        at_rest(driver)
        until(driver, "freesweep.isIdle(true)", 300.0)
        time.sleep(1.0)  # shapes are asked for when all else rests
        until(driver, "freesweep.isIdle(true)", 300.0)
        place = """const view = freesweep.viewOf(freesweep.models.map), box = view.el.getBoundingClientRect();
        const { x_scale: x, y_scale: y } = view.frame;
        return [box.x + x.compute(arguments[0]), box.y + y.compute(arguments[1])]"""
        x, y = driver.execute_script(place, *POINTER)
        driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})
        until(driver, "!document.getElementById('tip').hidden")
        driver.save_screenshot(picture)
    finally:
        driver.quit()
Image.open(picture).convert("RGB").save(picture, optimize=True)
