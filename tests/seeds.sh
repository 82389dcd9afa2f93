#!/bin/sh
# Runs the tests of a build over many seeds and instruction sets, and counts what fails:
#   tests/seeds.sh build/release                              20 seeds, each set of this machine
#   tests/seeds.sh build/release 5 "x86-64 x86-64-v3"         seeds 1 to 5, these sets
#   tests/seeds.sh build/release 50 x86-64-v3 -R Langevin     further words are ctest's
# Programs of tests have kernels of their own, compiled for BOLTZMANN_ARCH: try a build with -DBOLTZMANN_ARCH=x86-64-v3, too.
# A single test: BOLTZMANN_TEST_SEED=7 BOLTZMANN_INSTRUCTIONS=x86-64 build/release/tests/...
build=${1:?"usage: tests/seeds.sh BUILD [SEEDS] [SETS] [ctest's options]"}
seeds=${2:-20}
sets=$3
if [ -z "$sets" ]; then
  sets=x86-64
  grep -qw avx2 /proc/cpuinfo && sets="$sets x86-64-v3"
  grep -qw avx512bw /proc/cpuinfo && sets="$sets x86-64-v4"
fi
[ $# -ge 3 ] && shift 3 || shift $#
failures=$(mktemp)
trap 'rm -f "$failures"' EXIT
for set in $sets; do
  for seed in $(seq "$seeds"); do
    BOLTZMANN_TEST_SEED=$seed BOLTZMANN_INSTRUCTIONS=$set ctest --test-dir "$build" -j "$(nproc)" "$@" 2>/dev/null |
      awk -v where="$set, seed $seed" '/[*][*][*](Failed|Exception|Timeout|Not Run)/ { sub(/^[^:]*: /, ""); print $1 "\t" where }' |
      tee -a "$failures"
  done
done
echo "failures of each test:"
cut -f 1 "$failures" | sort | uniq -c | sort -rn
[ ! -s "$failures" ]
