"""The regular expressions in which a question says where a program prints its time.

Here they are only looked at; the program `carom` matches them, by the ECMAScript rules of C++. Python's own
rules accept more, and mean something else by parts of it. What is allowed is what both understand alike.
"""

import re
from dataclasses import dataclass

_CLASSES = "dDwWsS"
_CONTROLS = "tfvr"
_MOST_DEPTH = 50
_MOST_STATES = 10_000
"""The matcher of C++ gives up at ten times as many."""

_INSTEAD = {
    "?P<": "write ( ) for the group with the number",
    "?P": "write the text itself again",
    "?<=": "write what stands before in front of the group",
    "?<!": "write what stands before in front of the group",
    "?<": "write ( ) for the group with the number",
    "?=": "write what follows behind the group",
    "?!": "write what follows behind the group",
    "?#": "leave the comment out",
    "?>": "write (?: )",
    "?(": "write the alternatives with |",
}
_ESCAPES = {
    "A": "write ^", "Z": "write $", "z": "write $", "n": "a pattern matches one line",
    "b": "write what stands there", "B": "write what stands there",
}  # fmt: skip

_QUANTIFIER = re.compile(r"[*+?]|\{(?P<least>[0-9]{1,4})(,(?P<most>[0-9]{0,4}))?\}")
_SET = re.compile(r"\[\^?(?P<members>(?:\\.|[^\]\\])*)\]", re.DOTALL)
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)


class PatternError(Exception):
    """What is wrong with a pattern, and what to write instead, in one line."""


def groups_of(pattern: str) -> int:
    """How many groups ( ) a pattern has. Raises PatternError where it is none of those that are allowed:
    characters, `.`, `[ ]`, `\\d \\w \\s` and their opposites, `^ $`, `( )`, `(?: )`, `|` and the quantifiers
    `* + ? {n} {n,} {n,m}`, each also with a `?` behind it. A group that is repeated has neither | nor a
    quantifier in it.
    """
    scanner = _Scanner(pattern)
    scanner.alternatives(0)
    if scanner.at < len(pattern):
        raise PatternError("a ) without its (; a bracket itself is \\)")
    return scanner.groups


@dataclass
class _Scanner:
    """Reads a pattern from its beginning to its end; each part tells how many states it is matched with."""

    pattern: str
    at: int = 0
    groups: int = 0
    choices: int = 0
    """Alternatives and quantifiers so far."""

    def _is_at(self, *words: str) -> bool:
        return self.pattern.startswith(words, self.at)

    def _found(self, expression: re.Pattern[str]) -> re.Match[str] | None:
        """What stands next, which is behind us then."""
        found = expression.match(self.pattern, self.at)
        self.at = found.end() if found else self.at
        return found

    def alternatives(self, depth: int) -> int:
        if depth > _MOST_DEPTH:
            raise PatternError(f"more than {_MOST_DEPTH} brackets in each other")
        states = 1
        while self.at < len(self.pattern) and not self._is_at(")"):
            if self._is_at("|"):
                self.at += 1
                self.choices += 1
            else:
                states += self._quantified(depth)
            if states > _MOST_STATES:
                raise PatternError("a pattern that is far too long, or repeats too often")
        return states

    def _quantified(self, depth: int) -> int:
        begin, choices = self.at, self.choices
        states = self._part(depth)
        part = self.pattern[begin : self.at]
        is_open, at_most = self._is_at("{"), self._is_at("{,")
        times = self._found(_QUANTIFIER)
        least, most = (int(times[name] or 0) for name in ("least", "most")) if times else (0, 0)
        if is_open and (times is None or (times["most"] and most < least)):
            told = "write {0,m} for at most m" if at_most else "the character itself is \\{"
            raise PatternError(f"{{ that begins no number of times; {told}")
        if times is None:
            return states
        if self.choices > choices and times[0] != "?":
            # The matcher would try all ways to divide a line among the two, which may take for ever.
            told = "behind a group with | or a quantifier in it; repeat one of them"
            raise PatternError(f"{times[0][0]} {told}")
        self.choices += 1
        if part in "^$":
            raise PatternError(f"a quantifier behind {part}, which has no length; leave it out")
        if not part.isascii() and len(part) == 1:
            raise PatternError(f"a quantifier behind {part}, which is several bytes; write (?:{part})")
        self.at += self._is_at("?")
        if self._is_at("*", "+", "?", "{"):
            raise PatternError(f"{self.pattern[self.at]} behind a quantifier; write one quantifier")
        return states * max(1, least, most) + 2

    def _part(self, depth: int) -> int:
        first = self.pattern[self.at]
        if first == "(":
            return self._group(depth)
        if found := self._found(_SET):
            _require_set(re.findall(r"\\.|.", found["members"], re.DOTALL))
            return 1
        if found := self._found(_ESCAPE):
            _require_escape(found[1], in_set=False)
            return 1
        if first in "[\\":
            raise PatternError("an end too early; a backslash itself is \\\\, a bracket itself \\( or \\[")
        if first in "*+?":
            raise PatternError(f"{first} with nothing before it; the character itself is \\{first}")
        if first in "{}]":
            raise PatternError(f"{first} by itself; the character itself is \\{first}")
        _require_printed(first)
        self.at += 1
        return len(first.encode())

    def _group(self, depth: int) -> int:
        self.at += 1
        if self._is_at("?:"):
            self.at += 2
        elif self._is_at("?"):
            known = next((begin for begin in _INSTEAD if self._is_at(begin)), None)
            instead = _INSTEAD[known] if known else "write both letters, as in [Tt]ook, where either will do"
            raise PatternError(f"({known or self.pattern[self.at : self.at + 2]}; {instead}")
        else:
            self.groups += 1
        states = self.alternatives(depth + 1)
        if self.at == len(self.pattern):
            raise PatternError("a ( without its ); a bracket itself is \\(")
        self.at += 1
        return states + 2


def _require_printed(character: str) -> None:
    if not character.isprintable() and character != "\t":
        raise PatternError("a character that is not printed; a pattern matches one line of text")


def _require_escape(character: str, *, in_set: bool) -> None:
    is_itself = character.isascii() and not character.isalnum() and character.isprintable()
    if character in _CLASSES or character in _CONTROLS or is_itself:
        return
    if in_set and character in "bB":
        raise PatternError(f"\\{character} between [ and ]; write the characters themselves")
    raise PatternError(f"\\{character}; {_ESCAPES.get(character, 'write the character itself')}")


def _require_set(members: list[str]) -> None:
    """Characters, or classes such as \\d, and - between two that are a range."""
    if not members:
        raise PatternError("[] or [^]; the character itself is \\]")
    at = 0
    while at < len(members):
        low = _member(members[at], may_be_minus=at in (0, len(members) - 1))
        if members[at + 1 : at + 2] == ["-"] and at + 2 < len(members):
            at += 2
            high = _member(members[at], may_be_minus=True)
            if len(low) != 1 or len(high) != 1 or low > high:
                raise PatternError(f"{low}-{high} between [ and ]; write \\- for the character itself")
        at += 1


def _member(member: str, *, may_be_minus: bool) -> str:
    """The character that it is, or a class."""
    if member.startswith("\\"):
        _require_escape(member[1], in_set=True)
        return member if member[1].isalpha() else member[1]
    if member == "[":
        raise PatternError("[ between [ and ]; the character itself is \\[, a digit \\d")
    if member == "-" and not may_be_minus:
        raise PatternError("- between [ and ]; the character itself is \\-")
    if not member.isascii():
        raise PatternError(f"{member} between [ and ]; write (?:{member}|...)")
    _require_printed(member)
    return member
