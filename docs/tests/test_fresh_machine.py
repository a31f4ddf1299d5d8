"""On a bare Debian or Ubuntu, in a clean clone: README.md's two commands, the first of docs/start.md.

The machine is made by debootstrap, in a folder of its own, from the mirror that apt uses here, or the public
one of a distribution that apt here has not; what is mounted into it is mounted in a namespace that ends with
each command.
"""

import os
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from documents import ROOT, document, shell, write_file

pytestmark = pytest.mark.slow

PASSED_ON = ("http_proxy", "https_proxy", "no_proxy", "HTTP_PROXY", "HTTPS_PROXY", "NO_PROXY")
CONFIGURATION = (
    "etc/apt/apt.conf.d",
    "etc/apt/auth.conf.d",
    "etc/pip.conf",
    "etc/ssl/certs",
    "usr/local/share/ca-certificates",
    "etc/resolv.conf",
)
"""How this machine reaches its mirrors, which the new one has to reach as well."""

INSIDE = """
set -e
mount -t proc proc "$1/proc"
mount --rbind /sys "$1/sys"
mount -t tmpfs -o mode=1777 none "$1/dev/shm"
exec chroot --userspec="$2:$2" --groups="$2" "$1" bash -euo pipefail -c "$3"
"""


@dataclass(frozen=True)
class Distribution:
    """Where a distribution's packages are."""

    mirror: str
    components: str
    script: str
    """Of debootstrap, for suites that are newer than debootstrap."""


DISTRIBUTIONS = {
    "Debian": Distribution("http://deb.debian.org/debian", "main", "sid"),
    "Ubuntu": Distribution("http://archive.ubuntu.com/ubuntu", "main,universe", "gutsy"),
}
SUITES = {"bookworm": "Debian", "trixie": "Debian", "noble": "Ubuntu"}
"""Debian 12 and 13, Ubuntu 24.04."""


@dataclass(frozen=True)
class Machine:
    """A system below a folder."""

    root: Path

    def run(self, user: str, script: str) -> "subprocess.CompletedProcess[str]":
        """Run a script in the user's home, without a terminal; what it prints comes as one text."""
        home = "/root" if user == "root" else f"/home/{user}"
        settings = {"HOME": home, "USER": user, "LANG": "C.UTF-8", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}
        settings |= {
            key: value for key, value in os.environ.items() if key in PASSED_ON or key.startswith("PIP_")
        }
        return subprocess.run(
            ["unshare", "--mount", "sh", "-c", INSIDE, "sh", str(self.root), user, f"cd ~; {script}"],
            env=settings, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, errors="replace", check=False,
        )  # fmt: skip

    def succeed(self, user: str, script: str) -> str:
        """The same, for what must end well."""
        done = self.run(user, script)
        assert done.returncode == 0, f"{script}: exit code {done.returncode}\n{done.stdout[-6000:]}"
        return done.stdout


def mirror(name: str) -> str:
    """The mirror of a distribution: that of apt here if it has one."""
    if shutil.which("apt-get") is not None:
        shown = "$(SITE) $(RELEASE) $(ORIGIN)"
        wanted = ["apt-get", "indextargets", "--format", shown, "Created-By: Packages"]
        lines = subprocess.run(wanted, capture_output=True, text=True, check=True).stdout.splitlines()
        for site, release, *origin in map(str.split, lines):
            if origin == [name] and "-" not in release:
                return site
    return DISTRIBUTIONS[name].mirror


def bootstrap(suite: str, root: Path) -> None:
    """Unpack the smallest system of a suite that can fetch a clone; skip the test where that cannot be."""
    if os.geteuid() != 0:
        pytest.skip("no fresh machine: debootstrap needs root")
    if shutil.which("debootstrap") is None:
        pytest.skip("no fresh machine: debootstrap is not here (apt-get install debootstrap)")
    distribution = DISTRIBUTIONS[SUITES[suite]]
    known = Path("/usr/share/debootstrap/scripts", suite).exists()
    options = ["--variant=minbase", "--include=ca-certificates,git,make,sudo"]
    options += [f"--components={distribution.components}"]
    words = [suite, str(root), mirror(SUITES[suite]), *([] if known else [distribution.script])]
    made = subprocess.run(
        ["debootstrap", *options, *words],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
    )  # fmt: skip
    if made.returncode != 0:
        pytest.skip(f"no fresh machine: debootstrap {suite}: {made.stdout.strip().splitlines()[-1:]}")


