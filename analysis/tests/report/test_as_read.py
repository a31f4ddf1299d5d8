"""The report as a person reads it: what was asked first, places that links lead to, words that agree."""

import re
from pathlib import Path

import pytest

from analysis import claims, report
from analysis.cli import main
from analysis.report import graphs
from analysis.tests.report.test_report import Page, text_of
from analysis.tests.synthetic import Machine, failure, write
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_study import page_of, slowed, study, under

ROOT = Path(__file__).parents[3]


def nav_of(page: str) -> str:
    return page[page.index("<nav>") : page.index("</nav>")]


def rows_of(page: str) -> list[str]:
    """The first cell of each claim."""
    table = page[page.index('<table class="claims">') :] if '<table class="claims">' in page else ""
    return re.findall(r'<span class="id">(\w+)', table)


def test_what_was_asked_leads(tmp_path: Path) -> None:
    """A published question and one of one's own."""
    records = under("mine", study(["sequential_orders"], blocks=6, noise=QUIET), title="My orders")
    names = ["radius", "steps", "neighbourhood", "control"]
    write(tmp_path, [*records, *study(names, blocks=6, noise=QUIET)])
    page = page_of(tmp_path, ["neighbourhood", "mine"])
    places = [Page(page).ids.index(one) for one in ("neighbourhood", "mine", "study-1-claims", "steps")]
    assert places == sorted(places)
    links = [nav_of(page).index(f'"#{one}"') for one in ("neighbourhood", "mine", "study-1-claims")]
    assert links == sorted(links)
    assert "My orders" in nav_of(page)
    assert rows_of(page) == ["four_boxes", "radius", "steps"]
    assert "14 claims have no records yet, and no verdict: threads, particles" in text_of(page)
    unasked = page_of(tmp_path)
    ids = ("study-1-claims", "radius", "steps", "neighbourhood", "mine")
    places = [Page(unasked).ids.index(one) for one in ids]
    assert places == sorted(places)
    assert rows_of(unasked) == ["radius", "steps", "four_boxes"]


def test_a_study_that_has_what_was_asked_comes_first(tmp_path: Path) -> None:
    write(tmp_path, study(["steps"], blocks=3))
    write(tmp_path, study(["radius"], blocks=2, scale="quick", machine=Machine(host="bench-2")))
    headings = r"<h2>([^<]*scale[^<]*)</h2>"
    assert "paper scale" in re.findall(headings, page_of(tmp_path))[0]
    assert "quick scale" in re.findall(headings, page_of(tmp_path, ["radius"]))[0]


def test_the_contents_name_every_question_and_claims_lead_to_their_figures(page: str) -> None:
    links = set(re.findall(r'href="#([^"]+)"', nav_of(page)))
    assert {"control", "threads", "machine", "part-hard_cases", "ladder", "part-phases"} <= links
    assert "part-speed_against_error-path" in links
    table = page[page.index('<table class="claims">') : page.index('id="study-1-machine"')]
    for claim in claims.load():
        cell = table[table.index(f'<span class="id">{claim.id}') :]
        told = set(re.findall(r'href="#([^"]+)"', cell[: cell.index("</td>")]))
        assert len(told) == len(claim.experiments), claim.id
        assert told <= set(Page(page).ids)


def test_every_published_graph_has_its_place(page: str) -> None:
    section = page[page.index('<section id="graphs">') : page.index('<section id="method">')]
    for graph in graphs.load():
        assert f"<td>{graph.name}</td><td>{graph.showed}</td>" in section
        for question in graph.questions:
            assert f'<a href="#{question}">' in section


def test_a_graph_that_was_not_measured_has_its_command(tmp_path: Path) -> None:
    write(tmp_path, study(["steps"], blocks=2, scale="quick"))
    text = text_of(page_of(tmp_path))
    assert "Radius ( make experiments STUDY=radius SCALE=quick )" in text


def test_the_table_of_graphs_is_the_one_of_the_readme() -> None:
    readme = (ROOT / "analysis" / "README.md").read_text(encoding="utf-8")
    files = {path.stem for path in (ROOT / "experiments" / "questions").glob("*.toml")}
    for graph in graphs.load():
        assert set(graph.questions) <= files
        links = ", ".join(f"[{name}](../experiments/questions/{name}.toml)" for name in graph.questions)
        assert f"| {graph.name} | {graph.showed} | {links} |\n" in readme


def test_make_appendix_asks_what_the_table_says() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    (study_of,) = re.findall(r"^graphs := (\S+)$", makefile, re.MULTILINE)
    asked = [name for graph in graphs.load() if graph.appendix for name in graph.questions]
    assert study_of.split(",") == list(dict.fromkeys(asked))


def test_all_time_and_what_differs_stand_in_the_table_of_verdicts(tmp_path: Path) -> None:
    write(tmp_path, study(["neighbourhood"], blocks=6, noise=QUIET))
    text = text_of(page_of(tmp_path))
    head = "Difference, with 95 % interval All time together One start, one round differ by From Verdict"
    row = r"four boxes against nine boxes −4\.5 % \[[^]]+\] −4\.[0-9] % (–|\S+ %, \S+ %) 6 blocks"
    assert re.search(f"{head} {row}", text)


def test_the_box_on_noise_agrees_with_the_verdicts(tmp_path: Path) -> None:
    noisy = Noise(process=0.03, repetition=0, burst_rate=0, drift=0)
    far, near = (study([name], blocks=14, noise=noisy) for name in ("self_contained_track", "neighbourhood"))
    write(tmp_path, [*far, *slowed(near, 1.19 / 1.25, series="nine")])
    page = page_of(tmp_path)
    box = re.search(r'<p class="warning">(.*?)</p>', page, re.DOTALL)
    assert box is not None
    assert "in 1 of 2 experiments about small ones: neighbourhood." in box[1]
    said = dict(
        re.findall(r"<tr><td>(\w+)</td>(?:<td class=\"number\">[^<]*</td>\s*){4}<td>([^<]*)</td>", page)
    )
    assert said == {
        "neighbourhood": "too few for small differences",
        "self_contained_track": "settled all the same",
    }


def test_a_report_of_a_study_that_goes_on_says_when_and_how_far(tmp_path: Path) -> None:
    write(tmp_path, study(["steps"], blocks=2))
    how_far = "20 of 80 processes done, about 12 min left"
    assert report.write(tmp_path, ["steps"], how_far) == tmp_path / "report.html"
    text = text_of((tmp_path / "report.html").read_text(encoding="utf-8"))
    told = r"the study goes on: this is what it had at \d{4}-\d\d-\d\d \d\d:\d\d UTC, 20 of 80 processes done"
    assert re.search(told, text)
    assert {path.suffix for path in (tmp_path / "figures").iterdir()} == {".svg"}
    assert main(["report", "--results", str(tmp_path)]) == 0
    assert "goes on" not in text_of((tmp_path / "report.html").read_text(encoding="utf-8"))


def test_a_question_without_records_that_is_to_lead_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", "--results", str(tmp_path), "--study", "thraeds,control"]) == 0
    told = [f"study: found no records of {name}, which does not lead" for name in ("thraeds", "control")]
    assert [line.removesuffix(" the report") for line in capsys.readouterr().err.splitlines()] == told


def test_the_commands_to_repeat_it_name_the_questions_and_the_scale(tmp_path: Path) -> None:
    write(tmp_path, study(["steps", "control"], blocks=2, scale="quick"))
    write(tmp_path, [failure("compiler", "clang++", "is not built", scale="quick")])
    assert "make experiments STUDY=compiler,steps SCALE=quick\n" in page_of(tmp_path)
