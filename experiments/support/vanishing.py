"""A folder that is gone afterwards, also where this process is killed."""

import contextlib
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from support.files import FLEETING

_MARK = "CAROM_FOLDER"
_REMOVE = f"""read -r nothing
left=50
while
    found=$(grep -lsF "{_MARK}=$1" /proc/[0-9]*/environ)
    for one in $found; do one=${{one%/environ}}; kill -9 "${{one#/proc/}}"; done
    rm -rf "$1"
    left=$((left - 1))
    [ -n "$found$(ls -d "$1")" ] && [ $left -gt 0 ]
do sleep 0.1; done
eval "$2" """
"""For a shell: once its standard input is closed, end what is marked, and remove the folder."""


def marked(environment: Mapping[str, str], folder: Path) -> dict[str, str]:
    """An environment by which all that is started with it is known, and ends with the folder."""
    return {**environment, _MARK: str(folder)}


@contextlib.contextmanager
def vanishing_folder(prefix: str, then: str = "") -> Iterator[Path]:
    """A new folder for temporary files; `then` is a line for a shell that comes after its removal.

    A process of a session of its own sees this one's end, however it ends, ends what was `marked`, and
    removes what is left.
    """
    with tempfile.TemporaryDirectory(prefix=prefix, ignore_cleanup_errors=True) as folder:
        words = ("/bin/sh", "-c", _REMOVE, "sh", folder, then)
        nowhere = subprocess.DEVNULL
        remover = subprocess.Popen(
            words, cwd="/", stdin=subprocess.PIPE, stdout=nowhere, stderr=nowhere, start_new_session=True
        )
        FLEETING.add(Path(folder))
        try:
            yield Path(folder)
        finally:
            assert remover.stdin is not None
            remover.stdin.close()
            remover.wait()
