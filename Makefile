# Commands for people; .ci/run uses the same ones.
#
#   make walk      solve the default study; results in out/walk
#   make test      the tests (minutes)        make test-all   with the slow ones
#   make bench     what is fast               make clean      remove what make made
#   make docs      the guide as a site, in out/site
#
# The environment .venv is made from the pinned files in requirements/ and made again when they or
# pyproject.toml change. Another Python: make test PYTHON=python3.13 VENV=.venv-3.13
# More for a command: make walk ARGS="--nodes 24", make test ARGS="-k muscles"

PYTHON ?= python3
VENV ?= .venv
JOBS ?= 2
ARGS ?=

PY := $(VENV)/bin/python
PIP := $(PY) -m pip install -qq --disable-pip-version-check
PYTEST := OMP_NUM_THREADS=1 MPLBACKEND=Agg $(PY) -m pytest -n $(JOBS) --dist loadfile

# Drake's IPOPT factorises with SPRAL, which asks for this before the first import.
export OMP_CANCELLATION := TRUE

.PHONY: help walk test test-quick test-all bench docs lint lock clean

help:
	@sed -n 's/^# \{0,1\}//p;/^$$/q' Makefile

walk: $(VENV)/run.stamp
	$(VENV)/bin/drakegait walk --out out/walk $(ARGS)

test: $(VENV)/test.stamp
	$(PYTEST) -m "not slow" $(ARGS)

# Without the solves: what .ci/run repeats under a second Python.
test-quick: $(VENV)/test.stamp
	$(PYTEST) -m "not slow and not solve" $(ARGS)

test-all: $(VENV)/test.stamp
	$(PYTEST) $(ARGS)

bench: $(VENV)/test.stamp
	$(PY) benchmarks/walks.py --repeats 3 $(ARGS)
	$(PY) benchmarks/evaluation.py

# The guide, from docs/ and mkdocs.yml; strict: a page or link that is missing is an error.
docs: $(VENV)/docs.stamp
	NO_MKDOCS_2_WARNING=1 $(PY) -m mkdocs build --strict
	@echo "out/site/index.html"

lint: $(VENV)/test.stamp
	$(PY) -m ruff check .

$(VENV)/run.stamp: pyproject.toml requirements/run.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	  echo "drakegait needs Python >= 3.11, but '$(PYTHON)' is" \
	    "$$($(PYTHON) --version 2>/dev/null || echo not there);" \
	    "give another one: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  echo "'$(PYTHON)' cannot make environments: install its venv module" \
	    "(Debian and Ubuntu: apt-get install python3-venv)"; exit 1; }
	@echo "Making the environment $(VENV), a few minutes the first time ..."
	@rm -rf $(VENV)
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) --require-hashes -r requirements/run.txt
	@$(PIP) --no-deps --no-build-isolation --editable .
	@# Unlike a wheel, a checkout is not compiled by pip; the first walk need not do it.
	@$(PY) -m compileall -q drakegait
	@$(PY) -c 'import pydrake.math' 2>/dev/null || { \
	  echo "Drake does not start here; mostly the system lacks GLib" \
	    "(Debian and Ubuntu: apt-get install libglib2.0-0)"; exit 1; }
	@touch $@

$(VENV)/docs.stamp: $(VENV)/run.stamp requirements/docs.txt
	@$(PIP) --require-hashes -r requirements/docs.txt
	@touch $@

# The tests build the site too.
$(VENV)/test.stamp: $(VENV)/docs.stamp requirements/test.txt
	@$(PIP) --require-hashes -r requirements/test.txt
	@touch $@

# New versions for the pinned files, for every platform and Python >= 3.11. Hashes are those of the
# files on PyPI; no address is written.
LOCK := $(VENV)/bin/uv --quiet pip compile --upgrade --universal --python-version 3.11 \
  --only-binary :all: --generate-hashes --no-emit-index-url --no-emit-find-links \
  --custom-compile-command "make lock" pyproject.toml requirements/build.in

lock: $(VENV)/run.stamp
	@$(PIP) uv
	$(LOCK) --output-file requirements/run.txt
	$(LOCK) --extra test --constraint requirements/run.txt --output-file requirements/test.txt
	$(LOCK) --extra docs --constraint requirements/test.txt --output-file requirements/docs.txt

clean:
	rm -rf .venv .venv-* out build dist .pytest_cache .hypothesis .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
