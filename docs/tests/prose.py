"""The prose of a Markdown page: its words, and its sentences without code blocks, tables and headings."""

import re
from collections.abc import Iterator

from markdown_it import MarkdownIt
from markdown_it.token import Token

_PARSER = MarkdownIt().enable("table")
_END = re.compile(r"(?<=[.!?])[)\]\"'_”]*\s+(?=[(\[\"'_“]*[A-ZÄÖÜ0-9])|(?<=:)\s*$")


def words(text: str) -> int:
    """How many words a page has without its code blocks: what has a letter. Of a link its text counts."""
    inner = (part for token in _PARSER.parse(text) for part in token.children or ())
    parts = [part.content for part in inner if part.type != "image"]
    return sum(any(letter.isalpha() for letter in word) for part in parts for word in part.split())


def sentences(text: str) -> Iterator[str]:
    """The sentences of a page; code within a line counts as a word."""
    parent = ""
    for token in _PARSER.parse(text):
        if token.type == "inline" and parent == "paragraph_open":
            shown = "".join(map(_shown, token.children or ()))
            yield from filter(_words, (one.strip() for one in _END.split(shown) if one))
        parent = token.type


def longest(text: str, most: int) -> list[str]:
    """The sentences with more words than `most`, each with how many they are."""
    counted = ((len(_words(one)), one) for one in sentences(text))
    return [f"{count} words: {one}" for count, one in counted if count > most]


def _shown(part: Token) -> str:
    kinds = {"code_inline": "CODE", "softbreak": " ", "image": "", "html_inline": ""}
    return kinds.get(part.type, part.content)


def _words(text: str) -> list[str]:
    return [one for one in text.split() if re.search(r"\w", one)]
