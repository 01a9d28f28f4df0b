# SPDX-License-Identifier: GPL-2.0-or-later
PYTHON := /usr/bin/python3
RUFF_VERSION := 0.17.5
MYPY_VERSION := 2.4.1
IMPORTLINTER_VERSION := 2.17
LINTERS := build/venv/ruff-$(RUFF_VERSION)-mypy-$(MYPY_VERSION)-import-linter-$(IMPORTLINTER_VERSION)
MINUTES := 10
SEED := $(shell date +%s)
JOBS := $(shell nproc)
WORKERS := $(shell expr 3 \* $$(nproc)) # many wait for real motion, which needs a core in time

# RIP=DIR uses the LinuxCNC that was built to run in place in DIR, instead of an installed one.
IN_PLACE := $(if $(RIP),$(RIP)/scripts/rip-environment)

.PHONY: help setup demo test test-on lint bench soak deb kinematics clean

help:
	@echo "make setup  install what is missing on Debian; demo, test and bench do so by themselves"
	@echo "make demo   run the manuals' programs in headless LinuxCNC, pictures in build/demo"
	@echo "make test   run every test"
	@echo "make test-on SUITE=trixie   the same in a bare Debian of that name, as root"
	@echo "make lint   check the style of the code"
	@echo "make bench  measure the figures the project promises"
	@echo "make kinematics  build and install the kinematics of configs/kinematics (needs root)"
	@echo "make soak MINUTES=10   random blocks, contours, texts, aborts and kills"
	@echo "make deb    build the Debian package build/linuxcnc-g12_VERSION_all.deb"
	@echo "make clean  remove what the others made"
	@echo "RIP=DIR after demo, test, bench or kinematics: with the LinuxCNC built in DIR"

setup:
	@RIP=$(RIP) sh .ci/setup

demo: setup
	@echo "demo: running the manuals' programs in headless LinuxCNC"
	@$(IN_PLACE) $(PYTHON) python/g12 demo --output build/demo

test: setup
	@echo "test: every test, on $(JOBS) cores"
	@$(IN_PLACE) $(PYTHON) -m pytest -n $(WORKERS) --dist loadgroup

test-on:
	@sh .ci/test-on $(SUITE)

lint: $(LINTERS)
	@echo "lint: ruff $(RUFF_VERSION), mypy $(MYPY_VERSION), import-linter $(IMPORTLINTER_VERSION)"
	@build/venv/bin/ruff check --quiet
	@build/venv/bin/ruff format --check --quiet
	@build/venv/bin/mypy --cache-dir build/mypy --no-error-summary
	@PYTHONPATH=python build/venv/bin/lint-imports --no-logo --cache-dir build/import-linter \
		>build/imports.txt || (cat build/imports.txt; exit 1)

bench: setup kinematics
	@echo "bench: figures as ratios, each measured side by side in one run"
	@$(IN_PLACE) sh -c 'PYTHONPATH=python:tests:$$PYTHONPATH $(PYTHON) -m bench'

soak: setup
	@echo "soak: for $(MINUTES) minutes on two cores, seed $(SEED)"
	@SOAK_MINUTES=$(MINUTES) SOAK_SEED=$(SEED) $(IN_PLACE) \
		sh -c 'PYTHONPATH=python:tests:$$PYTHONPATH $(PYTHON) -m soak'

deb:
	@sh .ci/deb

kinematics:
	@$(IN_PLACE) sh .ci/kinematics

clean:
	@echo "clean: removing build"
	@rm -rf build .pytest_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(LINTERS):
	@sh .ci/setup python3-venv
	@echo "lint: fetching ruff $(RUFF_VERSION), mypy $(MYPY_VERSION)," \
		"import-linter $(IMPORTLINTER_VERSION)"
	@$(PYTHON) -m venv --clear build/venv
	@build/venv/bin/pip install --quiet --disable-pip-version-check ruff==$(RUFF_VERSION) \
		mypy==$(MYPY_VERSION) import-linter==$(IMPORTLINTER_VERSION)
	@touch $@
