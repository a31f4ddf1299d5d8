"""`carom gate`: which commits are compared, with what in them, and that each runs a program of its own."""

import os
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from experiments.tests.compare.calls import left_behind, needs_the_program, run

START = """
prints() { printf '#!/bin/sh\\necho took %s ms\\n' "$1" >prog.in; }
commit() { git add . && git commit -q --allow-empty -m "$1"; }
git init -q 'a repository' && cd 'a repository'
prints 100 && commit one
"""
"""A repository whose program says how long it took, in a folder with a space in its name."""

FASTER = f"""{START}
git checkout -q -b branch && echo hello >README && commit readme
git checkout -q main && prints 50 && commit faster && git checkout -q branch
"""
"""The base became faster after the branch had left it, and the branch adds a README alone."""

SLOWER = f"""{START}
git checkout -q -b branch && prints 150 && commit slower
"""

SUBMODULES = f"""
for one in nested lib; do
    git init -q $one && echo 50 >$one/value && echo $one >$one/name
    git -C $one add . && git -C $one commit -q -m one
done
git -C lib submodule --quiet add ../nested 'in it' && git -C lib commit -q -m two
{START}
git submodule --quiet add HERE/lib lib && git submodule --quiet update --init --recursive
commit lib && git checkout -q -b branch
echo 100 >'lib/in it/value' && git -C 'lib/in it' commit -q -a -m slower
git -C lib commit -q -a -m slower && commit slower
"""
"""A submodule with another in it, whose newest commits are nowhere but in the user's own folders."""

CLONED = f"""{SUBMODULES}
git clone -q . ../clone && cd ../clone && git checkout -q --detach origin/main && echo x >x && commit x
"""
"""A clone without submodules, of commits whose submodules are still where they come from."""

COPY = "cp prog.in prog && chmod +x prog"
FROM_LIB = """
took=$(($(cat lib/value) + $(cat 'lib/in it/value')))
printf '#!/bin/sh\\necho took %s ms\\n' $took >prog && chmod +x prog
"""
INSTALL = "mkdir -p HERE/fixed && cp prog.in HERE/fixed/prog && chmod +x HERE/fixed/prog"
"""Into a place that both builds share."""

OPENS = '#include <dlfcn.h>\nint main(void) { return !dlopen("HERE/fixed/libw.so", RTLD_NOW); }'
LIBRARY = """set -e; mkdir -p HERE/fixed
echo 'int w(void) { return 0; }' | gcc -xc -shared -fPIC -o HERE/fixed/libw.so -
echo 'int w(void); int main(void) { return w(); }' |
    gcc -xc - -xnone -LHERE/fixed -lw -Wl,-rpath,HERE/fixed -o prog
"""
PLUGIN = LIBRARY.replace("int w(void); int main(void) { return w(); }", OPENS).replace(
    "-LHERE/fixed -lw", "-ldl"
)
CURRENT = f"{COPY} && ln -sfn $PWD HERE/current"
ONCE = f"[ -e HERE/once ] || cp prog.in HERE/once; cp HERE/once prog.in && {COPY}"
"""As with a build folder that both builds share: the second one finds nothing to do."""

TOOK = ("--time-from", "took ([0-9]+) ms", "--time", "30s", "-q")
ALLOWED = {"GIT_ALLOW_PROTOCOL": "file"}
ONE_LEFT = (
    "where HEAD left main; 1 commit of main since then is not in HEAD (--base-exactly compares with main"
)
UNSHALLOW = "`git fetch --unshallow origin '+refs/heads/*:refs/remotes/origin/*'` (fetch-depth: 0 of actions/"
PASSED = "gate: passed: not slower by more than the margin"
FAILED = "gate: failed: slower"
SHARED = (
    "written by the builds: both commits would use what was built last; expected a path inside the checkout"
)
LOADED = "written by the builds and loaded: both commits use what was built last; expected it inside"
SAME = "found ./prog with the same bytes in both commits, which differ in "


