// The drawer below the picture: logs of several processes, what happened, and what hosts have of the components.

import { button, element, inWords, Message } from "./dom";
import { Facts } from "./facts";
import { Model } from "./model";
import { Abilities, ask, Refusal } from "./server";
import { clock, LogLines } from "./streams";

export interface Happened { time: number; name: string; text: string }
interface Available { host: string; processes: { name: string; component: string; assigned: boolean; present: boolean; missing: string[] }[]; diagnostics: Message[] }

type Tab = "logs" | "history" | "hosts";
const TITLES: Record<Tab, string> = { logs: "Logs", history: "History", hosts: "Hosts" };

export class Drawer {
  private tab: Tab | "" = "";
  private lines: LogLines | null = null;
  private readonly past: Happened[] = [];
  private readonly pastList = element("ol", "", { class: "history", role: "log", "aria-label": "what happened", tabindex: "0" });
  private readonly buttons = new Map<Tab, HTMLButtonElement>();
  private chosen: string[] = [];

  constructor(
    private readonly root: HTMLElement, bar: HTMLElement, private readonly model: Model, private readonly facts: Facts,
    private readonly can: Abilities, private readonly path: () => string, private readonly addHost: (() => void) | null,
    private readonly move: ((process: string, host: string) => void) | null,
  ) {
    for (const tab of Object.keys(TITLES) as Tab[]) {
      if (tab === "hosts" && !can.has("availability")) continue;
      const made = button(TITLES[tab], () => this.open(this.tab === tab ? "" : tab));
      made.setAttribute("aria-expanded", "false");
      made.setAttribute("aria-controls", root.id);
      this.buttons.set(tab, made);
      bar.append(made);
    }
  }

  open(tab: Tab | "", chosen: string[] = this.chosen): void {
    this.lines?.close();
    this.lines = null;
    this.tab = tab;
    this.chosen = chosen;
    this.root.hidden = !tab;
    for (const [name, one] of this.buttons) one.setAttribute("aria-expanded", String(name === tab));
    if (!tab) return;
    const close = button("✕", () => this.open(""), `close ${TITLES[tab].toLowerCase()}`);
    close.className = "close";
    this.root.replaceChildren(close, element("h2", TITLES[tab]));
    this.root.setAttribute("aria-label", TITLES[tab]);
    if (tab === "logs") this.logs();
    else if (tab === "history") this.root.append(element("p", "Since this manager was started:", { class: "hint" }), this.pastList);
    else this.hosts();
  }

  /** What the manager remembers, and what happens since. */
  async begin(): Promise<void> {
    this.open("");
    this.past.length = 0;
    this.pastList.replaceChildren();
    await this.catchUp();
  }

  async catchUp(): Promise<void> {
    const found = await ask<{ happened: Happened[] }>(`${this.path()}/history`);
    for (const one of found.happened) this.happened(one);
  }

  happened(one: Happened): void {
    if (this.past.some((each) => each.time === one.time && each.text === one.text && each.name === one.name)) return;
    this.past.push(one);
    const item = element("li");
    item.append(element("time", clock(one.time)), " ", element("strong", one.name), " ", one.text);
    this.pastList.prepend(item);
  }

  private logs(): void {
    const chosen = this.chosen, bar = element("p", "", { class: "buttons" });
    const search = element("input", "", { type: "search", placeholder: "Search the lines", "aria-label": "Search the lines" });
    search.addEventListener("input", () => this.lines?.find(search.value));
    const which = element("details"), boxes = element("fieldset");
    which.append(element("summary", chosen.length ? `of ${chosen.length} processes` : "of all processes"), boxes);
    boxes.append(element("legend", "Processes"));
    for (const name of this.model.states.keys()) {
      const label = element("label"), box = element("input", "", { type: "checkbox", value: name });
      box.checked = chosen.includes(name);
      box.addEventListener("change", () => {
        const all = [...boxes.querySelectorAll<HTMLInputElement>("input:checked")].map((one) => one.value);
        which.firstElementChild!.textContent = all.length ? `of ${all.length} processes` : "of all processes";
        this.chosen = all;
        this.follow(search.value);
      });
      label.append(box, ` ${name}`);
      boxes.append(label);
    }
    bar.append(search, which, button("Clear", () => this.lines?.clear()));
    this.root.append(bar);
    this.follow("");
  }

