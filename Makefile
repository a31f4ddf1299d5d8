# A thin face over cmake, ctest, pytest and the Python packages experiments/ and analysis/ (`make help`).
# What the user gives (STUDY=... and so on) reaches the shell through its environment, quoted, never as text.

.DEFAULT_GOAL := help
# Goals and prerequisites run one after another in the order given, also in `make -j2 setup test`.
.NOTPARALLEL:
.SILENT:
.PHONY: help setup environment build build-gcc build-clang install uninstall package calibration-gcc \
        tests-gcc tests-clang test test-all sanitize test-slurm fuzz fuzz-scenes fuzz-files experiments appendix calibrate \
        docs lint lint-quick format clean distclean settings

export COMPILER ?= gcc
CXX_gcc := g++
CXX_clang := clang++

python := .venv/bin/python -m
jobs := --parallel "$${JOBS:-$$(nproc)}"
generator := CMAKE_GENERATOR="$${CMAKE_GENERATOR:-$$(command -v ninja >/dev/null && echo Ninja || echo Unix Makefiles)}"
configure = CXX=$(CXX_$*) $(generator) cmake --preset release -B build/$* -DCAROM_WARNINGS_AS_ERRORS="$${WERROR:+ON}"
sources := find kernels variants harness -name '*.[ch]pp'
study := $${STUDY:+--study "$$STUDY"} $${SCALE:+--scale "$$SCALE"} $${SITE:+--site "$$SITE"} $${QUESTIONS:+--questions "$$QUESTIONS"}
results := $${RESULTS:+--results "$$RESULTS"}
limits := $${BUDGET:+--budget "$$BUDGET"} $${UNTIL:+"--until-$$UNTIL"}

# What may be given, with what holds if it is not: `make help` prints these lines.
#: Settings, given as NAME=VALUE behind the verb; in brackets what holds without:
#:   STUDY=      questions out of QUESTIONS, between commas (all)
#:   SCALE=      paper or quick, a tenth of the discs (paper)
#:   SITE=       where it runs: a name in experiments/sites, or a file *.toml (local)
#:   QUESTIONS=  folder of questions of your own (experiments/questions)
#:   RESULTS=    folder of records, figures and report (results)
#:   BUDGET=     minutes for the whole study, report included (45 at paper scale, 2.5 at quick scale)
#:   UNTIL=      decided: measure until all that can be decided is (no: for the budget)
#:   DRY_RUN=    1: say what would be done, do nothing (no)
#:   PREFIX=     where it is installed (~/.local)
#:   DESTDIR=    a folder put before PREFIX, to make a package of what is installed (none)
#:   COMPILER=   gcc or clang (gcc)
#:   JOBS=       compilers and tests at a time (one a processor)
#:   WERROR=     1: a compiler's warning stops the build (no)
#:   TIME=       seconds of random input for each reader, and of each stream of calibrate (60)
#:   FIGURES=    those of docs/figures/figures.toml that docs makes again (all that are stale)
#:   PYTHON=     the Python that makes .venv, 3.11 or newer (the system's)
#:
#: Exit codes: 0 done; else 2, and make's last line names that of the command, `Error N`:
#:   1 wrong input or usage, told in one line; 2 a point or a check failed, as the report says; 130 stopped, the
#:   same command goes on.
settings := STUDY SCALE SITE QUESTIONS RESULTS BUDGET UNTIL DRY_RUN PREFIX DESTDIR COMPILER JOBS WERROR TIME FIGURES PYTHON
of_tools := CC CXX CFLAGS CXXFLAGS LDFLAGS MAKEFLAGS SHELL CMAKE_% CTEST_% CCACHE_% CAROM_% PYTEST_% OMP_% PIP_%
given := $(foreach one,$(.VARIABLES),$(if $(filter command,$(firstword $(origin $(one)))),$(one)))
unknown := $(firstword $(filter-out $(settings) $(of_tools),$(given)))
$(if $(unknown),$(error $(unknown)=: is no setting, expected one of $(settings) (see `make help`)))

# A copied or moved checkout brings a build folder along that is not its own: CMake would not say what to do.
own_build = made=$$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' $(1)/CMakeCache.txt 2>/dev/null); \
	test -z "$$made" || test "$$made" -ef . || { \
	echo "$(1): was built for $$made, and this is $$PWD; \`make clean\` removes it, then build again" >&2; exit 1; }

