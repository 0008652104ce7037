# SPDX-License-Identifier: Apache-2.0 OR MIT
# The one door: `make demo` and `make test` set up all they need.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PEERS := build/peers
CORE := python/lamplit/_core.abi3.so
RUST := Cargo.toml Cargo.lock $(shell find crates -name '*.rs' -o -name Cargo.toml)
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.DEFAULT_GOAL := help
.PHONY: help demo test check format bench validate mutants docs wheel clean

help: ## say what each target does
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 10

# Python and the libraries that Lamplit runs with, at the versions of the lock files.
$(VENV)/.ready: requirements/run.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' \
	  || { echo "Lamplit needs Python 3.10 or later: make PYTHON=python3.12 ..."; exit 1; }
	@command -v cargo >/dev/null || { echo "Lamplit needs a Rust toolchain (https://rustup.rs)"; exit 1; }
	@echo "Installing the Python libraries into $(VENV): once, about a minute ..."
	@$(PYTHON) -m venv --clear $(VENV)
	@$(BIN)/python -m pip install --quiet --no-deps -r requirements/run.lock \
	  "$$(grep '^maturin==' requirements/dev.lock)"
	@touch $@

# What tests, checks and benches need besides.
$(VENV)/.tools: $(VENV)/.ready requirements/dev.lock
	@echo "Installing the tools for tests and checks into $(VENV): once, about a minute ..."
	@$(BIN)/python -m pip install --quiet --no-deps -r requirements/dev.lock
	@touch $@

# The compiled core and the package, installed in place.
$(CORE): $(VENV)/.ready $(RUST) pyproject.toml
	@echo "Compiling the core for this machine: about half a minute ..."
	@RUSTFLAGS="-C target-cpu=native" VIRTUAL_ENV=$(CURDIR)/$(VENV) $(BIN)/maturin develop --release --locked >$(VENV)/build.log 2>&1 \
	  || { cat $(VENV)/build.log; exit 1; }
	@touch $@

demo: $(CORE) ## render and measure the example rear lamp; says which files to open
	@$(BIN)/python examples/demo.py

test: $(CORE) $(VENV)/.tools ## run every test: Rust, Python, doctests, the wheel
	cargo test --workspace --locked --quiet
	$(BIN)/python -m pytest

check: $(CORE) $(VENV)/.tools ## format, lints, types, stubs: all must be clean
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright
	$(BIN)/python -m mypy.stubtest lamplit._core --ignore-disjoint-bases

format: $(VENV)/.tools ## put the code into its format
	cargo fmt --all
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

# Mitsuba 3, which benches and validation hold Lamplit against; its LLVM variants need an LLVM.
$(PEERS)/.ready: requirements/peers.lock
	@echo "Installing Mitsuba into $(PEERS): once, half a minute ..."
	@$(PYTHON) -m venv --clear $(PEERS)
	@$(PEERS)/bin/python -m pip install --quiet --no-deps -r $<
	@ls /usr/lib/*/libLLVM-19.so >/dev/null 2>&1 || { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null \
	  && echo "Installing Debian's libllvm19 for Mitsuba ..." \
	  && apt-get update -qq && apt-get install -qq libllvm19 >/dev/null; } \
	  || echo "No LLVM 19 (apt-get install libllvm19): Mitsuba's LLVM variants are left out."
	@touch $@

bench: $(CORE) $(VENV)/.tools $(PEERS)/.ready ## measure speed against peers; PARTS="unlit ..." for some of it
	$(BIN)/python benchmarks/run.py $(if $(PARTS),--parts $(PARTS))

validate: $(CORE) $(VENV)/.tools $(PEERS)/.ready ## hold the physics against closed forms and Mitsuba; writes docs/validation.md
	$(BIN)/python benchmarks/validate.py $(CASES)

mutants: $(CORE) $(VENV)/.tools ## break the physics on purpose, fault by fault: do the tests notice? An hour
	$(BIN)/python tools/mutants.py $(NAMES)

docs: $(CORE) $(VENV)/.tools ## make the pictures, tables and API pages of docs/ again
	$(BIN)/python docs/make.py

wheel: $(VENV)/.ready ## one self-contained abi3 wheel in dist/
	$(BIN)/maturin build --release --locked --quiet --out dist

clean: ## remove what the other targets made
	rm -rf target $(VENV) $(CORE) dist out build
