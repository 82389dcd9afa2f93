# Two commands: `make run` shows a first simulation, `make test` checks everything. Both install what is missing and build first.
BUILD := build/release
PACKAGES := $(shell cat dependencies.txt)
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)

.PHONY: run test build install dependencies browser page bench format clean

run: build
	$(BUILD)/bzm run copper --out results/copper --force
	@echo "Results are in $(CURDIR)/results/copper (start with picture.png)"

test: build browser
	cd $(BUILD) && ctest --output-on-failure --no-tests=error -j $$(nproc)

build: $(BUILD)/build.ninja
	cmake --build $(BUILD)

$(BUILD)/build.ninja: dependencies
	cmake --preset release

dependencies:
	@missing=$$(for p in $(PACKAGES); do dpkg-query -W -f='$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	if [ -n "$$missing" ]; then echo "installing" $$missing; \
	$(SUDO) apt-get update -qq && DEBIAN_FRONTEND=noninteractive $(SUDO) apt-get install -y -qq --no-install-recommends $$missing; fi

# For the window's tests in a browser; those are skipped where this fails.
browser:
	@missing=$$(for p in chromium nodejs npm; do command -v $$(echo $$p | sed s/nodejs/node/) >/dev/null || echo $$p; done); \
	if [ -n "$$missing" ]; then echo "installing" $$missing; \
	$(SUDO) apt-get update -qq && DEBIAN_FRONTEND=noninteractive $(SUDO) apt-get install -y -qq --no-install-recommends $$missing || true; fi

# After a change of boltzmann/window/web.
page:
	cd boltzmann/window/web && npm ci --ignore-scripts && npm run build

PREFIX := /usr/local
install: build
	$(SUDO) cmake --install $(BUILD) --prefix $(PREFIX)

bench: build
	cmake --build $(BUILD) --target bench

format:
	clang-format -i $$(git ls-files '*.cpp' '*.hpp' '*.c')

clean:
	rm -rf build results
