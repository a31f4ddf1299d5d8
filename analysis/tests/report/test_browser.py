"""The report in a real browser: nothing to scroll sideways, links that lead somewhere, a silent console."""

import json
import re
import shutil
import subprocess
from dataclasses import dataclass
from html import escape, unescape
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.slow

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
WIDTHS = (1280, 768, 390)
"""Pixels: a screen, a tablet, a telephone."""

LOOK = """
addEventListener("load", () => {
  const told = [...document.querySelectorAll("iframe")].map((frame) => {
    const page = frame.contentDocument, width = page.documentElement.clientWidth;
    const leads = (link) => {
      const place = page.getElementById(decodeURIComponent(link.getAttribute("href").slice(1)));
      return place !== null && place.getClientRects().length > 0;
    };
    const links = [...page.querySelectorAll("a")];
    return {
      width: width,
      needed: page.documentElement.scrollWidth,
      wide: [...page.querySelectorAll("body *")]
        .filter((one) => one.getBoundingClientRect().right > width + 1 && !one.closest(".wide, svg"))
        .map((one) => one.outerHTML.slice(0, 80)),
      links: links.length,
      dead: links.filter((link) => !leads(link)).map((link) => link.getAttribute("href")),
    };
  });
  document.getElementById("told").textContent = JSON.stringify(told);
});
"""


@dataclass(frozen=True)
class Browser:
    """A browser without a window, and a folder for what it needs."""

    program: str
    folder: Path

    def look(self, page: str) -> tuple[list[dict[str, Any]], list[str]]:
        """Show a page at each width; return what was seen there, and what its console says."""
        frames = "".join(
            f'<iframe srcdoc="{escape(page)}" style="border: 0; width: {width}px; height: 900px"></iframe>'
            for width in WIDTHS
        )
        text = f'<!DOCTYPE html><meta charset="utf-8"><pre id="told"></pre>{frames}<script>{LOOK}</script>'
        file = self.folder / "frames.html"
        file.write_text(text, encoding="utf-8")
        done = subprocess.run(
            [
                self.program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                "--enable-logging=stderr", f"--user-data-dir={self.folder / 'profile'}",
                "--window-size=1400,1000", "--virtual-time-budget=60000", "--dump-dom", file.as_uri(),
            ],
            capture_output=True, text=True, errors="replace", timeout=300, check=False,
        )  # fmt: skip
        found = re.search(r'<pre id="told">(.+?)</pre>', done.stdout, re.DOTALL)
        assert found is not None, done.stderr[-2000:]
        return json.loads(unescape(found[1])), re.findall(r"CONSOLE.*", done.stderr)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Browser:
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        pytest.skip("no browser is here to look at the report with (Debian: the package chromium)")
    return Browser(program, tmp_path_factory.mktemp("browser"))


def test_the_report_fits_its_links_lead_somewhere_and_the_console_is_silent(
    browser: Browser, page: str
) -> None:
    seen, said = browser.look(page)
    assert said == []
    assert [one["width"] for one in seen] == list(WIDTHS)
    for one in seen:
        assert one["wide"] == [], one["width"]
        assert one["needed"] <= one["width"]
        assert one["links"] > 60
        assert one["dead"] == []


def test_what_does_not_fit_and_leads_nowhere_is_seen(browser: Browser) -> None:
    page = (
        '<!DOCTYPE html><body><p id="here">Here</p><p id="hidden" style="display: none">Hidden</p>'
        '<div style="width: 700px">wide</div>'
        '<a href="#here">1</a><a href="#hidden">2</a><a href="#gone">3</a>'
        "<script>nonsense();</script></body>"
    )
    seen, said = browser.look(page)
    assert any("nonsense" in line for line in said)
    assert [bool(one["wide"]) for one in seen] == [False, False, True]
    assert [one["needed"] > one["width"] for one in seen] == [False, False, True]
    assert [one["dead"] for one in seen] == [["#hidden", "#gone"]] * 3
