"""Names made from content."""

import hashlib


def digest(text: str) -> str:
    """The first 16 hexadecimal digits of a text's SHA-256: a short name that no two texts share by chance."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
