#!/usr/bin/env bash
# Finishes an installation below the prefix $1: the Python environment, which no other package sees, and the links by which
# the program, its page and its completions are found. CMake calls it (`make install`, `make package`).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
prefix=$1
home=$prefix/lib/carom
environment=$home/.venv
python=$PWD/.venv/bin/python
[[ -x $python ]] || { echo "install: no .venv here: run \`make setup\` first" >&2; exit 1; }

# What runs, without what only developing needs; the versions are those of requirements.txt.
mapfile -t needed < <("$python" -c '
import tomllib
print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"], sep="\n")')
rm -rf "$environment"
"$python" -m venv --without-pip "$environment"
"$python" -m pip --python "$environment/bin/python" install --quiet --disable-pip-version-check \
    --no-warn-script-location --constraint requirements.txt "${needed[@]}" </dev/null

# A folder that is moved, or staged for a package, must not name the place where it was made.
find "$environment/bin" ! -name 'python*' -type f -delete
sed -i '/^command = /d' "$environment/pyvenv.cfg"
packages=$(echo "$environment"/lib/python*/site-packages)
echo ../../../.. >"$packages/carom.pth"
# Written now, they belong to the installation: nothing is left behind when it is removed.
"$environment/bin/python" -m compileall -q -f ${DESTDIR:+-s "$DESTDIR"} "$home/analysis" "$home/experiments" "$home/support" "$packages"

mkdir -p "$prefix/bin" "$prefix/share/man/man1" "$prefix/share/bash-completion/completions" \
    "$prefix/share/zsh/site-functions"
ln -sfn ../lib/carom/build/gcc/carom "$prefix/bin/carom"
carom=$home/build/gcc/carom
"$carom" help --man | gzip -9n >"$prefix/share/man/man1/carom.1.gz"
"$carom" help --completion bash >"$prefix/share/bash-completion/completions/carom"
"$carom" help --completion zsh >"$prefix/share/zsh/site-functions/_carom"
