// The page: a picture and a tree of one deployment, kept up to date by the server's events.

import { Changes } from "./changes";
import { Details } from "./details";
import { button, element, find, inWords, Message } from "./dom";
import { Drawer } from "./drawer";
import { Editing } from "./edit";
import { Facts } from "./facts";
import { box, gestures } from "./gestures";
import { Action, menu } from "./menu";
import { CLOSED, Graph, Look, look, Model, Positions, SIGNS, State } from "./model";
import { call, plan } from "./operate";
import { Scene } from "./scene";
import { Abilities, ask, Events, Refusal } from "./server";
import type { TextPane } from "./text";
import { Kind, Tree } from "./tree";

interface Served { id: string; document: string; problem: string }

const canvas = find<HTMLCanvasElement>("picture"), which = find<HTMLSelectElement>("which"), filter = find<HTMLSelectElement>("filter");
const model = new Model(), facts = new Facts(), can = new Abilities();
const scene = new Scene(canvas, model);
const tree = new Tree(find("tree"), model, (name) => select(name, true), (kind, name, x, y) => void askMenu(kind, name, x, y), nudge);
const closed = new Set<string>(); // boxes: `host NAME`, `group NAME`
let of: Graph["of"] = "network"; // what is drawn
let deployment = "", details: Details, drawer: Drawer, progress = "", text: TextPane | null = null;

const path = () => `deployments/${encodeURIComponent(deployment)}`;
const editing = new Editing(path, () => model.graph!, written, complain);
const changes = new Changes(editing, facts, path);
const mayOperate = () => can.may("operate"), mayEdit = () => can.may("edit");
const mayPlace = () => of === "network" && can.has("positions", "post") && mayEdit();
const NUDGE = 8; // pixels of the picture

/** Selects a node. `isFound`: it was not clicked in the picture, so that the picture goes where it is. */
function select(name: string, isFound = false, isInText = false): void {
  model.selected = name;
  show();
  if (name) scene.show(name, isFound);
  else scene.back();
  if (name && !isInText) void known.then(() => { if (model.selected === name) text?.mark(name); });
}

function show(): void {
  tree.show();
  details.show();
  scene.change();
  const counts = new Map<Look, number>();
  for (const state of model.states.values()) counts.set(look(undefined, state), (counts.get(look(undefined, state)) ?? 0) + 1);
  const words: [Look, string][] = [["ready", "ready"], ["busy", "not ready"], ["down", "failed"], ["idle", "not running"]];
  const parts = words.filter(([one]) => counts.get(one)).map(([one, word]) => `${SIGNS[one]} ${counts.get(one)} ${word}`);
  const wrong = [...model.nodes.values()].filter((one) => one.faults.some((fault) => fault.severity === "error")).length;
  if (wrong) parts.push(`${SIGNS.down} ${wrong} with errors in the documents`);
  const said = [parts.join("  "), progress].filter(Boolean).join(" · ");
  if (find("summary").textContent !== said) find("summary").textContent = find("summary").title = said;
}

function complain(said: string): void {
  find("problem").hidden = !said;
  find("problem").textContent = said;
}

/** Shows a picture: that of the documents, or of a text that is not saved. */
function take(graph: Graph): void {
  const isFirst = !model.graph;
  model.take(graph);
  complain(graph.faults.map(inWords).join("\n"));
  find("name").textContent = document.title = graph.name;
  choices();
  tree.build();
  if (isFirst) scene.fit();
}

/** The picture of a text that is not saved; null: it has none, and the last one stays. */
function draft(graph: Graph | null): void {
  if (graph) take(graph);
  find("draft").hidden = false;
  find("draft").textContent = graph ? "not saved: the picture is that of the text" : "not saved: the text has no picture, this is the last one";
  show();
}

let asked = 0, known: Promise<void> = Promise.resolve();

async function load(): Promise<void> {
  const mine = asked += 1;
  try {
    if (await text?.draw()) return;
    const shut = [...closed].map((name) => `&closed=${encodeURIComponent(name)}`).join("");
    const graph = await ask<Graph>(`${path()}/graph?of=${of}${shut}`);
    if (mine !== asked) return;
    find("draft").hidden = true;
    take(graph);
  } catch (error) {
    const data = error instanceof Refusal ? error.data : {};
    complain((data.diagnostics as Message[] | undefined)?.map(inWords).join("\n") || (error as Error).message);
  }
  show();
  known = facts.load(path()).then(() => { show(); drawer.changed(); text?.remark(); }, () => undefined); // the picture does not wait for it
}