@dataclass(frozen=True)
class Case:
    """What is done, and what is right: the exit code, and texts in what is said. HERE is the folder with all.

    The last folder of `done` is the user's own.
    """

    done: str
    code: int
    told: tuple[str, ...]
    options: tuple[str, ...] = ()
    build: str = COPY
    run: tuple[str, ...] = ("./prog",)
    not_told: str = "--base-exactly"
    env: dict[str, str] = field(default_factory=dict)


COMMITS = {
    "the base went on": Case(FASTER, 0, (ONE_LEFT, PASSED), not_told="2 commits"),
    "the base went on twice": Case(
        f"{FASTER} git checkout -q main && commit x && git checkout -q branch",
        0,
        ("; 2 commits of main since then are not in HEAD (",),
        not_told="1 commit ",
    ),
    "the base itself": Case(FASTER, 3, (FAILED,), ("--base-exactly",)),
    "the base did not go on": Case(SLOWER, 3, (FAILED,)),
    "the base has the head": Case(
        f"{FASTER} git checkout -q --detach main~1",
        1,
        ("HEAD has nothing that main lacks; --base-exactly compares them all the same",),
        not_told="since then",
    ),
    "the base has the head, exactly": Case(
        f"{FASTER} git checkout -q --detach main~1", 3, (FAILED,), ("--base-exactly",)
    ),
    "one commit": Case(START, 0, ("main and HEAD are the same commit, ", ": it is measured twice", PASSED)),
    "one commit, and something that is not committed": Case(
        f"{START} echo x >>prog.in",
        0,
        ("what is not committed is not measured: commit it first, then --base ", PASSED),
    ),
    "nothing in common": Case(
        f"{SLOWER} git checkout -q --orphan other && commit other",
        1,
        ("HEAD has no commit in common with main; --base-exactly compares them all the same",),
        not_told="shallow",
    ),
    "nothing in common, exactly": Case(
        f"{SLOWER} git checkout -q --orphan other && commit other", 3, (FAILED,), ("--base-exactly",)
    ),
    "nothing in common as far as the clone goes": Case(
        f'{SLOWER} git clone -q --depth 1 --no-single-branch "file://$PWD" ../clone && cd ../clone',
        1,
        ("HEAD has no commit in common with origin/main; the clone is shallow: ", UNSHALLOW),
        ("--base", "origin/main"),
        not_told="since then",
    ),
    "changes that are not committed": Case(
        f"{SLOWER} touch more", 3, ("carom: what is not committed is not measured",)
    ),
    "a folder that is new": Case(
        f"{START} git checkout -q -b branch && mkdir sub && touch sub/x && commit sub && cd sub",
        1,
        ("): has no folder sub, from which it was asked for",),
    ),
    "no program": Case(
        SLOWER,
        1,
        ("carom: head ", ": found ./prog, which is not there once it is built; expected a build that"),
        build=f"! grep -q 100 prog.in || {{ {COPY}; }}",
    ),
    "no program of that name on PATH": Case(
        SLOWER,
        1,
        (': found "prog", which is not on PATH; expected ./prog, if the file of the folder is meant',),
        run=("prog",),
    ),
    "in a hook": Case(
        f"{SLOWER} git checkout -q main",
        3,
        (FAILED,),
        ("--head", "branch"),
        env={"GIT_DIR": ".git", "GIT_INDEX_FILE": "HERE/a repository/.git/index", "GIT_PREFIX": ""},
    ),
}

WHAT_GIT_SAYS = {
    "not cloned": Case(
        f'{SLOWER} git clone -q --depth 1 "file://$PWD" ../clone && cd ../clone',
        1,
        ("--base: found main, expected a commit of HERE/clone; the clone is shallow: ", UNSHALLOW),
    ),
    "no such commit": Case(
        START, 1, ("--base: found x, expected a commit of ",), ("--base", "x"), not_told="shallow"
    ),
    "no commit": Case("git init -q empty && cd empty", 1, ("/empty: has no commits, expected two",)),
    "another owner": Case(
        START,
        1,
        (": detected dubious ownership in repository at ", "git config --global --add safe.directory "),
        env={"GIT_TEST_ASSUME_DIFFERENT_OWNER": "1"},
    ),
    "no repository": Case(
        "mkdir none && cd none",
        1,
        ("/none: expected a git repository to compare two commits of: not a git repository",),
    ),
    "a bare repository": Case(
        f"{START} git clone -q --bare . ../bare && cd ../bare", 1, ("/bare: is a bare repository, expected",)
    ),
    "no git": Case(START, 1, ("git: cannot be run: ", "expected git on PATH"), env={"PATH": "/nowhere"}),
}

