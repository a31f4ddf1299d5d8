"""Names made from content."""

import hashlib
from collections.abc import Sequence


def digest(text: str) -> str:
    """The first 16 hexadecimal digits of a text's SHA-256: a short name that no two texts share by chance."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def digest_of_hashes(hashes: Sequence[str]) -> str:
    """One SHA-256 for several files: that of the only one, or else of all of their hashes in a row."""
    return hashes[0] if len(hashes) == 1 else hashlib.sha256("".join(hashes).encode()).hexdigest()
