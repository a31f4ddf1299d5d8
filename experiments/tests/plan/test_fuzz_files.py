"""Question and site files with anything in them: read, or refused in one line that names the file."""

import re
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from experiments.plan import question, site
from experiments.plan.question import load_question
from experiments.plan.site import load_site
from experiments.tests.conftest import CHUNKS, PAIR
from support.errors import InputError

QUESTIONS = [CHUNKS, PAIR, *(path.read_text() for path in sorted(question.FOLDER.glob("*.toml")))]
SITES = [path.read_text() for path in sorted(site.FOLDER.glob("*.toml"))]

JUNK = [
    "nan", "inf", "-inf", "-1", "0", "1e400", "1e308", "9" * 400, "0.5", '"x"', '"\\u0000\\n"', "true", "[]",
    "{}", "[[]]", "{a = 1}", "1979-05-27", "1979-13-45", "'", "=", "[", "[[series]]", "\n", "[x]", "[" * 3000,
    '"a\\nb" = 1',
]  # fmt: skip


@st.composite
def damaged(draw: st.DrawFn, texts: list[str]) -> str:
    """A valid file in which up to three words or values are others, or some letters are gone."""
    text = draw(st.sampled_from(texts))
    for _ in range(draw(st.integers(0, 3))):
        words = list(re.finditer(r"[\w.\"]+|\[|\]|=|\n", text))
        if words:
            word = draw(st.sampled_from(words))
            text = text[: word.start()] + draw(st.sampled_from(JUNK)) + text[word.end() :]
    begin = draw(st.integers(0, len(text)))
    return text[:begin] + text[begin + draw(st.sampled_from([0, 0, 0, 1, 30])) :]


def is_read_or_refused_in_one_line(text: str, load: Callable[[Path], object]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "any.toml")
        path.write_text(text, encoding="utf-8")
        try:
            load(path)
        except InputError as error:
            said = str(error)
        else:
            return
    assert said.startswith(f"{path}: ")
    assert "\n" not in said


@given(damaged(QUESTIONS))
@settings(max_examples=300, deadline=None)
def test_any_question_is_read_or_refused_in_one_line(text: str) -> None:
    is_read_or_refused_in_one_line(text, load_question)


@given(damaged(SITES))
@settings(max_examples=300, deadline=None)
def test_any_site_is_read_or_refused_in_one_line(text: str) -> None:
    is_read_or_refused_in_one_line(text, lambda path: load_site(str(path)))


@pytest.mark.parametrize("value", ["nan", "inf", "1e400", "[" * 3000])
def test_a_number_that_is_none_is_refused(tmp_path: Path, value: str) -> None:
    for old, new in (("values = [1, 2, 3]", f"values = [{value}]"), ("side = 1000", f"side = {value}")):
        assert old in CHUNKS
        path = tmp_path / "any.toml"
        path.write_text(CHUNKS.replace(old, new))
        with pytest.raises(InputError, match=f"^{path}: "):
            load_question(path)
