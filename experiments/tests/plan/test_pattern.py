"""Patterns of printed times: what is allowed means the same to Python and to the program."""

import json
import random
import re
import subprocess
from pathlib import Path

import pytest

from experiments.plan.pattern import PatternError, groups_of
from experiments.tests.conftest import ROOT

CAROM = ROOT / "build" / "gcc" / "carom"

RIGHT = [
    r"took ([0-9.]+) ms", r"(\d+)", r"^\s*time: (\d+(?:\.\d+)?)$", r"[Tt]ook (\d{1,3}) \(all\)", r"a|(b+?)",
    r"([-+\w.]*)", r"(?:é)+ (\d)", r"[^a-c]([\d-]{2,})", r"\{(\d+)\}", r"()x", r"(\d*?)s",
    r"(?:ab)+(\d+)(?:\.\d+)?", r"[\]\[.]{0,2}(\d)",
]  # fmt: skip

WRONG = {
    r"(?i)took (\d+)": "(?i; write both letters, as in [Tt]ook",
    r"(?P<t>\d+)": "(?P<; write ( ) for the group with the number",
    r"(?P=t)(a)": "(?P; write the text itself again",
    r"(?<=took )(\d+)": "(?<=; write what stands before in front",
    r"(?<!a)(\d+)": "(?<!; write what stands before",
    r"(\d+)(?= ms)": "(?=; write what follows behind",
    r"(?>a)(b)": "(?>; write (?: )",
    r"(?#why)(b)": "(?#; leave the comment out",
    r"(?i:a)(b)": "(?i; write both letters",
    r"\A(\d+)": r"\A; write ^",
    r"(\d+)\Z": r"\Z; write $",
    r"(\d++)": "+ behind a quantifier",
    r"(\d*+)": "+ behind a quantifier",
    r"(a{2}{3})": "{ behind a quantifier",
    r"({,3}a)": "{ by itself",
    r"(a{,3})": "write {0,m}",
    r"(a{x})": r"the character itself is \{",
    r"(a{3,2})": r"the character itself is \{",
    r"(a}": r"} by itself; the character itself is \}",
    r"a]": r"] by itself",
    r"*a": r"* with nothing before it; the character itself is \*",
    r"a|+": "+ with nothing before it",
    r"(a": "a ( without its )",
    r"a)": "a ) without its (",
    "a\\": "an end too early",
    "[a": "an end too early",
    r"^*(a)": "a quantifier behind ^",
    r"[[:digit:]]+": r"[ between [ and ]; the character itself is \[, a digit \d",
    r"[]a]": r"[] or [^]; the character itself is \]",
    r"[^]a]": r"[] or [^]",
    r"[z-a]": "z-a between [ and ]",
    r"[\d-z]": r"\d-z between [ and ]",
    r"[a-c-e]": "- between [ and ]",
    r"[é]": "write (?:é|...)",
    r"é+": "write (?:é)",
    r"(a)\1": r"\1; write the character itself",
    r"(\x41)": r"\x; write the character itself",
    r"(\e)": r"\e; write the character itself",
    r"[\b]": r"\b between [ and ]",
    "(a)\n": "a character that is not printed",
    "(" * 60 + ")" * 60: "more than 50 brackets",
    r"(?:abcdefghijklm){999}": "repeats too often",
    r"(\d+)(?:a*)*b": "* behind a group with | or a quantifier in it",
    r"(\d+)(?:a|a)+b": "+ behind a group with | or a quantifier in it",
    r"(?:(a?)){2}": "{ behind a group with | or a quantifier in it",
}


@pytest.mark.parametrize("pattern", RIGHT)
def test_what_both_understand_alike_is_allowed(pattern: str) -> None:
    assert groups_of(pattern) == re.compile(pattern).groups


@pytest.mark.parametrize(("pattern", "said"), WRONG.items())
def test_what_they_do_not_is_refused_with_what_to_write_instead(pattern: str, said: str) -> None:
    with pytest.raises(PatternError) as refused:
        groups_of(pattern)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


