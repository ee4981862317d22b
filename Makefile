# Each target sets up .venv in the root folder if necessary.
# PYTHON selects the interpreter, TESTS the tests of `make test`, ONLY the measurement of `make bench`.
PYTHON ?= python3
TESTS ?=
ONLY ?=

VENV := .venv
BIN := $(VENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
# Marks an environment with all development packages, or with those for `make demo` only.
STAMP := $(VENV)/.installed
TRIAL := $(VENV)/.trial-installed
# Exists during an installation: the environment of an interrupted installation is recreated.
HALF := $(VENV)/.half-installed
# Build tools are pinned too. The path must not contain spaces, because pip splits this variable.
export PIP_CONSTRAINT := constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# An environment contains its own absolute path: one that was copied or moved is recreated.
$(foreach stamp,$(STAMP) $(TRIAL),$(if $(filter-out $(shell pwd),$(shell cat $(stamp) 2>/dev/null)),$(shell rm -f $(stamp))))
# An environment whose interpreter no longer exists is recreated too.
ifneq ($(shell $(BIN)/python -c 'print("runs")' 2>/dev/null),runs)
$(shell rm -f $(STAMP) $(TRIAL))
endif

comma := ,
# Install an extra of this package into .venv, with the pinned versions.
define install
$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 14))' \
  || { echo "Python 3.11 to 3.14 is required: make PYTHON=python3.12 ..." >&2; exit 1; }; \
set -e; \
if test -e $(HALF); then rm -rf $(VENV); fi; \
if command -v uv >/dev/null 2>&1; then \
  $(BIN)/python -c pass 2>/dev/null || \
    uv venv --quiet --clear --seed --python "$$($(PYTHON) -c 'import sys; print(sys.executable)')" $(VENV); \
  touch $(HALF); \
  uv pip install --quiet --python $(BIN)/python --constraint constraints.txt \
    --build-constraint constraints.txt --editable '.[$(1)]'; \
else \
  $(BIN)/python -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV); \
  touch $(HALF); \
  $(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[$(1)]'; \
fi; \
rm $(HALF); pwd > $@
endef

.PHONY: help demo docs forge test coverage test-live test-server test-trainers mutants release-check lint bench
.PHONY: setup clean
.DEFAULT_GOAL := help

help:  ## Show the targets.
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile

setup: $(STAMP)  ## Create .venv with everything for tests, docs and training (3.6 GB).

# The demo, the editor and the agents need neither torch nor the linters.
$(TRIAL): pyproject.toml constraints.txt
	@echo "setting up .venv (once): a minute or more, 1.4 GB"
	@$(call install,capture$(comma)vln)

$(STAMP): pyproject.toml constraints.txt
	@echo "setting up .venv with all development packages (once): some minutes, 3.6 GB"
	@$(call install,dev)

demo: $(if $(wildcard $(STAMP)),$(STAMP),$(TRIAL))  ## Scan a generated room and build it as a Minecraft world in OUT/.
	@$(BIN)/python -m world2minecraft demo

docs: $(STAMP)  ## Build the documentation site in site/; warnings are errors.
	@NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict
	@echo "site/index.html"

forge:  ## Build SceneForge's page from its TypeScript (needs Node 20 and npm).
	@cd src/world2minecraft/sceneforge/web && npm ci --no-audit --no-fund --silent && npm run --silent build

# The tests start hundreds of processes: keep their bytecode, and use one thread in each for matrices.
TEST_ENVIRONMENT := PYTHONDONTWRITEBYTECODE= OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

test: $(STAMP)  ## Run the tests, one file per core (TESTS=tests/reconstruction/fusion for a part).
	@$(TEST_ENVIRONMENT) $(BIN)/python -m world2minecraft doctor --warm > /dev/null
	@$(TEST_ENVIRONMENT) $(BIN)/python -m pytest --numprocesses auto --maxprocesses 4 --dist loadfile $(TESTS)

coverage: $(STAMP)  ## Run the tests and report the lines that no test reaches (95 % is required).
	@rm -f .coverage .coverage.*
	@$(BIN)/python -m coverage run -m pytest --numprocesses auto --maxprocesses 4 --dist loadfile $(TESTS)
	@$(BIN)/python -m coverage combine --quiet
	@$(BIN)/python -m coverage report

test-live: $(STAMP)  ## Load a built world on a real server and walk in it (needs Node and npm).
	@$(BIN)/python -m pytest -m live tests/live

test-server: $(STAMP)  ## Compare the player physics with those of a real server (needs Node and npm).
	@$(BIN)/python -m pytest -m live tests/live/test_live_body.py

test-trainers: $(STAMP)  ## Train on exports with LLaMA-Factory and TRL, on the CPU (fetches 3 GB to .trainers/).
	@$(BIN)/python -m pytest -m trainers -rP tests/trainers

mutants: $(STAMP)  ## Find small code changes that no test detects (ONLY=coordinates for a group).
	@test -d .mutants/cosmic_ray || if command -v uv >/dev/null 2>&1; then \
	  uv pip install --quiet --no-deps --target .mutants cosmic-ray==8.7.0 parso==0.8.7; \
	else \
	  $(BIN)/python -m pip install --quiet --no-deps --target .mutants cosmic-ray==8.7.0 parso==0.8.7; \
	fi
	@$(BIN)/python -m tools.mutants $(if $(ONLY),--only $(ONLY))

fuzz: $(STAMP)  ## Call all verbs with mutated files (MINUTES=30); faults are kept in FUZZ/.
	@$(BIN)/python -m benchmarks.fuzz_verbs --minutes $(or $(MINUTES),30)

pin-hashes: $(STAMP)  ## Write the hashes of all pinned packages after a change of constraints.txt (needs the network).
	@$(BIN)/python tools/release/pin_hashes.py

release-check: $(STAMP)  ## Build wheel and sdist, install the wheel for each Python version and run the demo.
	@$(BIN)/python tools/release/check.py

lint: $(STAMP)  ## Check style, spelling and types.
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python -m codespell_lib src tests docs benchmarks README.md CONTRIBUTING.md CHANGELOG.md
	$(BIN)/python -m pyright

bench: $(STAMP)  ## Compare speed and memory with the budgets (ONLY=cli for one).
	@$(BIN)/python -m benchmarks $(if $(ONLY),--only $(ONLY))

clean:  ## Remove the environment and the outputs of demo, docs and release-check.
	rm -rf $(VENV) OUT dist site
