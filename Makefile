# `make demo` and `make test` need nothing installed but Python, git and make; each makes its own .venv.

VENV   := .venv
BIN    := $(VENV)/bin
# The newest Python that PyBullet has wheels for, else the newest that the core runs on.
PYTHON ?= $(shell for p in python3.11 python3.10 python3 python; do \
	$$p -c 'import sys; sys.exit(not (3, 10) <= sys.version_info < (3, 12))' 2>/dev/null && echo $$p && exit; done; \
	for p in python3.13 python3.12 python3 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null && echo $$p && exit; done)
SEEDS  ?= 20
# Hundreds of programs are started, and several processes read all tests: to compile everything anew in each of them,
# as containers with this variable have it, costs a minute and more.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo before-commit test thorough test-keys quick nightly foreign mangled faults fuzz check audit package format lint types floors shapes docs-check experiment bench clean

demo: $(VENV)/with-sim
	$(BIN)/selfconf demo

# Five processes more than there are processors, for many tests wait for programs that they have started; which tests
# share one, and which processes compute meanwhile, is said in tests/harness/schedule.py.
PARALLEL := --forks $(shell echo $$((5 + $$(nproc 2>/dev/null || echo 2))))

# A test that hangs for five minutes has failed: it says where each thread is, and its process is replaced.
BOUNDED := -o faulthandler_timeout=300 -o faulthandler_exit_on_timeout=true

# What tests write lies in memory, where there are 2 GiB for it and programs may be in it: the tests of one run make and
# remove ten thousand folders, for which some disks take half a minute and more.
MEMORY := $(shell df --output=avail /dev/shm 2>/dev/null | awk '$$1 >= 2097152 { print "/dev/shm" }')
IN_MEMORY := $(if $(MEMORY),$(shell awk '$$2 == "/dev/shm" && $$4 !~ /noexec/ { print "TMPDIR=/dev/shm"; exit }' /proc/mounts))

# A test that starves among others on a busy machine is run once more, alone; more than five failures stand.
REPORT  = $(VENV)/$@.xml
PYTEST  = rm -f $(REPORT); $(IN_MEMORY) $(BIN)/python -m pytest $(PARALLEL) $(BOUNDED) --junitxml $(REPORT)
OR_ALONE = || $(BIN)/python -m tests.harness.alone $(REPORT)

# Every test but those that are thorough.
test: $(VENV)/with-dev
	$(PYTEST) -m 'not thorough' $(OR_ALONE)

# The tests that show by more or larger examples what others show by less, or run a benchmark for a moment.
thorough: $(VENV)/with-dev
	$(PYTEST) -m thorough $$(grep -lrE 'harness.effort import .*(batches|thorough)' tests --include='test_*.py') $(OR_ALONE)

# The tests that start programs once more, each ecology with keys: a job of its own, as it takes as long as the others.
# One that starves among others is run once more, alone, as by `make test`.
test-keys: export SELFCONF_TEST_KEYS := 1
test-keys: $(VENV)/with-dev
	$(PYTEST) -m process tests/access tests/cli tests/api tests/serve/test_page.py $(OR_ALONE)

# The inner loop: without tests that start processes or are slow, and a tenth of the examples of each property.
quick: $(VENV)/with-dev
	HYPOTHESIS_PROFILE=quick $(BIN)/python -m pytest $(PARALLEL) -m 'not process and not slow and not thorough'

# What programs judge that others wrote: nodes of ROS 2 by hiroz, Things and a client by node-wot, a page by YASGUI. They
# are had by cargo and npm into ~/.cache/selfconf-tests; where that cannot be, the tests are skipped and say so.
FOREIGN := tests/bridging/ros2/test_native_nodes.py tests/benchmarks/test_lost_node.py tests/bridging/wot/test_node_wot.py \
	tests/serve/test_foreign_clients.py

# Mistakes in good files, ten thousand random ecologies for each property of the search, against every oracle, ten
# thousand histories with faults and four thousand harsh ones, all that is recorded, drives of ten seeds, a hundred
# kills of a server that writes its history, the programs of others, and the ecologies of all tests once more with keys;
# about forty minutes.
nightly: $(VENV)/with-dev fuzz test-keys
	HYPOTHESIS_PROFILE=nightly $(BIN)/python -m pytest $(PARALLEL) tests/search tests/configurator tests/composition/test_searches.py \
		tests/test_configuration_certificate.py tests/faults tests/hostile tests/recorded tests/sim/test_rehearsal.py tests/sim/test_demo.py \
		tests/benchmarks/test_compare.py tests/docs/test_ci_for_users.py tests/access/test_expiry.py \
		tests/access/test_intruder.py tests/access/test_strangers.py tests/access/test_two_hosts.py tests/cli/test_access.py $(FOREIGN)
	$(BIN)/python -m benchmarks.history --kills 100

# The programs of others alone; the first time cargo takes some five minutes.
foreign: $(VENV)/with-dev
	HYPOTHESIS_PROFILE=nightly $(BIN)/python -m pytest $(FOREIGN)

