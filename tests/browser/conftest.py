"""A headless Chromium with WebGL in software and no way to the network.

Skipped where there is no Chromium or no playwright.
"""

import shutil
import sys
from pathlib import Path

import pytest
from browser_cases import VIEW, Visit

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

_NAMES = ("chromium", "chromium-browser", "google-chrome")
_ARGUMENTS = (
    "--no-sandbox",  # containers give no user namespaces
    "--use-gl=angle",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost",
)


@pytest.fixture(scope="session")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    path = next(filter(None, map(shutil.which, _NAMES)), None)
    if path is None:
        pytest.skip("needs Chromium")
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=path, args=list(_ARGUMENTS))
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def visit(browser):
    page = browser.new_page(viewport=VIEW)
    yield Visit(page)
    page.close()
