"""Slurm as Debian packages it, unpacked into a cache folder: nothing is installed, no root is needed."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

PACKAGES = (
    "libhwloc15",
    "liblua5.1-0",
    "libmunge2",
    "munge",
    "slurm-client",
    "slurm-wlm-basic-plugins",
    "slurmctld",
    "slurmd",
)
_DAEMONS = ("slurmctld", "slurmd", "slurmstepd")


class UnavailableError(Exception):
    """Why there is no Slurm to be had."""


def unpacked() -> Path:
    """The folder of the unpacked packages, made if need be. Raises UnavailableError with the reason."""
    for tool in ("apt-get", "dpkg"):
        if shutil.which(tool) is None:
            raise UnavailableError(f"{tool} is not here: Slurm comes as Debian's packages")
    root = _cache() / _release()
    if not root.is_dir():
        root.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=root.parent) as scratch:
            _download(Path(scratch))
            fresh = _unpack(Path(scratch))
            # Another run of the tests may have been faster.
            if not root.is_dir():
                fresh.rename(root)
    return root


def libraries(root: Path) -> Path:
    """The folder of the unpacked libraries; its folder `slurm-wlm` holds the plug-ins."""
    return next(root.glob("usr/lib/*-linux-gnu*"))


def _cache() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "carom" / "slurm"


def _release() -> str:
    """Names what packages of one Debian release have in common."""
    lines = Path("/etc/os-release").read_text(encoding="utf-8").splitlines()
    values = dict(line.split("=", 1) for line in lines if "=" in line)
    machine = os.uname().machine
    return "-".join(values.get(key, "").strip('"') for key in ("ID", "VERSION_ID")) + f"-{machine}"


def _download(folder: Path) -> None:
    done = _call("apt-get", "download", *PACKAGES, folder=folder)
    if done.returncode != 0:
        said = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise UnavailableError(f"apt-get download: {said} (`apt-get update` first?)")


def _unpack(folder: Path) -> Path:
    root = folder / "root"
    for package in sorted(folder.glob("*.deb")):
        done = _call("dpkg", "-x", os.fspath(package), os.fspath(root), folder=folder)
        if done.returncode != 0:
            raise UnavailableError(f"dpkg -x {package.name}: {done.stderr.strip()}")
    # Debian gives the daemons these names when it installs the packages.
    for name in _DAEMONS:
        (root / "usr" / "sbin" / name).symlink_to(f"{name}-wlm")
    return root


def _call(*command: str, folder: Path) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)
