"use strict";
const assert = require("node:assert/strict");
const { execFile } = require("node:child_process");
const os = require("node:os");
const test = require("node:test");

const { GLOB, kindOf, rootOf, schemaOf } = require("../src/documents");
const { problemOf, programOf } = require("../src/program");
const { tasksOf } = require("../src/tasks");

const only = (...paths) => (path) => paths.includes(path);

test("the program is the setting, else the workspace's own, else that of the PATH", () => {
  assert.equal(programOf("/opt/rcyaml", ["/w"], only("/w/.venv/bin/rcyaml")), "/opt/rcyaml");
  assert.equal(programOf("~/bin/rcyaml", ["/w"], only()), `${os.homedir()}/bin/rcyaml`);
  assert.equal(programOf("${workspaceFolder}/x", ["/w", "/v"], only()), "/w/x");
  assert.equal(programOf("", ["/w", "/v"], only("/v/.venv/bin/rcyaml")), "/v/.venv/bin/rcyaml");
  assert.equal(programOf("", ["/w"], only()), "rcyaml");
  assert.equal(programOf("", [], only()), "rcyaml");
});

test("an absent program is told with what to do", async () => {
  assert.match(await problemOf("/nowhere/rcyaml", "/"), /'\/nowhere\/rcyaml' is not found: pip install 'rcyaml\[lsp\]'/);
  assert.match(await problemOf("/etc/passwd", "/"), /cannot be executed/);
});

test("a program that ends tells why", async () => {
  const run = (_, args, options, done) => execFile("sh", ["-c", "echo 'Error: lsp needs pygls' >&2; exit 2"], options, done);
  assert.equal(await problemOf("rcyaml", "/", run), "rcyaml: lsp needs pygls");
  assert.equal(await problemOf("true", "/"), "");
});

test("kinds are those of the names", () => {
  const kinds = { "a/Arm.idsl.yaml": "idsl", "cdsl.yaml": "cdsl", "x.mock.yaml": "mock", "rcyaml.yaml": "workspace",
    "etc/config.yaml": "config", "config.yaml": undefined, "a.config.yaml": "config", "compose.yaml": undefined,
    "idsl.yaml.txt": undefined };
  for (const [path, kind] of Object.entries(kinds)) assert.equal(kindOf(`/w/${path}`), kind, path);
});

test("a schema is that of the nearest workspace, or of the component", () => {
  const files = only("/w/rcyaml.yaml", "/w/.rcyaml/schemas/cdsl.schema.json", "/w/c/generated/config.schema.json",
    "/w/inner/rcyaml.yaml");
  assert.equal(schemaOf("/w/c/a.cdsl.yaml", files), "/w/.rcyaml/schemas/cdsl.schema.json");
  assert.equal(schemaOf("/w/c/etc/config.yaml", files), "/w/c/generated/config.schema.json");
  assert.equal(schemaOf("/w/inner/a.cdsl.yaml", files), undefined);
  assert.equal(schemaOf("/v/a.cdsl.yaml", files), undefined);
  assert.equal(schemaOf("/w/compose.yaml", files), undefined);
  assert.equal(rootOf("/w/inner/x/a", files), "/w/inner");
});

test("each component can be run, and each deployment started", () => {
  const names = tasksOf(["robot.ddsl.yaml", "c/arm.cdsl.yaml", "i/Arm.idsl.yaml"]).map((one) => one.args.join(" "));
  assert.deepEqual(names, ["check", "compile", "build", "compile --watch", "run c/arm.cdsl.yaml", "deploy plan robot.ddsl.yaml",
    "deploy up robot.ddsl.yaml", "deploy status robot.ddsl.yaml", "deploy down robot.ddsl.yaml"]);
});

test("the search for documents has no braces in braces", () => {
  assert.match(GLOB, /^[^{}]*\{[^{}]*\}$/);
});
