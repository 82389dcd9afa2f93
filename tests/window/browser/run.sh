#!/usr/bin/env bash
# The window's tests in a browser: every *.test.mjs here, or those that are named.
# Usage: run.sh BUILD_FOLDER BZM [NAME.test.mjs...]
# Screenshots and what bzm printed are left in BUILD_FOLDER/window-browser/.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
what="browser tests"
. "$here/../node_modules.sh"
need node npm chromium

mkdir -p "$1/window-browser"
folder=$(cd "$1/window-browser" && pwd)
BZM=$(realpath "$2")
export BZM
shift 2
( # one at a time: tests run side by side
  flock 9
  cp "$here"/{package.json,package-lock.json,.npmrc} "$folder/"
  install "$folder"
) 9>"$folder/lock"
export WINDOW_FOLDER=$folder
cd "$here"
[ $# -gt 0 ] || set -- *.test.mjs
exec node --test --test-concurrency=1 "$@"
