# rcyaml: `make demo` shows what it does, `make test` proves that it works.

VENV ?= .venv
export VENV
# Ice comes as a module for Debian's own python3; a newer one in front of it cannot load it.
PYTHON ?= $(or $(RCYAML_PYTHON),$(shell /usr/bin/python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null \
  && echo /usr/bin/python3 || echo python3))
JOBS ?= 2
FUZZ_MINUTES ?= 10
MUTANTS ?= 60
SEED ?= 1

# What the system is to have for a goal: installed where that may be done, else named.
demo_NEEDS := python3-venv python3-zeroc-ice
test_NEEDS := $(demo_NEEDS) \
  zeroc-ice-compilers libzeroc-ice-dev zeroc-ice-slice zeroc-icebox libzeroc-icestorm3.7 zeroc-icegrid zeroc-ice-utils \
  qt6-base-dev cmake g++ make ninja-build nodejs npm git openssl iproute2 \
  openjdk-17-jdk-headless libzeroc-ice3.7-java
# More for the tests than one wants by the way on a machine of one's own: the CI has an SSH server, and systemd.
MORE ?=

.PHONY: help demo test test-long fast unit fuzz mutants lint format macros bench ice clean system-demo system-test
.NOTPARALLEL:

help:
	@echo "make demo   install into $(VENV), and run the example: migrate, check, compile, deploy, call"
	@echo "make test   install what the tests need, and run them all"
	@echo "make test-long  the same with all C++ builds and more random cases: more than half an hour"
	@echo "make unit   the tests of parts by themselves: some 30 seconds"
	@echo "make fast   the tests that need neither C++ builds nor an editor"
	@echo "make fuzz   look for new failing examples, for FUZZ_MINUTES=10 minutes"
	@echo "make mutants  MUTANTS=60 small changes of what the code means, SEED=1: which the unit tests notice"
	@echo "make bench  the benchmarks, as ratios"
	@echo "make lint   the code by itself: rules, types, layers"
	@echo "make format the order of imports, and the format, of all code"
	@echo "make macros the names that C++ takes, from this machine's compiler and headers"
	@echo "make ice    compile Ice into $(VENV), where Debian's python3-zeroc-ice cannot be installed: minutes"
	@echo "make clean  remove $(VENV) and what the demo made"

system-demo system-test: system-%:
	@$(PYTHON) tools/prepare.py system $* $($*_NEEDS) $(if $(filter test,$*),$(MORE))

$(VENV)/rcyaml: pyproject.toml
	@$(PYTHON) tools/prepare.py environment
	@touch $@

$(VENV)/tests: pyproject.toml $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py environment test
	@touch $@

demo: system-demo $(VENV)/rcyaml
	@$(VENV)/bin/python examples/demo.py

ice: $(VENV)/rcyaml
	@$(PYTHON) tools/prepare.py ice

test: system-test $(VENV)/tests
	@$(VENV)/bin/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -q

# What seldom breaks and takes long to build, and the random tests with more cases.
test-long: export RCYAML_ALL_BUILDS := 1
test-long: export RCYAML_CASES := 4000
test-long: export RCYAML_CPP_DOCUMENTS := 60
test-long: test

# The names that C++ takes, as this machine's compiler and headers have them; it only adds.
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

bench: $(VENV)/rcyaml
	@$(VENV)/bin/python benchmarks/run.py

clean:
	rm -rf $(VENV) .demo
