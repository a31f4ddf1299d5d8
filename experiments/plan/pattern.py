"""The regular expressions in which a question says where a program prints its time.

Here they are only looked at; the program `carom` matches them, by the ECMAScript rules of C++. Python's own
rules accept more, and mean something else by parts of it. What is allowed is what both understand alike.
"""

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
    if scanner.rest:
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

    @property
    def rest(self) -> str:
        return self.pattern[self.at :]

    def _next(self) -> str:
        if not self.rest:
            raise PatternError("an end too early; a backslash itself is \\\\, a bracket itself \\( or \\[")
        self.at += 1
        return self.pattern[self.at - 1]

    def alternatives(self, depth: int) -> int:
        if depth > _MOST_DEPTH:
            raise PatternError(f"more than {_MOST_DEPTH} brackets in each other")
        states = 1
        while self.rest and not self.rest.startswith(")"):
            if self.rest.startswith("|"):
                self.at += 1
                self.choices += 1
            else:
                states += self._quantified(depth)
            if states > _MOST_STATES:
                raise PatternError("a pattern that is far too long, or repeats too often")
        return states

    def _quantified(self, depth: int) -> int:
        begin, choices = self.at, self.choices
        first = self._next()
        states = self._part(first, depth)
        is_anchor = first in "^$"
        part = self.pattern[begin : self.at]
        quantifier = self.rest[:1]
        times = self._times()
        if times is None:
            return states
        if self.choices > choices and quantifier != "?":
            # The matcher would try all ways to divide a line among the two, which may take for ever.
            raise PatternError(
                f"{quantifier} behind a group with | or a quantifier in it; repeat one of them"
            )
        self.choices += 1
        if is_anchor:
            raise PatternError(f"a quantifier behind {part}, which has no length; leave it out")
        if not part.isascii() and len(part) == 1:
            raise PatternError(f"a quantifier behind {part}, which is several bytes; write (?:{part})")
        if self.rest.startswith("?"):
            self.at += 1
        if self.rest[:1] in ("*", "+", "?", "{"):
            raise PatternError(f"{self.rest[0]} behind a quantifier; write one quantifier")
        return states * max(1, times) + 2

    def _part(self, first: str, depth: int) -> int:
        if first == "(":
            return self._group(depth)
        if first == "[":
            return self._set()
        if first == "\\":
            return self._escape(in_set=False)
        if first in "*+?":
            raise PatternError(f"{first} with nothing before it; the character itself is \\{first}")
        if first in "{}]":
            raise PatternError(f"{first} by itself; the character itself is \\{first}")
        return self._plain(first)

    def _plain(self, character: str) -> int:
        if not character.isprintable() and character != "\t":
            raise PatternError("a character that is not printed; a pattern matches one line of text")
        return len(character.encode())

    def _group(self, depth: int) -> int:
        if self.rest.startswith("?:"):
            self.at += 2
        elif self.rest.startswith("?"):
            known = next((begin for begin in _INSTEAD if self.rest.startswith(begin)), None)
            instead = _INSTEAD[known] if known else "write both letters, as in [Tt]ook, where either will do"
            raise PatternError(f"({known or self.rest[:2]}; {instead}")
        else:
            self.groups += 1
        states = self.alternatives(depth + 1)
        if not self.rest:
            raise PatternError("a ( without its ); a bracket itself is \\(")
        self.at += 1
        return states + 2

    def _times(self) -> int | None:
        """How often at most what stands before is there, as far as it is counted; None without quantifier."""
        if self.rest[:1] in ("*", "+", "?") and self.rest:
            self.at += 1
            return 1
        if not self.rest.startswith("{"):
            return None
        end = self.rest.find("}")
        least, comma, most = self.rest[1:end].partition(",") if end > 0 else ("", "", "")
        if not _is_count(least) or not (most == "" or _is_count(most)) or (most and int(most) < int(least)):
            told = "write {0,m} for at most m" if comma and not least else "the character itself is \\{"
            raise PatternError(f"{{ that begins no number of times; {told}")
        self.at += end + 1
        return max(int(least), int(most or 0))

    def _escape(self, *, in_set: bool) -> int:
        character = self._next()
        if character in _CLASSES or character in _CONTROLS:
            return 1
        if character.isascii() and not character.isalnum() and character.isprintable():
            return 1
        if in_set and character in "bB":
            raise PatternError(f"\\{character} between [ and ]; write the characters themselves")
        instead = _ESCAPES.get(character, "write the character itself")
        raise PatternError(f"\\{character}; {instead}")

    def _set(self) -> int:
        if self.rest.startswith("^"):
            self.at += 1
        if self.rest.startswith("]"):
            raise PatternError("[] or [^]; the character itself is \\]")
        is_first = True
        while not self.rest.startswith("]"):
            low = self._member(is_first=is_first)
            is_first = False
            if self.rest.startswith("-") and not self.rest.startswith("-]"):
                self.at += 1
                high = self._member(is_first=True)
                if len(low) != 1 or len(high) != 1 or low > high:
                    raise PatternError(f"{low}-{high} between [ and ]; write \\- for the character itself")
        self.at += 1
        return 1

    def _member(self, *, is_first: bool) -> str:
        """A character of a set, or a class such as \\d."""
        begin = self.at
        character = self._next()
        if character == "\\":
            self._escape(in_set=True)
            escaped = self.pattern[begin + 1 : self.at]
            return escaped if not escaped.isalpha() else f"\\{escaped}"
        if character == "[":
            raise PatternError("[ between [ and ]; the character itself is \\[, a digit \\d")
        if character == "-" and not is_first and not self.rest.startswith("]"):
            raise PatternError("- between [ and ]; the character itself is \\-")
        if not character.isascii():
            raise PatternError(f"{character} between [ and ]; write (?:{character}|...)")
        self._plain(character)
        return character


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) <= 4