PARTS = [
    "a", "b", "7", "1", ".", r"\d", r"\w", r"\s", r"\D", r"\W", r"\S", r"\.", r"\-", r"\t", " ", "é", "(?:é)",
    "[a7]",
    "[^a]", r"[\d.]", "[a-c1-7]", "[-a]", "[a-]", r"[\w-]", r"[\]\\]", "^", "$", "_", ":", ",", '"',
    "'", "/", r"\/", r"\(", r"\{", "#", "&", "~", "<", "=", "!", "%", "@",
]  # fmt: skip
QUANTIFIERS = ["", "", "", "", "*", "+", "?", "{2}", "{0,2}", "{1,}", "*?", "+?", "??", "{1,2}?"]
MEDDLED = [*"()[]{}|*+?^$\\-,:=!<>PiAZbdnx0", "(?", "\\b", "{,2}", "[:"]
LETTERS = "ab71. -_:é"


def generated(draw: random.Random, depth: int = 0) -> str:
    """A pattern that may be right."""
    words = []
    for _ in range(draw.randint(1, 4)):
        part = draw.choice(PARTS)
        if depth < 2 and draw.random() < 0.25:
            part = f"(?:{generated(draw, depth + 1)})"
        words.append(part + draw.choice(QUANTIFIERS))
    if draw.random() < 0.2:
        words.insert(draw.randint(0, len(words)), "|")
    return "".join(words)


def timed(draw: random.Random) -> str:
    """A pattern around a number, now and then with a mistake in it."""
    number = draw.choice([r"(\d+)", r"([0-9.]+)", r"(\w*?)", r"(7+?|1)", f"({generated(draw, 1)})"])
    pattern = draw.choice([generated(draw), ""]) + number + draw.choice([generated(draw), ""])
    if draw.random() < 0.3:
        at = draw.randint(0, len(pattern))
        pattern = pattern[:at] + draw.choice(MEDDLED) + pattern[at:]
    return pattern


@pytest.mark.skipif(not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)")
@pytest.mark.parametrize("seed", range(2))
def test_the_program_finds_what_python_finds(tmp_path: Path, seed: int) -> None:
    draw = random.Random(seed)
    patterns = [one for one in (timed(draw) for _ in range(300)) if _groups(one) == 1]
    assert len(patterns) > 100
    lines = ["".join(draw.choices(LETTERS, k=draw.randint(1, 9))) for _ in patterns]
    described = [
        {"command": ["echo", line], "record": f"{number}.json", "pattern": pattern}
        | {"axes": {"threads": 1}, "unit_seconds": 1.0}
        for number, (pattern, line) in enumerate(zip(patterns, lines, strict=True))
    ]
    (tmp_path / "all.json").write_text(json.dumps(described))
    subprocess.run(
        [str(CAROM), "processes", "all.json"], cwd=tmp_path, check=False, capture_output=True, timeout=300
    )
    for number, (pattern, line) in enumerate(zip(patterns, lines, strict=True)):
        record = json.loads((tmp_path / f"{number}.json").read_text())
        reason = record.get("reason", "")
        every = enumerate(re.finditer(pattern.encode(), line.encode(), re.ASCII))
        matches = [one for at, one in every if at == 0 or one[0]]
        group = matches[0][1] or b"" if matches else b""
        if len(matches) != 1:
            assert f"matches {len(matches)} " in reason, (pattern, line)
        elif (expected := _number(group)) is None:
            assert "found '" in reason or group != group.strip(), (pattern, line)
        elif _has_letters_behind(matches[0], line.encode()):
            assert "with the unit" in reason or "within a longer number" in reason, (pattern, line)
        elif not _is_cut(matches[0], line.encode()) or not reason:
            assert record["repetitions"][0]["steps_seconds"] == pytest.approx(expected), (pattern, line)
        else:
            assert "within a longer number" in reason, (pattern, line)


def _groups(pattern: str) -> int:
    try:
        return groups_of(pattern)
    except PatternError:
        return 0


def _is_cut(found: re.Match[bytes], line: bytes) -> bool:
    """Whether a number may go on where the group ends, or may have begun before it."""
    before, after = line[: found.start(1)], line[found.end(1) :]
    return bool(re.match(rb"[0-9.,:'_eE+-]", after) or re.search(rb"[0-9.,:'_+-]$", before))


def _has_letters_behind(found: re.Match[bytes], line: bytes) -> bool:
    """Whether letters follow the number at once, of which the pattern says nothing: an unknown unit."""
    short = re.match(rb"[A-Za-z]{1,3}(?![A-Za-z])", line[found.end() :])
    return found.end() == found.end(1) and short is not None


def _number(text: bytes) -> float | None:
    """As the program reads it."""
    if not re.fullmatch(rb"[0-9]+\.?[0-9]*|\.[0-9]+", text):
        return None
    return float(text) or None
