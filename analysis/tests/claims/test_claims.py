"""Each claim is tested as it was made: on its threads, its scale, its sizes, and where its effect is."""

import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from analysis import claims
from analysis.claims import missing
from analysis.claims.entry import Evidence
from analysis.claims.outcome import FAILS, HOLDS, IN_DIRECTION, OPEN, Verdict
from analysis.records import published
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.claims.judging import Records, figures, row_of, verdicts_of
from analysis.tests.synthetic import Machine, Point, bench, failure, write
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_points import EXPERIMENTS
from analysis.tests.synthetic_study import slowed, study

IDS = [
    "threads", "particles", "grid_length", "radius", "steps", "velocity", "machine", "four_boxes",
    "self_contained_checkered", "self_contained_sequential", "find_schedule", "resolve_schedule",
    "row_schedule", "row", "reverse", "compiler", "resolve_dominates",
]  # fmt: skip
ELSEWHERE, FAILS_ELSEWHERE = Verdict.HOLDS_ELSEWHERE, Verdict.FAILS_ELSEWHERE
IN_DIRECTION_ELSEWHERE = Verdict.IN_DIRECTION_ELSEWHERE
XEON, I7 = "Intel Xeon Silver 4114 CPU @ 2.20GHz", "13th Gen Intel(R) Core(TM) i7-13700"


# Records, each of one claim


def on(*names: str, **more: Any) -> Records:  # noqa: ANN401
    return study(names, **{"noise": QUIET, "threads": 20, **more})


def boxes(factor: float, **more: Any) -> Records:  # noqa: ANN401
    """Four boxes, which are 4.8 % faster than nine, by a factor slower."""
    return slowed(on("neighbourhood", **{"blocks": 21, **more}), factor, series="four")


def at_margin(margin: float) -> Records:
    return [one | {"tags": one["tags"] | {"margin": margin}} for one in on("neighbourhood")]


def never_at_one_size() -> Records:
    return [one for one in on("row") if (one["tags"]["x"] > 50_000) == (one["tags"]["series"] == "row")]


def velocities(seconds: dict[str, dict[int, float]]) -> Records:
    axes = {"threads": 20}
    return [
        bench(name, Point("checkered", x, 1.0, name, axes=axes), block, [second + block / 500], Machine())
        for name, curve in seconds.items()
        for x, second in curve.items()
        for block in range(6)
    ]  # fmt: skip


RISING = {1: 1.0, 5: 1.1, 25: 1.3, 45: 1.5, 50: 0.7}
FALLING = {1: 1.5, 5: 1.4, 25: 1.2, 45: 1.0, 50: 9.0}


def threads(cores: int, hardware: int, **slow: float) -> Records:
    records = study(
        ["threads"], machine=Machine(cores=cores, hardware_threads=hardware), noise=QUIET, blocks=9
    )
    return slowed(records, slow.get("first", 1.0), x=1)


def bound_otherwise() -> Records:
    records = threads(2, 4)
    for record in records:
        if record["axes"]["threads"] > 2:
            record["provenance"]["openmp"]["proc_bind"] = "false"
    return records


def machines(*told: tuple[str, float, int]) -> Records:
    """The same scene on machines of these processors, so many times as fast, on so many threads."""
    return [
        record
        for number, (cpu, speed, threads) in enumerate(told)
        for record in study(["machine"], machine=Machine(host=f"h{number}", cpu_model=cpu), noise=QUIET,
                            speed=speed, threads=threads)
    ]  # fmt: skip


def schedules(*others: float) -> Records:
    """Guided with a chunk of 4 takes 0.7276 s, the others so long."""
    names = [("dynamic", 10), ("dynamic", 50), ("static", 80)]
    seconds = {("guided", 4): 0.7276, **dict(zip(names, others, strict=True))}
    return [
        bench("schedule_find", Point(kind, chunk, 1.0, "chunk",
              axes={"find_schedule": f"{kind}_chunk", "find_chunk": chunk, "threads": 8}), block,
              [second * (1 + block / 400 + chunk * (block % 2) / 1e5)], Machine())
        for (kind, chunk), second in seconds.items()
        for block in range(8)
    ]  # fmt: skip


