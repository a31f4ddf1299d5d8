"""A folder that is gone afterwards, also where this process is killed."""

import contextlib
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

_REMOVE = """read -r nothing
left=50
while [ -e "$1" ] && [ $left -gt 0 ]; do rm -rf "$1"; left=$((left - 1)); [ -e "$1" ] && sleep 0.1; done
eval "$2" """
"""For a shell: once its standard input is closed, remove a folder, which others may still write into."""


@contextlib.contextmanager
def vanishing_folder(prefix: str, then: str = "") -> Iterator[Path]:
    """A new folder for temporary files; `then` is a line for a shell that comes after its removal.

    A process of a session of its own sees this one's end, however it ends, and removes what is left.
    """
    with tempfile.TemporaryDirectory(prefix=prefix, ignore_cleanup_errors=True) as folder:
        words = ("sh", "-c", _REMOVE, "sh", folder, then)
        nowhere = subprocess.DEVNULL
        remover = subprocess.Popen(
            words, cwd="/", stdin=subprocess.PIPE, stdout=nowhere, stderr=nowhere, start_new_session=True
        )
        try:
            yield Path(folder)
        finally:
            assert remover.stdin is not None
            remover.stdin.close()
            remover.wait()
