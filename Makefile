# aionode's commands. The first one makes .venv and installs what it needs; nothing else is touched.
#
#   make demo      two nodes talk: python -m aionode.examples.pubsub
#   make test      the tests, in WORKERS processes: two for each processor, and four more
#   make check     style, types, layers and structure, the documentation and its code
#   make docs      the documentation as pages, in site/
#   make bench     the benchmarks; tables, JSON and pictures in benchmarks/results/
#   make coverage  how much of aionode is reached by tests that start no process, and by programs of rclpy
#   make clean     removes everything generated, including .venv
#
# Experiments that take longer, for releases and for changes to the code they test: make NAME runs one,
# and python3 -m tests.lab lists them.

# The first of these that is Python 3.11 or newer. Use another one with make PYTHON=/path/to/python.
PYTHON ?= $(shell for name in python3 python3.14 python3.13 python3.12 python3.11 python; do \
	$$name -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$name && break; \
	done)
BIN := .venv/bin
PIP ?= $(BIN)/python -m pip --disable-pip-version-check
WORKERS ?= auto
LAB := $(shell sed -n 's/^\[\(.*\)\]$$/\1/p' tests/lab.toml)

.DEFAULT_GOAL := help
.PHONY: help demo test check docs bench coverage clean $(LAB)
.PHONY: check-style check-types check-layers check-docs check-tools check-pages

help:
	@sed -n '3,12s/^# *//p' Makefile

demo: .venv/installed
	$(BIN)/python -m aionode.examples.pubsub

# `make check` runs the tests of the documentation and of the structure.
test: .venv/installed-dev
	$(BIN)/python -m pytest -q -n $(WORKERS) --ignore=tests/test_docs.py --ignore=tests/test_structure.py

# Targets of their own, the longest first, so that `make -j 2 check` uses two processors.
check: check-types check-pages check-docs check-tools check-style check-layers

check-style: .venv/installed-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check

check-types: .venv/installed-dev
	$(BIN)/mypy

check-layers: .venv/installed-dev
	PYTHONPATH=aionode/ros_packages $(BIN)/lint-imports --no-logo

check-docs: .venv/installed-dev
	$(BIN)/python docs/quotes.py --check
	$(BIN)/python -m pytest -q tests/test_docs.py tests/test_structure.py

check-tools: .venv/installed-dev
	$(BIN)/python -m pytest -q -m checks tests/typing tests/idl/test_generator.py

# Reads all pages and resolves their references, without writing them, which takes as long again.
check-pages: .venv/installed-dev
	$(BIN)/sphinx-build -q -W --keep-going -b dummy docs site

docs: .venv/installed-dev
	$(BIN)/sphinx-build -q -W --keep-going -b html docs site
	@echo "Open site/index.html"

bench: .venv/installed-dev
	for program in benchmarks/*.py; do $(BIN)/python $$program || exit 1; done

# Lines are counted in the tests' own processes and in those that they start. Programs of rclpy run
# in separate processes, so the tests that start them are included. Tests with time limits may fail
# meanwhile: `make test` decides about them, so only the share of covered code matters here.
coverage: .venv/installed-dev
	-$(BIN)/python -m pytest -q -n $(WORKERS) \
		-m "not checks and not processes and not faults and not stress and not second_loop" \
		--cov --cov-branch --cov-report= --cov-fail-under=0
	-$(BIN)/python -m pytest -q -n $(WORKERS) tests/rclpy \
		-m "processes and not faults and not stress and not second_loop" \
		--cov --cov-branch --cov-append --cov-report= --cov-fail-under=0
	$(BIN)/coverage report --skip-covered --sort=cover

$(LAB): %: .venv/installed-dev
	@$(BIN)/python -m tests.lab $@

clean:
	rm -rf .venv .fuzz .mcap-core .rosbridge-clients site benchmarks/results .coverage htmlcov
	rm -rf .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache .grimp_cache

# Two steps, so that trying aionode out does not wait for the development tools.
.venv/installed: pyproject.toml | .venv/bin/python
	@echo "Installing aionode into .venv ..."
	@$(PIP) install --quiet --editable '.[fast]'
	@touch $@

.venv/installed-dev: pyproject.toml | .venv/bin/python
	@echo "Installing aionode and its development tools into .venv ..."
	@$(PIP) install --quiet --editable '.[dev]'
	@touch .venv/installed $@

.venv/bin/python:
	@if [ -z "$(PYTHON)" ]; then \
		echo "aionode needs Python 3.11 or newer, and none was found on PATH." >&2; \
		echo "Install one, or name it: make $(MAKECMDGOALS) PYTHON=/path/to/python3" >&2; exit 1; fi
	@$(PYTHON) -m venv .venv || { rm -rf .venv; \
		echo "$(PYTHON) -m venv failed; on Debian and Ubuntu: apt install python3-venv" >&2; exit 1; }