/** After a change of this page: it is shown at once, and not only when the manager looks at the disk again. */
async function written(what: string): Promise<void> {
  progress = what;
  await load();
  await text?.reload();
}

function choices(): void {
  const graph = model.graph!, chosen = model.filter;
  const interfaces = [...new Set([...model.nodes.values()].flatMap((node) => node.serves.map((one) => one.interface)))].sort();
  const options: [string, string][] = [["", "everything"], ["sdown", "failed, or with errors"], ["sbusy", "not ready"], ["sready", "ready"], ["sidle", "not running"],
    ...graph.hosts.map((host): [string, string] => [`h${host.name}`, `host ${host.title}`]),
    ...interfaces.map((name): [string, string] => [`i${name}`, `interface ${name}`])];
  filter.replaceChildren(...options.map(([value, title]) => element("option", title, { value })));
  filter.value = options.some(([value]) => value === chosen) ? chosen : "";
  model.filter = filter.value;
}

function listen(): Events {
  const events = new Events(`api/${path()}/events`);
  let isFirst = true;
  events.on("states", (event) => {
    const data = JSON.parse(event.data) as { all: boolean; processes: State[]; gone?: string[]; problem: string; topics?: Record<string, { rate: number }> };
    if (data.all) model.states.clear();
    for (const state of data.processes) model.states.set(state.name, state);
    for (const name of data.gone ?? []) model.states.delete(name);
    for (const [name, one] of Object.entries(data.topics ?? {})) model.rates.set(name, one.rate);
    if (data.problem) complain(data.problem);
    show();
  });
  events.on("documents", () => { void load(); void text?.reload(); });
  events.on("happened", (event) => drawer.happened(JSON.parse(event.data)));
  events.on("progress", (event) => {
    const data = JSON.parse(event.data);
    progress = `${data.name ?? data.host ?? ""} ${data.kind ?? ""}`.trim();
    show();
  });
  events.on("error", (event) => {
    progress = "no connection to the manager";
    show();
    if ((event.target as EventSource).readyState !== EventSource.CLOSED) return; // the browser connects again
    ask("deployments").catch((error) => {
      if (error instanceof Refusal && error.status === 403) complain("The manager was started again, and has another token: open the address that it prints.");
    });
  });
  events.on("open", () => {
    progress = "";
    show();
    if (!isFirst) { void load(); void text?.reload(); void drawer.catchUp().catch(() => undefined); } // what happened meanwhile is not sent again
    isFirst = false;
  });
  return events;
}

function operate(action: string, chosen: string[], called = chosen.join(", ") || (model.graph?.name ?? "")): void {
  void plan(path(), action, chosen, called, (problem) => {
    complain(problem);
    progress = "";
    show();
  });
}

