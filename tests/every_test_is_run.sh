#!/usr/bin/env bash
# Whether ctest has exactly one entry for each test of each program, and long.txt names existing ones.
# Usage: every_test_is_run.sh LONG PROGRAM..., beside each program PROGRAM.cmake with its entries
set -euo pipefail
long=$1
shift
entries=() failed=0
for program in "$@"; do
  entries+=("$program.cmake")
  has=$("$program" --gtest_list_tests |
    awk '/^[^ ]+\.( |$)/ {suite = $1} /^  / {print suite $1}' | LC_ALL=C sort)
  run=$(sed -n 's/.*--gtest_filter=\(.*\))$/\1/p' "$program.cmake" | LC_ALL=C sort)
  if [ "$has" != "$run" ]; then
    echo "ctest doesn't run each test of ${program##*/} once (<: not run, >: run again or unknown):"
    diff <(echo "$has") <(echo "$run") || true
    failed=1
  fi
  [ -n "$has" ] || { echo "${program##*/} has no tests"; failed=1; }
done
while read -r _ name; do
  grep -qF "add_test($name " "${entries[@]}" || { echo "long.txt: there is no test $name"; failed=1; }
done < <(grep -v '^#' "$long")
exit $failed
