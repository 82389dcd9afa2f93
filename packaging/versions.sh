#!/bin/sh
# Compiler and CMake are new enough, or one line says what was found and what is needed.
set -eu
older() { [ "$1" != "$2" ] && [ "$(printf '%s\n%s\n' "$1" "$2" | sort -V | head -n 1)" = "$1" ]; }

compiler=${CXX:-g++}
if ! command -v ${compiler%% *} >/dev/null; then
  echo "the compiler '$compiler' is not there; g++ 12 or newer is needed (CXX=g++-12 chooses another)" >&2
  exit 1
fi
# clang says a version of gcc that it imitates; only g++ is asked.
if $compiler -v 2>&1 | grep -q '^gcc version'; then
  found=$($compiler -dumpfullversion -dumpversion)
  if older "$found" 12; then
    echo "$compiler $found found, g++ 12 or newer is needed (Debian 12 has it; CXX=g++-12 chooses another)" >&2
    exit 1
  fi
fi
if ! command -v cmake >/dev/null; then
  echo "cmake is not there; 3.25 or newer is needed" >&2
  exit 1
fi
found=$(cmake --version | sed -n 's/^cmake version //p')
if older "$found" 3.25; then
  echo "cmake $found found, 3.25 or newer is needed (Debian 12 has it)" >&2
  exit 1
fi