OF_SUBMODULES = {
    "the user's own": Case(
        f"{SUBMODULES} mkdir ../gone && mv ../lib ../nested ../gone", 3, ("+50.0 %", FAILED), build=FROM_LIB
    ),
    "the user's own in a linked worktree": Case(
        f"{SUBMODULES} git worktree add -q --detach ../linked && cd ../linked",
        3,
        ("+50.0 %", FAILED),
        build=FROM_LIB,
    ),
    "none is checked out now": Case(
        f"{SUBMODULES} git branch slower && git rm -q lib && commit none",
        3,
        ("+50.0 %", FAILED),
        ("--head", "slower"),
        build=FROM_LIB,
    ),
    "from elsewhere": Case(
        f"{CLONED}", 0, (PASSED,), ("--base", "origin/main", "--same-bytes"), build=FROM_LIB, env=ALLOWED
    ),
    "the inner one from elsewhere": Case(
        f"{CLONED} git submodule --quiet update --init",
        0,
        (PASSED,),
        ("--base", "origin/main", "--same-bytes"),
        build=FROM_LIB,
        env=ALLOWED,
    ),
    "from nowhere": Case(
        CLONED,
        1,
        (": the submodule lib cannot be checked out: transport 'file' not allowed", "update none` leaves"),
        ("--base", "origin/main"),
        build=FROM_LIB,
    ),
    "not wanted": Case(
        f"{CLONED} git config submodule.lib.update none",
        0,
        (PASSED,),
        ("--base", "origin/main", "--same-bytes"),
    ),
    "shallow": Case(
        f"{CLONED} git submodule --quiet init && git config submodule.lib.url file://HERE/lib\n"
        "git submodule --quiet update --depth 1",
        0,
        (PASSED,),
        ("--base", "origin/main", "--same-bytes"),
        build=f"git -C lib log && git -C lib describe --always && {COPY}",
        env=ALLOWED,
    ),
    "a repository by mistake": Case(
        f"{SLOWER} git clone -q . stray && git add stray 2>&1 && commit x && rm -rf stray && mkdir stray",
        3,
        (FAILED,),
    ),
}

