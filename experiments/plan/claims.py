"""What questions may bear on: the claims of the published study, and those of a user's own."""

import tomllib
from pathlib import Path

from support.errors import InputError

CLAIMS = "claims.toml"
"""Beside questions: what is claimed of them. It is no question."""

PUBLISHED_CLAIMS = (
    "threads", "particles", "grid_length", "radius", "steps", "velocity", "machine", "four_boxes",
    "self_contained_checkered", "self_contained_sequential", "find_schedule", "resolve_schedule",
    "row_schedule", "row", "reverse", "compiler", "resolve_dominates",
)  # fmt: skip
"""Those of analysis/claims/claims.toml, in its order: a test there compares them."""

LARGE_SCALE_CLAIMS = ("threads", "velocity", "machine", "row")
"""Those of them that no quick study decides: a test there compares them, too."""


def known_claims(file: Path) -> list[str]:
    """The published claims, and those that stand beside a question's file. Raises InputError for a list of
    claims that is none.
    """
    own = file.with_name(CLAIMS)
    try:
        content = tomllib.loads(own.read_text(encoding="utf-8")) if own.exists() else {}
        return [*PUBLISHED_CLAIMS, *(str(claim["id"]) for claim in content.get("claim", []))]
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise InputError(f"{own}: is not a list of claims, each with an id: {error}") from error
