// What is known of the selected process, its log, and what can be done with it.

import { Model } from "./model";
import { ask } from "./server";

const LONGEST = 2000; // lines of a log

export function element<K extends keyof HTMLElementTagNameMap>(name: K, text = "", attributes: Record<string, string> = {}): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  if (text) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

export function button(text: string, act: () => void): HTMLButtonElement {
  const made = element("button", text, { type: "button" });
  made.addEventListener("click", act);
  return made;
}

export class Details {
  private shown = "";
  private following: EventSource | null = null;
  private readonly facts = element("dl");
  private readonly faults = element("div");

  constructor(
    private readonly root: HTMLElement, private readonly model: Model,
    private readonly address: () => string, private readonly operate: ((action: string, names: string[]) => void) | null,
    private readonly close: () => void,
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
      this.build(node.name);
    }
    this.update(node.name);
  }

  private build(name: string): void {
    this.stop();
    const close = button("✕", () => this.close());
    close.setAttribute("aria-label", "close the details");
    close.className = "close";
    this.root.replaceChildren(close, element("h2", name), this.faults, this.facts);
    if (!this.model.states.has(name)) return;
    if (this.operate) {
      const buttons = element("p", "", { class: "buttons" });
      for (const [text, action] of [["Start", "up"], ["Restart", "restart"], ["Stop", "down"]]) {
        const made = button(`${text}…`, () => this.operate!(action, [name]));
        made.setAttribute("aria-label", `${text.toLowerCase()} ${name}`);
        buttons.append(made);
      }
      this.root.append(buttons);
    }
    const values = element("div");
    const log = element("pre", "", { id: "log", tabindex: "0", role: "log", "aria-label": `log of ${name}` });
    this.root.append(element("h3", "Log"), log, element("h3", "Values"), button("Read the values that it has now", () => this.read(name, values)), values);
    this.following = new EventSource(`${this.address()}/log-events?last=100&name=${encodeURIComponent(name)}`);
    this.following.addEventListener("line", (event) => {
      const line = JSON.parse(event.data), isAtEnd = log.scrollTop + log.clientHeight >= log.scrollHeight - 4;
      log.append(`${line.time.slice(11, 19)} ${line.text}\n`);
      while (log.childNodes.length > LONGEST) log.firstChild!.remove();
      if (isAtEnd) log.scrollTop = log.scrollHeight;
    });
    // A browser that connects again gets the last lines once more.
    this.following.addEventListener("open", () => log.replaceChildren());
  }

  private async read(name: string, values: HTMLElement): Promise<void> {
    values.replaceChildren("…");
    try {
      const path = this.address().replace(/^api\//, "");
      const found = await ask<{ parameters: { path: string; data: unknown; unit: string }[] }>(`${path}/parameters?process=${encodeURIComponent(name)}`);
      const list = element("dl");
      for (const one of found.parameters) list.append(element("dt", one.path), element("dd", `${typeof one.data === "string" ? one.data : JSON.stringify(one.data)} ${one.unit}`));
      values.replaceChildren(list);
    } catch (error) {
      values.replaceChildren(element("p", (error as Error).message, { class: "fault" }));
    }
  }

  private update(name: string): void {
    const node = this.model.nodes.get(name)!, state = this.model.states.get(name);
    const rows: [string, string][] = [["What", node.texts.slice(1, 2).join(" ")], ["Host", node.host]];
    if (node.groups.length) rows.push(["Groups", node.groups.join(", ")]);
    if (state) {
      rows.unshift(["State", state.words]);
      if (state.pid) rows.push(["Process", String(state.pid)]);
      if (state.pid && state.memory !== null) rows.push(["Memory", `${(state.memory / 2 ** 20).toFixed(0)} MiB`]);
      if (state.pid && state.cpu !== null) rows.push(["CPU", `${state.cpu.toFixed(1)} s`]);
      if (state.restarts) rows.push(["Restarts", String(state.restarts)]);
      if (state.last_exit) rows.push(["Last end", state.last_exit]);
    }
    for (const one of node.serves) rows.push(["Serves", one.port ? `${one.interface}, port ${one.port}` : one.interface]);
    const edges = this.model.graph!.edges;
    for (const edge of edges) {
      const what = edge.label ? `${edge.label} of ` : "";
      if (edge.from === name) rows.push([{ uses: "Uses", after: "After", publishes: "Publishes", subscribes: "Receives" }[edge.kind] ?? edge.kind, what + edge.to]);
      else if (edge.to === name && edge.kind === "uses") rows.push(["Used by", edge.from]);
    }
    this.facts.replaceChildren(...rows.flatMap(([key, value]) => [element("dt", key), element("dd", value)]));
    this.faults.replaceChildren(...node.faults.map((fault) => element("p", `${fault.code}: ${fault.message}`, { class: "fault" })));
  }

  private stop(): void {
    this.following?.close();
    this.following = null;
  }
}