/** Everything that can be done with something, as a menu. */
async function askMenu(kind: Kind, name: string, x: number, y: number): Promise<void> {
  await known;
  const actions: Action[] = [], node = model.nodes.get(name);
  if (of === "components") {
    const component = kind === "node" ? facts.componentOf(name) : "";
    if (component) actions.push({ label: "Show its document", act: () => void openText(name, component) });
    if (mayEdit()) actions.push(...(component ? changes.ofComponent(component) : changes.ofNetwork()));
    if (actions.length) menu(name || "components", actions, x, y);
    return;
  }
  if (kind === "node" && node?.kind === CLOSED) {
    void askMenu(...box(node), x, y);
    return;
  }
  const members = kind === "node" ? (model.states.has(name) ? [name] : []) : kind === "network" ? [] :
    [...model.nodes.values()].filter((one) => model.states.has(one.name) && (kind === "host" ? one.host === name : one.groups.includes(name))).map((one) => one.name);
  if (mayOperate() && (members.length || kind === "network")) {
    for (const [label, action] of [["Start…", "up"], ["Restart…", "restart"], ["Stop…", "down"]]) {
      actions.push({ label, act: () => operate(action, kind === "group" ? [name] : members, kind === "host" ? model.hostTitle(name) : undefined) });
    }
    if (kind === "network") actions.push({ label: "Roll back…", act: () => operate("rollback", []) });
  }
  if (mayOperate() && kind === "node" && node?.serves.length) actions.push({ label: "Call a method…", begins: true, act: () => void call(path(), name) });
  if (members.length) actions.push({ label: "Logs", act: () => drawer.open("logs", members) });
  if (kind === "host" || kind === "group") actions.push({ label: closed.has(`${kind} ${name}`) ? "Open in the picture" : "Close in the picture", act: () => toggle(kind, name) });
  if (kind === "node" && facts.entry(name)) actions.push({ label: "Show in the document", act: () => void openText(name) });
  if (facts.entry(name)?.component && kind === "node") actions.push({ label: "Show its component's document", act: () => void openText(name, facts.entry(name)!.component) });
  if (kind === "node" && model.positions[name]) actions.push({ label: "Forget its position", act: () => void place({ [name]: null }) });
  const edits = !mayEdit() ? [] : (kind === "network" ? changes.ofNetwork() : kind === "host" ? changes.ofHost(name) : kind === "group" ? changes.ofGroup(name) : changes.ofProcess(name));
  actions.push(...edits.map((one, at) => ({ ...one, begins: !at })));
  if (actions.length) menu(name || model.graph?.name || "network", actions, x, y);
}

function toggle(kind: "host" | "group", name: string): void {
  const key = `${kind} ${name}`;
  if (!closed.delete(key)) closed.add(key);
  void load().then(() => scene.refit());
}

/** Keeps positions, or forgets those that are null. */
async function place(moved: Record<string, [number, number] | null>): Promise<void> {
  try {
    model.positions = (await ask<{ positions: Positions }>(`${path()}/positions`, { positions: moved })).positions ?? model.positions;
    await load();
  } catch (error) {
    complain((error as Error).message);
  }
}

let nudged = 0;

/** Moves a node by the keyboard; its position is kept when the keys rest. */
function nudge(name: string, dx: number, dy: number): void {
  const node = model.graph?.nodes.find((one) => one.name === name);
  if (!node || !mayPlace()) return;
  [node.x, node.y] = [Math.max(0, node.x + NUDGE * dx), Math.max(0, node.y + NUDGE * dy)];
  scene.show(name);
  clearTimeout(nudged);
  nudged = window.setTimeout(() => void place({ [name]: [node.x, node.y] }), 400);
}

/** The document beside the picture; the editor is loaded when it is first wanted. */
async function openText(name = "", document = ""): Promise<void> {
  const before = model.selected;
  const { TextPane } = await import("./text");
  const found = (nodes: string[]) => {
    const first = nodes.find((one) => model.nodes.has(one));
    if (first && !nodes.includes(model.selected)) select(first, true, true);
  };
  text ??= new TextPane(find("text"), can, path, found, facts, load, (isOpen) => find("text-button").setAttribute("aria-expanded", String(isOpen)), draft, () => ({ closed: [...closed], of }));
  await text.open(document || (facts.entry(name)?.document ?? model.graph!.document));
  await known;
  const wanted = model.selected === before ? name : model.selected; // another one was selected while the editor was loaded
  if (wanted) text.mark(wanted);
}

function bars(): void {
  const bar = find("editing");
  if (mayOperate()) find("all").append(button("Start…", () => operate("up", [])), button("Stop…", () => operate("down", [])));
  if (mayEdit()) {
    const add = button("Add ▾", () => {
      const at = add.getBoundingClientRect();
      menu("Add", changes.ofNetwork(), at.left, at.bottom);
    });
    add.setAttribute("aria-haspopup", "menu");
    bar.append(add, button("↶", () => void editing.back("undo"), "Undo"), button("↷", () => void editing.back("redo"), "Redo"));
    window.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || (event.target as HTMLElement).closest("input, textarea, #text, dialog")) return;
      event.preventDefault();
      void editing.back(event.shiftKey ? "redo" : "undo");
    });
  }
  const toggleText = button("YAML", () => { if (find("text").hidden) void openText(model.selected); else text!.close(); });
  toggleText.id = "text-button";
  toggleText.setAttribute("aria-expanded", "false");
  toggleText.setAttribute("aria-controls", "text");
  const components = button("Components", () => {
    of = of === "network" ? "components" : "network";
    components.setAttribute("aria-pressed", String(of === "components"));
    model.selected = "";
    void load().then(() => scene.fit());
  });
  components.setAttribute("aria-pressed", "false");
  components.id = "components";
  find("panels").append(toggleText, components);
}