help: ## list these verbs, the settings and the exit codes
	sed -nE 's/^([a-z-]+):[^#]*## (.*)/  make \1\t\2/p' Makefile | expand -t 20
	echo
	sed -nE 's/^#: ?//p' Makefile

settings:
	case "$${JOBS-}" in *[!0-9]*|0*) echo "JOBS=$$JOBS: expected a whole number of at least 1" >&2; exit 1;; esac
	case "$${UNTIL-}" in ""|decided) ;; *) echo "UNTIL=$$UNTIL: expected decided" >&2; exit 1;; esac
	case "$${TIME-}" in *[!0-9]*) echo "TIME=$$TIME: expected a whole number of seconds" >&2; exit 1;; esac

setup: ## install what is missing and make .venv (PYTHON=another Python, 3.11 or newer)
	./setup.sh

build: settings ## build build/$COMPILER/carom (COMPILER=gcc|clang; JOBS=; WERROR=1 stops at a warning)
	case "$$COMPILER" in gcc|clang) ;; *) echo "COMPILER=$$COMPILER: expected gcc or clang" >&2; exit 1;; esac
	$(MAKE) --no-print-directory "build-$$COMPILER"

# The program alone: what the study and the verbs need. The tests are built for the tests.
build-gcc build-clang: build-%: settings
	$(call own_build,build/$*)
	$(configure)
	cmake --build build/$* --target carom $(jobs)

tests-gcc tests-clang: tests-%: settings
	$(call own_build,build/$*)
	$(configure)
	cmake --build build/$* $(jobs)

# What is there, in one folder, lib/carom, which looks as a checkout does; and links to it.
prefix := "$${PREFIX:-$$HOME/.local}"
install: environment build-gcc build-clang ## install it, to be called `carom` in any folder (PREFIX=~/.local DESTDIR=)
	cmake --install build/clang --prefix $(prefix) --component clang >/dev/null
	cmake --install build/gcc --prefix $(prefix) --component gcc >/dev/null
	echo "installed: $${DESTDIR-}"$(prefix)/bin/carom

uninstall: ## remove what was installed (PREFIX= DESTDIR=)
	place="$${DESTDIR-}"$(prefix); rm -rf "$$place/lib/carom"; rm -f "$$place/bin/carom" \
		"$$place/share/man/man1/carom.1.gz" "$$place/share/bash-completion/completions/carom" \
		"$$place/share/zsh/site-functions/_carom"

