# Works on a bare machine with Python 3.11, pip and venv. PYTHON may name another interpreter.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: venv demo docs test pytest lint review ratios check-slow pages charts pictures rule-pictures atlas contact-table dist sbom audit pythons fuzz mutants soak paper lock clean

venv: $(VENV)/.dev

$(VENV)/.run: requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "pneutouch needs Python 3.11 or newer; set PYTHON")'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(PIP) install --require-hashes --requirement requirements.lock
	$(PIP) install --no-deps --no-build-isolation --editable .
	touch $@

$(VENV)/.dev: requirements-dev.lock $(VENV)/.run
	$(PIP) install --require-hashes --requirement requirements-dev.lock
	touch $@

demo: $(VENV)/.run
	$(BIN)/pneutouch build paper-dome
	@ls outputs/paper-dome

test: lint pytest

pytest: $(VENV)/.dev
	$(BIN)/python -m pytest -n 2 --dist worksteal

lint: $(VENV)/.dev
	$(BIN)/ruff check generator tests benchmarks docs release
	$(BIN)/ruff format --check generator tests benchmarks release docs/conf.py docs/_ext docs/gallery
	$(BIN)/mypy

# What CI requires in addition to the tests; pre-commit needs a clone, and its hooks are programs of the virtual environment.
review: $(VENV)/.dev
	$(BIN)/sp-repo-review .
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pre-commit run --all-files

# Times of single jobs over those of others in the same run; and of the commands over the import of their libraries.
ratios: $(VENV)/.dev
	$(BIN)/python -m tests.ratios
	$(BIN)/python -m tests.ratios start-up

check-slow: $(VENV)/.dev
	$(BIN)/python -m pytest -m slow -n 2 --dist worksteal

# The site, in docs/_build/html; offline, and a warning is an error.
docs: $(VENV)/.dev
	$(BIN)/sphinx-build --quiet --fail-on-warning --nitpicky --fresh-env docs docs/_build/html
	@echo docs/_build/html/index.html

# Wheel and source archive, the same bytes in every folder and at every time: all dates in them are this one.
dist: $(VENV)/.run
	rm -rf dist
	SOURCE_DATE_EPOCH=1580601600 $(BIN)/python -m hatchling build --directory dist
	cd dist && sha256sum pneutouch-*

# The locked dependencies as a CycloneDX document, dist/pneutouch.cdx.json.
sbom: $(VENV)/.run
	$(BIN)/python -m release.sbom

# Known vulnerabilities of the locked dependencies, by pip-audit; fails where the index does not answer for one of them. In an environment of
# its own: pip-audit would bring 25 packages into the locked ones.
audit: $(VENV)/audit/.pip-audit
	$(VENV)/audit/bin/pip-audit --require-hashes --disable-pip --strict --requirement requirements.lock

$(VENV)/audit/.pip-audit:
	$(PYTHON) -m venv $(VENV)/audit
	$(VENV)/audit/bin/python -m pip --disable-pip-version-check --quiet install pip-audit==2.10.1
	touch $@

# Fuzzes every reader by the branches that its inputs reach, an hour of processor time in all. Needs atheris, which has no wheels for
# every system and Python that are supported: it is installed into an environment of its own, which sees the packages of the other.
fuzz: $(VENV)/fuzz/.atheris
	PYTHONPATH=generator $(VENV)/fuzz/bin/python -m tests.fuzzing --seconds 3600 --jobs 2

$(VENV)/fuzz/.atheris: $(VENV)/.dev
	$(PYTHON) -m venv $(VENV)/fuzz
	$(VENV)/fuzz/bin/python -m pip --disable-pip-version-check --quiet install atheris==3.0.0
	$(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))' > $$($(VENV)/fuzz/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/other.pth
	touch $@

# Faults in mechanics, printability and bench, drawn at random, and whether the everyday tests notice them.
mutants: $(VENV)/.dev
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.mutants --count 120 --seed 5 --calls outputs/calls.json --out outputs/mutants-5.json

# The studio in use for an hour, in a browser.
soak: $(VENV)/.dev
	$(BIN)/python -m tests.studio.soak --minutes 60

# The figures of paper/paper.md, from stored ones.
paper: $(VENV)/.run
	$(BIN)/python -m release.paper

# The wheel under every supported Python that is found here, with the everyday tests of commands and of the Python interface.
pythons: $(VENV)/.run
	$(BIN)/python -m release.pythons --tests tests/api tests/cli

# Needs uv; writes the locked dependencies with hashes for every platform.
lock:
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-emit-index-url \
	    --extra cad --extra live --extra studio pyproject.toml requirements-build.in --output-file requirements.lock
	uv pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-emit-index-url \
	    --extra cad --extra live --extra studio --group dev --constraint requirements.lock pyproject.toml --output-file requirements-dev.lock

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache

# The pages that are templates, from stored measurements. `python -m benchmarks.NAME` measures, and stores docs/background/NAME.json.
pages: $(VENV)/.dev
	$(BIN)/python docs/_ext/stored_pages.py

# The charts of docs/background, from the same measurements and from what the code gives in seconds.
charts: $(VENV)/.dev
	PYTHONPATH=docs/_ext OMP_NUM_THREADS=1 $(BIN)/python -m pictures

# A good and a bad case of every print rule, with what the rule finds; some minutes.
rule-pictures: $(VENV)/.dev
	PYTHONPATH=docs/_ext OMP_NUM_THREADS=1 $(BIN)/python -m pictures.rules.draw

# The studio's screens, in a browser, the connectors, and the map of a sweep.
pictures: $(VENV)/.dev
	PYTHONPATH=docs/_ext $(BIN)/python -m pictures.studio
	PYTHONPATH=docs/_ext $(BIN)/python -m pictures.connectors
	PYTHONPATH=docs/_ext OMP_NUM_THREADS=1 $(BIN)/python -m pictures.sweeps

# The shipped table of the solid's answers; goes on where it was stopped.
atlas: $(VENV)/.dev
	OMP_NUM_THREADS=1 $(BIN)/python -m release.tables.atlas

# The shipped table of contact that is not central; goes on where it was stopped.
contact-table: $(VENV)/.dev
	OMP_NUM_THREADS=1 $(BIN)/python -m release.tables.contact