PROGRAMS = {
    "a file of the user's own checkout": Case(
        SLOWER,
        1,
        ("of your own checkout: both commits would use it; expected a path inside the checkout",),
        run=("sh", "HERE/a repository/prog.in"),
    ),
    "installed": Case(
        SLOWER, 1, (f"found HERE/fixed/prog, {SHARED}",), build=INSTALL, run=("HERE/fixed/prog",)
    ),
    "outside, and nothing of the checkout": Case(
        f"{SLOWER} cp prog.in HERE/outside && chmod +x HERE/outside",
        1,
        ("both commits use HERE/outside, and nothing that the command names lies in the checkout; expected",),
        run=("HERE/outside",),
    ),
    "outside, on PATH": Case(
        f"{SLOWER} mkdir HERE/on-path && cp prog.in HERE/on-path/prog && chmod +x HERE/on-path/prog",
        0,
        ("both commits use HERE/on-path/prog, and nothing that the command names", PASSED),
        run=("HERE/on-path/prog",),
        env={"PATH": f"HERE/on-path:{os.environ['PATH']}"},
    ),
    "nothing of the checkout, on PATH": Case(
        SLOWER,
        0,
        ("both commits use echo, and nothing that the command names lies in the checkout", PASSED),
        run=("echo", "took 500 ms"),
    ),
    "of the checkout, and of that name on PATH": Case(
        f"{SLOWER} mkdir HERE/on-path && cp prog.in HERE/on-path/prog && chmod +x HERE/on-path/prog",
        1,
        ("found prog, which is HERE/on-path/prog for both commits; expected ./prog",),
        run=("prog",),
        env={"PATH": f"HERE/on-path:{os.environ['PATH']}"},
    ),
    "built in the user's own checkout, by its bare name": Case(
        f"{SLOWER} echo prog >.git/info/exclude && cp prog.in prog && chmod +x prog",
        1,
        (': found "prog", which is not on PATH; expected ./prog',),
        run=("prog",),
    ),
    "in the user's own checkout alone, by its bare name": Case(
        f"{SLOWER} echo prog >.git/info/exclude && cp prog.in prog && chmod +x prog",
        1,
        (': found "prog", which is not there; expected a program on PATH',),
        build="true",
        run=("prog",),
    ),
    "not built": Case(
        f"{SLOWER} echo prog >.git/info/exclude && cp prog.in prog && chmod +x prog",
        1,
        (": found ./prog, which is not there; expected --build LINE if it is to be built",),
        build="",
    ),
    "installed, for a Python": Case(
        f"{SLOWER} mkdir HERE/modules && echo 'import mod' >bench.py && commit bench",
        1,
        ("found HERE/modules/mod.py, which python3 may load, written by the builds",),
        build="echo 'x = 1' >HERE/modules/mod.py",
        run=("python3", "bench.py"),
        env={"PYTHONPATH": "HERE/modules"},
    ),
    "a hook that fails without a word": Case(
        f"{SLOWER} cd .git/hooks && printf '#!/bin/sh\\nexit 1\\n' >post-checkout && chmod +x post-checkout"
        " && cd ../..",
        1,
        ("cannot be checked out: exit code 1 without a word, as of a hook",),
    ),
    "a variable that leads into the user's own checkout": Case(
        f"{SLOWER} mkdir src",
        1,
        ("found PYTHONPATH=HERE/a repository/src, of your own checkout: both commits would use it",),
        env={"PYTHONPATH": "HERE/a repository/src"},
    ),
    "modules of the user's own checkout, for another interpreter": Case(
        SLOWER,
        1,
        ("found NODE_PATH=HERE/a repository, of your own checkout: both commits would use it",),
        env={"NODE_PATH": "HERE/a repository"},
    ),
    "a package that was installed to be edited": Case(
        f"{SLOWER} python3 -m venv --without-pip HERE/venv\n"
        "for one in HERE/venv/lib/python3*/site-packages; do pwd > $one/p.pth; done",
        1,
        ("found HERE/a repository, where HERE/venv/bin/python looks for modules (--same-bytes accepts",),
        run=("HERE/venv/bin/python", "prog"),
    ),
    "a script with the path of the user's own checkout": Case(
        f"{SLOWER} echo \"cat '$PWD/prog.in'\" >>prog.in && git commit -qam own",
        1,
        ("found HERE/a repository in ./prog, of your own checkout: both commits would use it",),
    ),
    "a script of a script with the user's own checkout itself": Case(
        f"{SLOWER} echo \"cd '$PWD'\" >inner.sh && echo . ./inner.sh >>prog.in && git add . && commit own",
        1,
        ("found HERE/a repository in ./inner.sh, of your own checkout: both commits would use it",),
    ),
    "the user's own checkout below the home folder": Case(
        SLOWER,
        1,
        ("found HERE/a repository, of your own checkout: both commits would use it",),
        run=("sh", "-c", "cd ~/'a repository' && ./prog"),
        env={"HOME": "HERE"},
    ),
    "a folder of the checkout": Case(
        f"{START} mkdir lib && git mv prog.in lib && commit lib\n"
        "git checkout -q -b branch && touch x.c && commit x",
        0,
        (PASSED,),
        build="true",
        run=("sh", "-c", "cd lib && sh ./prog.in"),
        not_told="nothing that the command names",
    ),
    "programs of the user's own checkout on PATH": Case(
        SLOWER,
        3,
        ("carom: PATH=HERE/a repository, of your own checkout: both commits run programs that", FAILED),
        env={"PATH": f"HERE/a repository:{os.environ['PATH']}"},
    ),
    "installed, one commit": Case(START, 0, (PASSED,), build=INSTALL, run=("HERE/fixed/prog",)),
    "installed on PATH": Case(
        SLOWER,
        1,
        (f"found prog, which is HERE/fixed/prog, {SHARED}",),
        build=INSTALL,
        run=("env", "prog"),
        env={"PATH": f"HERE/fixed:{os.environ['PATH']}"},
    ),
    "installed, for a shell": Case(
        SLOWER,
        1,
        (f"found HERE/fixed/prog, {SHARED}",),
        build=INSTALL,
        run=("sh", "-c", "cd /; X='1' HERE/fixed/prog; true"),
    ),
    "installed, for a script of the repository": Case(
        f"{START} echo 'HERE/fixed/prog' >run.sh && commit script\n"
        "git checkout -q -b branch && prints 150 && commit slower\n",
        1,
        (f"found HERE/fixed/prog, {SHARED}",),
        build=INSTALL,
        run=("sh", "run.sh"),
    ),
    "a program of the user's own checkout on PATH": Case(
        f"{SLOWER} mkdir bin && cp prog.in bin/bench && chmod +x bin/bench && commit bench",
        1,
        ("found bench, of your own checkout: both commits would use it",),
        run=("bench",),
        env={"PATH": f"HERE/a repository/bin:{os.environ['PATH']}"},
    ),
    "a program of the user's own checkout in a variable": Case(
        SLOWER,
        1,
        ("of your own checkout: both commits would use it",),
        run=("sh", "-c", "sh $BENCH"),
        env={"BENCH": "HERE/a repository/prog.in"},
    ),
    "installed, for a loader": Case(
        SLOWER,
        1,
        (f"found HERE/fixed/prog, {SHARED}",),
        build=f"{INSTALL} && {COPY}",
        run=("env", "LD_PRELOAD=HERE/fixed/prog", "./prog"),
    ),
    "a library that the builds install": Case(
        f"{START} git checkout -q -b branch && prints 150 && commit slower",
        1,
        (f"found HERE/fixed/libw.so, {LOADED}",),
        ("--same-bytes",),
        build=LIBRARY,
    ),
    "a plugin that the builds install": Case(
        f"{START} git checkout -q -b branch && prints 150 && commit slower",
        1,
        (f"found HERE/fixed/libw.so, {LOADED}",),
        ("--same-bytes",),
        build=PLUGIN,
    ),
    "a build in the user's own checkout": Case(
        f"{SLOWER} echo prog >.git/info/exclude",
        1,
        ("found ./prog, which is not there once it is built; expected a build that makes it in its",),
        build='cp prog.in "$(git rev-parse --path-format=absolute --git-common-dir)/../prog"',
    ),
    "a link out of the tree": Case(
        SLOWER,
        1,
        (f"found ./prog, which is HERE/fixed/prog, {SHARED}",),
        build=f"{INSTALL} && ln -s HERE/fixed/prog prog",
    ),
    "a link into the last tree": Case(
        SLOWER, 1, (f"/head/prog, {SHARED}",), build=CURRENT, run=("HERE/current/prog",)
    ),
    "installed before": Case(
        f"{SLOWER} mkdir ../fixed && cp prog.in ../fixed/prog && chmod +x ../fixed/prog && sleep 0.1",
        0,
        (PASSED,),
        ("--same-bytes",),
        run=("HERE/fixed/prog",),
        build="true",
    ),
    "a tool": Case(SLOWER, 3, (FAILED,), build=f"{COPY} && ln -s /bin/sh tool", run=("./tool", "prog")),
    "the same bytes": Case(SLOWER, 1, (f"{SAME}prog.in; do the builds share something",), build=ONCE),
    "the same bytes, accepted": Case(SLOWER, 0, (PASSED,), ("--same-bytes",), build=ONCE),
    "an object in a fixed place, linked into programs with another version": Case(
        f"{START} printf 'prog:\\n\\t[ -e HERE/part ] || cp prog.in HERE/part\\n\\tcp HERE/part prog\\n"
        "\\techo : $$PWD >> prog\\n' > Makefile && commit x && git checkout -q -B main && "
        "git checkout -q -b branch && prints 150 && commit slower",
        0,
        (
            "carom: --build writes to HERE/part, which both builds share: what one left there may be in",
            PASSED,
        ),
        build="make",
        run=("sh", "prog"),
    ),
    "how it is built differs": Case(
        f"{START} git checkout -q -b branch && touch CMakeLists.txt && commit x",
        1,
        (f"{SAME}CMakeLists.txt; ",),
    ),
    "no source differs": Case(
        f"{START} git checkout -q -b branch && mkdir -p a/doc && touch a/doc/x.c a/b.TXT .x && commit x",
        0,
        ("carom: base and head build the same bytes of ./prog: no source differs", PASSED),
    ),
    "a script that reads another file": Case(
        f"{START} echo '. ./prog.in' >prog && chmod +x prog && commit x && git checkout -q -B main\n"
        "git checkout -q -b branch && prints 150 && commit slower",
        3,
        (FAILED,),
        build="true",
        run=("sh", "prog"),
    ),
}


