"""How much of a machine's processors this process's control groups grant, as `carom doctor` reads it too.

`harness/tests/machine/cpu_quotas.json` holds both readers to the same cases.
"""

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath


def read_cpu_quota(root: Path = Path("/")) -> float | None:
    """How many processors' time may be used, such as 1.5: the least that the process's own group and those
    around it allow, as far as it sees them; None where none limits it.

    Read below `root` are proc/self/cgroup, proc/self/mountinfo (man 5 proc) and the groups' `cpu.max`, of
    version 2 alone. What cannot be understood is no limit.
    """
    quotas = [_quota_of(group) for group in _limiting_groups(root)]
    return min((quota for quota in quotas if quota is not None), default=None)


def _limiting_groups(root: Path) -> list[Path]:
    own = next((line[3:] for line in _lines(root / "proc/self/cgroup") if line.startswith("0::")), None)
    groups: list[Path] = []
    tops: list[Path] = []
    for place, top in _mounts(root) if own is not None else ():
        tops.append(root / place.lstrip("/"))
        inside = PurePosixPath(own or "/")
        if inside.is_relative_to(top) and ".." not in inside.parts:
            names = inside.relative_to(top).parts
            groups += [tops[-1].joinpath(*names[:count]) for count in range(len(names) + 1)]
    # A container may be told its group by another name than the one that it sees it by, as the top.
    return groups or tops


def _mounts(root: Path) -> Iterator[tuple[str, str]]:
    """Where the hierarchy is mounted, and the group that is the top there."""
    for line in _lines(root / "proc/self/mountinfo"):
        about, dash, kind = line.partition(" - ")
        fields = about.split(" ")
        if dash and len(fields) >= 5 and kind.split(" ")[0] == "cgroup2":
            yield _unescaped(fields[4]), _unescaped(fields[3])


def _quota_of(group: Path) -> float | None:
    """What one group allows by itself."""
    numbers = next(iter(_lines(group / "cpu.max")), "").split(" ")
    if len(numbers) != 2 or not all(re.fullmatch("[0-9]{1,18}", number) for number in numbers):
        return None
    quota, period = map(int, numbers)
    return quota / period if quota and period else None


def _unescaped(text: str) -> str:
    """A blank, tab, line break or backslash stands as three octal digits in mountinfo."""
    return re.sub(r"\\([0-3][0-7]{2})", lambda found: chr(int(found[1], 8)), text)


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8", errors="surrogateescape").split("\n")
    except OSError:
        return []
