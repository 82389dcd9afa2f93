// Builds the page as a single file, ../page.html, with script and style embedded, so that nothing is loaded at run
// time. It includes the digest of its source, by which tests/window/page_test.cpp checks that it is up to date, and
// that of its script, by which a browser accepts the script if the page is opened as a file (../replay_page.cpp).
import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";

const here = fileURLToPath(new URL(".", import.meta.url));

/** All files under a folder except hidden ones and editor backups, as paths from here with "/". */
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

/** Embeds the script and the style in the page. */
function oneFile(): Plugin {
  return {
    name: "one-file",
    apply: "build",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["index.html"];
      if (page?.type !== "asset") throw new Error("there is no index.html in what was built");
      let html = page.source.toString();
      // The page must include the licence of its libraries; minifying removes the comments with it.
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
