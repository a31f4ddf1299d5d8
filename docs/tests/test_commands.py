"""The commands of the documents are run in the order in which a reader would type them.

Where a block is marked `verbs`, only the names of its verbs are checked.
"""

import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from documents import (
    BUILT,
    DOCUMENTS,
    FENCED,
    KINDS,
    ROOT,
    Block,
    blocks,
    document,
    output_of,
    shell,
    write_file,
)

COMMAND = r"(make|cmake|ctest|python|\.venv/bin/python|build/\w+/carom|carom|git|apt-get) "
LOOKS_LIKE_A_COMMAND = re.compile(rf"^\s*{COMMAND}", re.MULTILINE)
INDENTED_COMMAND = re.compile(rf"^(    |\t){COMMAND}", re.MULTILINE)
CMAKE_LISTS = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
TESTS_BUILT = (ROOT / "build" / "gcc" / "kernels" / "tests" / "kernels_tests").is_file()
"""`make build` builds the program alone."""
MAKEFILE_VERBS = set(
    re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
)


def having(*kinds: str) -> list[str]:
    return [name for name in DOCUMENTS if any(shell(name, kind) for kind in kinds)]


def copy_of_the_project(folder: Path) -> Path:
    """What a clone would hold if everything here were committed, with the environment that is here."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        files = subprocess.run(listed, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"which files belong to the project is not known: {error}")
    for name in filter(None, files.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    (folder / ".venv").unlink(missing_ok=True)
    (folder / ".venv").symlink_to((ROOT / ".venv").resolve())
    return folder


def copy_programs(folder: Path) -> None:
    """Put what is built where the copy would have built it: a program takes what is around it for its own."""
    for program in (ROOT / "build").glob("*/carom"):
        (folder / "build" / program.parent.name).mkdir(parents=True)
        shutil.copy(program, folder / "build" / program.parent.name)


def follow(document_blocks: list[Block], folder: Path, kinds: tuple[str, ...]) -> None:
    """Write the files and run the commands of a document, as far as they are of these kinds."""
    for block in document_blocks:
        if block.language == "sh" and block.word in kinds:
            run(replace(block, text=shortened(block.text)), folder)
        elif block.language != "sh" and block.word:
            write_file(block, folder)


def shortened(text: str) -> str:
    """The same commands, but that a comparison takes a second: how long it measures is tested elsewhere."""
    as_long = r"^carom compare (?:(.*)--time \d+s )?"
    return re.sub(as_long, r"carom compare --time 1s \1", text, flags=re.MULTILINE)


def run(block: Block, folder: Path) -> None:
    try:
        output_of(block.text, folder)
    except AssertionError as error:
        raise AssertionError(f"line {block.line}: {error}") from error


@pytest.mark.skipif(not BUILT, reason="build/gcc/carom is not built (`make build` builds it)")
@pytest.mark.parametrize("name", having(""))
def test_quick_commands(tmp_path: Path, name: str) -> None:
    folder = copy_of_the_project(tmp_path)
    copy_programs(folder)
    follow(document(name), folder, ("",))


@pytest.mark.slow
@pytest.mark.parametrize("name", having("slow"))
def test_all_commands_from_an_empty_build(tmp_path: Path, name: str) -> None:
    follow(document(name), copy_of_the_project(tmp_path), ("", "slow") if BUILT else ("slow",))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_no_command_escapes(name: str) -> None:
    unfenced = FENCED.sub("", (ROOT / name).read_text(encoding="utf-8"))
    assert not INDENTED_COMMAND.search(unfenced), f"{name}: has commands outside of ```sh"
    for block in document(name):
        if block.language == "sh":
            assert block.word in KINDS, f"{name}:{block.line}: found '{block.word}' behind sh"
        elif block.language in ("", "bash", "shell", "console"):
            assert not LOOKS_LIKE_A_COMMAND.search(block.text), (
                f"{name}:{block.line}: has commands, is not marked sh"
            )


def has_help(command: list[str]) -> bool:
    return subprocess.run([*command, "--help"], cwd=ROOT, capture_output=True, check=False).returncode == 0


def exists(words: list[str]) -> bool:
    """Whether a command's program, verb, goal or preset is there; False for what is no known command."""
    match words:
        case [setting, *rest] if re.fullmatch(r"[A-Z_]+=\S+", setting):
            return exists(rest)
        case ["make", *rest]:
            goals = {word for word in rest if "=" not in word}
            return bool(goals) and goals <= MAKEFILE_VERBS
        case [".venv/bin/python", "-m", *rest]:
            return has_help([sys.executable, "-m", *rest[:2]])
        case ["carom", *rest]:
            return not BUILT or has_help(["build/gcc/carom", *rest[: 2 if rest[0] == "study" else 1]])
        case [program] if program.startswith("build/gcc/"):
            return not TESTS_BUILT or (ROOT / program).is_file()
        case ["cmake" | "ctest", "--preset", preset] | ["cmake", "--build", "--preset", preset, *_]:
            return f'"name": "{preset}"' in (ROOT / "CMakePresets.json").read_text(encoding="utf-8")
        case ["cmake", "-B", "build/gcc", option]:
            return f"option({option.removeprefix('-D').split('=')[0]} " in CMAKE_LISTS
        case ["apt-get", "install", package]:
            return package in CMAKE_LISTS
        case ["srun", _, *rest] if "carom" in rest:
            return exists(rest[rest.index("carom") :])
    return False