def compiled(gcc: float | None, clang: float) -> Records:
    """The times of the code of g++ and of clang++."""
    return [
        bench("compiler", Point(compiler, 0, 1.0, compiler=compiler, axes={"threads": 20}),
              block, [seconds * (1 + block / 300)], Machine(runtime="libomp"))
        for compiler, seconds in (("g++ 12.2.0", gcc), ("Clang 14.0.6", clang))
        if seconds
        for block in range(6)
    ]  # fmt: skip


def profiled(find: float, resolve: float, search: float, speeds: tuple[float, ...] = (1.0,)) -> Records:
    """Profiles of a step with early resolves, and without, where finding takes `search`; a machine of these
    speeds in turn, by block and variant.
    """
    records = on("phases")
    for record in records:
        walls = {"move": 0.02, "bin": 0.08, "find": find, "resolve": resolve}
        if record["axes"]["variant"] == "self_contained_off":
            walls["find"] = search
        speed = speeds[(record["tags"]["block"] + len(record["axes"]["variant"])) % len(speeds)]
        for phase in record["profile"]["phases"]:
            phase["wall_seconds"] = walls[phase["phase"]] * (1 + record["tags"]["block"] / 1000) * speed
    return records


def about_half() -> Records:
    records = profiled(0.4, 0.5, 0.3)
    for record in records:
        odd = record["tags"]["block"] % 2
        for phase in record["profile"]["phases"]:
            if phase["phase"] == "resolve":
                phase["wall_seconds"] += 0.002 * odd - 0.0005
            elif phase["phase"] == "find" and record["axes"]["variant"] == "self_contained_off":
                phase["wall_seconds"] = 0.75 if odd else 0.25
    return records


def without_early() -> Records:
    return [one for one in profiled(0.3, 0.6, 0.3) if one["axes"]["variant"] != "self_contained_off"]


SEEDS = (1, 2, 3, 4, 5, 6)
REVERSE, FORWARD = [1500, 1510, 1490, 1505, 1495, 1500], [2000, 2010, 1990, 1980, 2020, 2000]


def attempts(
    reverse: list[int], forward: list[int], resolves: tuple[int, int] = (1000, 1000), scale: str = "paper"
) -> Records:
    """Attempts of each direction by seed; reverse is the slower one."""
    sides = (("reverse", reverse, resolves[0], 1.2), ("forward", forward, resolves[1], 1.0))
    points = [
        Point(direction, seed, seconds, "seed", axes={"direction": direction}, pair_resolves=resolved,
              pair_attempts=count)
        for direction, counts, resolved, seconds in sides
        for seed, count in zip(SEEDS, counts, strict=False)
    ]  # fmt: skip
    return [
        bench("reverse", point, block, [point.seconds * (1 + block / 1000)], Machine(), scale=scale)
        for point in points
        for block in range(3)
    ]