@needs_the_program
@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, id=name)
        for table in (COMMITS, WHAT_GIT_SAYS, OF_SUBMODULES, PROGRAMS)
        for name, case in table.items()
    ],
)
def test_what_is_done_is_answered(tmp_path: Path, case: Case) -> None:
    (tmp_path / "tmp").mkdir()
    (tmp_path / "git").write_text(
        "[user]\nname = a\nemail = a@b\n[init]\ndefaultBranch = main\n", encoding="utf-8"
    )
    env = {**os.environ, "GIT_CONFIG_GLOBAL": str(tmp_path / "git"), "GIT_CONFIG_NOSYSTEM": "1"}
    setting = {**env, "GIT_CONFIG_PARAMETERS": "'protocol.file.allow=always'"}
    done = f"set -e; {case.done.replace('HERE', str(tmp_path))}\npwd"
    made = subprocess.run(
        ["sh", "-c", done], cwd=tmp_path, env=setting, capture_output=True, text=True, check=True
    )
    folder = Path(made.stdout.splitlines()[-1])
    before = state(tmp_path, env)
    build = ("--build", case.build) if case.build else ()
    base = () if "--base" in case.options else ("--base", "main")
    words = ["gate", *base, *case.options, *build, *TOOK, "--", *case.run]
    env_of_case = {name: value.replace("HERE", str(tmp_path)) for name, value in case.env.items()}
    words = [word.replace("HERE", str(tmp_path)) for word in words]
    said = run(folder, *words, env={**env, **env_of_case}, tmp=tmp_path / "tmp")
    everything = said.stdout + said.stderr
    assert said.returncode == case.code, everything
    for text in case.told:
        assert text.replace("HERE", str(tmp_path)) in everything
    assert case.not_told not in everything
    if said.returncode == 1:
        assert len([one for one in said.stderr.splitlines() if "is called slower in at most" not in one]) == 1
    assert left_behind(tmp_path) == []
    assert state(tmp_path, env) == before


def state(folder: Path, env: dict[str, str]) -> list[str]:
    """What git says of every repository of the user, with its configuration, and all that its folder has."""
    told = []
    for git in sorted(folder.glob("*/.git")):
        for words in (
            ["status", "--porcelain"],
            ["submodule", "status", "--recursive"],
            ["worktree", "list"],
        ):
            done = subprocess.run(
                ["git", *words], cwd=git.parent, env=env, capture_output=True, text=True, check=False
            )
            told.append(done.stdout + done.stderr)
        if git.is_dir():
            told += [str(one) for one in sorted(git.rglob("*"))]
            told.append((git / "config").read_text(encoding="utf-8"))
    return told
