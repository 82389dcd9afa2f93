// Makes one file of the page, ../page.html: the script and the style stand in it, so that nothing is fetched at run time,
// the digest of its source, by which tests/window/page_test.cpp sees whether it is fresh, and that of its script, by which a
// browser that is given the page as a file knows it (../replay_page.cpp).
import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";

const here = fileURLToPath(new URL(".", import.meta.url));

/** All files under a folder but hidden ones and an editor's copies, as paths from here with "/". */
function filesUnder(folder: string): string[] {
  return readdirSync(join(here, folder), { withFileTypes: true })
    .filter((entry) => !entry.name.startsWith(".") && !entry.name.endsWith("~"))
    .flatMap((entry) => (entry.isDirectory() ? filesUnder(`${folder}/${entry.name}`) : [`${folder}/${entry.name}`]));
}

/** FNV-1a, 64 bits, of path, 0, content, 0 of each source file in the order of the paths: 16 hexadecimal digits. */
function digest(): string {
  const single = ["index.html", "package-lock.json", "package.json", "tsconfig.json", "vite.config.ts"];
  const paths = [...single, ...filesUnder("src")].sort((a, b) => Buffer.compare(Buffer.from(a), Buffer.from(b)));
  let sum = 0xcbf29ce484222325n;
  for (const path of paths)
    for (const byte of Buffer.concat([Buffer.from(path), Buffer.of(0), readFileSync(join(here, path)), Buffer.of(0)]))
      sum = ((sum ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return sum.toString(16).padStart(16, "0");
}

/** Puts the script and the style into the page, and leaves the page alone. */
function oneFile(): Plugin {
  return {
    name: "one-file",
    apply: "build",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["index.html"];
      if (page?.type !== "asset") throw new Error("there is no index.html in what was built");
      let html = page.source.toString();
      // The licence of what the page contains goes with it; minifying takes the comments that had it.
      const licence = readFileSync(join(here, "node_modules/uplot/LICENSE"), "utf8").trim();
      html = html.replace("<head>", () => `<head>\n<meta name="boltzmann-source" content="${digest()}">`);
      html = html.replace("</head>", () => `<!-- uPlot is in this page:\n${licence}\n-->\n</head>`);
      for (const [name, file] of Object.entries(bundle)) {
        if (file === page) continue;
        const escaped = name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
        let tag: RegExp, content: string;
        if (file.type === "chunk") {
          tag = new RegExp(`[ \\t]*<script [^>]*src="[^"]*${escaped}"[^>]*></script>\\n?`);
          const code = file.code.trim().replace(/<(?=\/script|!--)/gi, "\\x3c");
          const sum = `sha256-${createHash("sha256").update(code).digest("base64")}`;
          html = html.replace("<head>", () => `<head>\n<meta name="boltzmann-script" content="${sum}">`);
          content = `<script type="module">${code}</script>\n`;
        } else if (name.endsWith(".css")) {
          tag = new RegExp(`[ \\t]*<link [^>]*href="[^"]*${escaped}"[^>]*>\\n?`);
          content = `<style>${file.source.toString().trim()}</style>\n`;
        } else {
          throw new Error(`${name} can't stand in the page: import it into the script or the style`);
        }
        if (!tag.test(html)) throw new Error(`the page has no tag for ${name}`);
        html = html.replace(tag, () => content);
        delete bundle[name];
      }
      page.source = html;
      page.fileName = "page.html";
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [oneFile()],
  build: {
    outDir: process.env.PAGE_FOLDER ?? "..", // a test builds elsewhere and compares
    emptyOutDir: false,
    target: "es2021",
    modulePreload: { polyfill: false },
    cssCodeSplit: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