CASES: list[tuple[str, Callable[[], Records], str, Verdict, dict[str, str]]] = [
    # on other threads, at other scales
    ("as made", lambda: boxes(1.0), "four_boxes", HOLDS, {"said": "holds"}),
    ("on 2", lambda: boxes(1.0, threads=2), "four_boxes", ELSEWHERE,
     {"said": "holds at 2 threads (claimed at 20)"}),
    ("in direction on 2", lambda: boxes(1.04, threads=2), "four_boxes", IN_DIRECTION_ELSEWHERE,
     {"said": "holds in direction at 2 threads (claimed at 20)"}),
    ("slower on 1", lambda: boxes(1.2, threads=1), "four_boxes", FAILS_ELSEWHERE,
     {"said": "does not hold at 1 thread (claimed at 20)"}),
    ("quick on 2", lambda: boxes(1.0, scale="quick", threads=2), "four_boxes", ELSEWHERE,
     {"said": "holds at quick scale, at 2 threads (claimed at 20)", "why": "24 rows"}),
    ("no scale", lambda: on("neighbourhood", scale="unstated"), "four_boxes", Verdict.OTHER_SCALE,
     {"said": "cannot be decided at unstated scale", "why": "24 rows", "measured": "["}),
    ("quick threads", lambda: on("threads", scale="quick"), "threads", Verdict.OTHER_SCALE,
     {"said": "cannot be decided at quick scale", "measured": "["}),
    ("its own margin", lambda: at_margin(0.1), "four_boxes", IN_DIRECTION,
     {"measured": "(faster, but by less than 10 %)"}),
    ("noise", lambda: boxes(1.25 / 1.19, blocks=14, noise=Noise(process=0.05)), "four_boxes", OPEN,
     {"measured": "14 blocks", "why": "more blocks"}),
    # where its effect is
    ("150 rows", lambda: on("row", threads=8), "row", HOLDS, {}),
    ("never alike", never_at_one_size, "row", OPEN, {"why": "of row and checkered at the same particles"}),
    # trends
    ("equal velocities",
     lambda: velocities({"min_velocity": RISING, "max_velocity": {**RISING, 1: 9.0, 50: 1.6}}),
     "velocity", HOLDS, {"measured": "(without the degenerate min_velocity = 50)"}),
    ("slow ends",
     lambda: velocities({"min_velocity": FALLING, "max_velocity": {1: 0.1, 5: 1.0, 25: 1.2, 50: 1.5}}),
     "velocity", FAILS, {"measured": "(without the degenerate max_velocity = 1)"}),
    ("another radius", lambda: slowed(on("radius"), 0.7, x=25), "radius", FAILS, {"why": "radius 25"}),
    ("within the margin", lambda: slowed(on("radius"), 1 / 0.99, x=35), "radius", HOLDS, {}),
    ("no such radius", lambda: [one for one in on("radius") if one["tags"]["x"] != 35], "radius", OPEN,
     {"why": "needs radius = 35"}),
    # threads
    ("no more threads", lambda: threads(2, 2), "threads", OPEN, {"why": "more hardware threads than cores"}),
    ("not faster", lambda: threads(8, 16, first=0.32), "threads", FAILS, {"why": "expected faster"}),
    ("binding", bound_otherwise, "threads", OPEN, {"why": "binding changes"}),
    ("too fast", lambda: threads(2, 4, first=2.0), "threads", HOLDS,
     {"measured": "is doubtful, the cores give 2.00 at most"}),
    # machines
    ("clock", lambda: machines((XEON, 1.0, 16), (I7, 1.5, 16)), "machine", HOLDS, {"measured": "5.1 GHz"}),
    ("equal", lambda: machines((XEON, 1.0, 16), (I7, 1.0, 16)), "machine", FAILS, {"measured": "3.0 GHz"}),
    ("unequal", lambda: machines((XEON, 1.0, 16), (I7, 2.0, 8)), "machine", OPEN,
     {"why": "unequal numbers of threads: 8, 16"}),
    ("base clock", lambda: machines((I7, 1.0, 16), ("Some CPU @ 2.00GHz", 0.5, 16)), "machine", OPEN,
     {"why": "a base clock in a name is none", "measured": "clock not known"}),
    ("one of two is not faster",
     lambda: machines((XEON, 1.0, 16), ("Xeon w5-3423", 2.0, 16), (I7, 1.5, 16)), "machine", FAILS, {}),
    # schedules
    ("best", lambda: schedules(0.75, 0.80, 0.90), "find_schedule", HOLDS, {"why": "none of 3 others"}),
    ("as good", lambda: schedules(0.72, 0.80, 0.90), "find_schedule", HOLDS, {}),
    ("hardly better", lambda: schedules(0.73, 0.73, 0.73), "find_schedule", IN_DIRECTION, {}),
    ("all alike", lambda: schedules(0.725, 0.725, 0.725), "find_schedule", FAILS,
     {"why": "does not matter which is chosen"}),
    ("beaten", lambda: schedules(0.65, 0.80, 0.90), "find_schedule", FAILS, {"why": "dynamic 10"}),
    # compilers
    ("one alone", lambda: compiled(None, 1.0), "compiler", OPEN, {"why": "compiler_family = gcc"}),
    ("quicker code", lambda: compiled(1.1, 1.0), "compiler", HOLDS, {"measured": "clang against gcc: −9.1"}),
    ("alike in code", lambda: compiled(1.0, 1.0), "compiler", FAILS, {"measured": "equivalent"}),
    # phases: finding, resolving, finding without early resolves
    ("with early", lambda: profiled(0.40, 0.45, 0.30), "resolve_dominates", HOLDS, {}),
    ("with early, one process disturbed", lambda: profiled(0.4, 0.45, 0.3, (*[1] * 21, 10, *[1] * 9)),
     "resolve_dominates", OPEN, {"measured": "rest is 1.38"}),
    ("half", lambda: profiled(0.45, 0.45, 0.45), "resolve_dominates", FAILS, {}),
    ("hardly more", lambda: profiled(0.40, 0.502, 0.30), "resolve_dominates", HOLDS, {}),
    ("two speeds hide nothing that a process tells",
     lambda: profiled(0.3, 0.6, 0.3, (1, 2)), "resolve_dominates", HOLDS,
     {"measured": "alone, without what is done early in find; the ratio to all the rest is 1.50 [1.50"}),
    ("about half", about_half, "resolve_dominates", OPEN, {}),
    ("no early", without_early, "resolve_dominates", OPEN, {"why": "of the variant self_contained_off"}),
    # counts
    ("fewer attempts", lambda: attempts(REVERSE, FORWARD), "reverse", HOLDS,
     {"measured": "; +20.0 % [+20.0 %, +20.0 %] of time"}),
    ("fewer, quick", lambda: attempts(REVERSE, FORWARD, scale="quick"), "reverse", HOLDS,
     {"measured": "over 6 seeds: −50.0 % [−51.1 %, −48.9 %] of wasted attempts (fewer)"}),
    ("the same waste",
     lambda: attempts(REVERSE, [one + 100 for one in REVERSE], (1000, 1100)), "reverse", FAILS,
     {"measured": "of pair resolves (fewer)"}),
    ("one seed", lambda: attempts(REVERSE[:1], FORWARD[:1]), "reverse", OPEN,
     {"why": "rests on 1 seed: a verdict needs at least 6"}),
    ("seeds disagree", lambda: attempts([1220, 1700, 1300, 1650, 1250, 1600], [1500] * 6), "reverse", OPEN,
     {"why": "more seeds"}),
    # what failed
    ("failed",
     lambda: [*on("grid_length", blocks=4), failure("grid_length", "checkered", "step 3")], "grid_length",
     OPEN,
     {"why": "1 process failed and left no time"}),
]  # fmt: skip
"""What it is about, the records, the claim, its verdict, and what is said."""


