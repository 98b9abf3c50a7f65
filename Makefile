# aionode's commands. The first one makes .venv and installs what it needs; nothing else is touched.
#
#   make demo      two nodes talk: python -m aionode.examples.pubsub
#   make test      the tests, in WORKERS processes: two more than there are processors
#   make stress    variants that take long or differ little from what `make test` runs
#   make replay    a hundred processes have to publish the same in a replay
#   make bag-kills a recording is killed at fifty moments, and its power is cut: the rest is there
#   make bag-reader  bags are read by @mcap/core: needs node and npm
#   make check     style, types, layers and structure, the documentation and its code
#   make coverage  how much of aionode is reached by tests that start no process, and by programs of rclpy
#   make bench     the benchmarks; tables, JSON and pictures in benchmarks/results/
#   make profile   instructions and cache lines for one message, by valgrind: docs/performance.md
#   make docs      the documentation as pages, in site/
#   make fuzz      damaged input for every parser: by property tests, and guided by coverage
#   make faults    processes that freeze, lag and die, FAULTS_TIMES times: writes docs/reliability.md
#   make attacks   lies, floods and forgeries beside true traffic: writes them into docs/security.md
#   make zenoh-defects   what aionode works around: a program that fails shows what Zenoh has mended
#   make motion    robots whose movers go in every way, MOTION_TIMES times: writes docs/motion.md
#   make ros-test  aionode over DDS, beside rclpy of PyPI; Linux x86-64
#   make launch-files FOLDER=…  how many launch files of public repositories evaluate
#   make live      aionode beside a real ROS 2 on rmw_zenoh, where one is sourced
#   make tf-differential TF2=<folder>   transforms beside those of geometry2's sources, compiled here
#   make rosbridge-clients   roslib of npm, in Node and in Chromium, and roslibpy talk to the gateway: needs node and npm
#   make gateway-load  many clients, images, garbage, clients that vanish: writes docs/performance.md
#   make crowd     300 nodes come and go beside a router, which has to answer all the while
#   make system-stress   fifty processes that are killed, hang and print; a hundred starts and stops
#   make soak      everything at once, for SOAK_SECONDS seconds: nothing may grow
#   make quotes    brings the code and the docstrings that the documentation shows up to date
#   make clean     removes what was made, .venv included

# The first of these that is Python 3.11 or newer. Use another one with make PYTHON=/path/to/python.
PYTHON ?= $(shell for name in python3 python3.14 python3.13 python3.12 python3.11 python; do \
	$$name -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$name && break; \
	done)
BIN := .venv/bin
SOAK_SECONDS ?= 600
FUZZ_SECONDS ?= 60
FUZZ_INPUTS ?= 10000
FAULTS_TIMES ?= 3
MOTION_TIMES ?= 20
WORKERS ?= auto
CLIENTS := .rosbridge-clients

.DEFAULT_GOAL := help
.PHONY: help demo test launch-files stress replay bag-kills bag-reader check coverage bench profile docs fuzz faults attacks zenoh-defects motion live ros-test rosbridge-clients gateway-load crowd \
	tf-differential system-stress soak quotes clean

help:
	@sed -n '3,28s/^# *//p' Makefile

demo: .venv/installed
	$(BIN)/python -m aionode.examples.pubsub

test: .venv/installed-dev
	$(BIN)/python -m pytest -q -n $(WORKERS)

stress: .venv/installed-dev
	$(BIN)/python -m pytest -q -n $(WORKERS) -m "stress or second_loop" --hypothesis-profile=thorough

replay: .venv/installed-dev
	$(BIN)/python -m pytest -q -m stress tests/bag/test_robot.py

bag-kills: .venv/installed-dev
	$(BIN)/python -m pytest -q -m stress tests/bag/test_kills.py

bag-reader: .venv/installed-dev
	npm install --silent --no-save --prefix .mcap-core @mcap/core@2 fzstd lz4js
	MCAP_CORE=.mcap-core $(BIN)/python -m pytest -q -rs tests/bag/test_mcap_core.py

check: .venv/installed-dev
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo
	$(BIN)/python docs/quotes.py --check
	$(BIN)/python -m pytest -q tests/test_docs.py tests/test_structure.py
	$(BIN)/python -m pytest -q -m checks tests/typing tests/idl/test_generator.py
	$(BIN)/sphinx-build -q -W --keep-going -b html docs site

