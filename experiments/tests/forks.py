"""Processes of tests that are forks of this one, where a new interpreter would only load the same once more.

Python and what Carom imports take a second to begin, and one study of a test has thirty processes.
"""

import contextlib
import faulthandler
import gc
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

from experiments.run.host_lock import WAITS
from experiments.support.descendants import adopt_orphans
from experiments.tests import fake_carom
from experiments.tests.slurm import fake_slurm_commands

Main = Callable[[Sequence[str]], int]
"""A program as a function of its words; returns its exit code."""

HEAD = f"#!{sys.executable} -IS\n"
"""The first line of a stand-in, behind which it is one of these modules, whole."""
STAND_INS = {
    (HEAD + Path(str(one.__file__)).read_text(encoding="utf-8")).encode(): one
    for one in (fake_carom, fake_slurm_commands)
}

_LEFT: list[object] = []
"""What must not be closed: a stream would write what was still to be written when this process was forked."""

_Popen = subprocess.Popen


def forked(main: Main, words: Sequence[str], **options: Any) -> "subprocess.Popen[Any]":  # noqa: ANN401
    """What Popen of `words` would be, if it were the program that `main` is."""
    environment = dict(os.environ if options.get("env") is None else options["env"])
    prepare = options.pop("preexec_fn", None) or (lambda: None)
    # A signal's exception in one of the hooks of a fork would be ignored.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
    try:
        become = partial(_become, main, words, environment, prepare, mask)
        return _Popen(words, preexec_fn=become, **options)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


class Forking(_Popen):
    """Popen, but that stand-ins are forks."""

    def __new__(cls, args: Sequence[str], **options: Any) -> Any:  # noqa: ANN401
        main = _main_of(args, options.get("env") or os.environ)
        return _Popen(args, **options) if main is None else forked(main, args, **options)


def _main_of(words: Sequence[str], environment: Mapping[str, str]) -> Main | None:
    file = shutil.which(words[0], path=environment.get("PATH"))
    if file is None:
        return None
    with Path(file).open("rb") as opened:
        content = opened.read(max(map(len, STAND_INS)))
    stand_ins = (one for text, one in STAND_INS.items() if content.startswith(text))
    return next((partial(_stand_in, one, file) for one in stand_ins), None)


def _stand_in(module: ModuleType, file: str, words: Sequence[str]) -> int:
    vars(module)["__file__"] = file  # what records of it tell the hash of
    return int(module.main(words))


def _become(
    main: Main,
    words: Sequence[str],
    environment: Mapping[str, str],
    prepare: Callable[[], object],
    mask: Collection[int],
) -> NoReturn:
    """Go on as another program, in a child that has just been forked."""
    code = 1
    try:
        _begin_anew(environment)
        prepare()
        if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        sys.argv = list(words)
        code = main(words[1:])
    except SystemExit as leaving:
        code = leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)


def _begin_anew(environment: Mapping[str, str]) -> None:
    """Leave behind what a new program would not have: open files, handlers of signals, what was counted."""
    gc.freeze()
    gc.enable()
    faulthandler.disable()
    os.closerange(3, os.sysconf("SC_OPEN_MAX"))
    for number in signal.valid_signals():
        if callable(signal.getsignal(number)):
            signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    os.environ.clear()
    os.environ.update(environment)
    adopt_orphans.cache_clear()
    WAITS.seconds, WAITS.is_said = 0.0, False
    tempfile.tempdir = None
    _LEFT.extend((sys.stdin, sys.stdout, sys.stderr))
    encoding = environment.get("PYTHONIOENCODING", "utf-8")
    sys.stdin = os.fdopen(0, closefd=False)
    sys.stdout = os.fdopen(1, "w", encoding=encoding, closefd=False)
    sys.stderr = os.fdopen(2, "w", 1, encoding=encoding, errors="backslashreplace", closefd=False)
