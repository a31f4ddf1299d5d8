"""What can be held of the pages' language: how long a sentence is, and how long a page."""

import re
from collections.abc import Iterator

import pytest
from documents import DOCUMENTS, FENCED, ROOT

MOST_IN_A_SENTENCE = 40
MOST_ON_A_PAGE = {"README.md": 600}
MOST_ON_OTHER_PAGES = 1500
MOST_IN_ALL = 9000
PAGES = [name for name in DOCUMENTS if re.fullmatch(r"docs/\w+\.md", name)]
"""The pages to be read from top to bottom; those of docs/reference/ are looked things up in."""

READ = ["README.md", "CONTRIBUTING.md", *(name for name in DOCUMENTS if name.startswith("docs/"))]
ENDS_A_SENTENCE = re.compile(r"(?<=[.!?])\s+(?=[A-Z]|[^\w\s])|; ")


def words(text: str) -> int:
    """The number of words: what has a letter in it. The target of a link is none."""
    shown = re.sub(r"\]\([^)]*\)", "] ", text)
    return sum(any(letter.isalpha() for letter in word) for word in shown.split())


def prose(name: str) -> str:
    """A page without its fenced blocks."""
    return FENCED.sub("", (ROOT / name).read_text(encoding="utf-8"))


def sentences(text: str) -> Iterator[str]:
    """The sentences of a page: of its paragraphs, of the items of its lists, of the cells of its tables."""
    rows = re.findall(r"^\|.*$", text, re.MULTILINE)
    paragraphs = re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )|\n(?=#)", re.sub(r"(?m)^\|.*$", "", text))
    for part in (*paragraphs, *(cell for row in rows for cell in row.split("|"))):
        yield from ENDS_A_SENTENCE.split(" ".join(part.split()))


@pytest.mark.parametrize("name", READ)
def test_no_sentence_is_too_long(name: str) -> None:
    long = [one for one in sentences(prose(name)) if words(one) > MOST_IN_A_SENTENCE]
    assert long == []


@pytest.mark.parametrize("name", ["README.md", *PAGES])
def test_a_page_can_be_read_in_minutes(name: str) -> None:
    assert words(prose(name)) <= MOST_ON_A_PAGE.get(name, MOST_ON_OTHER_PAGES)


def test_all_pages_can_be_read_in_an_hour() -> None:
    assert sum(words(prose(name)) for name in PAGES) <= MOST_IN_ALL


def test_words_and_sentences_are_told_apart() -> None:
    text = "One two. Three [four](five.md) 6:\n\n- Seven eight\n  nine\n- Ten\n\n| Eleven. Twelve | 13 |\n"
    assert [words(one) for one in sentences(text) if words(one)] == [2, 2, 3, 1, 1, 1]
    assert words(text) == 10
