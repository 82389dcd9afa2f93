# `make run` shows a first simulation, `make test` checks everything. Both install what is missing and build first.
BUILD := build/release
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)
CORES := $(shell nproc)
# CPU seconds that bzm takes from nothing, for one instruction set (docs/how-to/install.md has the measurement).
BZM_SECONDS := 560
NINJA := NINJA_STATUS='[%p of %t, %e s] ' cmake --build $(BUILD)

.PHONY: run python docs test build all-sets install dependencies test-dependencies page bench format clean

# Kernels for this machine only, and nothing but the command.
run: | $(BUILD)/build.ninja
	@[ -x $(BUILD)/bzm ] || echo "Building bzm: about $$(( ($(BZM_SECONDS) / $(CORES) + 59) / 60 )) minutes on $(CORES) cores, once."
	@$(NINJA) --target bzm
	$(BUILD)/bzm run copper --out results/copper --force
	@echo "Results are in $(CURDIR)/results/copper (start with picture.png)"

# import boltzmann, for Debian's Python or that of an active virtual environment.
python: | $(BUILD)/build.ninja
	@packaging/need.sh $$(cat packaging/python.txt)
	@cmake $(BUILD) -DBOLTZMANN_PYTHON=ON > $(BUILD)/python.log || { cat $(BUILD)/python.log; false; }
	@[ -e $(BUILD)/libboltzmann.a ] || echo "Building the library: about $$(( ($(BZM_SECONDS) / $(CORES) + 59) / 60 )) minutes on $(CORES) cores, once."
	@$(NINJA) --target python

# The documentation as a site, in build/site; notebooks are run for it.
docs: python
	@packaging/need.sh mkdocs-material python3-nbclient python3-ipykernel python3-matplotlib
	PYTHONPATH=$(CURDIR)/$(BUILD)/python /usr/bin/python3 -B docs/site/make.py build/site-pages --execute
	BOLTZMANN_PAGES=$(CURDIR)/build/site-pages /usr/bin/mkdocs --quiet build --strict -f docs/site/mkdocs.yml -d $(CURDIR)/build/site
	@echo "The site is in $(CURDIR)/build/site (start with index.html; python3 -m http.server -d build/site, and it can be searched)"

test: test-dependencies build
	cd $(BUILD) && ctest --output-on-failure --no-tests=error -j $$(( $(CORES) + 2 ))  # browsers, servers and what is killed wait much of their time

build: all-sets
	$(NINJA)

# Kernels for every x86-64, and the tests; what is compiled already stays. Configured again, too, if pybind11 has come since.
all-sets: | $(BUILD)/build.ninja
	@grep -q 'BOLTZMANN_SETS:STRING=all' $(BUILD)/CMakeCache.txt && grep -q 'BOLTZMANN_TESTS:BOOL=ON' $(BUILD)/CMakeCache.txt && \
	{ ! [ -e /usr/include/pybind11/pybind11.h ] || grep -q 'PYBIND11_HEADERS:PATH=/' $(BUILD)/CMakeCache.txt; } || \
	cmake --preset release -DBOLTZMANN_SETS=all -DBOLTZMANN_TESTS=ON

$(BUILD)/build.ninja:
	@$(MAKE) --no-print-directory dependencies
	cmake --preset release -DBOLTZMANN_SETS=machine -DBOLTZMANN_TESTS=OFF

# Without root the line that installs them is printed, and make stops.
dependencies:
	@packaging/need.sh $$(cat dependencies.txt)
	@packaging/versions.sh

test-dependencies: dependencies
	@packaging/need.sh $$(sed '/^#/d; s/ /=/' tests/dependencies.txt)

include packaging/package.mk

# After a change of boltzmann/window/web.
page:
	cd boltzmann/window/web && npm ci --ignore-scripts && npm run build

PREFIX := /usr/local
install: all-sets
	$(NINJA) --target installable
	$(SUDO) cmake --install $(BUILD) --prefix $(PREFIX)

bench: all-sets
	$(NINJA) --target bench

format:
	clang-format -i $$(git ls-files '*.cpp' '*.hpp' '*.c')

clean:
	rm -rf build results
