import re
from pathlib import Path

import pytest

from analysis import claims
from analysis.cli import main
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study, under


def folder(path: Path, blocks: int = 10) -> str:
    write(path, study(["neighbourhood", "steps"], blocks=blocks, noise=QUIET))
    return str(path)


def test_a_damaged_record_is_told_once_while_figures_are_drawn(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path, study(["steps"], blocks=2))
    torn = tmp_path / "records" / "torn.json"
    torn.write_text("{", encoding="utf-8")
    assert main(["figures", "--results", str(tmp_path)]) == 0
    assert capfd.readouterr().err.count(f"{torn}: skipped: ") == 1


def test_figures_of_one_experiment(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder(tmp_path, blocks=2)
    assert main(["figures", "--results", str(tmp_path), "--experiment", "steps"]) == 0
    assert capsys.readouterr().out.splitlines() == [str(tmp_path / "figures" / "steps.svg")]
    assert main(["figures", "--results", str(tmp_path), "--experiment", "radius"]) == 0
    assert "no records" in capsys.readouterr().err


def test_an_experiment_that_nothing_knows_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder(tmp_path, blocks=1)
    assert main(["figures", "--results", str(tmp_path), "--experiment", "raduis"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "found 'raduis', expected one of" in line
    assert not (tmp_path / "figures").exists()


@pytest.mark.parametrize("kind", ["trend", "scaling", "phases", "doughnut"])
def test_a_figure_that_the_records_do_not_allow_is_one_line(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], kind: str
) -> None:
    known = "phases" if kind == "trend" else "radius"
    write(tmp_path, under("mine", study([known], blocks=1), figure=kind))
    assert main(["figures", "--results", str(tmp_path)]) == 0
    lines = capfd.readouterr().err.splitlines()
    assert lines[0].startswith(f"mine: not drawn: found figure '{kind}'")


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Of radius there are too few blocks."""
    path = tmp_path_factory.mktemp("compared")
    write(path, study(["radius"], blocks=3, noise=QUIET))
    return folder(path)


def test_claims_are_printed(compared: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["claims", "--results", compared]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 + 17 + 1
    assert max(map(len, lines)) <= 100
    assert lines[-1].endswith("carom claims --verbose")
    assert re.fullmatch(r"  \d+ decided, \d+ open, \d+ not measured, \d+ not decidable here", lines[1])
    assert sum(map(int, re.findall(r"\d+", lines[1]))) == 17
    assert any(
        re.fullmatch(r"\(✓\) four_boxes +−4.\d % \[−\S+, −\S+\] +holds at 2 threads", line) for line in lines
    )
    assert "  – particles                                        not measured" in lines
    [few] = [line for line in lines if line.startswith("  ? radius ")]
    assert few.endswith("not decided: too few blocks for an interval")
    assert "inf" not in few
    assert "∞" not in few


def test_all_that_is_known_of_a_claim_is_below_it(compared: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["claims", "--verbose", "--results", compared]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 100
    text = " ".join(" ".join(lines).split())
    for claim in claims.load():
        assert claim.claim in text
        assert " ".join(claim.published.effect.split()) in text
    assert "four against nine: published −4.6 %, here −4." in text
    assert "why: no records yet (experiment 'particles')" in text


@pytest.mark.parametrize("verb", ["figures", "report", "claims", "export"])
def test_bad_input_is_one_line_and_code_1(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([verb, "--results", "absent"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "absent: no such folder" in line


@pytest.mark.parametrize("arguments", [[], ["draw"], ["figures", "--speed"]])
def test_wrong_usage_is_one_line_and_code_1(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 1
    assert len(capsys.readouterr().err.splitlines()) == 1