@pytest.mark.parametrize(
    ("made", "claim", "verdict", "told"), [one[1:] for one in CASES], ids=[one[0] for one in CASES]
)
def test_a_claim_is_judged_as_it_was_made(
    tmp_path: Path, made: Callable[[], Records], claim: str, verdict: Verdict, told: dict[str, str]
) -> None:
    row = row_of(tmp_path, made(), claim)
    assert row["verdict"] == verdict
    for key, said in told.items():
        found = str(row[key]).replace("\\xa0", " ").replace("\u00a0", " ")
        assert found == said if key == "said" else said in found, key


def test_every_published_claim_has_its_row_and_its_verdict(data: Evidence) -> None:
    table = claims.evaluate(data).set_index("id")
    assert list(table.index) == IDS
    assert table.loc["machine", "verdict"] == OPEN
    assert "only one is present" in table.loc["machine", "why"]
    verdicts = table["verdict"].drop("machine")
    without_threads = [one.id for one in claims.load() if one.published.threads is None]
    assert without_threads == ["threads", "reverse"]
    assert verdicts[without_threads].eq(HOLDS).all()
    assert verdicts.drop(without_threads).eq(ELSEWHERE).all()
    assert table["measured"].drop("machine").str.contains(r"\[").all()


def test_the_study_s_figures_stand_beside_ours(tmp_path: Path) -> None:
    named = on("neighbourhood", "particles", "threads", "schedule_find")
    write(tmp_path, named)
    rows = verdicts_of(tmp_path)
    plain = {name: {what: [one.replace("\u00a0", " ") for one in both] for what, both in figures(row).items()}
             for name, row in rows.iterrows()}  # fmt: skip
    scene = "100 000 discs of radius 16, side 10 000, 100 steps"
    assert plain["four_boxes"]["scene"] == [scene, scene]
    assert plain["four_boxes"]["tolerance"] == ["published", "relative"]
    assert plain["four_boxes"]["threads"] == ["20", "20"]
    assert plain["four_boxes"]["four against nine"][0] == "−4.6 %"
    assert plain["particles"]["particles"][0] == "+467 %"
    assert plain["particles"]["particles"][1].startswith("+42")
    assert plain["threads"]["up to the cores"][0] == "−82.2 %"
    assert plain["threads"]["beyond"][0] == "+215 %"
    assert plain["find_schedule"]["best other"][0] == "−1.0 %"
    assert plain["find_schedule"]["against the others"][0].startswith("−")
    assert rows.loc["four_boxes", ["claimed_threads", "tested_threads"]].tolist() == [(20,), (20,)]


