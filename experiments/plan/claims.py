"""What questions may bear on: the claims of the published study, and those of a user's own."""

import tomllib
from pathlib import Path

from support.errors import InputError, nearest

CLAIMS = "claims.toml"
"""Beside questions: what is claimed of them. It is no question."""

PUBLISHED_CLAIMS = (
    "threads", "particles", "grid_length", "radius", "steps", "velocity", "machine", "four_boxes",
    "self_contained_checkered", "self_contained_sequential", "find_schedule", "resolve_schedule",
    "row_schedule", "row", "reverse", "compiler", "resolve_dominates",
)  # fmt: skip
"""Those of analysis/claims/claims.toml, in its order: a test there compares them."""


def require_claim(file: Path, claim: str) -> None:
    """Raises InputError unless the claim is a published one, or stands beside the question's file."""
    own = file.with_name(CLAIMS)
    known = [*PUBLISHED_CLAIMS, *(_claims_in(own) if own.exists() else ())]
    if claim not in known:
        expected = f"one of {', '.join(known)}{nearest(claim, known)}"
        raise InputError(f'{file}: claim: found "{claim}", expected {expected}')


def _claims_in(path: Path) -> list[str]:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        return [str(claim["id"]) for claim in content.get("claim", [])]
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise InputError(f"{path}: is not a list of claims, each with an id: {error}") from error
