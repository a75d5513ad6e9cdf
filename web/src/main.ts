// The page: a picture and a tree of one deployment, kept up to date by the server's events.

import { button, Details, element } from "./details";
import { Graph, Model, SIGNS, State } from "./model";
import { Scene } from "./scene";
import { ask, names, Refusal } from "./server";
import { Tree } from "./tree";

interface Served { id: string; document: string; problem: string }
interface Step { name: string; action: string; reason: string; changes: { field: string; old: unknown; new: unknown }[] }
interface Message { severity: string; message: string; code: string }

const find = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const canvas = find<HTMLCanvasElement>("picture"), which = find<HTMLSelectElement>("which"), filter = find<HTMLSelectElement>("filter");
const model = new Model();
const scene = new Scene(canvas, model);
const tree = new Tree(find("tree"), model, (name) => select(name, true));
let deployment = "", details: Details, progress = "";

const path = () => `deployments/${encodeURIComponent(deployment)}`;

/** Selects a node. `isFound`: it was not clicked in the picture, so that the picture goes where it is. */
function select(name: string, isFound = false): void {
  model.selected = name;
  show();
  scene.covered = find("details").hidden ? 0 : find("details").offsetWidth;
  if (name) scene.show(name, isFound);
}

function show(): void {
  tree.show();
  details.show();
  scene.change();
  const counts = new Map<string, number>();
  for (const name of model.states.keys()) counts.set(model.look(name), (counts.get(model.look(name)) ?? 0) + 1);
  const words: Record<string, string> = { ready: "ready", busy: "not ready", down: "failed", idle: "not running" };
  const parts = Object.entries(words).filter(([look]) => counts.get(look)).map(([look, word]) => `${SIGNS[look as "ready"]} ${counts.get(look)} ${word}`);
  const text = [...parts, progress].filter(Boolean).join("   ");
  if (find("summary").textContent !== text) find("summary").textContent = text;
}

function complain(text: string): void {
  find("problem").hidden = !text;
  find("problem").textContent = text;
}

async function load(): Promise<void> {
  try {
    const isFirst = !model.graph;
    model.take(await ask<Graph>(`${path()}/graph`));
    complain(model.graph!.faults.map((fault) => `${fault.code}: ${fault.message}`).join("\n"));
    find("name").textContent = document.title = model.graph!.name;
    choices();
    tree.build();
    if (isFirst) scene.fit();
  } catch (error) {
    const data = error instanceof Refusal ? error.data : {};
    const found = (data.diagnostics as Message[] | undefined)?.map((one) => `${one.code}: ${one.message}`);
    complain(found?.join("\n") || (error as Error).message);
  }
  show();
}

function choices(): void {
  const graph = model.graph!, chosen = model.filter;
  const interfaces = [...new Set(graph.nodes.flatMap((node) => node.serves.map((one) => one.interface)))].sort();
  const options: [string, string][] = [["", "everything"], ["sdown", "failed"], ["sbusy", "not ready"], ["sready", "ready"], ["sidle", "not running"],
    ...graph.hosts.map((host): [string, string] => [`h${host.name}`, `host ${host.title}`]),
    ...interfaces.map((name): [string, string] => [`i${name}`, `interface ${name}`])];
  filter.replaceChildren(...options.map(([value, text]) => element("option", text, { value })));
  filter.value = options.some(([value]) => value === chosen) ? chosen : "";
  model.filter = filter.value;
}

function listen(): EventSource {
  const events = new EventSource(`api/${path()}/events`);
  events.addEventListener("states", (event) => {
    const data = JSON.parse(event.data) as { all: boolean; processes: State[]; gone?: string[]; problem: string };
    if (data.all) model.states.clear();
    for (const state of data.processes) model.states.set(state.name, state);
    for (const name of data.gone ?? []) model.states.delete(name);
    if (data.problem) complain(data.problem);
    show();
  });
  events.addEventListener("documents", () => void load());
  events.addEventListener("progress", (event) => {
    const data = JSON.parse(event.data);
    progress = `${data.name} ${data.kind}`;
    show();
  });
  events.addEventListener("error", () => { progress = "no connection to the manager"; show(); });
  events.addEventListener("open", () => { progress = ""; show(); });
  return events;
}

