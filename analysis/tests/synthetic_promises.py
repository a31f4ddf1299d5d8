"""Synthetic records of promised errors."""

from typing import Any

from analysis.tests.synthetic import record


def promises(beside: dict[str, Any], broken: str = "") -> dict[str, Any]:
    """Return the record of promises on the scene of another record: three bounds of each error, all kept but
    those of the measure `broken`, the one for 0.01 at twice the least cost.
    """

    def run(variant: str, seconds: float, error: float) -> dict[str, Any]:
        return {"variant": variant, "substeps": 4, "seconds": seconds, "error": error}

    kept = [
        {
            "measure": measure,
            "error_below": bound,
            "promised": 0.9 * bound,
            "trial_seconds": 0.2,
            "methods": 29,
            "chosen": run("published", 0.02, (2.0 if measure == broken else 0.5) * bound),
            "cheapest": run("nine", 0.01 if bound == 0.01 else 0.02, 0.8 * bound),
        }
        for measure in ("path", "collision_rate", "pressure")
        for bound in (0.1, 0.01, 0.001)
    ]
    tags = beside["tags"]
    return record("promises", {**tags, "point": f"promises-{tags['scene_name']}"}) | {
        "axes": {"threads": beside["axes"]["threads"]},
        "scene": beside["scene"],
        "promises": kept,
        "process_seconds": 3.0,
        "provenance": beside["provenance"],
    }
