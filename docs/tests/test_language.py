"""Pages are short, and so are the sentences of all documents but the notebook."""

import pytest
from documents import ROOT
from prose import longest, sentences, words

README_WORDS = 600
PAGE_WORDS = 1_500
DOCS_WORDS = 9_000
SENTENCE_WORDS = 40
FOLDERS = ("docs", "kernels", "variants", "harness", "experiments", "analysis", "support")

DOCS = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").glob("*.md"))
DOCUMENTS = sorted(
    path.relative_to(ROOT).as_posix()
    for folder in (ROOT, *(ROOT / name for name in FOLDERS))
    for path in (folder.glob("*.md") if folder == ROOT else folder.rglob("*.md"))
    if "notebook" not in path.parts
)


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", DOCUMENTS)
def test_no_sentence_is_long(name: str) -> None:
    found = longest(text_of(name), SENTENCE_WORDS)
    assert not found, f"{name}: has sentences of more than {SENTENCE_WORDS} words:\n" + "\n".join(found)


def test_readme_is_short() -> None:
    assert words(text_of("README.md")) <= README_WORDS


@pytest.mark.parametrize("name", DOCS)
def test_a_page_is_read_in_minutes(name: str) -> None:
    assert words(text_of(name)) <= PAGE_WORDS


def test_the_pages_together_are_short() -> None:
    counts = {name: words(text_of(name)) for name in DOCS}
    told = ", ".join(f"{name} {count}" for name, count in counts.items())
    assert sum(counts.values()) <= DOCS_WORDS, f"{sum(counts.values())} words: {told}"


PAGE = """<!-- No words here. -->
# A heading counts as words, and is no sentence

One sentence of `code that is a word` and a [link of four words](a/long/target.md).
Another one, wrapped
over lines! (A third one.) *A fourth?* It has 3.5 % of x. 2 begin with a number.

```sh
carom run scene.in   # not. A. Sentence.
```

- An item
  goes on
- Another item: with a colon

| a table | is |
|---|---|
| no sentence | at all |

![An image. Is no sentence](a.svg)

So it ends:

1. First.
"""


def test_sentences_are_found_without_what_is_none() -> None:
    assert list(sentences(PAGE)) == [
        "One sentence of CODE and a link of four words.",
        "Another one, wrapped over lines!",
        "(A third one.",
        "A fourth?",
        "It has 3.5 % of x.",
        "2 begin with a number.",
        "An item goes on",
        "Another item: with a colon",
        "So it ends:",
        "First.",
    ]


def test_words_are_those_of_headings_tables_and_sentences() -> None:
    assert (
        words("# Two words\n\n| a | b |\n|---|---|\n| c | `d e` |\n\n```\nf g\n```\n\n[h](i) – ![j](k) 5.\n")
        == 8
    )


def test_a_long_sentence_is_told_with_its_length() -> None:
    page = f"Short one. {'Word ' * 40}end. Another.\n"
    assert longest(page, 41) == []
    (found,) = longest(page, 40)
    assert found.startswith("41 words: Word Word")
