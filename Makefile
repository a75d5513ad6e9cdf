# rcyaml: `make demo` shows what it does, `make test` tests it.

VENV ?= .venv
export VENV
# Debian's module of Ice is for Debian's own python3. A newer Python that is first on PATH cannot load it.
PYTHON ?= $(or $(RCYAML_PYTHON),$(shell /usr/bin/python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
  && echo /usr/bin/python3 || echo python3))
# Many tests wait for processes: three at once use two cores.
JOBS ?= 3
FUZZ_MINUTES ?= 10
MUTANTS ?= 60
SEED ?= 1

# The packages that a goal needs. They are installed if possible; otherwise they are listed.
demo_NEEDS := python3-venv python3-zeroc-ice
test_NEEDS := $(demo_NEEDS) \
  zeroc-ice-compilers libzeroc-ice-dev zeroc-ice-slice zeroc-icebox libzeroc-icestorm3.7 zeroc-icegrid zeroc-ice-utils \
  qt6-base-dev cmake g++ make ninja-build nodejs npm git openssl iproute2 openssh-client rsync chromium \
  openjdk-17-jdk-headless libzeroc-ice3.7-java neovim
case-study_NEEDS := $(demo_NEEDS) zeroc-ice-compilers libzeroc-ice-dev zeroc-ice-slice cmake g++ make ninja-build espeak-ng
experiment_NEEDS := $(demo_NEEDS)
# More packages for the tests, which few want on their own machine: the CI has an SSH server, systemd and Emacs.
MORE ?=

.PHONY: help demo case-study experiment docs pictures test test-long fast unit fuzz mutants lint format macros bench ice clean system-demo system-test system-case-study system-experiment system-python
.NOTPARALLEL:

help:
	@echo "make demo        install into $(VENV), and run the example: migrate, check, compile, deploy, call, see"
	@echo "make case-study  the paper's case study: a head that speaks gets a mouth, in four changes"
	@echo "make experiment  the paper's five tasks, done in three ways: lines, files, commands, seconds"
	@echo "make docs        build the documentation as a site, in site/"
	@echo "make pictures    draw the pictures of the documentation again"
	@echo "make test        install the requirements of the tests, and run all tests"
	@echo "make test-long   the same with all C++ builds, more random cases and all faults: more than half an hour"
	@echo "make unit        the unit tests: some 20 seconds"
	@echo "make fast        the tests without C++ builds, editor and Ice"
	@echo "make fuzz        search for new failing examples, for FUZZ_MINUTES=10 minutes"
	@echo "make mutants     mutation tests: which of MUTANTS=60 small changes (SEED=1) the unit tests detect"
	@echo "make bench       the benchmarks, as ratios"
	@echo "make lint        static checks: rules, format, types, layers"
	@echo "make format      sort the imports, and format the code"
	@echo "make macros      update the names that C++ reserves, from this machine's compiler and headers"
	@echo "make ice         compile Ice into $(VENV), if python3-zeroc-ice of Debian cannot be installed: some minutes"
	@echo "make clean       remove $(VENV) and the files of the demo"

# The smallest Debian has no Python, with which everything else is prepared.
system-python:
	@command -v $(PYTHON) >/dev/null || sh tools/python.sh

system-demo system-test system-case-study system-experiment: system-%: system-python
	@$(PYTHON) tools/prepare.py system $* $($*_NEEDS) $(if $(filter test,$*),$(MORE))

$(VENV)/rcyaml: pyproject.toml | system-python
	@$(PYTHON) tools/prepare.py environment
	@touch $@

$(VENV)/tests: pyproject.toml $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py environment test
	@touch $@

$(VENV)/docs: pyproject.toml $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py environment docs
	@touch $@

$(VENV)/lsp: pyproject.toml $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py environment lsp
	@touch $@

$(VENV)/page: web/build_page.py web/package-lock.json $(wildcard web/src/*) $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py page
	@touch $@

demo: system-demo $(VENV)/rcyaml $(VENV)/page
	@$(VENV)/bin/python examples/demo.py

case-study: system-case-study $(VENV)/rcyaml
	@$(VENV)/bin/python examples/case_study.py

experiment: system-experiment $(VENV)/lsp
	@$(VENV)/bin/python experiments/tasks/run.py
	@$(VENV)/bin/python experiments/mistakes/compare.py

# Material for MkDocs advertises its successor on each run. With --quiet, MkDocs would not count warnings as errors.
docs: $(VENV)/docs
	@NO_MKDOCS_2_WARNING=1 $(VENV)/bin/python -m mkdocs build
	@echo "site/index.html is the first page; to serve them all: python3 -m http.server -d site"

pictures: $(VENV)/docs
	@$(VENV)/bin/python tools/pictures.py

ice: $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py ice

test: system-test $(VENV)/tests $(VENV)/page
	@$(VENV)/bin/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -q

# All builds, also the long ones that seldom fail, more cases in random tests, and all faults of a large network.
test-long: export RCYAML_ALL_BUILDS := 1
test-long: export RCYAML_CASES := 4000
test-long: export RCYAML_CPP_DOCUMENTS := 60
test-long: export RCYAML_FAULT_COMPONENTS := 30
test-long: export PYTEST_TIMEOUT := 3000
test-long: export PYTEST_ADDOPTS := -o faulthandler_timeout=4000
test-long: test

# Adds the names that this machine's compiler and headers reserve in C++.
macros: $(VENV)/tests
	@$(VENV)/bin/python tests/ice/cpp_macros.py

unit: $(VENV)/tests
	@$(VENV)/bin/python -m pytest -q -m unit

fast: $(VENV)/tests
	@$(VENV)/bin/python -m pytest -n $(JOBS) -q -m 'not slow' --ignore tests/editor --ignore tests/ice

fuzz: $(VENV)/tests
	@$(VENV)/bin/python tests/fuzz/run.py --minutes $(FUZZ_MINUTES) --jobs $(JOBS)

mutants: $(VENV)/tests
	@$(VENV)/bin/python tests/mutation/run.py --mutants $(MUTANTS) --seed $(SEED)

lint: $(VENV)/tests
	@$(VENV)/bin/python tools/lint.py

format: $(VENV)/tests
	@$(VENV)/bin/python tools/lint.py --fix

bench: $(VENV)/lsp
	@$(VENV)/bin/python benchmarks/run.py
	@$(VENV)/bin/python benchmarks/living.py
	@$(VENV)/bin/python benchmarks/editors.py --page

clean:
	rm -rf $(VENV) .demo .case-study .experiment site
