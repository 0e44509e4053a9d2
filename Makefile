# Everything is done inside .venv; `make help` lists the targets.
# A stamp in the environment records what it was set up for, so a second run is instant;
# a change of pyproject.toml or of the locked versions sets it up again.

PYTHON ?= python3
VENV   ?= .venv
PYTEST_ARGS ?=
TESTS ?= changed
PAPER ?= out/paper
FUZZ ?= 8

BIN := $(VENV)/bin
SETUP := pyproject.toml tools/setup.sh tools/run_uv.py tools/common.sh tools/locks/newest.txt

# uv compiles no bytecode: the first import leaves it for the next process.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help demo test check coverage fuzz integrations api lint format docs site gallery client paper paper-quick wheel clean

help: ## list the targets
	@echo "flowtex. Choose an interpreter with PYTHON=python3.12, tests with PYTEST_ARGS='-k trace'."
	@sed -n 's/^\([a-z-]*\):[^#]*## /  make \1\t/p' Makefile | expand -t 20

demo: $(VENV)/.ready-demo ## set up if necessary, and show the example flows
	@sh tools/opengl.sh $(BIN)/python
	@$(BIN)/flowtex demo

test: $(VENV)/.ready-test ## set up if necessary, then run all checks and all tests
	@sh tools/opengl.sh $(BIN)/python
	@sh tools/browsers.sh $(BIN)/python
	@sh tools/check.sh $(BIN) all $(PYTEST_ARGS)

check: $(VENV)/.ready-test ## style, format, types, and the fast tests of changed modules, or all fast ones with TESTS=fast
	@sh tools/opengl.sh $(BIN)/python
	@sh tools/check.sh $(BIN) $(TESTS) $(PYTEST_ARGS)

coverage: $(VENV)/.ready-test ## measure the coverage of flowtex/ and client/src, into out/coverage
	@sh tools/opengl.sh $(BIN)/python
	@sh tools/browsers.sh $(BIN)/python
	@sh tools/coverage.sh $(BIN) $(PYTEST_ARGS)

fuzz: $(VENV)/.ready-test ## try ten thousand random fields, settings, states, links, files and messages
	FLOWTEX_FUZZ=$(FUZZ) $(BIN)/pytest -n auto --maxprocesses 4 -m hypothesis -o faulthandler_timeout=0 $(PYTEST_ARGS)

integrations: $(VENV)-integrations/.ready ## show a flow in hosts such as Notebook 7, Panel and MyST, and results of other libraries, in a separate environment
	@sh tools/browsers.sh $(VENV)-integrations/bin/python
	$(VENV)-integrations/bin/python -m pytest tests/integrations $(PYTEST_ARGS)

api: $(VENV)/.ready-test ## list public names and arguments that have gone since the last release
	@last=$$(git describe --tags --match 'v*' --abbrev=0 2>/dev/null) || { echo "flowtex: there is no release yet"; exit 0; }; \
	$(BIN)/griffe check flowtex --against "$$last" && echo "flowtex: all that $$last has is there"

lint: $(VENV)/.ready-test ## style, format, types and the browser client, without the tests
	@sh tools/check.sh $(BIN) none

format: $(VENV)/.ready-test ## format the code
	$(BIN)/ruff check --select I --fix
	$(BIN)/ruff format

client: $(VENV)/.ready-test ## build the browser client into the package
	sh tools/client.sh $(BIN) build

docs: $(VENV)/.ready-test ## write the tables of settings and of supported data into the docs
	FLOWTEX_WRITE_DOCS=1 $(BIN)/python -m pytest -q tests/test_docs.py -k table

site: $(VENV)/.ready-site ## build the site into out/site, and check its links, spelling and accessibility
	@sh tools/opengl.sh $(BIN)/python
	@sh tools/browsers.sh $(BIN)/python
	@sh tools/site.sh $(BIN)

gallery: client ## draw the pictures of the README and the gallery
	$(BIN)/python docs/make_pictures.py

paper: $(VENV)/.ready-demo ## compute the paper's tables and figures into out/paper, in a few minutes
	@$(BIN)/python -m paper -o $(PAPER)

paper-quick: $(VENV)/.ready-demo ## the same in reduced form, in less than a minute
	@$(BIN)/python -m paper --quick -o $(PAPER)

wheel: $(VENV)/.ready-test ## build dist/flowtex-*.whl and the source archive
	$(BIN)/hatchling build

clean: ## remove the environment and all build products
	rm -rf $(VENV) $(VENV)-integrations dist build out .mypy_cache .pytest_cache .ruff_cache
	find . -name node_modules -type d -prune -exec rm -rf {} +
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.ready-demo: $(SETUP)
	@sh tools/setup.sh "$(PYTHON)" $(VENV) app,movie
	@touch $@

# What the tests need includes what the demo needs.
$(VENV)/.ready-test: $(SETUP)
	@sh tools/setup.sh "$(PYTHON)" $(VENV) all dev
	@touch $@ $(VENV)/.ready-demo

$(VENV)/.ready-site: $(SETUP)
	@sh tools/setup.sh "$(PYTHON)" $(VENV) all site
	@touch $@ $(VENV)/.ready-demo

$(VENV)-integrations/.ready: $(SETUP)
	@sh tools/setup.sh "$(PYTHON)" $(VENV)-integrations notebook,xarray integrations
	@touch $@
