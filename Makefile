# A thin face over cmake, ctest, pytest and the Python packages experiments/ and analysis/ (`make help`).
# What the user gives (STUDY=... and so on) reaches the shell through its environment, quoted, never as text.

.DEFAULT_GOAL := help
# Goals and prerequisites run one after another in the order given, also in `make -j2 setup test`.
.NOTPARALLEL:
.SILENT:
.PHONY: help setup environment build build-gcc build-clang build-gcc-libomp tests-gcc tests-clang test test-all sanitize test-slurm fuzz fuzz-scenes fuzz-files movie \
        experiments status submit resume collect figures report compare lint lint-quick format clean distclean

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
dry_run := $${DRY_RUN:+--dry-run}

help: ## list these verbs
	sed -nE 's/^([a-z-]+):[^#]*## (.*)/  make \1\t\2/p' Makefile | expand -t 20

setup: ## install what is missing and make .venv (PYTHON=another Python, 3.11 or newer)
	./setup.sh

build: ## build build/$COMPILER/carom (COMPILER=gcc|clang|gcc-libomp; JOBS=; WERROR=1 stops at a warning)
	case "$$COMPILER" in gcc|clang|gcc-libomp) ;; *) echo "COMPILER=$$COMPILER: expected gcc, clang or gcc-libomp" >&2; exit 1;; esac
	$(MAKE) --no-print-directory "build-$$COMPILER"

# The program alone: what the study and the verbs need. The tests are built for the tests.
build-gcc build-clang: build-%:
	$(configure)
	cmake --build build/$* --target carom $(jobs)

tests-gcc tests-clang: tests-%:
	$(configure)
	cmake --build build/$* $(jobs)

# g++'s code with the OpenMP runtime of clang++, which has g++'s entry points too: to compare the compilers' code alone.
build-gcc-libomp:
	CXX=g++ $(generator) cmake --preset release -B build/gcc-libomp -DBUILD_TESTING=OFF \
		-DOpenMP_CXX_FLAGS=-fopenmp -DOpenMP_CXX_LIB_NAMES=omp \
		-DOpenMP_omp_LIBRARY="$$(dirname "$$(readlink -f "$$(command -v clang++)")")/../lib/libomp.so"
	cmake --build build/gcc-libomp $(jobs) --target carom

test: lint-quick tests-gcc tests-clang ## build with both compilers and run every quick test
	ctest --test-dir build/gcc --output-on-failure --no-tests=error -LE slow $(jobs)
	ctest --test-dir build/clang --output-on-failure --no-tests=error -LE slow $(jobs)
	$(python) pytest

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

fuzz-scenes: environment
	$(generator) cmake --preset fuzz
	cmake --build build/fuzz $(jobs)
	mkdir -p build/fuzz/corpus
	build/fuzz/harness/tests/scenes/fuzz/scene_seeds build/fuzz/seeds
	build/fuzz/harness/tests/scenes/fuzz/scene_reader_fuzz -max_total_time="$${TIME:-60}" -timeout=10 -print_final_stats=1 \
		-dict=harness/tests/scenes/fuzz/scene.dict -artifact_prefix=build/fuzz/ build/fuzz/corpus build/fuzz/seeds

fuzz-files: environment
	CAROM_FUZZ_SECONDS="$${TIME:-60}" $(python) pytest -m fuzz -s

sanitize: environment ## run the quick C++ tests with AddressSanitizer and UBSan, then with ThreadSanitizer (most of an hour)
	for preset in asan-ubsan tsan; do \
		$(generator) cmake --preset $$preset && cmake --build --preset $$preset $(jobs) && ctest --preset $$preset $(jobs) || exit 1; \
	done

test-slurm: environment ## the tests that need Slurm, which they unpack themselves (Debian's packages, no root)
	$(python) pytest -m slurm

# What g++'s build can measure is measured before another one is built. A point that failed (2) belongs in the report
# and still fails the goal.
run := $(python) experiments run $(study) $(results) $${BUDGET:+--budget "$$BUDGET"} $${UNTIL:+"--until-$$UNTIL"}
experiments: environment build-gcc ## run the study, then report (STUDY= SCALE=quick|paper SITE= QUESTIONS= RESULTS= BUDGET=minutes UNTIL=decided)
	builds=$$($(python) experiments builds $(study)) || exit; \
	case $$builds in *clang*) \
		$(run) --builds gcc; case $$? in 0|2) ;; *) exit $$?;; esac; \
		$(MAKE) --no-print-directory build-clang || exit;; \
	esac; \
	code=0; $(run) || code=$$?; \
	case $$code in 0|2) $(python) analysis report $(results) && exit $$code;; *) exit $$code;; esac

status: environment ## what of the study is done, what is missing (STUDY= SCALE= SITE= RESULTS=)
	$(python) experiments status $(study) $(results)

submit: environment ## hand what is missing to a Slurm cluster (SITE= STUDY= SCALE= RESULTS= DRY_RUN=1)
	: "$${SITE:?the site of a cluster, a file *.toml}"
	$(python) experiments submit $(study) $(results) $(dry_run)

resume: environment ## hand it again what is missing of all that was submitted (SITE= RESULTS= DRY_RUN=1)
	: "$${SITE:?the site of a cluster, a file *.toml}"
	$(python) experiments resume $(study) $(results) $(dry_run)

collect: environment ## merge a cluster's records, or another folder's, into RESULTS (SITE= or FROM=)
	: "$${FROM:-$${SITE:?the site of a cluster, or FROM=, a results folder}}"
	$(python) experiments collect $(study) $(results) $${FROM:+"$$FROM"}

figures: environment ## draw the figures of whatever is there (RESULTS=)
	$(python) analysis figures $(results)

report: environment ## write the report of whatever is there (RESULTS=)
	$(python) analysis report $(results)

movie: environment build ## draw a run (SCENE= OUT=*.mp4|*.gif|*.png VARIANT= STEP=)
	: "$${SCENE:?a scene file}"
	folder=$$(mktemp -d) && trap 'rm -rf "$$folder"' EXIT && \
	"build/$$COMPILER/carom" run "$$SCENE" --variant "$${VARIANT:-published}" --trajectory "$$folder/trajectory" && \
	$(python) analysis movie "$$SCENE" "$$folder/trajectory" $${OUT:+--output "$$OUT"} $${STEP:+--step "$$STEP"}

compare: environment ## compare two result folders (A= B=)
	: "$${A:?one result folder}" "$${B:?the other result folder}"
	$(python) analysis compare "$$A" "$$B"

lint: lint-quick ## every static check of C++ and Python (clang-tidy from the package of that name)
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
