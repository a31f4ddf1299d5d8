"""What is read first: sentences about verdicts, the figure of all claims, and what stands beside it."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from analysis import claims
from analysis.claims import evidence_of
from analysis.claims.summary import both_in_short, change_in_short, published_in_short
from analysis.cli import main
from analysis.figures import titles
from analysis.report import answers
from analysis.report.all_claims import LOWEST, NARROW, WIDE, Layout, all_claims, draw
from analysis.statistics.verdicts import Ratio
from analysis.tests.report.test_as_read import nav_of
from analysis.tests.report.test_report import Page, text_of
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import page_of, slowed, study, under


@pytest.fixture(scope="module")
def refuted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four boxes are slower than nine; of radius there are too few blocks; steps are as published."""
    folder = tmp_path_factory.mktemp("refuted")
    records = study(["neighbourhood", "steps", "control"], blocks=9, noise=QUIET)
    write(folder, [*slowed(records, 1.12, series="four"), *study(["radius"], blocks=3, noise=QUIET)])
    return folder


@pytest.fixture(scope="module")
def refuted_page(refuted: Path) -> str:
    return page_of(refuted)


def first_screen_of(page: str) -> str:
    return text_of(page[page.index('<div class="first">') : page.index("<nav>")]).replace("\u00a0", " ")


def test_a_sentence_for_each_verdict_what_does_not_hold_first(refuted_page: str) -> None:
    text = first_screen_of(refuted_page)
    fails, holds, still_open = (
        text.index(said)
        for said in (
            "(✗) does not hold at 2 threads Looking into four boxes beats looking into nine : +6.9 % [",
            "(✓) holds at 2 threads Time is linear in the number of steps : 1.00 [",
            "? not decided 1 claim is measured, and pale below.",
        )
    )
    assert fails < holds < still_open
    assert "here, −4.6 % published." in text
    assert "∞" not in text
    assert "inf" not in text.split()


def test_beside_it_stand_machine_time_control_and_the_share_decided(refuted_page: str) -> None:
    text = first_screen_of(refuted_page)
    for said in (
        "Machine bench-1: Example CPU @ 2.50GHz; 2 cores, 4 hardware threads, a virtual machine",
        "min of processes; paper scale",
        "Control ✓ no difference found: ",
        "Decided 2 of 17 claims; 1 open, 14 not measured",
    ):
        assert said in text


def test_many_that_hold_are_one_sentence(page: str) -> None:
    text = first_screen_of(page)
    assert "✓ holds 16 claims, 14 of them on other threads or at another scale than claimed:" in text
    assert "✓ faster The fastest variant: " in text


def test_questions_of_ones_own_have_sentences_too(tmp_path: Path) -> None:
    write(tmp_path, under("mine", study(["sequential_orders"], blocks=9, noise=QUIET), title="My orders"))
    (tmp_path / "claims.toml").write_text("")
    page = page_of(tmp_path)
    for said, verdict in (("repeat against once", "slower"), ("track against once", "faster")):
        assert re.search(rf"<td>{said}</td>.*<td>{verdict}</td>", page)
    text = first_screen_of(page)
    assert re.search(r"✓ faster \S.*: −30", text)
    assert "Decided" not in text
    assert "Control – not measured" in text


def test_each_row_of_the_figure_leads_to_its_section(page: str) -> None:
    figure = page[page.index('<figure class="claims-figure"') :]
    figure = figure[: figure.index("</figure>")]
    assert figure.count("<svg") == 2
    links = re.findall(r'<a href="#([^"]+)"><title>([^<]*)</title>', figure)
    assert len(links) == 2 * len(claims.load())
    parsed = Page(page)
    assert {anchor for anchor, _ in links} <= set(parsed.ids)
    of_boxes = [anchor for anchor, said in links if said.startswith("Looking into four boxes")]
    assert of_boxes == ["neighbourhood"] * 2
    assert all("✓" in said or "cannot be decided" in said for _, said in links)


