// Bundles src/ into the package's static folder; with --check only says whether what is there is up to date.
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const out = here("../src/kfmaps/viz/static/");

async function bundle(entry, extra) {
  const result = await build({
    entryPoints: [here(entry)],
    bundle: true,
    minify: true,
    write: false,
    charset: "ascii",
    target: ["chrome100", "firefox100", "safari15.4"],
    legalComments: "none",
    ...extra,
  });
  return result.outputFiles[0].text.trim();
}

async function licences() {
  const parts = [];
  for (const name of ["three", "three-mesh-bvh"]) {
    const about = JSON.parse(await readFile(here(`node_modules/${name}/package.json`), "utf8"));
    const text = await readFile(here(`node_modules/${name}/LICENSE`), "utf8");
    parts.push(`${name} ${about.version}\n\n${text.trim()}\n`);
  }
  return parts.join("\n" + "-".repeat(78) + "\n\n");
}

const notice = "three.js and three-mesh-bvh, MIT licence; full text in viewer.LICENSE.txt";
const script = await bundle("src/main.js", { format: "iife" });
const files = {
  "viewer.js": `/* With ${notice} */\n${script}\n`,
  "viewer.css": (await bundle("src/viewer.css", {})) + "\n",
  "viewer.LICENSE.txt": await licences(),
};
// Inside <script> these would end the script or start a comment.
if (/<\/script|<!--/i.test(script)) throw new Error("the bundle cannot stand inside a <script> element");

let stale = false;
for (const [name, text] of Object.entries(files)) {
  if (process.argv.includes("--check")) {
    const have = await readFile(out + name, "utf8").catch(() => "");
    if (have !== text) {
      stale = true;
      console.error(`${name} is not what src/ builds: run "npm run build"`);
    }
  } else {
    await writeFile(out + name, text);
    console.log(`${name} ${text.length}`);
  }
}
process.exit(stale ? 1 : 0);