# Lines are counted in the tests' own processes and in those that they start. Programs of rclpy run
# in processes of their own, so the tests that start them count, too. Tests with time limits may fail
# meanwhile: `make test` is what judges them, so only the share of the code counts.
coverage: .venv/installed-dev
	-$(BIN)/python -m pytest -q -n $(WORKERS) \
		-m "not checks and not processes and not faults and not stress and not second_loop" \
		--cov --cov-report= --cov-fail-under=0
	-$(BIN)/python -m pytest -q -n $(WORKERS) tests/rclpy \
		-m "processes and not faults and not stress and not second_loop" \
		--cov --cov-append --cov-report= --cov-fail-under=0
	$(BIN)/coverage report --skip-covered --sort=cover

bench: .venv/installed-dev
	for program in benchmarks/*.py; do $(BIN)/python $$program || exit 1; done

profile: .venv/installed-dev
	$(BIN)/python benchmarks/instructions.py --write docs/performance.md

docs: .venv/installed-dev
	$(BIN)/sphinx-build -q -W --keep-going -b html docs site
	@echo "Open site/index.html"

fuzz: .venv/installed-dev
	$(BIN)/python -m pytest -q -m hypothesis --hypothesis-profile=fuzz --timeout=3600
	$(BIN)/python -m tests.support.fuzz_cdr --cases 3000000
	$(BIN)/python -m tests.fuzz.mutate --inputs $(FUZZ_INPUTS)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[fuzz]'
	$(BIN)/python -m tests.fuzz --seconds $(FUZZ_SECONDS)
	$(BIN)/python -m tests.attacks.fuzz --seconds $(FUZZ_SECONDS)

faults: .venv/installed-dev
	$(BIN)/python -m tests.faults --only '^(?!motion)' --times $(FAULTS_TIMES) --write docs/reliability.md

attacks: .venv/installed-dev
	$(BIN)/python -m tests.attacks --write docs/security.md

zenoh-defects: .venv/installed-dev
	$(BIN)/python -m pytest -q tests/zenoh_defects/[a-z]*.py

motion: .venv/installed-dev
	$(BIN)/python -m tests.faults --only '^motion' --times $(MOTION_TIMES) --write-motion docs/motion.md

ros-test: .venv/installed-dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[ros]'
	$(BIN)/python -m pytest -q -rs tests/transport/rcl tests/transport/test_contract.py

tf-differential: .venv/installed-dev
	$(BIN)/python -m tests.tf.differential $(TF2)

live: .venv/installed-dev
	$(BIN)/python -m pytest -q -rs tests/live

rosbridge-clients: .venv/installed-dev
	npm install --silent --no-audit --no-fund --prefix $(CLIENTS) roslib@2.1.0
	test -d $(CLIENTS)/venv || python3 -m venv $(CLIENTS)/venv
	$(CLIENTS)/venv/bin/pip install --quiet --disable-pip-version-check roslibpy==2.1.0
	AIONODE_ROSLIB=$(CLIENTS)/node_modules/roslib/dist/RosLib.js \
		AIONODE_ROSLIBPY=$(CLIENTS)/venv/bin/python $(BIN)/python -m pytest -q -rs tests/gateway/clients

gateway-load: .venv/installed-dev
	$(BIN)/python -m tests.gateway --write docs/performance.md

launch-files: .venv/installed-dev
	$(BIN)/python -m tests.launch.survey $(FOLDER)

crowd: .venv/installed-dev
	$(BIN)/python -m tests.faults.crowd

system-stress: .venv/installed-dev
	$(BIN)/python -m tests.system

soak: .venv/installed-dev
	$(BIN)/python benchmarks/soak.py --seconds $(SOAK_SECONDS)

quotes: .venv/installed-dev
	$(BIN)/python docs/quotes.py

clean:
	rm -rf .venv .fuzz .mcap-core .rosbridge-clients site benchmarks/results .coverage htmlcov
	rm -rf .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache .grimp_cache

# Two steps, so that the first look at aionode does not wait for the tools of its developers.
.venv/installed: pyproject.toml | .venv/bin/python
	@echo "Installing aionode into .venv ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[fast]'
	@touch $@

.venv/installed-dev: pyproject.toml | .venv/bin/python
	@echo "Installing aionode and the tools of its developers into .venv ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch .venv/installed $@

.venv/bin/python:
	@if [ -z "$(PYTHON)" ]; then \
		echo "aionode needs Python 3.11 or newer, and none was found on PATH." >&2; \
		echo "Install one, or name it: make $(MAKECMDGOALS) PYTHON=/path/to/python3" >&2; exit 1; fi
	@$(PYTHON) -m venv .venv || { rm -rf .venv; \
		echo "$(PYTHON) -m venv failed; on Debian and Ubuntu: apt install python3-venv" >&2; exit 1; }
