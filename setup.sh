#!/usr/bin/env bash
# Installs what Carom needs: Debian/Ubuntu packages that are missing, and .venv from requirements.txt.
# PYTHON=... chooses the Python (3.11 or newer). Does nothing, quickly, when nothing is to do.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# Ubuntu 22.04 (jammy) has Python 3.10 as python3.
python_packages=python3,python3-venv
! grep -qs '^UBUNTU_CODENAME=jammy' /etc/os-release || python_packages=python3.11,python3.11-venv

# Each line: needed or optional; the packages that bring it; the question that finds it, from wherever it came.
requirements() {
    cat <<TABLE
needed   g++                command_found g++
needed   cmake              command_found cmake
needed   make               command_found make
needed   git                command_found git
needed   clang              command_found clang++
needed   libomp-dev         header_found clang++ omp.h
needed   libbenchmark-dev   header_found g++ benchmark/benchmark.h
needed   libpapi-dev        header_found g++ papi.h
needed   libssl-dev         header_found g++ openssl/evp.h
needed   zlib1g-dev         header_found g++ zlib.h
needed   libcli11-dev       header_found g++ CLI/CLI.hpp
needed   nlohmann-json3-dev header_found g++ nlohmann/json.hpp
needed   libgtest-dev       header_found g++ gtest/gtest.h
needed   $python_packages   find_python
optional ninja-build        command_found ninja
optional libhwloc-dev       header_found g++ hwloc.h
optional valgrind           command_found valgrind
TABLE
}

fail() {
    echo "setup: $*" >&2
    exit 1
}

command_found() { command -v "$1" >/dev/null; }

# Looks where the compiler looks (so CPATH counts, as modules set it) and below CMAKE_PREFIX_PATH.
header_found() {
    local prefix prefixes options=()
    IFS=':;' read -ra prefixes <<<"${CMAKE_PREFIX_PATH:-}"
    for prefix in "${prefixes[@]}"; do options+=("-I$prefix/include"); done
    printf '#if !__has_include(<%s>)\n#error missing\n#endif\n' "$2" |
        "$1" -E -x c++ "${options[@]}" - >/dev/null 2>&1
}

# Sets `python` to one that is new enough and can make a virtual environment.
find_python() {
    local candidates=(python3 /usr/bin/python3 python3.14 python3.13 python3.12 python3.11)
    [[ -z ${PYTHON:-} ]] || candidates=("$PYTHON")
    for python in "${candidates[@]}"; do
        "$python" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && return
    done
    return 1
}

# missing_packages needed|optional: the packages of what is not found.
missing_packages() {
    local importance packages question
    requirements | while read -r importance packages question; do
        # shellcheck disable=SC2086 # the question is a command and its arguments
        [[ $importance != "$1" ]] || $question </dev/null || tr ',' '\n' <<<"$packages"
    done
}

# Sets `as_root` to what runs a command as root; fails, saying why, where that cannot be.
find_root() {
    as_root=()
    command_found apt-get || { why="no apt-get here"; return 1; }
    ((EUID != 0)) || return 0
    command_found sudo || { why="not root, and no sudo"; return 1; }
    sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; } || { why="not root, and sudo is refused"; return 1; }
    as_root=(sudo)
}

explain_by_hand() {
    cat >&2 <<TEXT

An administrator of a Debian or Ubuntu machine installs them with
    apt-get install $*
Without one, Carom takes any copy that it is pointed at:
    module load gcc llvm cmake papi python       (names differ between clusters: module avail)
    export CMAKE_PREFIX_PATH=/one/prefix:/another (libraries with include/ and lib/ below)
    export PATH=/one/prefix/bin:\$PATH             (compilers and tools)
    make setup PYTHON=/path/to/python3.11         (Python 3.11 or newer, with venv)
Then run make setup again.
TEXT
}

install_packages() {
    local needed optional missing why
    mapfile -t needed < <(missing_packages needed)
    mapfile -t optional < <(missing_packages optional)
    missing=("${needed[@]}" "${optional[@]}")
    ((${#missing[@]})) || return 0
    echo "setup: missing packages: ${missing[*]}"
    if find_root; then
        echo "setup: installing them with apt-get"
        "${as_root[@]}" apt-get update -qq || echo "setup: some package lists are old; going on"
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes -qq --no-install-recommends \
            -o DPkg::Lock::Timeout=300 "${missing[@]}" </dev/null || why="apt-get failed, its reason is above"
        mapfile -t needed < <(missing_packages needed)
        [[ -n ${why:-} ]] || why="not found although apt-get installed them"
    fi
    if ((${#needed[@]})); then
        echo "setup: Carom needs what cannot be installed here ($why): ${needed[*]}" >&2
        explain_by_hand "${missing[@]}"
        exit 1
    fi
    mapfile -t optional < <(missing_packages optional)
    ((${#optional[@]} == 0)) || echo "setup: going on without ${optional[*]} ($why):" \
        "slower builds or fewer counters"
}

# What tells one Python installation from another.
identity() { "$1" -c 'import sys; print(sys.base_prefix, sys.version)' 2>/dev/null; }

environment_is_current() {
    local now
    cmp -s requirements.txt .venv/requirements.txt && now=$(identity .venv/bin/python) &&
        compgen -G '.venv/lib/python*/site-packages/carom.pth' >/dev/null &&
        [[ -z ${PYTHON:-} || $now == "$(identity "$PYTHON")" ]]
}

make_environment() {
    ! environment_is_current || return 0
    find_python || fail "no Python 3.11 or newer with venv found: make setup PYTHON=/path/to/python3"
    echo "setup: making .venv with $("$python" -c 'import sys; print(sys.executable, sys.version.split()[0])')"
    if ! { "$python" -m venv --clear .venv &&
        .venv/bin/python -m pip install --quiet --disable-pip-version-check --requirement requirements.txt; } </dev/null
    then
        rm -rf .venv
        fail "pip could not install requirements.txt into .venv (its reason is above); run make setup again"
    fi
    # Lets it find the packages of this checkout from any folder.
    echo ../../../.. >"$(echo .venv/lib/python*/site-packages)/carom.pth"
    # Copied last: it says that the environment is whole.
    cp requirements.txt .venv/requirements.txt
}

[[ -z ${PYTHON:-} ]] || find_python || fail "PYTHON=$PYTHON: expected a Python 3.11 or newer with venv and ensurepip"
install_packages
make_environment
echo "setup: complete"
