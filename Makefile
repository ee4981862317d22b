# Each target sets up .venv by itself, and does nothing twice.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test test-live lint bench clean help

help:  ## Show the targets.
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/'

$(STAMP): pyproject.toml constraints.txt
	@if command -v uv >/dev/null 2>&1; then \
	  test -x $(BIN)/python || uv venv --python $(PYTHON) $(VENV); \
	  uv pip install --python $(BIN)/python --constraint constraints.txt --editable '.[dev]'; \
	else \
	  test -x $(BIN)/python || $(PYTHON) -m venv $(VENV); \
	  $(BIN)/python -m pip install --quiet --constraint constraints.txt --editable '.[dev]'; \
	fi
	@touch $@

demo: $(STAMP)  ## Scan the embedded room and build it as a Minecraft world in OUT/.
	$(BIN)/w2m demo

test: $(STAMP)  ## Run the tests.
	$(BIN)/python -m pytest

test-live: $(STAMP)  ## Load a built world into a real server and walk in it (needs Node and npm).
	$(BIN)/python -m pytest -m live tests/live

lint: $(STAMP)  ## Check style and types.
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell src tests docs benchmarks README.md CONTRIBUTING.md CHANGELOG.md
	$(BIN)/pyright

bench: $(STAMP)  ## Measure speed and memory against the budgets.
	$(BIN)/python -m benchmarks

clean:  ## Remove the environment and the demo's output.
	rm -rf $(VENV) OUT
