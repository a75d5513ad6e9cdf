"use strict";
// The tasks of a workspace. Nothing here needs VS Code.

const path = require("node:path");

const BUILD = "build";
const ALWAYS = [
  { name: "check", args: ["check"] },
  { name: "compile", args: ["compile"], group: BUILD },
  { name: "build", args: ["build"], group: BUILD },
  { name: "compile --watch", args: ["compile", "--watch"], isEndless: true, matcher: "$rcyaml-watch" },
];

/** The tasks of a workspace: what is done with all of it, with each component and with each deployment. `documents` are
 * paths relative to the workspace; each task is a name, its arguments, and whether it runs until it is stopped. */
function tasksOf(documents) {
  const posix = documents.map((one) => one.split(path.sep).join("/")).sort();
  const components = posix.filter((one) => /(^|[./])cdsl\.yaml$/.test(one));
  const deployments = posix.filter((one) => /(^|[./])ddsl\.yaml$/.test(one));
  return [
    ...ALWAYS,
    ...components.map((one) => ({ name: `run ${one}`, args: ["run", one], isEndless: true })),
    ...deployments.flatMap((one) =>
      ["plan", "up", "status", "down"].map((verb) => ({ name: `deploy ${verb} ${one}`, args: ["deploy", verb, one] })),
    ),
  ];
}

module.exports = { ALWAYS, BUILD, tasksOf };
