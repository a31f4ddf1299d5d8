"""Claims that one choice is the better one: schedules, machines, compilers, and the phase that takes most."""

from math import exp
from pathlib import Path

import pytest

from analysis import claims
from analysis.claims.outcome import FAILS, HOLDS, IN_DIRECTION, OPEN, Verdict
from analysis.records import published
from analysis.tests.claims.judging import Records, figures, row_of
from analysis.tests.synthetic import Machine, Point, bench, write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study

# Schedules


def schedules(seconds: dict[tuple[str, int], float]) -> Records:
    return [
        bench("schedule_find", Point(kind, chunk, 1.0, "chunk",
              axes={"find_schedule": f"{kind}_chunk", "find_chunk": chunk, "threads": 8}), block,
              [second * (1 + block / 400 + chunk * (block % 2) / 1e5)], Machine())
        for (kind, chunk), second in seconds.items()
        for block in range(8)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("others", "verdict", "said"),
    [
        ((0.75, 0.80, 0.90), HOLDS, "none of 3 others"),
        ((0.72, 0.80, 0.90), HOLDS, ""),
        ((0.73, 0.73, 0.73), IN_DIRECTION, ""),
        ((0.725, 0.725, 0.725), FAILS, "does not matter which is chosen"),
        ((0.65, 0.80, 0.90), FAILS, "dynamic 10"),
    ],
)
def test_a_schedule_to_choose_is_beaten_by_none_and_better_than_the_average(
    tmp_path: Path, others: tuple[float, float, float], verdict: Verdict, said: str
) -> None:
    names = [("dynamic", 10), ("dynamic", 50), ("static", 80)]
    records = schedules({("guided", 4): 0.7276, **dict(zip(names, others, strict=True))})
    row = row_of(tmp_path, records, "find_schedule")
    assert row["verdict"] == verdict
    assert said in row["why"]
    assert figures(row)["fastest measured"][0] == "dynamic 10, 0.7204\u00a0s".replace("\u00a0", " ")


@pytest.mark.parametrize("claim", ["find_schedule", "resolve_schedule", "row_schedule"])
def test_the_effect_of_a_schedule_names_the_least_published_time(claim: str) -> None:
    entry = next(one for one in claims.load() if one.id == claim)
    times = published.load().experiment(entry.experiments[0])
    least = times.loc[times["seconds"].idxmin()]
    chosen = (entry.arguments["schedule"], entry.arguments["chunk"]) == (least["series"], least["x"])
    said = f"{least['seconds']:.3f}"[:-1]
    assert said in entry.published.effect
    assert chosen == ("the least of all" in entry.published.effect)
    assert chosen or f"{least['series']} with chunk {least['x']:g}" in entry.published.effect


# Machines


def test_machines_on_unequal_threads_are_not_ordered(tmp_path: Path) -> None:
    slow = Machine(host="a", cpu_model="Intel Xeon Silver 4114 CPU @ 2.20GHz")
    fast = Machine(host="b", cpu_model="13th Gen Intel(R) Core(TM) i7-13700")
    write(tmp_path, study(["machine"], machine=slow, noise=QUIET, threads=16))
    row = row_of(tmp_path, study(["machine"], machine=fast, noise=QUIET, speed=2, threads=8), "machine")
    assert row["verdict"] == OPEN
    assert "unequal numbers of threads: 8, 16" in row["why"]


def test_a_base_clock_in_a_name_stands_beside_no_greatest_clock(tmp_path: Path) -> None:
    known = Machine(host="a", cpu_model="13th Gen Intel(R) Core(TM) i7-13700")
    other = Machine(host="b", cpu_model="Some CPU @ 2.00GHz")
    write(tmp_path, study(["machine"], machine=known, noise=QUIET, threads=16))
    row = row_of(tmp_path, study(["machine"], machine=other, noise=QUIET, speed=0.5, threads=16), "machine")
    assert row["verdict"] == OPEN
    assert "a base clock in a name is none" in row["why"]
    assert "clock not known" in row["measured"]


@pytest.mark.parametrize(("count", "verdict"), [(2, FAILS), (3, OPEN)])
def test_pairs_of_machines_are_corrected_for_their_number(
    tmp_path: Path, count: int, verdict: Verdict
) -> None:
    # The second as much slower than the first as makes the p-value of its not being faster, alone, 0.035; the
    # third far faster.
    models = ["Xeon Silver 4114", "Xeon w5-3423", "Core i7-13700"][:count]
    for shift, model in zip((0, 0.0305, -1), models, strict=False):
        machine = Machine(host=model.split()[-1], cpu_model=model)
        point = Point("checkered", 0, 1.0, axes={"threads": 16})
        for block, scatter in enumerate([0.031, -0.031, 0.012, -0.012, 0.02, -0.02]):
            write(tmp_path, [bench("machine", point, block, [exp(scatter + shift)], machine)])
    assert row_of(tmp_path, [], "machine")["verdict"] == verdict


# Compilers


