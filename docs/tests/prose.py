"""The prose of a Markdown page: its words, and its sentences without code blocks, tables and headings."""

import re
from collections.abc import Iterator

_FENCED = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_LEFT_OUT = re.compile(r"^\s*(\||#{1,6} |<)")
_ITEM = re.compile(r"^\s*([-*+]|\d+\.) ")
_IMAGE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
_CODE = re.compile(r"(`+).+?\1", re.DOTALL)
_END = re.compile(r"(?<=[.!?])[)\]\"'*_”]*\s+(?=[(\[\"'*_“]*[A-ZÄÖÜ0-9])|(?<=:)\s*$")


def words(text: str) -> int:
    """How many words a page has without its code blocks: what has a letter. Of a link its text counts."""
    text = _LINK.sub(r"\1", _IMAGE.sub(" ", _COMMENT.sub(" ", _FENCED.sub(" ", text))))
    return sum(any(letter.isalpha() for letter in word) for word in text.split())


def sentences(text: str) -> Iterator[str]:
    """The sentences of a page; code within a line counts as a word."""
    for paragraph in _paragraphs(_COMMENT.sub("", _FENCED.sub("\n\n", text))):
        shown = _LINK.sub(r"\1", _CODE.sub("CODE", _IMAGE.sub(" ", paragraph)))
        yield from filter(_words, (one.strip() for one in _END.split(shown) if one))


def longest(text: str, most: int) -> list[str]:
    """The sentences with more words than `most`, each with how many they are."""
    counted = ((len(_words(one)), one) for one in sentences(text))
    return [f"{count} words: {one}" for count, one in counted if count > most]


def _words(text: str) -> list[str]:
    return [one for one in text.split() if re.search(r"\w", one)]


def _paragraphs(text: str) -> Iterator[str]:
    """Paragraphs and items of lists, each in one line."""
    lines: list[str] = []
    for line in [*text.splitlines(), ""]:
        left_out = _LEFT_OUT.match(line) is not None
        if lines and (not line.strip() or left_out or _ITEM.match(line)):
            yield " ".join(lines)
            lines = []
        if line.strip() and not left_out:
            lines.append(_ITEM.sub("", line).strip().removeprefix("> "))