package: environment build-gcc build-clang ## make a Debian package of it, for the distribution at hand (needs dpkg-dev)
	command -v dpkg-shlibdeps >/dev/null || { echo "package: needs dpkg-shlibdeps (Debian: the package dpkg-dev)" >&2; exit 1; }
	cd build/gcc && cpack -B ../package >../package.log 2>&1 || { tail -n 3 ../package.log >&2; exit 1; }; \
	rm -rf ../package/_CPack_Packages
	ls build/package/*.deb

test: settings lint-quick tests-gcc tests-clang ## build with both compilers and run every quick test
	ctest --test-dir build/gcc --output-on-failure --no-tests=error -LE slow $(jobs)
	ctest --test-dir build/clang --output-on-failure --no-tests=error -LE slow $(jobs)
	$(python) pytest --numprocesses "$${JOBS:-$$(nproc)}" --dist loadfile

test-all: test ## and the slow ones, and those that need Slurm
	ctest --test-dir build/gcc --output-on-failure -L slow
	ctest --test-dir build/clang --output-on-failure -L slow
	$(python) pytest -m "slow or slurm"
	if command -v run-clang-tidy >/dev/null; then $(MAKE) --no-print-directory lint; \
	else echo "clang-tidy: not run: it is not here (Debian: the package clang-tidy)"; fi
	$(MAKE) --no-print-directory fuzz-files
	if echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' | \
		clang++ -fsanitize=fuzzer -x c++ - -o /dev/null 2>/dev/null; then $(MAKE) --no-print-directory fuzz-scenes; \
	else echo "scene reader: not fuzzed: clang++ has no libFuzzer here (Debian: the package libclang-rt-dev)"; fi

fuzz: fuzz-scenes fuzz-files ## let random input loose on every reader (TIME=60, seconds for each; needs libclang-rt-dev)

fuzz-scenes: environment settings
	$(generator) cmake --preset fuzz
	cmake --build build/fuzz $(jobs)
	mkdir -p build/fuzz/corpus
	build/fuzz/harness/tests/scenes/fuzz/scene_seeds build/fuzz/seeds
	build/fuzz/harness/tests/scenes/fuzz/scene_reader_fuzz -max_total_time="$${TIME:-60}" -timeout=10 -print_final_stats=1 \
		-dict=harness/tests/scenes/fuzz/scene.dict -artifact_prefix=build/fuzz/ build/fuzz/corpus build/fuzz/seeds

fuzz-files: environment
	CAROM_FUZZ_SECONDS="$${TIME:-60}" $(python) pytest -m fuzz -s

sanitize: environment settings ## run the quick C++ tests with AddressSanitizer and UBSan, then with ThreadSanitizer (most of an hour)
	for preset in asan-ubsan tsan; do \
		$(generator) cmake --preset $$preset && cmake --build --preset $$preset $(jobs) && ctest --preset $$preset $(jobs) || exit 1; \
	done

test-slurm: environment ## the tests that need Slurm, which they unpack themselves (Debian's packages, no root)
	$(python) pytest -m slurm --numprocesses 2 --dist loadfile

# A mistake is told before anything is built. What g++'s build can measure is measured before another one is built. A
# point that failed (2) belongs in the report and still fails the goal.
run := $(python) experiments run $(study) $(results) $(limits)
experiments: environment settings ## run the study, then report (STUDY= SCALE= SITE= QUESTIONS= RESULTS= BUDGET= UNTIL= DRY_RUN=1)
	builds=$$($(python) experiments builds $(study) $(results) $(limits)) || exit; \
	if test -n "$${DRY_RUN-}"; then exec $(python) experiments plan $(study) $(results) $(limits); fi; \
	$(MAKE) --no-print-directory build-gcc || exit; \
	case $$builds in *clang*) \
		$(run) --builds gcc; case $$? in 0|2) ;; *) exit $$?;; esac; \
		$(MAKE) --no-print-directory build-clang || exit;; \
	esac; \
	$(run)

# analysis/report/graphs.toml says which graphs these are.
graphs := neighbourhood,self_contained_checkered,self_contained_track,self_contained_repeat,schedule_find,schedule_resolve,schedule_resolve_row
appendix: ## draw the graphs of the published appendix as SVG and PDF, measuring what is missing (SCALE= RESULTS= BUDGET=)
	$(MAKE) --no-print-directory experiments STUDY=$(graphs)
	test -n "$${DRY_RUN-}" || $(python) analysis figures $(results) --experiment $(graphs)

calibration-gcc: calibration-%: settings
	$(call own_build,build/$*)
	$(configure)
	cmake --build build/$* --target calibration $(jobs)

calibrate: environment settings calibration-gcc ## measure how often verdicts are wrong on this machine (TIME=60 RESULTS=results/calibration)
	$(python) experiments calibrate $(results) $${TIME:+--seconds "$$TIME"}

docs: environment settings build-gcc ## make docs/reference and the figures that are stale again (FIGURES=; may take hours)
	$(python) docs.generate $${FIGURES:+--figures "$$FIGURES"}

lint: settings lint-quick ## every static check of C++ and Python (clang-tidy from the package of that name)
	CXX=clang++ $(generator) cmake --preset release -B build/lint -DCAROM_UNITY=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
	cmake --build build/lint --target carom_build_info
	run-clang-tidy -quiet -p build/lint -j "$${JOBS:-$$(nproc)}"

lint-quick: environment
	$(sources) -exec .venv/bin/clang-format --dry-run --Werror {} +
	$(python) ruff check
	$(python) ruff format --check
	$(python) mypy

format: environment ## format C++ and Python
	$(sources) -exec .venv/bin/clang-format -i {} +
	$(python) ruff check --fix
	$(python) ruff format

clean: ## remove what was built
	rm -rf build

distclean: clean ## and .venv and caches; results/ always stays
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

environment:
	test -x .venv/bin/python || { echo "no .venv here: run \`make setup\` first" >&2; exit 1; }
	cmp -s requirements.txt .venv/requirements.txt || { \
		echo ".venv has not what requirements.txt asks for now: run \`make setup\` again" >&2; exit 1; }
