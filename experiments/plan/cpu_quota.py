"""How much of a machine's processors this process's control groups grant, as `carom doctor` reads it too.

`harness/tests/machine/cpu_quotas.json` holds both readers to the same cases.
"""

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath


def read_cpu_quota(root: Path = Path("/")) -> float | None:
    """How many processors' time may be used, such as 1.5: the least that the process's own group and those
    around it allow, as far as it sees them; None where none limits it.

    Read below `root` are proc/self/cgroup, proc/self/mountinfo (man 5 proc) and the groups' `cpu.max`, or
    `cpu.cfs_quota_us` and `cpu.cfs_period_us` in version 1. What cannot be understood is no limit.
    """
    groups = [(group, version) for version in (1, 2) for group in _limiting_groups(root, version)]
    quotas = [_quota_of(group, version) for group, version in groups]
    return min((quota for quota in quotas if quota is not None), default=None)


def _limiting_groups(root: Path, version: int) -> list[Path]:
    own = _own_group(root, version)
    groups: list[Path] = []
    tops: list[Path] = []
    for place, top in _mounts(root, version) if own is not None else ():
        tops.append(root / place.lstrip("/"))
        inside = PurePosixPath(own or "/")
        if inside.is_relative_to(top) and ".." not in inside.parts:
            names = inside.relative_to(top).parts
            groups += [tops[-1].joinpath(*names[:count]) for count in range(len(names) + 1)]
    # A container may be told its group by another name than the one that it sees it by, as the top.
    return groups or tops


def _mounts(root: Path, version: int) -> Iterator[tuple[str, str]]:
    """Where a hierarchy that can limit processors is mounted, and the group that is the top there."""
    for line in _lines(root / "proc/self/mountinfo"):
        about, dash, kind = line.partition(" - ")
        fields, kinds = about.split(" "), kind.split(" ")
        if dash and len(fields) >= 5:
            found = {"cgroup2": 2, "cgroup": 1 if "cpu" in kinds[-1].split(",") else 0}.get(kinds[0])
            if found == version:
                yield _unescaped(fields[4]), _unescaped(fields[3])


def _own_group(root: Path, version: int) -> str | None:
    for line in _lines(root / "proc/self/cgroup"):
        fields = line.split(":", 2)
        if len(fields) == 3:
            number, controllers, path = fields
            if version == 2 and number == "0" and not controllers:
                return path
            if version == 1 and "cpu" in controllers.split(","):
                return path
    return None


def _quota_of(group: Path, version: int) -> float | None:
    """What one group allows by itself."""
    if version == 2:
        numbers = _first_line(group / "cpu.max").split(" ")
    else:
        numbers = [_first_line(group / f"cpu.cfs_{name}_us") for name in ("quota", "period")]
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


def _first_line(path: Path) -> str:
    return next(iter(_lines(path)), "")