function point(): void {
  const side = find("details");
  scene.covered = () => side.hidden || getComputedStyle(side).position === "static" ? 0 : side.offsetWidth;
  scene.hasHandle = (name) => mayEdit() && Boolean(facts.entry(name)?.requires.length);
  gestures(canvas, scene, {
    canEdit: mayEdit(), get canPlace() { return mayPlace(); }, select, toggle,
    ask: (hit, x, y) => {
      if (!hit || hit.kind === "end") void askMenu("network", "", x, y);
      else if (!("node" in hit)) void askMenu(hit.kind, hit.name, x, y);
      else {
        select(hit.node.name);
        void askMenu("node", hit.node.name, x, y);
      }
    },
    targets: (source) => new Set([...model.nodes.keys()].filter((name) => name !== source && facts.matching(source, name).length)),
    connect: (source, target) => changes.connect(source, "", target),
    reconnect: (edge, target) => {
      const port = facts.entry(edge.from)?.requires.find((one) => one.to === edge.to && (edge.label === one.interface || edge.label.startsWith(`${one.port}:`)))?.port ?? "";
      if (target) changes.connect(edge.from, port, target);
      else if (port) changes.disconnect(edge.from, port);
    },
    move: (name, host) => changes.move(name, host),
    place: (name, x, y) => place({ [name]: [x, y] }),
  });
}

async function begin(): Promise<void> {
  const [{ deployments, rights }] = await Promise.all([ask<{ deployments: Served[]; rights: string[] }>("deployments"), can.learn()]);
  can.rights = rights;
  bars();
  details = new Details(find("details"), model, facts, path,
    { operate: mayOperate() ? operate : null, canSet: mayOperate(), canEcho: can.has("topic"), canCall: mayOperate() },
    (name) => void call(path(), name), (name, x, y) => void askMenu("node", name, x, y), () => { select(""); tree.enter(); });
  drawer = new Drawer(find("drawer"), find("panels"), model, facts, can, path, mayEdit() ? () => changes.host() : null,
    mayEdit() ? (name, host) => changes.move(name, host) : null);
  for (const one of deployments) which.append(element("option", one.id, { value: one.id }));
  which.hidden = deployments.length < 2;
  find("name").classList.toggle("away", !which.hidden); // which one it is, the choice says
  find("fit").addEventListener("click", () => scene.fit());
  find<HTMLInputElement>("search").addEventListener("input", (event) => { model.search = (event.target as HTMLInputElement).value; show(); });
  filter.addEventListener("change", () => { model.filter = filter.value; show(); });
  point();
  window.addEventListener("keydown", (event) => {
    const zoom = { "+": 1.25, "=": 1.25, "-": 0.8 }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || (event.target as HTMLElement).closest("input, textarea, select, #text, dialog, .menu")) return;
    if (event.key === "0") scene.fit();
    else if (zoom) scene.zoomAt(zoom, canvas.clientWidth / 2, canvas.clientHeight / 2);
  });
  let events: Events | null = null;
  const open = async (id: string) => {
    events?.close();
    deployment = id;
    Object.assign(model, { graph: null, selected: "", positions: {} });
    model.states.clear();
    model.nodes.clear();
    closed.clear();
    of = "network";
    find("components").setAttribute("aria-pressed", "false");
    text?.close();
    if (can.has("positions")) model.positions = (await ask<{ positions: Positions }>(`${path()}/positions`).catch(() => ({ positions: {} }))).positions;
    await load();
    events = listen();
    await drawer.begin();
  };
  which.addEventListener("change", () => {
    if (text?.keeps()) which.value = deployment;
    else void open(which.value);
  });
  window.addEventListener("beforeunload", (event) => { if (text?.isChanged) event.preventDefault(); });
  await open(deployments[0].id);
}

// For tests: where the picture is, and how often it was drawn.
Object.assign(window, { scene, model, facts });
begin().catch((error) => complain((error as Error).message));
