"""What users do with `carom compare` on their first day, as a section of the page of faults."""

from docs.generate.markdown import table
from experiments.tests.compare.first_day import CASES
from experiments.tests.compare.test_commits import COMMITS, OF_SUBMODULES, PROGRAMS, WHAT_GIT_SAYS
from support.home import ROOT

PAGE = ROOT / "docs" / "reference" / "faults.md"
HEAD, NEXT = "## The first day\n", "\n## Random input\n"


def render() -> str:
    """The whole page, with the section made of the table that its test runs."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(HEAD)
    _, following, after = rest.partition(NEXT)
    rows = [(one.kind, one.input, one.right) for one in CASES] + _of_commits()
    told = (
        "\nWhat people do with `carom compare` and `carom gate` on their first day. Each row is a test "
        "of the real program\n(`first_day.py` and `test_commits.py` in `experiments/tests/compare/`, from "
        "which `make docs` makes this table).\n\n"
    )
    return f"{before}{HEAD}{told}{table(('about', 'given', 'right'), rows)}\n{following}{after}"


def _of_commits() -> list[tuple[str, str, str]]:
    """What `carom gate` is given, and what it says first."""
    cases = {**COMMITS, **WHAT_GIT_SAYS, **OF_SUBMODULES, **PROGRAMS}
    return [
        (
            "commits",
            name,
            f"exit code {one.code}: {one.told[0].removeprefix('carom: ').replace('HERE', '/folder')}",
        )
        for name, one in cases.items()
    ]