@pytest.mark.parametrize("measured", ["steps", "compiler"])
def test_without_its_records_a_claim_is_open_and_says_so(tmp_path: Path, measured: str) -> None:
    write(tmp_path, study([measured], blocks=2, noise=QUIET))
    table = verdicts_of(tmp_path)
    lacking = table[[measured not in names for names in table["experiments"]]]
    assert len(lacking) == len(IDS) - 1
    assert set(EXPERIMENTS) >= {name for names in table["experiments"] for name in names}
    assert (lacking["verdict"] == OPEN).all()
    assert lacking["missing"].all()
    assert not lacking["figures"].any()
    assert lacking["why"].str.contains("no records yet").all()


def test_the_command_that_would_settle_a_claim_names_the_folder_of_its_question(tmp_path: Path) -> None:
    write(tmp_path, study(["neighbourhood"], blocks=2))
    (measured,) = split(load(tmp_path))
    (claim,) = (replace(one, questions="my questions") for one in claims.load() if one.id == "four_boxes")
    command = "`make experiments STUDY=neighbourhood QUESTIONS='my questions' BUDGET="
    assert command in missing.said(measured, claim, 10, 20)


def test_a_machine_speaks_with_the_records_of_the_revision_that_is_judged(tmp_path: Path) -> None:
    for machine, speed in (
        (Machine(host="a", cpu_model=XEON, commit="0" * 40), 4.0),
        (Machine(host="a", cpu_model=XEON, commit="1" * 40), 1.0),
        (Machine(host="b", cpu_model=I7), 2.0),
    ):
        folder = tmp_path / "records" / f"{machine.host}{machine.commit[0]}"
        write(folder, study(["machine"], machine=machine, noise=QUIET, speed=speed, threads=16))
    verdicts = {}
    for one in claims.evidence_of(tmp_path):
        table = claims.evaluate(one).set_index("id")
        verdicts[one.study.machine[0], one.study.revision[0]] = table.loc["machine", "verdict"]
    assert (verdicts["a", "0"], verdicts["a", "1"]) == (FAILS, HOLDS)


def test_attempts_that_were_not_counted_are_no_zero(tmp_path: Path) -> None:
    write(tmp_path, attempts(REVERSE, FORWARD))
    [evidence] = claims.evidence_of(tmp_path)
    evidence.study.runs["pair_attempts"] = float("nan")  # as it is of whole processes
    row = claims.evaluate(evidence).set_index("id").loc["reverse"]
    assert row["verdict"] == OPEN
    assert "not counted" in row["why"]


def test_the_claimed_threads_and_machines_are_those_of_the_published_times() -> None:
    content = tomllib.loads(published.PUBLISHED_FILE.read_text(encoding="utf-8"))["experiments"]
    for claim in claims.load():
        for name in claim.experiments:
            table = content.get(name, {})
            assert claim.published.threads == table.get("threads", claim.published.threads), claim.id
            assert claim.published.machine == table.get("machine", claim.published.machine), claim.id


def test_every_claim_says_what_the_study_measured_and_where_it_may_be_decided() -> None:
    for claim in claims.load():
        assert claim.published.effect
        assert set(claim.scales) <= {"paper", "quick"}
        assert claim.other_scales


@pytest.mark.parametrize("claim", ["find_schedule", "resolve_schedule", "row_schedule"])
def test_the_effect_of_a_schedule_names_the_least_published_time(claim: str) -> None:
    entry = next(one for one in claims.load() if one.id == claim)
    times = published.load().experiment(entry.experiments[0])
    least = times.loc[times["seconds"].idxmin()]
    chosen = (entry.arguments["schedule"], entry.arguments["chunk"]) == (least["series"], least["x"])
    assert f"{least['seconds']:.3f}"[:-1] in entry.published.effect
    assert chosen == ("the least of all" in entry.published.effect)
    assert chosen or f"{least['series']} with chunk {least['x']:g}" in entry.published.effect
