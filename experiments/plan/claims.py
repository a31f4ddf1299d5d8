"""What questions may bear on: the claims of the published study, and those of a user's own."""

import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from support.errors import InputError
from support.home import ROOT

CLAIMS = "claims.toml"
"""Beside questions: what is claimed of them. It is no question."""


@cache
def published_claims() -> Mapping[str, frozenset[str]]:
    """The claims of the study, with the scales at which the question of each can be settled."""
    found = _claims(ROOT / "analysis" / "claims" / CLAIMS)
    return {one["id"]: frozenset((*one["scales"], *one.get("smaller_scales", ()))) for one in found}


def known_claims(file: Path) -> list[str]:
    """The published claims, and those that stand beside a question's file. Raises InputError for a list of
    claims that is none.
    """
    own = file.with_name(CLAIMS)
    try:
        found = _claims(own) if own.exists() else []
        return [*published_claims(), *(str(claim["id"]) for claim in found)]
    except (OSError, ValueError, TypeError, KeyError) as error:
        raise InputError(f"{own}: is not a list of claims, each with an id: {error}") from error


def _claims(file: Path) -> list[dict[str, Any]]:
    claims: list[dict[str, Any]] = tomllib.loads(file.read_text(encoding="utf-8")).get("claim", [])
    return claims