  private follow(search: string): void {
    this.lines?.close();
    this.lines?.root.remove();
    this.lines = new LogLines(this.path(), this.chosen, 50);
    this.lines.find(search);
    this.root.append(this.lines.root);
  }

  /** What of the components each host has, what is missing, and the push that brings it there. */
  private hosts(): void {
    const bar = element("p", "", { class: "buttons" }), names = this.hostNames();
    for (const name of names) bar.append(button(this.called(name), () => void this.availability(name), `what ${this.called(name)} has`));
    if (this.addHost) bar.append(button("Add a host…", this.addHost));
    this.root.append(bar, this.shown);
    const added = names.find((name) => this.known.length && !this.known.includes(name));
    this.host = added ?? (names.includes(this.host) ? this.host : names[0] ?? "");
    this.known = names;
    this.meant = this.assigned();
    if (this.host) void this.availability(this.host);
  }

  private readonly shown = element("div", "", { "aria-live": "polite" });
  private host = ""; // whose components are shown
  private meant = ""; // what was to run where then
  private known: string[] = [];

  /** This machine has no name in a document without hosts. */
  private called(host: string): string {
    return this.facts.hosts.length ? host : this.model.hostTitle(host);
  }

  private hostNames(): string[] {
    return this.facts.hosts.length ? this.facts.hosts.map((one) => one.name) : this.model.graph!.hosts.map((one) => one.name);
  }

  /** The documents changed: also the hosts, and what is to run there. */
  changed(): void {
    if (this.tab === "hosts" && this.meant !== this.assigned()) this.open("hosts");
  }

  private assigned(): string {
    return JSON.stringify([this.facts.hosts, this.facts.entries.map((one) => [one.process, one.host, one.component])]);
  }

  private async availability(host: string): Promise<void> {
    const { shown } = this;
    this.host = host;
    shown.replaceChildren(element("p", `asking ${this.called(host)}…`));
    try {
      const found = await ask<Available>(`${this.path()}/availability?host=${encodeURIComponent(host)}`);
      if (this.host !== host) return;
      const table = element("table"), head = element("tr");
      for (const title of ["Process", "Component", "To run there", "There", "Missing"]) head.append(element("th", title, { scope: "col" }));
      table.append(element("caption", this.called(host)), head);
      for (const one of found.processes) {
        const row = element("tr"), assigned = element("td", one.assigned ? "yes" : "");
        if (!one.assigned && this.move) assigned.append(button("Move here…", () => this.move!(one.name, host), `Move here…: ${one.name} to ${host}`));
        row.append(element("td", one.name), element("td", one.component), assigned, element("td", one.present ? "✓" : "✕"), element("td", one.missing.join(", ")));
        if (!one.present) row.className = "missing";
        table.append(row);
      }
      shown.replaceChildren(table);
      const problems = found.diagnostics.map(inWords).join("\n");
      if (problems) shown.append(element("p", problems, { class: "fault", role: "alert" }));
      if (!this.can.has("push", "post") || !this.can.may("operate") || !found.processes.some((one) => one.assigned && !one.present)) return;
      const push = button(`Push what is missing to ${host}`, () => void this.push(host, push));
      shown.append(push);
    } catch (error) {
      shown.replaceChildren(element("p", (error as Error).message, { class: "fault", role: "alert" }));
    }
  }

  private async push(host: string, pushing: HTMLButtonElement): Promise<void> {
    pushing.disabled = true;
    pushing.textContent = `pushing to ${host}…`;
    try {
      await ask(`${this.path()}/push`, { hosts: [host] });
      await this.availability(host);
    } catch (error) {
      const found = error instanceof Refusal ? (error.data.diagnostics as Message[] | undefined) : undefined;
      this.shown.append(element("p", found?.map(inWords).join("\n") || (error as Error).message, { class: "fault", role: "alert" }));
    }
  }
}
