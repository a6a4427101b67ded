# Two commands set everything up: `make demo` and `make test`.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV   := .venv
BIN    := $(VENV)/bin

# Tests run side by side, one BLAS thread each: more only get in each other's way.
export OPENBLAS_NUM_THREADS ?= 1
export OMP_NUM_THREADS ?= 1

# What CI runs twice more, with the last bits changed as other processors would: see tests/shake.py.
CORE := automatic clouds device eigensolver energy formulas formulas_match formulations descriptor_guidance cleaning \
	kernels collection shape_differences collection_maps maps nystrom orientation pipeline rounding large_shapes search shot spectrum

.PHONY: demo test shake lint mutants docs experiments dist image web clean

demo: $(VENV)/.base
	$(BIN)/kfmaps demo --output demo.png --force

test: lint
	$(BIN)/pytest -n auto
	$(MAKE) shake

# The kernels that OpenBLAS has for an older processor, where it has them; anything else takes no notice.
shake: $(VENV)/.dev
	$(BIN)/pytest -q -n auto --shake 1 $(CORE:%=tests/test_%.py)
	OPENBLAS_CORETYPE=Nehalem $(BIN)/pytest -q -n auto --shake 2 $(CORE:%=tests/test_%.py)

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright

# Formulas broken on purpose, one at a time: the list and 30 drawn blindly. Fails when the tests miss one. Takes hours.
mutants: $(VENV)/.dev
	$(BIN)/python benchmarks/mutants.py

# A wheel and a source archive, each tried in an environment of its own.
dist: $(VENV)/.dev
	rm -rf dist
	$(BIN)/python -m build
	for archive in dist/*.whl dist/*.tar.gz; do \
	    rm -rf build/dist && $(PYTHON) -m venv build/dist && \
	    build/dist/bin/python -m pip install --quiet --constraint constraints.txt $$archive && \
	    (cd build/dist && bin/kfmaps demo --output demo.png --force) || exit 1; \
	done

# The image of the Dockerfile; where nothing builds images, its steps in a temporary folder.
image:
	docker build --tag kfmaps . || $(PYTHON) tests/test_image.py

# The bundle of the result page; only needed after a change under web/ (Node 20 or newer).
web:
	cd web && npm ci && npm run build

docs: $(VENV)/.docs
	$(BIN)/sphinx-build -W --keep-going -j auto -b html docs docs/_build/html
	@echo "open docs/_build/html/index.html"

# The paper's figures and tables, to experiments-output: make experiments ARGS="figure6 --data DIR --pairs 20"
experiments: $(VENV)/.base
	$(BIN)/python experiments/run.py $(ARGS)

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.base: $(VENV)/bin/python pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable .
	@touch $@

$(VENV)/.dev: $(VENV)/bin/python pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable ".[dev]"
	@touch $@ $(VENV)/.base

$(VENV)/.docs: $(VENV)/bin/python pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable ".[docs]"
	@touch $@ $(VENV)/.base

clean:
	rm -rf $(VENV) build dist demo.png docs/_build docs/gallery
