// Bundles the page, and lists what it contains of others.

import { build } from "esbuild";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";

const OUT = "rcyaml_manager/static";
const made = await build({
  entryPoints: ["src/main.ts", "src/page.css"], bundle: true, minify: true, splitting: true, format: "esm", target: "es2022",
  chunkNames: "[name]-[hash]", outdir: OUT, metafile: true, legalComments: "none",
});
const used = Object.values(made.metafile.outputs).flatMap((one) => Object.keys(one.inputs));
const packages = new Set(used.map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]).filter(Boolean));
const texts = [...packages].sort().map((name) => {
  const folder = `node_modules/${name}`, { version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((one) => /^licen[cs]e/i.test(one));
  return `${name} ${version} (${license})\n\n${file && existsSync(`${folder}/${file}`) ? readFileSync(`${folder}/${file}`, "utf8").trim() : ""}\n`;
});
writeFileSync(`${OUT}/licences.txt`, texts.join(`\n${"-".repeat(72)}\n\n`));