/** Shows what an operation would do, and does it when that is confirmed. */
async function operate(action: string, chosen: string[]): Promise<void> {
  const dialog = find<HTMLDialogElement>("plan");
  const title = { up: "Start", restart: "Restart", down: "Stop" }[action]! + " " + (chosen.join(", ") || model.graph?.name);
  const list = element("ul"), buttons = element("p", "", { class: "buttons" });
  let isPossible = true;
  try {
    const plan = await ask<{ plan?: Step[]; stop?: string[]; diagnostics: Message[] }>(`${path()}/plan?action=${action}&${names(chosen)}`);
    const steps = plan.plan?.filter((step) => step.action !== "keep") ?? plan.stop!.map((name) => ({ name, action: "stop", reason: "", changes: [] }));
    for (const step of steps) list.append(element("li", `${step.action} ${step.name}${step.reason ? `: ${step.reason}` : ""}`));
    for (const one of plan.diagnostics) list.append(element("li", `${one.code}: ${one.message}`, one.severity === "error" ? { class: "fault" } : {}));
    if (!steps.length) list.append(element("li", "Nothing to do."));
    isPossible = steps.length > 0 && !plan.diagnostics.some((one) => one.severity === "error");
  } catch (error) {
    list.append(element("li", (error as Error).message, { class: "fault" }));
    isPossible = false;
  }
  const close = button("Cancel", () => dialog.close());
  if (isPossible) buttons.append(button("Do it", () => { dialog.close(); void run(action, chosen); }));
  buttons.append(close);
  dialog.replaceChildren(element("h2", title, { id: "plan-title" }), list, buttons);
  dialog.showModal();
}

async function run(action: string, chosen: string[]): Promise<void> {
  complain("");
  try {
    const done = await ask<{ ok: boolean; diagnostics: Message[] }>(`${path()}/${action}`, { names: chosen });
    const wrong = done.diagnostics.filter((one) => one.severity === "error");
    complain(wrong.map((one) => `${one.code}: ${one.message}`).join("\n"));
  } catch (error) {
    complain((error as Error).message);
  }
  progress = "";
  show();
}

function gestures(): void {
  let last: { x: number; y: number } | null = null, moved = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    last = { x: event.offsetX, y: event.offsetY };
    moved = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!last) return;
    const [dx, dy] = [event.offsetX - last.x, event.offsetY - last.y];
    moved += Math.abs(dx) + Math.abs(dy);
    last = { x: event.offsetX, y: event.offsetY };
    if (moved > 4) scene.pan(dx, dy);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (last && moved <= 4) select(scene.at(event.offsetX, event.offsetY)?.name ?? "");
    last = null;
  });
  canvas.addEventListener("pointercancel", () => { last = null; });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    scene.zoomAt(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), event.offsetX, event.offsetY);
  }, { passive: false });
}

async function begin(): Promise<void> {
  const { deployments, rights } = await ask<{ deployments: Served[]; rights: string[] }>("deployments");
  const mayOperate = rights.includes("operate");
  details = new Details(find("details"), model, () => `api/${path()}`, mayOperate ? (action, chosen) => void operate(action, chosen) : null, () => select(""));
  for (const one of deployments) which.append(element("option", one.id, { value: one.id }));
  which.hidden = deployments.length < 2;
  if (mayOperate) find("all").append(button("Start…", () => void operate("up", [])), button("Stop…", () => void operate("down", [])));
  find("fit").addEventListener("click", () => scene.fit());
  find<HTMLInputElement>("search").addEventListener("input", (event) => { model.search = (event.target as HTMLInputElement).value; show(); });
  filter.addEventListener("change", () => { model.filter = filter.value; show(); });
  gestures();
  let events: EventSource | null = null;
  const open = async (id: string) => {
    events?.close();
    deployment = id;
    Object.assign(model, { graph: null, selected: "" });
    model.states.clear();
    model.nodes.clear();
    await load();
    events = listen();
  };
  which.addEventListener("change", () => void open(which.value));
  await open(deployments[0].id);
}

// For tests: where the picture is, and how often it was drawn.
Object.assign(window, { scene, model });
begin().catch((error) => complain((error as Error).message));
