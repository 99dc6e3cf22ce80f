"""Opens the pages of a study, a fit, a trace and a prediction in headless Chromium and uses them.

    python tests/browser/check.py STUDY FOLDER

STUDY is the program. Results and screenshots go to FOLDER: every page at the width of a phone and of a laptop, light and
dark, and as it is printed. Fails with one line for whatever is wrong: an error on the console, a page wider than the
screen, a serious finding of axe-core, a table that does not sort, a switch that hides nothing, values that are not told, a
page of a trace whose first figure is far down, a part that does not open, a wide table that does not say so.
"""

import base64
import pathlib
import shutil
import subprocess
import sys
import tempfile

from axe_core_python.selenium import Axe
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WIDTHS = {"phone": (390, 844), "laptop": (1366, 768)}
OPTIONS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--no-first-run",
]


def pages(study: str, folder: pathlib.Path) -> dict[str, pathlib.Path]:
    """Makes one page of every kind."""
    records = ROOT / "scenarios/records"
    commands = {
        "study": [ROOT / "scenarios/yukun.toml"],
        "fit": ["fit", records / "first-order.csv"],
        "trace": ["trace", records / "undeclared-damping.csv"],
        "predict": ["predict", folder / "trace/trace.json"],
    }
    for name, command in commands.items():
        told = subprocess.run(
            [study, *map(str, command), "--out", str(folder / name), "--quiet"], capture_output=True, text=True
        )
        if told.returncode:
            sys.exit(f"{name}: {told.stderr}")
    return {name: folder / name / "report.html" for name in commands}


def browser(profile: str) -> webdriver.Chrome:
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for option in [*OPTIONS, f"--user-data-dir={profile}"]:
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    # All parts open, a page is long, and a busy machine slow.
    driver.set_script_timeout(120)
    return driver


def look(driver: webdriver.Chrome, size: tuple[int, int], scheme: str) -> None:
    width, height = size
    driver.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False},
    )
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})


def begins(driver: webdriver.Chrome) -> str | None:
    """The first figure of a trace begins on the first screen, and every part is closed."""
    top = driver.execute_script("return document.querySelector('main figure').getBoundingClientRect().top / innerHeight")
    if top > 1.0:
        return f"the first figure is {top:.1f} screens down"
    return "a part is open" if driver.find_elements(By.CSS_SELECTOR, "main details[open]") else None


def unfolds(driver: webdriver.Chrome) -> str | None:
    """Opens one part with a key and the others; what is wider than the screen says so."""
    parts = driver.find_elements(By.CSS_SELECTOR, "main details > summary")
    if parts:
        parts[0].send_keys(Keys.ENTER)
        if not driver.find_elements(By.CSS_SELECTOR, "main details[open]"):
            return "a part does not open"
    driver.execute_script("for (const part of document.querySelectorAll('details')) part.open = true")
    wide = """return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(
        [...document.querySelectorAll('.table, .plot')].filter(
            box => box.scrollWidth > box.clientWidth + 1 && !box.classList.contains('wide')).length))))"""
    return "something wide does not say so" if driver.execute_script(wide) else None


def sorts(driver: webdriver.Chrome) -> str | None:
    """Sorts the first table by its second column, which has numbers, both ways."""
    tables = [one for one in driver.find_elements(By.TAG_NAME, "table") if one.find_elements(By.TAG_NAME, "button")]
    if not tables:
        return "no table can be sorted"
    head = tables[0].find_elements(By.CSS_SELECTOR, "thead th")[1]
    cells = lambda: [row.text for row in tables[0].find_elements(By.CSS_SELECTOR, "tbody tr > :nth-child(2)")]
    before = cells()
    head.find_element(By.TAG_NAME, "button").send_keys(Keys.ENTER)
    up, said = cells(), head.get_attribute("aria-sort")
    head.find_element(By.TAG_NAME, "button").send_keys(Keys.SPACE)
    down = cells()
    if said != "ascending" or head.get_attribute("aria-sort") != "descending":
        return f"a sorted column is not told: {said}"
    return None if sorted(before) == sorted(up) and (up != down or len(set(up)) == 1) else "a table does not sort"


def answers(driver: webdriver.Chrome) -> str | None:
    """Hides a curve and shows it again, reads a value with the keys, zooms and goes back."""
    switches = driver.find_elements(By.CSS_SELECTOR, ".keys button[aria-pressed]")
    if not switches:
        return "no figure has switches"
    hidden = lambda: len(driver.find_elements(By.CSS_SELECTOR, ".hidden"))
    switches[0].send_keys(Keys.SPACE)
    if not hidden() or switches[0].get_attribute("aria-pressed") != "false":
        return "a switch hides nothing"
    switches[0].send_keys(Keys.SPACE)
    if hidden():
        return "a switch does not show again what it hid"
    keys = switches[0].find_element(By.XPATH, "..")
    figure = keys.find_element(By.XPATH, "ancestor::figure")
    value, plot = (figure.find_element(By.CSS_SELECTOR, one) for one in [".value", ".plot"])
    plot.send_keys(Keys.ARROW_RIGHT)
    first = value.text
    plot.send_keys(Keys.ARROW_RIGHT)
    if ":" not in first or value.text == first:
        return f"arrow keys read no values: {first!r}, then {value.text!r}"
    view = lambda: figure.find_element(By.TAG_NAME, "svg").get_dom_attribute("viewBox")
    whole = view()
    near, back = keys.find_elements(By.CSS_SELECTOR, "button:not([aria-pressed])")
    near.click()
    if view() == whole:
        return "a figure does not zoom"
    back.click()
    return None if view() == whole else "a figure does not come back from zoom"


def main() -> None:
    study, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    made = pages(study, folder)
    wrong = []
    with tempfile.TemporaryDirectory() as profile:
        driver = browser(profile)
        try:
            for name, page in made.items():
                if page.stat().st_size >= 2_000_000:
                    wrong.append(f"{name}: {page.stat().st_size} bytes")
                for width, size in WIDTHS.items():
                    for scheme in ["light", "dark"]:
                        look(driver, size, scheme)
                        driver.get(page.as_uri())
                        place = f"{name}, {width}, {scheme}"
                        driver.save_screenshot(str(folder / f"{name}-{width}-{scheme}.png"))
                        late = begins(driver) if name == "trace" else None
                        faults = [late, unfolds(driver)]
                        wrong += [f"{place}: {fault}" for fault in faults if fault]
                        if driver.execute_script("return document.documentElement.scrollWidth > innerWidth"):
                            wrong.append(f"{place}: wider than the screen")
                        # What it looks for depends on the width and the colours alone, one at a time.
                        if (width, scheme) not in [("laptop", "light"), ("phone", "dark")]:
                            continue
                        found = Axe().run(driver)["violations"]
                        wrong += [
                            f"{place}: {one['id']}: {one['help']}, {one['nodes'][0]['html'][:200]}"
                            for one in found
                            if one["impact"] in ("serious", "critical")
                        ]
                # A prediction compares no methods: its figures have no switches.
                faults = [sorts(driver), None if name == "predict" else answers(driver)]
                wrong += [f"{name}: {fault}" for fault in faults if fault]
                wrong += [f"{name}: console: {line['message']}" for line in driver.get_log("browser")]
                printed = driver.execute_cdp_cmd("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})
                (folder / f"{name}.pdf").write_bytes(base64.b64decode(printed["data"]))
        finally:
            driver.quit()
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(made)} pages at {len(WIDTHS)} widths, light and dark, and printed; screenshots in {folder}")


main()
