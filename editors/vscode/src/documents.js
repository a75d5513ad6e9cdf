"use strict";
// The kinds of documents, and where the schema of a document is. Nothing here needs VS Code.

const fs = require("node:fs");
const path = require("node:path");

const KINDS = ["idsl", "cdsl", "pdsl", "ddsl", "config"];
// Braces in braces are not understood by the search of VS Code.
const NAMES = [...KINDS.map((kind) => `*.${kind}.yaml`), ...["idsl", "cdsl", "pdsl", "ddsl"].map((kind) => `${kind}.yaml`)];
const GLOB = `**/{rcyaml.yaml,*.mock.yaml,${NAMES.join(",")}}`;

/** The kind of a document by its path; undefined if rcyaml has no schema for it. */
function kindOf(file) {
  const name = path.basename(file);
  if (name === "rcyaml.yaml") return "workspace";
  if (name.endsWith(".mock.yaml")) return "mock";
  if (name === "config.yaml") return path.basename(path.dirname(file)) === "etc" ? "config" : undefined;
  return KINDS.find((kind) => name === `${kind}.yaml` || name.endsWith(`.${kind}.yaml`));
}

/** The nearest folder with an `rcyaml.yaml`, it or above; undefined if there is none. */
function rootOf(file, exists = fs.existsSync) {
  for (let folder = path.dirname(file); ; folder = path.dirname(folder)) {
    if (exists(path.join(folder, "rcyaml.yaml"))) return folder;
    if (folder === path.dirname(folder)) return undefined;
  }
}

/** The schema of a document in its workspace, which has its names. A component's own schema comes first. */
function schemaOf(file, exists = fs.existsSync) {
  const kind = kindOf(file);
  if (!kind) return undefined;
  if (kind === "config" && path.basename(path.dirname(file)) === "etc") {
    const own = path.join(path.dirname(path.dirname(file)), "generated", "config.schema.json");
    if (exists(own)) return own;
  }
  const root = rootOf(file, exists);
  const schema = root && path.join(root, ".rcyaml", "schemas", `${kind}.schema.json`);
  return schema && exists(schema) ? schema : undefined;
}

module.exports = { GLOB, KINDS, kindOf, rootOf, schemaOf };
