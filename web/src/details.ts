// What is known of the selected process or topic, its log or messages, and what can be done with it.

import { button, buttons, element, inWords } from "./dom";
import { Facts, process } from "./facts";
import { COMPONENT, Model, Node, TOPIC } from "./model";
import { RunningValues } from "./operate";
import { Echo, LogLines } from "./streams";

export interface Rights { operate: ((action: string, names: string[]) => void) | null; canSet: boolean; canEcho: boolean; canCall: boolean }

export class Details {
  private shown = "";
  private stream: LogLines | Echo | null = null;
  private readonly facts = element("dl");
  private readonly faults = element("div");

  constructor(
    private readonly root: HTMLElement, private readonly model: Model, private readonly known: Facts, private readonly path: () => string,
    private readonly rights: Rights, private readonly call: (name: string) => void,
    private readonly ask: (name: string, x: number, y: number) => void, private readonly close: () => void,
  ) {}

  show(): void {
    const node = this.model.nodes.get(this.model.selected);
    this.root.hidden = !node;
    if (!node) {
      this.stop();
      this.shown = "";
      return;
    }
    if (this.shown !== node.name) {
      this.shown = node.name;
      this.build(node);
    }
    this.update(node);
  }

  private build(node: Node): void {
    this.stop();
    const { name } = node, isProcess = this.model.states.has(name);
    const close = button("✕", () => this.close(), "close the details");
    close.className = "close";
    this.root.replaceChildren(close, element("h2", node.title), this.faults, this.facts);
    const row: HTMLElement[] = [];
    if (this.rights.operate && isProcess) {
      for (const [text, action] of [["Start", "up"], ["Restart", "restart"], ["Stop", "down"]]) {
        row.push(button(`${text}…`, () => this.rights.operate!(action, [name]), `${text.toLowerCase()} ${name}`));
      }
    }
    if (this.rights.canCall && isProcess && node.serves.length) row.push(button("Call…", () => this.call(name), `call a method of ${name}`));
    const more = button("More ▾", () => {
      const place = more.getBoundingClientRect();
      this.ask(name, place.left, place.bottom);
    }, `more for ${name}`);
    more.setAttribute("aria-haspopup", "menu");
    if (isProcess || node.kind !== TOPIC || this.model.positions[name]) row.push(more);
    this.root.append(buttons(...row));
    if (node.kind === TOPIC && this.rights.canEcho && this.model.graph!.of === "network") {
      this.stream = new Echo(this.path(), node.title);
      this.root.append(element("h3", "Messages"), this.stream.root);
    }
    if (!isProcess) return;
    this.stream = new LogLines(this.path(), [name], 100);
    const values = new RunningValues(this.path(), name, this.rights.canSet ? () => process(this.path(), name).then((found) => found.parameters) : null);
    this.root.append(element("h3", "Log"), this.stream.root);
    if (node.kind === COMPONENT) this.root.append(element("h3", "Values"), values.root);
  }

  private update(node: Node): void {
    const { name } = node, state = this.model.states.get(name), entry = this.known.entry(name);
    const rows: [string, string][] = [["What", node.texts.slice(1, 2).join(" ")], ["Host", this.model.hostTitle(node.host)]];
    if (node.groups.length) rows.push(["Groups", node.groups.join(", ")]);
    const rate = this.model.rate(node);
    if (rate) rows.push(["Rate", rate]);
    if (state) {
      rows.unshift(["State", state.words]);
      if (state.pid) rows.push(["Process", String(state.pid)]);
      if (state.pid && state.memory !== null) rows.push(["Memory", `${(state.memory / 2 ** 20).toFixed(0)} MiB`]);
      const load = state.load === null || state.load === undefined ? "" : `${state.load} % of a core, `;
      if (state.pid && state.cpu !== null) rows.push(["CPU", `${load}${state.cpu.toFixed(1)} s in all`]);
      if (state.restarts) rows.push(["Restarts", String(state.restarts)]);
      if (state.last_exit) rows.push(["Last end", state.last_exit]);
    }
    for (const one of node.serves) rows.push(["Serves", one.port ? `${one.interface}, port ${one.port}` : one.interface]);
    for (const one of entry?.requires ?? []) rows.push(["Uses", `${one.port} of ${one.to || "nobody"}`]);
    for (const one of entry?.topics ?? []) rows.push([one.out ? "Publishes" : "Receives", one.topic || one.port]);
    for (const edge of this.model.graph!.edges) {
      const what = edge.label ? `${edge.label} of ` : "";
      if (edge.from === name && edge.kind === "uses" && !entry) rows.push(["Uses", what + edge.to]);
      else if (edge.from === name && edge.kind === "publishes" && !entry) rows.push(["Publishes", this.model.title(edge.to)]);
      else if (edge.from === name && edge.kind === "subscribes" && !entry) rows.push(["Receives", this.model.title(edge.to)]);
      else if (edge.from === name && edge.kind === "after") rows.push(["After", edge.to]);
      else if (edge.to === name && edge.kind === "uses") rows.push(["Used by", edge.from]);
      else if (edge.to === name && edge.kind === "publishes") rows.push(["Publisher", edge.from]);
      else if (edge.to === name && edge.kind === "subscribes") rows.push(["Subscriber", edge.from]);
    }
    const text = JSON.stringify(rows);
    if (this.facts.dataset.rows !== text) {
      this.facts.dataset.rows = text;
      this.facts.replaceChildren(...rows.filter(([, value]) => value).flatMap(([key, value]) => [element("dt", key), element("dd", value)]));
    }
    this.faults.replaceChildren(...node.faults.map((fault) => element("p", inWords(fault), { class: fault.severity === "error" ? "fault" : "hint" })));
  }

  private stop(): void {
    this.stream?.close();
    this.stream = null;
  }
}
