"use strict";
// The part of the extension that talks to VS Code: the language server, schemas for redhat.vscode-yaml, tasks.

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

const { GLOB, schemaOf } = require("./documents");
const { problemOf, programOf } = require("./program");
const { BUILD, tasksOf } = require("./tasks");

const YAML = "redhat.vscode-yaml";
const SCHEME = "rcyaml";

let client;
let output;

const settings = (scope) => vscode.workspace.getConfiguration("rcyaml", scope);
const folders = () => (vscode.workspace.workspaceFolders || []).map((one) => one.uri.fsPath);
const program = (own = folders()) => programOf(settings().get("path"), own);

async function start() {
  const command = program();
  const problem = await problemOf(command, folders()[0]);
  if (problem) {
    output.appendLine(problem);
    const chosen = await vscode.window.showErrorMessage(`rcyaml: ${problem}`, "Open Settings");
    if (chosen) await vscode.commands.executeCommand("workbench.action.openSettings", "rcyaml.path");
    return;
  }
  const include = (settings().get("include") || []).flatMap((folder) => ["-I", folder]);
  const server = { command, args: ["lsp", ...include], options: { cwd: folders()[0] } };
  const wanted = settings().get("schemaServer");
  const hasSchemas = vscode.extensions.getExtension(YAML) !== undefined;
  client = new LanguageClient("rcyaml", "rcyaml", server, {
    documentSelector: [{ scheme: "file", language: "yaml" }],
    initializationOptions: { schemaServer: wanted === "auto" ? (hasSchemas ? "yes" : "no") : wanted },
    outputChannel: output,
    diagnosticCollectionName: "rcyaml", // the owner of the problems of tasks: each replaces those of the other
  });
  await client.start();
}

async function stop() {
  const running = client;
  client = undefined;
  if (running) await running.stop().catch(() => {});
}

/** Documents whose first line names no schema get that of their workspace. */
async function wireSchemas() {
  const extension = vscode.extensions.getExtension(YAML);
  const api = extension && (await extension.activate());
  if (!api || !api.registerContributor) return;
  api.registerContributor(
    SCHEME,
    (resource) => {
      const uri = vscode.Uri.parse(resource);
      const schema = uri.scheme === "file" ? schemaOf(uri.fsPath) : undefined;
      return schema && vscode.Uri.file(schema).toString();
    },
    () => undefined, // the schemas are files, which the server reads by itself
  );
}

class Tasks {
  async provideTasks() {
    const found = await Promise.all((vscode.workspace.workspaceFolders || []).map((one) => this.#tasksIn(one)));
    return found.flat();
  }

  async #tasksIn(folder) {
    const pattern = new vscode.RelativePattern(folder, GLOB);
    const hidden = "**/{node_modules,generated,build,__pycache__,.*}/**";
    const documents = await vscode.workspace.findFiles(pattern, hidden);
    if (!documents.length) return [];
    const names = documents.map((one) => vscode.workspace.asRelativePath(one, false));
    return tasksOf(names).map((one) => this.#task(folder, { type: "rcyaml", args: one.args }, one));
  }

  resolveTask(task) {
    const args = task.definition.args;
    return Array.isArray(args) ? this.#task(task.scope, task.definition, { name: args.join(" "), args }) : undefined;
  }

  #task(scope, definition, { name, args, group, isEndless, matcher }) {
    const own = scope && scope.uri ? [scope.uri.fsPath] : folders();
    const execution = new vscode.ProcessExecution(program(own), args, { cwd: own[0] });
    const task = new vscode.Task(definition, scope, name, "rcyaml", execution, matcher || "$rcyaml");
    if (group === BUILD) task.group = vscode.TaskGroup.Build;
    task.isBackground = Boolean(isEndless);
    return task;
  }
}

async function activate(context) {
  output = vscode.window.createOutputChannel("rcyaml");
  context.subscriptions.push(
    output,
    vscode.tasks.registerTaskProvider("rcyaml", new Tasks()),
    vscode.commands.registerCommand("rcyaml.restart", async () => {
      await stop();
      await start();
    }),
    vscode.commands.registerCommand("rcyaml.output", () => output.show()),
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (!event.affectsConfiguration("rcyaml") || event.affectsConfiguration("rcyaml.trace")) return;
      await stop();
      await start();
    }),
  );
  await Promise.allSettled([start(), wireSchemas()]);
  return { client: () => client };
}

module.exports = { activate, deactivate: stop };