@pytest.mark.parametrize("name", having("verbs", "fresh"))
def test_commands_that_are_only_looked_at_exist(name: str) -> None:
    for block in (*shell(name, "verbs"), *shell(name, "fresh")):
        for line in filter(None, (line.split("#")[0].strip() for line in block.text.splitlines())):
            for command in line.split("&&"):
                assert exists(command.split()), f"{name}:{block.line}: {command}"


@pytest.mark.parametrize("name", DOCUMENTS)
def test_links_lead_somewhere(name: str) -> None:
    text = FENCED.sub("", (ROOT / name).read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if not target.startswith(("http://", "https://")):
            file, _, anchor = target.partition("#")
            path = (ROOT / name).parent / file if file else ROOT / name
            assert path.exists(), f"{name}: links to {target}"
            assert not anchor or anchor in anchors(path), f"{name}: links to {target}"


def anchors(path: Path) -> set[str]:
    """What GitHub makes of a document's headings."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_blocks_are_found_with_their_kind_and_line() -> None:
    found = list(blocks("a\n\n```sh slow\nx\ny\n```\n\n```\nz\n```\n"))
    assert found == [Block("sh", "slow", "x\ny\n", 3), Block("", "", "z\n", 8)]


def test_what_does_not_exist_is_seen() -> None:
    for command in (
        "make nonsense",
        "make",
        "cmake --preset nonsense",
        "cmake -B build/gcc -DCAROM=1",
        "A=1 frob",
        "ctest",
        "",
    ):
        assert not exists(command.split()), command
    assert exists(["A=1", "make", "setup"])


def test_a_command_that_fails_fails(tmp_path: Path) -> None:
    for text in ("false\ntrue\n", "false | true\n", "echo $UNSET_VARIABLE\n"):
        with pytest.raises(AssertionError, match="line 7: exit code 1"):
            run(Block("sh", "", text, 7), tmp_path)


def test_a_change_whose_old_lines_are_not_there_fails(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("one\ntwo\n")
    write_file(Block("diff", "file", "-one\n+1\n two\n", 1), tmp_path)
    assert (tmp_path / "file").read_text() == "1\ntwo\n"
    with pytest.raises(ValueError, match="holds 0 times"):
        write_file(Block("diff", "file", "-one\n+1\n", 1), tmp_path)
