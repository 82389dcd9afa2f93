#!/usr/bin/env bash
# Whether boltzmann/window/page.html is, byte for byte, what its source gives when it is built here; and whether its ticks,
# the outlines of its spaces and the layout of its figures are those of pictures.
# Usage: page.sh BUILD_FOLDER
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
what="build of the page"
. "$here/node_modules.sh"
need node npm

window=$(cd "$here/../../boltzmann/window" && pwd)
folder=$1/window-page
mkdir -p "$folder"
rm -rf "$folder/src" "$folder/out"
for name in .npmrc package.json package-lock.json tsconfig.json vite.config.ts index.html src; do
  cp -r "$window/web/$name" "$folder/"
done
install "$folder"
cd "$folder"
PAGE_FOLDER=out npm run --silent build
cmp out/page.html "$window/page.html" || {
  echo "boltzmann/window/page.html is not what its source gives; build it again: cd boltzmann/window/web && npm ci && npm run build"
  exit 1
}
echo "page.html is what its source gives"
node_modules/.bin/esbuild src/paint/ticks.ts --format=esm --log-level=error --outfile=out/ticks.mjs
node "$here/ticks.mjs" out/ticks.mjs "$here/../pictures/ticks.json"
cat >out/outline.ts <<'END'
export { Outline } from "../src/paint/outline";
export { Space } from "../src/paint/look";
export { themes } from "../src/paint/theme";
END
node_modules/.bin/esbuild out/outline.ts --bundle --format=esm --log-level=error --outfile=out/outline.mjs
node "$here/outline.mjs" out/outline.mjs "$here/../pictures/outlines.json"
cat >out/layout.ts <<'END'
export { View } from "../src/paint/view";
export { Pen } from "../src/paint/text";
export { css, themes } from "../src/paint/theme";
END
node_modules/.bin/esbuild out/layout.ts --bundle --format=esm --log-level=error --outfile=out/layout.mjs
node "$here/layout.mjs" out/layout.mjs "$here/layouts.json"