def test_the_contents_tell_by_a_mark_and_a_word(refuted_page: str) -> None:
    parts = nav_of(refuted_page).split("<li>")
    items = [text_of(one.partition("</li>")[0]).replace("\u00a0", " ") for one in parts]
    assert "(✗) does not hold Four boxes against nine" in items
    assert "(✓) holds Steps" in items
    assert "? not decided Radius" in items
    assert "✓ equivalent Control: the same variant twice" in items
    # A claim without records leads to the table.
    assert refuted_page.count('<a href="#claims-table"><title>') == 2 * 14
    assert "claims-table" in Page(refuted_page).ids


def test_a_section_is_a_question_an_answer_a_figure_and_its_commands(refuted_page: str) -> None:
    section = refuted_page[refuted_page.index('<section class="question" id="neighbourhood">') :]
    section = section[: section.index("</section>")]
    assert "<h3>Is looking into four boxes faster than looking into nine?</h3>" in section
    assert section.index('class="answer"') < section.index("<svg") < section.index("<figcaption><details>")
    assert "carom bench scene.in --variant nine" in section[section.index("Commands to repeat it") :]


def test_every_question_with_a_figure_has_words() -> None:
    assert set(titles()) <= set(answers.questions())
    assert all(text.endswith("?") for text in answers.questions().values())


@pytest.mark.parametrize("layout", [WIDE, NARROW])
def test_a_missing_interval_does_not_stretch_the_axis(refuted: Path, layout: Layout) -> None:
    data = evidence_of(refuted)[0]
    table = claims.evaluate(data)
    plain = all_claims(table, layout)
    assert plain is not None
    wide = Ratio(what="x", ratio=0.9, low=1e-9, high=1e9, published=0.95)
    none = Ratio(what="y", ratio=1.05)
    stretched = table.assign(effects=[(*row, wide, none) for row in table["effects"]])
    drawn = all_claims(stretched, layout)
    assert drawn is not None
    (axes,), (before,) = drawn.figure.axes, plain.figure.axes
    assert axes.get_xlim() == before.get_xlim()
    assert axes.get_xlim()[0] in LOWEST
    arrows = [line for line in axes.lines if line.get_marker() in ("<", ">")]
    assert len(arrows) == 2 * len(table)
    assert {float(line.get_xdata()[0]) for line in arrows} == set(axes.get_xlim())  # type: ignore[index, arg-type]


def test_nothing_measured_is_no_figure(tmp_path: Path) -> None:
    write(tmp_path, study(["sequential_orders"], blocks=2))
    assert draw(evidence_of(tmp_path)[0]) == ("", [])
    assert 'class="claims-figure"' not in page_of(tmp_path)


def test_the_figure_is_a_file_like_others(refuted: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "--results", str(refuted)]) == 0
    assert str(refuted / "figures" / "claims.svg") in capsys.readouterr().out.splitlines()
    written = {path.suffix for path in (refuted / "figures").glob("claims.*")}
    assert written == {".svg", ".pdf"}
    text = (refuted / "figures" / "claims.svg").read_text(encoding="utf-8")
    assert text.count('xlink:href="../report.html#claim-') == len(claims.load())


def test_effects_in_words() -> None:
    effect = Ratio(what="four against nine", ratio=0.9, low=0.853, high=0.95, published=0.954)
    assert change_in_short(effect) == "−10.0\u00a0% [−14.7, −5.0]"
    assert published_in_short(effect) == "−4.6\u00a0%"
    assert change_in_short(replace(effect, ratio=5.27, low=5.24, high=5.3)) == "+427\u00a0% [+424, +430]"
    few = Ratio(ratio=0.9, published=0.954)
    assert change_in_short(few) == "−10.0\u00a0% (too few blocks for an interval)"
    assert change_in_short(Ratio(what="exponent", ratio=1.0, low=0.98, high=1.02)) == "1.00 [0.980, 1.02]"
    assert both_in_short(few).endswith("interval) here, −4.6\u00a0% published")
    assert both_in_short(replace(effect, published=math.nan)).endswith("here, no number published")
    assert change_in_short(Ratio()) == published_in_short(Ratio()) == "–"
