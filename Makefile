# SPDX-FileCopyrightText: The Swiftlet authors
# SPDX-License-Identifier: Apache-2.0
#
# Short names for what one does every day. Each target says what it is doing and repeats nothing
# that is done already.

.PHONY: help packages build program demo test test-full bench bench-middleware bench-chain bench-slam bench-screen asan tsan fuzz format tidy clean

PROGRAM := build/release/swiftlet
SCENARIO := components/sim/scenarios/office.yaml
JOBS ?= $(shell nproc)
FUZZ_SECONDS ?= 60

help:
	@echo "make demo       install packages, build, and fly the office: out/demo/"
	@echo "make test       install packages, build, and run the tests"
	@echo "make test-full  the tests with many seeds and long runs"
	@echo "make bench      benchmarks;  make bench-middleware  beside Cyclone DDS, roscpp, Fast DDS"
	@echo "make bench-chain  a phone's pose on its way to the motors, in real time"
	@echo "make bench-slam   a scan on its way to its pose, while loops are closed"
	@echo "make bench-screen  the ground station's screen: processor and memory over an hour, sped up"
	@echo "make asan tsan  the tests under the address and the thread sanitizer"
	@echo "make fuzz       libFuzzer on all that reads foreign bytes, FUZZ_SECONDS=60 each"
	@echo "make format     clang-format over our files;  make tidy  clang-tidy"
	@echo "make clean      remove build/ and out/"

packages:
	@.ci/install-packages

build: packages build/release/build.ninja
	@echo "== build: release"
	@cmake --build --preset release --parallel $(JOBS)

program: packages build/release/build.ninja
	@echo "== build: $(PROGRAM)"
	@cmake --build --preset release --parallel $(JOBS) --target swiftlet

build/%/build.ninja:
	@echo "== configure: $*"
	@mkdir -p build/$*
	@cmake --preset $* > build/$*/configure.log 2>&1 || { cat build/$*/configure.log; exit 1; }

demo: program
	@echo "== fly: $(SCENARIO)"
	@mkdir -p out/demo
	@$(PROGRAM) --log warning fly $(SCENARIO) --record out/demo/flight.mcap --report out/demo

test: build
	@echo "== test: release"
	@ctest --preset release --parallel $(JOBS)

test-full: build
	@echo "== test: release, everything"
	@SWIFTLET_FULL_TESTS=1 ctest --preset release --parallel $(JOBS) --timeout 3600

bench: build
	@echo "== bench: release"
	@build/release/swiftlet_bench --benchmark_min_time=0.2
	@tests/bench/sim_speed $(PROGRAM) $(SCENARIO)

bench-middleware: packages
	@.ci/install-packages packages-bench.txt
	@mkdir -p build/release
	@cmake --preset release > build/release/configure.log 2>&1 || { cat build/release/configure.log; exit 1; }
	@echo "== build: middleware_bench"
	@cmake --build --preset release --parallel $(JOBS) --target middleware_bench
	@echo "== bench: middleware (some ten minutes; only a quiet machine gives figures worth keeping)"
	@tests/bench/middleware/compare build/release

bench-chain: build
	@cmake --build --preset release --parallel $(JOBS) --target chain_bench
	@echo "== bench: datagram to motor command (half a minute)"
	@tests/bench/chain/measure build/release

bench-slam: build
	@cmake --build --preset release --parallel $(JOBS) --target slam_live_bench
	@echo "== bench: scan to pose while loops are closed (seven minutes)"
	@build/release/slam_live_bench

bench-screen: build
	@cmake --build --preset release --parallel $(JOBS) --target talking_vehicle
	@echo "== bench: screen, a minute as it is, then an hour in six minutes"
	@tests/bench/screen/measure build/release
	@tests/bench/screen/measure build/release 360 10

asan tsan: packages
	@$(MAKE) --no-print-directory build/$@/build.ninja
	@echo "== build: $@"
	@cmake --build --preset $@ --parallel $(JOBS)
	@echo "== test: $@"
	@ctest --preset $@

fuzz: packages
	@.ci/install-packages packages-fuzz.txt
	@$(MAKE) --no-print-directory build/$@/build.ninja
	@echo "== build: $@"
	@cmake --build --preset $@ --parallel $(JOBS)
	@tests/fuzz/run build/$@ $(FUZZ_SECONDS)

format:
	@git ls-files '*.cpp' '*.hpp' | xargs clang-format -i

tidy: packages build/tidy/build.ninja
	@echo "== build: $@"
	@cmake --build --preset $@ --parallel $(JOBS)
	@echo "== clang-tidy"
	@git ls-files '*.cpp' | grep -v '^tests/' \
	  | xargs -P $(JOBS) -n 1 clang-tidy -p build/$@ --quiet --extra-arg=-Qunused-arguments

clean:
	rm -rf build out
