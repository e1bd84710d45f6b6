# Targets for newcomers, developers and the CI. Each target sets up what it needs in a private
# environment, which is made once and reused. Only Python >= 3.11, pip and make are needed.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OLDEST := .venv-lowest
DASK   := .venv-cluster
OUTPUT ?= results
QUALITY ?= quick
WHICH ?= all
ALL_LESSONS := [0-9]
LESSON ?= $(ALL_LESSONS)
LESSONS := build/lessons
CHECK_PYTHON := $(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
  { echo "Python 3.11 or later is needed; name one with: make PYTHON=python3.12 ..."; exit 1; }
ROOMS  := model particles kinetic comparison reproduction apps
# Many containers forbid Python to keep compiled modules. Every process then compiles all that it
# imports, for 3 s more; tests, notebooks and pages start a few hundred processes.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: help run kernels test validate cluster test-lowest torture coverage check audit reproduce lessons notebooks render browser docs \
  linkcheck benchmark package clean
.DEFAULT_GOAL := help

help:
	@echo "make run        compare simulation and theory at e = 1; figures into $(OUTPUT)/"
	@echo "make test       run the tests that are quick (2 min)"
	@echo "make validate   run the others: statistics, long runs, kills, wheel, the page in a browser (3 min)"
	@echo "make cluster    run that of sweeps on a dask cluster (half a minute)"
	@echo "make test-lowest  run the tests with the oldest allowed version of every package"
	@echo "make torture    test kills, full disks, bad input and long runs (8 min; docs/reliability.md)"
	@echo "make coverage   show which lines the tests reach, kernels included (9 min)"
	@echo "make check      check lint, format and types"
	@echo "make audit      look up known vulnerabilities of every package used (needs the network)"
	@echo "make reproduce  draw every figure and check every claim of the paper (2 min; QUALITY=full 15 min;"
	@echo "                WHICH=analytics: only the paper's analytics section, 1 min)"
	@echo "make kernels    compile the kernels, which the first simulation does otherwise (30 s)"
	@echo "make lessons    write the lessons without outputs and solutions, for learners, into $(LESSONS)/"
	@echo "make notebooks  execute the lessons, into build/notebooks/"
	@echo "make render     write the lessons from their scripts, with outputs (LESSON=03: only that one)"
	@echo "make docs       build the documentation into build/docs/ and execute its examples"
	@echo "make linkcheck  look up every address the pages point to (needs the network)"
	@echo "make benchmark  measure the speed"
	@echo "make package    build what the package index gets, into build/package/"
	@echo "make clean      remove the environment and everything built"

run: $(VENV)/installed
	$(BIN)/crazybilliards compare --output $(OUTPUT)

# Done before two processes start, which would both compile them.
kernels: $(VENV)/installed-test
	$(BIN)/python -c "from crazybilliards.particles.simulation import compile_kernels; compile_kernels()"

# Two processes use two cores. Threads of the linear algebra would only make them wait. All tests of
# a file run in one of them, and compute only once what they share. The files come in their order:
# the last ones take seconds, so that both processes end together.
IN_TWO := -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test: $(VENV)/installed-test
	OPENBLAS_NUM_THREADS=1 $(BIN)/python $(IN_TWO) -m "not validate"

validate: $(VENV)/installed-test
	OPENBLAS_NUM_THREADS=1 $(BIN)/python $(IN_TWO) -m validate

# xarray imports dask wherever it is, in every process, so dask has an environment of its own.
cluster:
	$(MAKE) VENV=$(DASK) $(DASK)/installed-cluster
	OPENBLAS_NUM_THREADS=1 $(DASK)/bin/python -m pytest -m cluster tests/comparison/test_executors.py

# numba's cache belongs to one version, so each environment needs a cache of its own.
test-lowest: $(OLDEST)/installed
	OPENBLAS_NUM_THREADS=1 NUMBA_CACHE_DIR=$(CURDIR)/$(OLDEST)/numba \
	  $(OLDEST)/bin/python $(IN_TWO)

# Three processes for two cores: these tests wait a lot for others that they kill.
torture: $(VENV)/installed-test
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 3 --dist worksteal --timeout=3600 -m torture

# Coverage cannot be measured in compiled kernels. Tests that are quick enough run them as Python.
coverage: $(VENV)/installed-coverage
	$(BIN)/coverage erase
	OPENBLAS_NUM_THREADS=1 NUMBA_DISABLE_JIT=1 $(BIN)/coverage run $(IN_TWO) -m "not compiled"
	OPENBLAS_NUM_THREADS=1 $(BIN)/coverage run $(IN_TWO) -m compiled
	$(BIN)/coverage combine -q
	$(BIN)/coverage report --skip-covered

# Scripts import those beside them, and a twin of the tests, by their bare names.
check: $(VENV)/installed-check
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	MYPYPATH=$(LINKS) $(BIN)/mypy -p crazybilliards
	MYPYPATH=$(LINKS):benchmarks:docs/figures:tests/twins $(BIN)/mypy studies benchmarks docs/figures

# --strict: a package that could not be looked up is a failure.
audit: $(VENV)/installed-test $(VENV)/installed-docs $(VENV)/installed-audit
	mkdir -p build
	$(BIN)/python -m pip freeze --all --exclude-editable > build/audit.txt
	$(BIN)/pip-audit --strict --no-deps --disable-pip --requirement build/audit.txt

reproduce: $(VENV)/installed
	$(BIN)/crazybilliards reproduce $(WHICH) --quality $(QUALITY)

# A lesson that exists stays, because it holds somebody's answers.
lessons: $(VENV)/installed-notebooks
	@$(BIN)/python notebooks/without_outputs.py $(LESSONS)
	@echo "open the lessons with: $(BIN)/jupyter lab $(LESSONS)"
	@echo "open the page of the chain with: $(BIN)/crazybilliards explore"

# No bars (TQDM_DISABLE) in what is kept. A number that disagrees stops a strict lesson. Copies of the
# notebooks are executed, and the documentation shows their outputs.
notebooks: $(VENV)/installed-render
	mkdir -p build/notebooks
	rm -f build/notebooks/$(LESSON)*.ipynb
	cp -R notebooks/$(LESSON)*.ipynb notebooks/teaching.py notebooks/solutions build/notebooks
	CRAZYBILLIARDS_LESSONS=strict TQDM_DISABLE=1 OPENBLAS_NUM_THREADS=1 \
	  $(BIN)/python notebooks/execute.py build/notebooks/$(LESSON)*.ipynb
	test "$(LESSON)" != "$(ALL_LESSONS)" || touch build/notebooks/executed

build/notebooks/executed: $(wildcard notebooks/*.ipynb notebooks/solutions/*.py) notebooks/teaching.py
	$(MAKE) notebooks

# The committed notebooks show their outputs on the web. A test compares code and outputs.
render: $(VENV)/installed-render
	$(BIN)/jupytext --quiet --update --to ipynb notebooks/$(LESSON)*.py
	$(MAKE) notebooks
	$(BIN)/python notebooks/outputs.py notebooks/$(LESSON)*.py
	test "$(LESSON)" != "$(ALL_LESSONS)" || touch build/notebooks/executed

# The test of the page needs a browser and is skipped without one. Root on Debian can install it.
browser:
	@command -v chromium >/dev/null && command -v chromedriver >/dev/null || \
	  { command -v apt-get >/dev/null && [ "$$(id -u)" = 0 ] && apt-get update -qq && \
	    apt-get install -y -qq --no-install-recommends chromium chromium-driver >/dev/null; } || \
	  echo "install chromium and chromedriver to test the page of crazybilliards explore"

# The examples of the pages. They are executed as the lessons are, and Sphinx takes the outputs from
# the cache. It would start a kernel for each page.
build/pages/executed: notebooks/execute.py $(wildcard docs/*.md docs/howto/*.md) | $(VENV)/installed-docs $(VENV)/installed-render
	rm -rf build/pages
	mkdir -p build/pages/cache
	cp $$(grep -l '^```{code-cell}' docs/*.md docs/howto/*.md) build/pages
	$(BIN)/jupytext --quiet --to ipynb build/pages/*.md
	TQDM_DISABLE=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python notebooks/execute.py build/pages/*.ipynb
	$(BIN)/jcache cache --cache-path build/pages/cache add build/pages/*.ipynb
	touch $@

# Warnings are errors, for example links that lead nowhere and examples that fail.
docs: $(VENV)/installed-docs build/notebooks/executed build/pages/executed
	TQDM_DISABLE=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m sphinx -W --keep-going -b html docs build/docs
	@echo "open build/docs/index.html"

linkcheck: $(VENV)/installed-docs build/notebooks/executed build/pages/executed
	$(BIN)/python -m sphinx -b linkcheck docs build/linkcheck

# The other scripts of that folder need more than these packages.
MEASURED := particle_steps contact_solves replica_threads hydrodynamics
benchmark: $(VENV)/installed-benchmark
	mkdir -p $(OUTPUT)
	$(BIN)/python -m pytest $(MEASURED:%=benchmarks/%.py) --timeout=1800 --benchmark-columns=median,iqr,rounds \
	  --benchmark-max-time=0.3 --benchmark-min-rounds=3 --benchmark-json=$(OUTPUT)/benchmark.json
	$(BIN)/python benchmarks/report.py $(OUTPUT)/benchmark.json $(OUTPUT)/cost.csv $(OUTPUT)/cost.png

# twine finds what the package index would refuse.
package: $(VENV)/installed-package
	rm -rf build/package
	$(BIN)/python -m build --outdir build/package
	$(BIN)/python -m twine check --strict build/package/*

# Type checkers and editors do not find an editable install: a finder hides the folders. A .pth file
# leads them, and Python, to links to the rooms. Links to folders have new files at once.
LINKS := build/links
$(LINKS): Makefile $(BIN)/uv
	@mkdir -p $@/crazybilliards
	@for file in __init__.py __init__.pyi __main__.py py.typed; do \
	  ln -sfn "$(CURDIR)/api/$$file" $@/crazybilliards/$$file; done
	@for room in $(ROOMS); do ln -sfn "$(CURDIR)/$$room" $@/crazybilliards/$$room; done
	@$(BIN)/python -c "from pathlib import Path; from sysconfig import get_path; \
	  Path(get_path('purelib'), 'crazybilliards.pth').write_text(f'{Path(\"$@\").resolve()}\n')"
	@touch $@

# uv installs in seconds what pip installs in a minute, and compiles no module that nobody imports.
# Python 3.11 comes with a setuptools of 2022, which has a known vulnerability.
INSTALL := $(BIN)/uv --system-certs pip install --quiet --python $(BIN)/python --upgrade-package pip \
  --upgrade-package setuptools pip setuptools --editable

$(BIN)/uv:
	@$(CHECK_PYTHON)
	@echo "making the environment $(VENV), with pip and uv; this takes some seconds"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/python -m pip install -qq uv

$(VENV)/installed: pyproject.toml $(BIN)/uv | $(LINKS)
	@echo "installing crazybilliards and what it needs into $(VENV), about 600 MB; on a slow network this takes two minutes"
	@$(INSTALL) .
	@touch $@

$(VENV)/installed-%: pyproject.toml $(BIN)/uv | $(LINKS)
	@echo "installing what make $* needs into $(VENV), once; on a slow network this takes minutes"
	@$(INSTALL) ".[$*]"
	@touch $@

$(OLDEST)/installed: pyproject.toml
	@$(CHECK_PYTHON)
	@echo "installing the oldest packages into $(OLDEST), for some minutes ..."
	@$(PYTHON) -m venv $(OLDEST)
	@$(OLDEST)/bin/python -m pip install --quiet --upgrade pip setuptools uv
	@$(OLDEST)/bin/uv --system-certs pip install --quiet --python $(OLDEST)/bin/python --resolution lowest-direct \
	  --editable ".[cluster]"
	touch $@

clean:
	rm -rf $(VENV) $(OLDEST) $(DASK) build .coverage docs/notebooks *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
