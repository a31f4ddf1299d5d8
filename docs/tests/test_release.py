"""A version is one: VERSION, the citation and the changelog agree, and the changelog is short."""

import re

import pytest
from documents import ROOT

VERSION = (ROOT / "VERSION").read_text(encoding="utf-8").strip()
CITATION = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
MAINTAIN = ROOT / "docs" / "maintain.md"
HEADING = re.compile(r"^## (.*)$", re.MULTILINE)
RELEASED = re.compile(r"(\d+\.\d+\.\d+) \((\d{4}-\d\d-\d\d)\)")
MOST_LINES = 15
"""Of one version: some ten, and what stands before them."""


def released() -> list[tuple[str, str]]:
    """Versions and dates of the changelog, in its order."""
    return RELEASED.findall("\n".join(HEADING.findall(CHANGELOG)))


def cited(key: str) -> str:
    """What the citation says."""
    [found] = re.findall(rf'(?m)^{key}: "?([^"\n]*)"?$', CITATION)
    return str(found)


def test_version_citation_and_changelog_agree() -> None:
    version, day = released()[0]
    assert (cited("version"), cited("date-released")) == (version, day)
    assert version == VERSION


def test_the_changelog_has_a_date_for_each_version_and_the_newest_first() -> None:
    first, *rest = HEADING.findall(CHANGELOG)
    assert first == "Unreleased"
    assert all(RELEASED.fullmatch(one) for one in rest)
    numbers = [tuple(map(int, version.split("."))) for version, _ in released()]
    days = [day for _, day in released()]
    assert numbers == sorted(set(numbers), reverse=True)
    assert days == sorted(days, reverse=True)


def test_a_version_has_some_ten_lines() -> None:
    for part in re.split(HEADING, CHANGELOG)[2::2]:
        assert len([line for line in part.splitlines() if line]) <= MOST_LINES


@pytest.mark.skipif(not MAINTAIN.is_file(), reason="docs/maintain.md is not there yet")
@pytest.mark.parametrize(
    "word", ["VERSION", "CITATION.cff", "CHANGELOG.md", "git tag", "make package", "make docs"]
)
def test_the_page_for_maintainers_says_what_a_release_takes(word: str) -> None:
    assert f"`{word}" in MAINTAIN.read_text(encoding="utf-8")
