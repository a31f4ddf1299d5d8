"""A question to start from: a commented file, and something for it to measure."""

import re
import shlex
from pathlib import Path

from experiments.plan.question import FOLDER
from support.errors import InputError
from support.files import require_room_for_folder

TEMPLATE = FOLDER / "question.template"

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_LINES = 300_000


def new_question(name: str, folder: Path) -> int:
    """Write `folder/NAME.toml` and the file that it sorts. Returns the exit code, 0.

    Raises InputError for a name that is none, and where a file of that name is there.
    """
    if not _NAME.fullmatch(name):
        raise InputError(f'NAME: found "{name}", expected letters, digits, _ and -, a letter first')
    require_room_for_folder("questions", folder)
    question, sorted_file = folder / f"{name}.toml", folder / f"{name}.txt"
    for path in (question, sorted_file):
        if path.exists():
            raise InputError(f"{path}: is there; expected a name that is free")
    folder.mkdir(parents=True, exist_ok=True)
    lines = (str(number * 7919 % 1_000_003) for number in range(_LINES))
    sorted_file.write_text("\n".join(lines) + "\n", encoding="ascii")
    text = TEMPLATE.read_text(encoding="utf-8").replace("NAME.txt", sorted_file.name)
    asked, results = shlex.quote(str(folder)), shlex.quote(str(folder / "results"))
    question.write_text(text.replace("FOLDER", asked), encoding="utf-8")
    print(f"{question}: edit it, then `carom study run --questions {asked} --results {results}`")
    return 0
