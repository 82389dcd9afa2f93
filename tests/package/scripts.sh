#!/usr/bin/env bash
# What make says before it configures, and what bzm --version says, with programs of our own in place of the machine's.
set -euo pipefail
source=$(realpath "$(dirname "$0")/../..")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
export PATH="$folder/bin:$PATH"
unset CXX

program() { printf '#!/bin/sh\n%s\n' "$2" > "$folder/bin/$1"; chmod +x "$folder/bin/$1"; }
gone() { rm -f "$folder/bin/$1"; }
expect() {  # STATUS TEXT COMMAND...: the status, and all that is printed
  local wanted=$1 text=$2 status=0 out
  shift 2
  out=$("$@" 2>&1) || status=$?
  if [ "$status" != "$wanted" ] || [ "$out" != "$text" ]; then
    printf 'FAILED: %s\n  wanted %s: %s\n  got    %s: %s\n' "$*" "$wanted" "$text" "$status" "$out" >&2
    exit 1
  fi
}

# Versions: one line says what was found and what is needed.
versions=$source/packaging/versions.sh
gcc() { program "$1" "case \$1 in -v) echo 'gcc version $2' >&2 ;; *) echo $2 ;; esac"; }
gcc g++ 12.2.0
program cmake 'echo cmake version 3.25.1'
expect 0 "" "$versions"
gcc g++ 9.4.0
expect 1 "g++ 9.4.0 found, g++ 12 or newer is needed (Debian 12 has it; CXX=g++-12 chooses another)" "$versions"
gcc g++-13 13.1.0
expect 0 "" env CXX=g++-13 "$versions"
expect 1 "the compiler 'g++-99' is not there; g++ 12 or newer is needed (CXX=g++-12 chooses another)" env CXX=g++-99 "$versions"
gcc g++ 100.0.1
program cmake 'echo cmake version 3.5.1'
expect 1 "cmake 3.5.1 found, 3.25 or newer is needed (Debian 12 has it)" "$versions"
program cmake 'echo cmake version 4.0.0'
expect 0 "" "$versions"
gone cmake

# Packages: installed by root or by a sudo that asks for nothing; else the line that does it.
need=$source/packaging/need.sh
program dpkg-query 'for last; do :; done; [ "$last" = present ] && echo "install ok installed"'
program id 'echo 1000'
program sudo 'exit 1'
expect 0 "" "$need" present
expect 1 "sudo apt-get install -y --no-install-recommends absent other" "$need" absent present other
program apt-get 'echo "apt-get $*"'
wanted='installing absent
apt-get update -qq
apt-get install -y -qq --no-install-recommends absent'
program sudo 'shift; [ "$1" = true ] || exec "$@"'
expect 0 "$wanted" "$need" absent
program id 'echo 0'
gone sudo
expect 0 "$wanted" "$need" absent

# The version: of the project without git, else with the commit; a tag is where commits are counted from.
describe() { cmake -DSOURCE="$folder/tree" -DVERSION=0.1.0 -DOUTPUT="$folder/version.cpp" -P "$source/cmake/describe.cmake" && grep -o '"[^"]*"' "$folder/version.cpp"; }
git() { command git -C "$folder/tree" -c user.name=test -c user.email=test@localhost "$@"; }
mkdir "$folder/tree"
expect 0 '"0.1.0"' describe
git init -q
echo one > "$folder/tree/file"
git add file && git commit -qm one
echo two > "$folder/tree/file"
git commit -qam two
expect 0 "\"0.1.0-2-g$(git rev-parse --short HEAD)\"" describe
before=$(stat -c %y "$folder/version.cpp")
expect 0 "\"0.1.0-2-g$(git rev-parse --short HEAD)\"" describe
[ "$before" = "$(stat -c %y "$folder/version.cpp")" ] || { echo "FAILED: the version is written again" >&2; exit 1; }
git tag v0.1.0 HEAD~1
expect 0 "\"0.1.0-1-g$(git rev-parse --short HEAD)\"" describe
git tag v0.2.0
expect 0 '"0.2.0"' describe
echo three > "$folder/tree/file"
expect 0 '"0.2.0-dirty"' describe
echo "1 passed, 0 failed"