def compiled(times: dict[tuple[str, str], float]) -> Records:
    axes = {"threads": 20}
    return [
        bench("compiler", Point(f"{compiler} {runtime}", 0, 1.0, compiler=compiler, axes=axes), block,
              [seconds * (1 + block / 300)], Machine(runtime=runtime))
        for (compiler, runtime), seconds in times.items()
        for block in range(6)
    ]  # fmt: skip


GCC, GCC_LIBOMP, CLANG = ("g++ 12.2.0", "libgomp"), ("g++ 12.2.0", "libomp"), ("Clang 14.0.6", "libomp")


@pytest.mark.parametrize(
    ("times", "verdict", "said"),
    [
        ({GCC: 1.1, CLANG: 1.0}, OPEN, "g++'s code with the runtime of clang++"),
        ({GCC_LIBOMP: 1.1, CLANG: 1.0}, HOLDS, "with the same runtime"),
        ({GCC: 1.1, GCC_LIBOMP: 1.1, CLANG: 1.0}, HOLDS, "with the same runtime"),
        ({GCC: 1.1, GCC_LIBOMP: 1.0, CLANG: 1.0}, FAILS, "equivalent with the same runtime"),
        ({GCC: 1.0, GCC_LIBOMP: 1.1, CLANG: 1.0}, HOLDS, "with the same runtime"),
    ],
)
def test_compilers_are_compared_by_their_code_alone(
    tmp_path: Path, times: dict[tuple[str, str], float], verdict: Verdict, said: str
) -> None:
    row = row_of(tmp_path, compiled(times), "compiler")
    assert row["verdict"] == verdict
    assert said in row["why"]


def test_what_the_runtime_changes_is_told_beside_the_compilers(tmp_path: Path) -> None:
    row = row_of(tmp_path, compiled({GCC: 1.2, GCC_LIBOMP: 1.1, CLANG: 1.0}), "compiler")
    assert "the runtime alone: gcc (libgomp) against gcc (libomp): +9.1" in row["measured"]


# Phases


def profiled(find: float, resolve: float, search: float) -> Records:
    records = study(["phases"], noise=QUIET, threads=20)
    for record in records:
        walls = {"move": 0.02, "bin": 0.08, "find": find, "resolve": resolve}
        if record["axes"]["variant"] == "self_contained_off":
            walls["find"] = search
        for phase in record["profile"]["phases"]:
            phase["wall_seconds"] = walls[phase["phase"]] * (1 + record["tags"]["block"] / 1000)
    return records


@pytest.mark.parametrize(
    ("find", "resolve", "search", "verdict"),
    [
        (0.30, 0.60, 0.30, HOLDS),
        (0.40, 0.45, 0.30, HOLDS),
        (0.45, 0.45, 0.45, FAILS),
        (0.50, 0.50, 0.40, HOLDS),
        (0.45, 0.46, 0.44, FAILS),
        (0.40, 0.502, 0.30, HOLDS),
    ],
)
def test_most_of_the_time_is_more_than_half_of_it_early_resolves_included(
    tmp_path: Path, find: float, resolve: float, search: float, verdict: Verdict
) -> None:
    row = row_of(tmp_path, profiled(find, resolve, search), "resolve_dominates")
    assert row["verdict"] == verdict


def test_a_machine_of_two_speeds_does_not_hide_what_each_process_tells(tmp_path: Path) -> None:
    """The share of the later resolves is of one process; early ones are a difference of two."""
    records = profiled(0.3, 0.6, 0.3)
    for record in records:
        slow = (record["tags"]["block"] + len(record["axes"]["variant"])) % 2
        for phase in record["profile"]["phases"]:
            phase["wall_seconds"] *= 1 + slow
    row = row_of(tmp_path, records, "resolve_dominates")
    assert row["verdict"] == HOLDS
    assert "60\u00a0% of a step in resolve alone, without what is done early" in row["measured"]
    assert "the ratio to all the rest is 1.50 [1.50, 1.50]" in row["measured"]


def test_later_resolves_of_about_half_refute_nothing(tmp_path: Path) -> None:
    records = profiled(0.4, 0.5, 0.3)
    for record in records:
        odd = record["tags"]["block"] % 2
        for phase in record["profile"]["phases"]:
            if phase["phase"] == "resolve":
                phase["wall_seconds"] += 0.002 * odd - 0.0005
            elif phase["phase"] == "find" and record["axes"]["variant"] == "self_contained_off":
                phase["wall_seconds"] = 0.75 if odd else 0.25
    assert row_of(tmp_path, records, "resolve_dominates")["verdict"] == OPEN


def test_early_resolves_are_not_guessed(tmp_path: Path) -> None:
    records = [one for one in profiled(0.3, 0.6, 0.3) if one["axes"]["variant"] != "self_contained_off"]
    row = row_of(tmp_path, records, "resolve_dominates")
    assert row["verdict"] == OPEN
    assert "of the variant self_contained_off" in row["why"]
