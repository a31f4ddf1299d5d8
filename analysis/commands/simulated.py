"""The run of a scene that is still to be simulated: by the program, into a file that is gone afterwards."""

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class ProgramError(Exception):
    """The program said on standard error why; it ended with `exit_code`."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(f"exit code {exit_code}")
        self.exit_code = exit_code


@contextmanager
def simulated(program: Path, scene: Path, variant: str) -> Iterator[Path]:
    """The trajectory of a variant on a scene. The program's summary goes where this program's output goes.

    Raises ProgramError.
    """
    with tempfile.TemporaryDirectory(prefix="carom-") as folder:
        trajectory = Path(folder) / "trajectory"
        words = [program, "run", scene, "--variant", variant, "--trajectory", trajectory]
        code = subprocess.call([str(word) for word in words])
        if code != 0:
            raise ProgramError(code if code > 0 else 128 - code)
        yield trajectory
