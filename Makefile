# rcyaml: `make demo` shows what it does, `make test` proves that it works.

VENV ?= .venv
# Ice comes as a module for Debian's own python3 (3.11); another one cannot load it.
PYTHON ?= $(shell test -x /usr/bin/python3 && echo /usr/bin/python3 || echo python3)
JOBS ?= 2
FUZZ_MINUTES ?= 10
ICE := zeroc-ice-compilers libzeroc-ice-dev zeroc-ice-slice zeroc-icebox libzeroc-icestorm3.7 python3-zeroc-ice \
  zeroc-icegrid zeroc-ice-utils
QT := qt6-base-dev
TOOLS := python3-venv cmake g++ make ninja-build nodejs npm git openssl iproute2
# More for the tests than one wants by the way on a machine of one's own: the CI has an SSH server, and systemd.
MORE ?=

.PHONY: help demo test fast fuzz lint bench clean

help:
	@echo "make demo   install into $(VENV) and run the example: migrate, check, compile, run"
	@echo "make test   install what the tests need, and run them all"
	@echo "make fast   the tests that need neither C++ builds nor an editor"
	@echo "make fuzz   look for new failing examples, for FUZZ_MINUTES=10 minutes"
	@echo "make bench  the benchmarks, as ratios"
	@echo "make clean  remove $(VENV) and what the demo made"

$(VENV)/rcyaml: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "rcyaml needs Python 3.11 or later"; exit 1; }
	@test -x $(VENV)/bin/python || $(PYTHON) -m venv --system-site-packages $(VENV) 2>/dev/null || $(MAKE) --no-print-directory venv-package
	@$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

# Debian's python3 comes without venv: its package is fetched when we may, else asked for.
.PHONY: venv-package
venv-package:
	@rm -rf $(VENV)
	@if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	  apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq python3-venv >/dev/null; \
	else echo "python3 cannot make virtual environments here: apt install python3-venv, then again"; exit 1; fi
	@$(PYTHON) -m venv --system-site-packages $(VENV)

demo: $(VENV)/rcyaml
	@$(VENV)/bin/python examples/demo.py

$(VENV)/tests: pyproject.toml $(VENV)/rcyaml
	@$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $@

# What the tests need of the system: installed when we may, else named.
.PHONY: system
system:
	@missing=""; \
	for package in $(ICE) $(QT) $(TOOLS) $(MORE); do \
	  case $$package in nodejs) command -v node >/dev/null && continue;; npm) command -v npm >/dev/null && continue;; esac; \
	  dpkg-query -W -f '$${Status}' $$package 2>/dev/null | grep -q 'ok installed' || missing="$$missing $$package"; done; \
	if [ -n "$$missing" ]; then \
	  if [ "$$(id -u)" = 0 ]; then echo "installing:$$missing"; \
	    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null; \
	  else echo "some tests will be skipped; to run them all: sudo apt install$$missing"; fi; fi

test: system $(VENV)/tests
	@$(VENV)/bin/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder -q --reruns 2 --reruns-delay 1

fast: $(VENV)/tests
	@$(VENV)/bin/python -m pytest -n $(JOBS) -q -m 'not slow' --ignore tests/editor --ignore tests/ice

fuzz: $(VENV)/tests
	@$(VENV)/bin/python tests/fuzz/run.py --minutes $(FUZZ_MINUTES) --jobs $(JOBS)

lint: $(VENV)/tests
	@$(VENV)/bin/lint-imports

bench: $(VENV)/rcyaml
	@$(VENV)/bin/python benchmarks/run.py

clean:
	rm -rf $(VENV) .demo
