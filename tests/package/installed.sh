#!/usr/bin/env bash
# installed.sh BUILD [PYTHON]: what BUILD would install, put into a folder, compiles a user's program by bzm build, by CMake's
# find_package and with pkg-config; all three leave the same numbers. PYTHON imports the package there and leaves those of bzm.
# tests/package/bare_debian.sh does the same with packages.
set -euo pipefail
build=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$folder/there" > "$folder/log" || fail "cmake --install: $(tail -n 1 "$folder/log")"
bzm=$folder/there/bin/bzm
[ "$($bzm list --names scenarios)" = "$("$build/bzm" list --names scenarios)" ] || fail "other scenarios"
for shell in bash zsh fish; do
  find "$folder/there/share" -path "*$shell*" -type f -exec cat {} + | cmp -s - <("$build/bzm" completion $shell) || fail "completion of $shell"
done
mkdir "$folder/user"
cd "$folder/user"
if [ -n "${2:-}" ]; then
  cat > program.py <<'END'
import boltzmann, sys
assert boltzmann.__file__.startswith(sys.argv[1]), boltzmann.__file__
assert boltzmann._core.find_scenario("copper") == sys.argv[1] + "/share/boltzmann/scenarios/copper.toml"
boltzmann.load("copper", steps=100).run(out="from-python")
END
  PYTHONPATH=$folder/there/lib/python3/dist-packages "$2" -B program.py "$(realpath "$folder/there")" > "$folder/log" 2>&1 || fail "python: $(cat "$folder/log")"
  "$bzm" run copper --steps 100 --out from-bzm --quiet > "$folder/log" 2>&1 || fail "bzm run: $(cat "$folder/log")"
  cmp -s from-python/diagnoses.csv from-bzm/diagnoses.csv || fail "Python has other numbers than bzm"
  echo "python: imports and runs"
fi
cp "$here/user.cpp" "$here/CMakeLists.txt" .
ran() {  # NAME PROGRAM
  rm -rf results
  "./$2" > "$folder/log" 2>&1 || fail "the program of $1: $(cat "$folder/log")"
  [ -s results/picture.png ] || fail "the program of $1 left no picture"
  [ -f wanted.csv ] || cp results/diagnoses.csv wanted.csv
  cmp -s results/diagnoses.csv wanted.csv || fail "the program of $1 has other numbers than that of bzm build"
  echo "$1: compiles and runs"
}
"$bzm" build user.cpp -o by-bzm > "$folder/log" 2>&1 || fail "bzm build: $(cat "$folder/log")"
grep -q -- "-I$folder/there/include " "$folder/log" || fail "bzm build took other headers: $(cat "$folder/log")"
ran "bzm build" by-bzm
PKG_CONFIG_PATH=$(dirname "$(find "$folder/there" -name boltzmann.pc)")
export PKG_CONFIG_PATH
g++ -O3 -DNDEBUG user.cpp -o by-pkg-config $(pkg-config --cflags --libs boltzmann) || fail "pkg-config"
ran pkg-config by-pkg-config
cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$folder/there" > "$folder/log" 2>&1 || fail "find_package: $(cat "$folder/log")"
cmake --build build > "$folder/log" 2>&1 || fail "find_package: $(cat "$folder/log")"
ran find_package build/user

rm -r "$folder/there/include"
status=0
"$bzm" build user.cpp -o refused > "$folder/log" 2>&1 || status=$?
[ $status = 2 ] && [ "$(wc -l < "$folder/log")" = 1 ] && grep -q 'apt install libboltzmann-dev' "$folder/log" || fail "bzm build without headers: $(cat "$folder/log")"
echo "1 passed, 0 failed"
