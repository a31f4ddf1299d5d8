"""The page of the command line: every verb of `carom` with its arguments and options."""

from pathlib import Path

from docs.generate import program_help, python_verbs
from docs.generate.markdown import code, page, sentence, table, with_large_letter
from docs.generate.program_help import Verb

COMMON = "study run"
"""The verb whose options others share."""

INTERNAL = "Called by a study"
OPENING = (
    "Every verb of `carom`, from the program's own help. `carom VERB --help` says the same. "
    "What stands in brackets may be left out."
)
OF_INTERNAL = (
    "A running study, a batch script or `make` calls these. They may be called by hand. "
    "`carom --help` does not list them."
)


def render(program: Path) -> str:
    """The page. Raises CalledProcessError where the program cannot be asked."""
    brief = program_help.help_of(program, "--help")
    own = program_help.verbs(program_help.help_of(program, "--help-all"))
    verbs = own | python_verbs.verbs() | python_verbs.study_verbs()
    parts = [OPENING, program_help.ending(brief)]
    shown = {"help"}
    for group, listed in program_help.groups(brief).items():
        of_study = python_verbs.listed_study_verbs()
        names = [one for name in listed for one in (of_study if name == "study" else [name])]
        parts += [f"## {group}", *(_section(verbs[name], verbs[COMMON]) for name in names)]
        shown.update(names, listed)
    parts.append(_section(verbs["help"], verbs[COMMON]))
    rest = [_section(verb, verbs[COMMON]) for name, verb in verbs.items() if name not in shown]
    return page("Command line", *parts, f"## {INTERNAL}", OF_INTERNAL, *rest)


def _section(verb: Verb, common: Verb) -> str:
    """A verb with a table of what it takes; for options that it shares with a study's run a link to those."""
    usages = "\n".join(f"- {code(one)}" for one in verb.usages)
    shares = verb.name != common.name and set(common.rows) <= set(verb.rows)
    link = f"It takes the options of [carom {common.name}](#carom-{common.name.replace(' ', '-')})"
    own = [row for row in verb.rows if not shares or row not in common.rows]
    also = f"{link}{', and' if own else ''}{':' if own else '.'}" if shares else ""
    rows = [(code(row.typed), row.default, with_large_letter(row.told)) for row in own]
    listed = table(("argument or option", "default", "meaning"), rows) if rows else ""
    parts = (f"### carom {verb.name}", sentence(verb.told), usages, also, listed, verb.end)
    return "\n\n".join(filter(None, parts))
