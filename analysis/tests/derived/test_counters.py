import pandas as pd
import pytest

from analysis.derived.counters import derived

WORK = {"experiment": "phases", "series": "checkered", "particles": 1000, "steps": 10, "substeps": 1}


def table(source: str, values: dict[str, list[float | None]], file: str = "a") -> pd.DataFrame:
    return pd.DataFrame(
        [
            {**WORK, "file": file, "source": source, "name": name, "thread": thread, "value": value}
            for name, threads in values.items()
            for thread, value in enumerate(threads)
        ]
    )


def quantities(rows: pd.DataFrame) -> dict[str, float]:
    return derived(rows).set_index("quantity")["value"].to_dict()


def test_threads_are_summed_and_set_against_the_work() -> None:
    found = quantities(
        table(
            "papi-hardware",
            {"PAPI_TOT_INS": [3e6, 1e6], "PAPI_TOT_CYC": [1e6, 1e6], "PAPI_L3_TCM": [1e4, 1e4]},
        )
    )
    assert found == {
        "instructions per cycle": pytest.approx(2.0),
        "instructions per disc and step": pytest.approx(400),
        "last-level misses per disc and step": pytest.approx(2),
        "bytes from memory per disc and step": pytest.approx(128),
    }


def test_a_thread_without_a_value_gives_no_quantity() -> None:
    assert quantities(table("papi-software", {"perf::TASK-CLOCK": [1e9, None]})) == {}


def test_the_kernels_generic_events_stand_in_for_presets() -> None:
    rows = table(
        "papi-hardware", {"PAPI_TOT_INS": [None], "perf::INSTRUCTIONS": [6e6], "perf::CYCLES": [2e6]}
    )
    assert quantities(rows)["instructions per cycle"] == pytest.approx(3.0)


def test_a_simulation_counts_its_own_steps() -> None:
    found = quantities(
        table(
            "cachegrind",
            {"instructions": [8e6], "l1_read_misses": [3e3], "l1_write_misses": [1e3], "steps": [2]},
        )
    )
    assert found["instructions per disc and step"] == pytest.approx(4000)
    assert found["L1 data misses per disc and step"] == pytest.approx(2)


def test_sources_are_never_mixed() -> None:
    rows = pd.concat(
        [table("papi-software", {"perf::PAGE-FAULTS": [100]}), table("rusage", {"minor_page_faults": [200]})]
    )
    found = derived(rows).set_index("source")
    assert found.loc["papi-software", "value"] == 10
    assert found.loc["rusage", "value"] == 20


def test_several_runs_give_a_median_and_their_range() -> None:
    rows = pd.concat(
        table("papi-software", {"perf::TASK-CLOCK": [nanoseconds]}, file)
        for file, nanoseconds in (("a", 1e6), ("b", 2e6), ("c", 9e6))
    )
    (row,) = derived(rows).to_dict("records")
    assert (row["least"], row["value"], row["greatest"], row["runs"]) == (100, 200, 900, 3)