@pytest.fixture(scope="module", params=SUITES)
def machine(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Iterator[Machine]:
    root = tmp_path_factory.mktemp(request.param) / "root"
    bootstrap(request.param, root)
    for name in CONFIGURATION:
        source, target = Path("/", name), root / name
        if source.is_dir():
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree(source, target, symlinks=True)
        elif source.is_file():
            shutil.copy(source, target)
    new = Machine(root)
    for user in ("sudoer", "plain"):
        new.succeed("root", f"useradd --create-home --shell /bin/bash {user}")
    (root / "etc" / "sudoers.d" / "sudoer").write_text("sudoer ALL=(ALL) NOPASSWD: ALL\n")
    subprocess.run(
        ["git", "clone", "--quiet", "--bare", str(ROOT), str(root / "srv" / "carom.git")], check=True
    )
    yield new
    shutil.rmtree(root.parent, ignore_errors=True)


def clone(machine: Machine, user: str) -> None:
    machine.succeed(user, "git config --global safe.directory '*'; git clone --quiet /srv/carom.git carom")


def test_without_root_there_are_instructions_and_nothing_else(machine: Machine) -> None:
    clone(machine, "plain")
    done = machine.run("plain", "cd carom && make setup")
    assert done.returncode != 0
    assert "apt-get install" in done.stdout
    assert "CMAKE_PREFIX_PATH" in done.stdout
    assert "Traceback" not in done.stdout
    assert machine.succeed("plain", "cd carom && git status --porcelain --ignored") == ""


def test_the_two_commands_as_a_user_with_sudo(machine: Machine) -> None:
    clone(machine, "sudoer")
    (commands,) = shell("README.md", "fresh")
    experiments, test, install = commands.text.splitlines()
    assert "missing packages" in machine.succeed(
        "sudoer", f"cd carom && {experiments.split('#')[0]} SCALE=quick"
    )
    report = machine.root / "home" / "sudoer" / "carom" / "results" / "report.html"
    assert report.stat().st_size > 100_000
    machine.succeed("sudoer", f"cd carom && {test}")
    machine.succeed("sudoer", f"cd carom && {install}")
    for block in shell("docs/start.md", "fresh"):
        machine.succeed("sudoer", f"cd carom && {block.text}")
    assert machine.succeed("sudoer", "cd carom && git status --porcelain") == ""
    machine.succeed("sudoer", "cd carom && make distclean")
    assert machine.succeed("sudoer", "cd carom && git status --porcelain --ignored") in ("", "!! results/\n")


INSTALLED = ("docs/compare.md", "docs/start.md")
"""The pages whose quick commands need no checkout."""


def test_installed_it_works_in_an_empty_folder_and_leaves_without_a_trace(machine: Machine) -> None:
    machine.succeed("sudoer", "rm -rf carom anywhere && mkdir anywhere")
    clone(machine, "sudoer")
    machine.succeed("sudoer", "cd carom && make setup install")
    anywhere = machine.root / "home" / "sudoer" / "anywhere"
    for name in INSTALLED:
        for block in document(name):
            if block.language == "sh" and block.word == "":
                installed = 'export PATH="$HOME/.local/bin:$PATH"; cd anywhere'
                machine.succeed("sudoer", f"{installed}; {block.text}")
            elif block.language not in ("sh", "diff") and block.word.startswith("mine/"):
                write_file(block, anywhere)
                machine.succeed("root", f"chown -R sudoer /home/sudoer/anywhere/{Path(block.word).parent}")
    machine.succeed("sudoer", "cd carom && make uninstall")
    assert machine.succeed("sudoer", "find .local -type f -o -type l") == ""


def test_the_package_is_installed_and_removed(machine: Machine) -> None:
    """After the one above, which has cloned and built."""
    machine.succeed("root", "apt-get install --yes dpkg-dev")
    before = machine.succeed("root", FILES)
    machine.succeed("sudoer", "cd carom && make package")
    machine.succeed("root", "apt-get install --yes /home/sudoer/carom/build/package/*.deb")
    told = machine.succeed("plain", "carom compare --time 60s 'sleep 0.01' 'sleep 0.02'")
    assert "0.02 against" in told
    machine.succeed("root", "apt-get purge --yes carom && apt-get autoremove --purge --yes")
    assert machine.succeed("root", FILES) == before


FILES = "find /usr /etc /opt -path /usr/share/doc -prune -o -name '*carom*' -print | sort"
"""What of the system's files is called after Carom."""
