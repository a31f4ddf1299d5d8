"""Files that are whole or not there."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Give a path to write to, which becomes the target once all of it is on the disk.

    Meanwhile it is `.NAME.part.SUFFIX` beside the target; if writing fails it is gone, and an earlier target
    as it was. Makes the folder. Raises OSError that names the target.
    """
    part = target.with_name(f".{target.stem}.part{target.suffix}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        yield part
        with part.open("rb") as file:
            os.fsync(file.fileno())
        part.replace(target)
    except BaseException as error:
        with contextlib.suppress(OSError):
            part.unlink()
        if isinstance(error, OSError) and error.filename in (None, os.fspath(part)):
            raise OSError(error.errno, error.strerror or str(error), os.fspath(target)) from error
        raise
