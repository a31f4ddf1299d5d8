"""A disk of a few kilobytes: a tmpfs in a mount namespace of its own, gone with the command."""

import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

_SCRIPT = """
mount -t tmpfs -o size="$1" none "$2" || exit 99
cd "$3" && shift 3
eval "$1"
"""


def run_on_small_disk(disk: Path, size: str, folder: Path, script: str, *words: str) -> str:
    """Run a shell script in `folder` while `disk` holds no more than `size`; return all that it printed.

    `$1` in the script is the script itself, `$2` and so on are the words. Skips the test, saying why, where
    the system allows no mounts.
    """
    disk.mkdir(exist_ok=True)
    command = ["sh", "-c", _SCRIPT, "sh", size, str(disk), str(folder), script, *words]
    done = subprocess.run(
        [*_namespace(), *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    if done.returncode == 99:
        pytest.skip(f"no tmpfs can be mounted here: {done.stdout.strip()}")
    assert done.returncode == 0, done.stdout
    return done.stdout


def _namespace() -> Sequence[str]:
    """How a mount namespace is had: as root at once, else in a user namespace as its root."""
    reasons = []
    for options in (["--mount"], ["--map-root-user", "--mount"]):
        try:
            done = subprocess.run(["unshare", *options, "true"], capture_output=True, text=True, check=False)
        except OSError as error:
            pytest.skip(f"no small disk can be made: unshare: {error.strerror}")
        if done.returncode == 0:
            return ["unshare", *options]
        reasons.append(done.stderr.strip())
    pytest.skip(f"no small disk can be made: {'; '.join(reasons)}")
