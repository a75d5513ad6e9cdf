"use strict";
// Which program `rcyaml` is, and what is told to the user if it cannot be started. Nothing here needs VS Code.

const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { execFile } = require("node:child_process");

const INSTALL = "pip install 'rcyaml[lsp]'";

/** The program: the user's setting, else that of the workspace's own environment, else the one in the PATH. */
function programOf(setting, folders, exists = fs.existsSync) {
  if (setting) {
    const home = setting === "~" || setting.startsWith("~/") ? os.homedir() + setting.slice(1) : setting;
    return home.replaceAll("${workspaceFolder}", folders[0] || "");
  }
  const places = process.platform === "win32" ? ["Scripts", "rcyaml.exe"] : ["bin", "rcyaml"];
  const own = folders.map((folder) => path.join(folder, ".venv", ...places));
  return own.find((one) => exists(one)) || "rcyaml";
}

/** What is wrong with a program, as a text for the user; "" if its language server can be started. */
function problemOf(program, folder, run = execFile) {
  return new Promise((resolve) => {
    // `lsp` with an input that is closed ends at once, and has imported all that it needs.
    const child = run(program, ["lsp"], { cwd: folder, timeout: 30_000 }, (error, _, stderr) => {
      if (!error || error.killed) return resolve("");
      if (error.code === "ENOENT") return resolve(`'${program}' is not found: ${INSTALL}, or set rcyaml.path`);
      if (error.code === "EACCES") return resolve(`'${program}' cannot be executed: set rcyaml.path`);
      const said = String(stderr).trim().split("\n").pop().replace(/^(Error|error): /, "");
      resolve(said ? `${program}: ${said}` : `'${program} lsp' ends with ${error.code}`);
    });
    child.stdin?.on("error", () => {});
    child.stdin?.end();
  });
}

module.exports = { INSTALL, problemOf, programOf };
