"""The page about the published study: every claim stands on it as the analysis has it, with its questions."""

import re

from documents import ROOT

from analysis import claims

ROW = re.compile(r"^\| `(\w+)` \| (.*) \| (.*) \| (.*) \|$", re.MULTILINE)
PAGE = (ROOT / "docs" / "study.md").read_text(encoding="utf-8")


def test_every_claim_stands_on_the_page_as_it_is_tested() -> None:
    expected = [
        (one.id, one.claim, one.published.effect, ", ".join(f"`{name}`" for name in one.experiments))
        for one in claims.load()
    ]
    assert ROW.findall(PAGE) == expected


def test_the_study_is_cited() -> None:
    assert "https://github.com/bryanyee33/Particles-OpenMP" in PAGE