# Ten thousand mangled messages, payloads, advertisements, certificates and HTTP requests each; some minutes.
mangled: $(VENV)/with-dev
	HYPOTHESIS_PROFILE=nightly $(BIN)/python -m pytest $(PARALLEL) tests/hostile

# Whether a vulnerability of a pinned version is known. Where nobody can be asked, it says so and is no failure.
audit: $(VENV)/with-dev
	$(BIN)/python -m supply.audit

# Five hundred real faults: processes that are killed, stopped and ended at random moments; about twenty minutes.
faults: $(VENV)/with-dev
	$(BIN)/python -m benchmarks.faults --trials 500 --workers 4

# Mistakes made on purpose in good files: how many `validate` finds, where, and what it complains of for nothing.
fuzz: $(VENV)/with-dev
	$(BIN)/python -m benchmarks.fuzz --number 60 --seed $$(date +%j) --show

# What looks at the files and what builds the package wait for each other in no way; the tests use all processors.
check: $(VENV)/with-dev
	@$(MAKE) --jobs=2 --output-sync=target lint types floors shapes docs-check package audit
	@$(MAKE) test
	@$(MAKE) thorough

package: $(VENV)/with-dev
	.ci/package

$(VENV)/python:
	@test -n "$(PYTHON)" || { echo "selfconf needs Python 3.10 or newer; install python3.11 and try again" >&2; exit 2; }
	pip=$$($(PYTHON) -m supply.pins bundled) && $(PYTHON) -m venv $${pip:+--without-pip} $(VENV)
	@touch $@

# Every file that is installed has a hash in requirements.txt, and nothing else is looked for: not even what builds the
# package, which is installed beforehand.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check
SELECT  := $(BIN)/python -m supply.pins select

# The pip that is pinned installs so many packages in half the time of the one that comes with Python. That one need not
# be installed to install it, as `venv` does: it runs from its wheel, which saves three seconds.
$(VENV)/pip: $(VENV)/python requirements.txt
	$(BIN)/python -m supply.pins installer >$(VENV)/installer.txt
	PYTHONPATH=$$($(BIN)/python -m supply.pins bundled) $(INSTALL) --no-compile --require-hashes --no-deps \
		-r $(VENV)/installer.txt
	@touch $@

# The extras by the Python there is: PyBullet has wheels for 3.10 and 3.11 on Linux x86_64 only.
$(VENV)/with-sim: $(VENV)/pip pyproject.toml requirements.txt
	@$(BIN)/python -c 'import platform, sys; sys.exit(not ((3, 10) <= sys.version_info < (3, 12) \
		and sys.platform == "linux" and platform.machine() == "x86_64"))' \
	|| { echo "the demo needs PyBullet, which has wheels for Python 3.10 and 3.11 on Linux x86_64 only:" \
		"install python3.11, or type 'make demo PYTHON=/path/to/python3.11'" >&2; exit 2; }
	$(SELECT) build sim serve keys >$(VENV)/demo.txt
	$(INSTALL) --require-hashes --no-deps -r $(VENV)/demo.txt
	$(INSTALL) --no-deps --no-build-isolation -e .
	@touch $@

# It is left to Python to compile what is imported, which is a quarter. pip computes more than it fetches, so two do it
# in half the time.
DEV_EXTRAS  := build sim solvers serve keys wot ros2 dev
INSTALL_DEV := $(INSTALL) --no-compile --require-hashes --no-deps -r $(VENV)/dev
$(VENV)/with-dev: $(VENV)/pip pyproject.toml requirements.txt
	for half in 1 2; do $(SELECT) --half $$half $(DEV_EXTRAS) >$(VENV)/dev-$$half.txt || exit; done
	$(INSTALL_DEV)-1.txt & one=$$!; $(INSTALL_DEV)-2.txt; other=$$?; wait $$one && exit $$other
	$(INSTALL) --no-deps --no-build-isolation -e .
	@touch $@ $(VENV)/with-sim

# What a commit has to pass besides the tests around the change; it takes under a minute, and needs no network.
before-commit: $(VENV)/with-dev
	@$(MAKE) --jobs=2 --output-sync=target lint types floors docs-check
	$(BIN)/python -m pytest -q tests/test_house.py tests/test_mirror.py tests/test_floors.py tests/model/test_immutable.py

lint: $(VENV)/with-dev
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

format: $(VENV)/with-dev
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

types: $(VENV)/with-dev
	$(BIN)/mypy

floors: $(VENV)/with-dev
	$(BIN)/lint-imports

shapes: $(VENV)/with-dev
	$(BIN)/selfconf validate ontology examples

docs-check: $(VENV)/with-dev
	$(BIN)/python -m docs.generate --check

experiment: $(VENV)/with-sim
	$(BIN)/python -m benchmarks.experiment --seeds $(SEEDS)

bench: $(VENV)/with-dev
	$(BIN)/python -m benchmarks.failover

clean:
	rm -rf $(VENV) out dist build .mypy_cache .ruff_cache .import_linter_cache .hypothesis
