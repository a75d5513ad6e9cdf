// What can be changed in the network: entries with their ports, hosts, groups, and what can be added.

import { ask } from "./server";

export interface Required { port: string; interface: string; to: string }
export interface Offered { port: string; interface: string }
/** `number` is the TCP port that the document sets. */
export interface Port extends Offered { number: number | null }
export interface TopicPort { port: string; interface: string; out: boolean; topic: string }
/** `scope` is the include that the entry is in, with a dot. */
export interface Entry {
  process: string; entry: string; scope: string; document: string; line: number; kind: string; host: string; component: string; requires: Required[];
  serves: Port[]; topics: TopicPort[]; instances: number | null; after: string[];
}
export interface Known { name: string; path: string; implements: string[]; requires: string[]; publishes: string[]; subscribes: string[] }
/** `written`: the document of the deployment lists its members. */
export interface GroupFacts { name: string; members: string[]; closed: boolean; serves: Offered[]; written: boolean }
export interface Parameter {
  path: string; type: string; words: string; doc: string; unit: string; secret: boolean; editable: boolean;
  choices?: unknown[]; low?: number; high?: number; default?: unknown; present?: unknown;
}
export interface Input { name: string; type: string; words: string; doc: string; unit: string; zero: unknown; choices?: string[]; members?: Input[] }
export interface Method { name: string; doc: string; inputs: Input[] }

const NOTHING = { entries: [], hosts: [], groups: [], services: [], components: [], interfaces: [] };

export class Facts {
  entries: Entry[] = [];
  hosts: { name: string; address: string }[] = [];
  groups: GroupFacts[] = [];
  services: string[] = [];
  components: Known[] = [];
  interfaces: [string, boolean][] = [];
  private of = new Map<string, Entry>();

  async load(path: string): Promise<void> {
    Object.assign(this, NOTHING, await ask<object>(`${path}/entries`));
    this.of = new Map(this.entries.map((one) => [one.process, one]));
  }

  entry(process: string): Entry | undefined {
    return this.of.get(process);
  }

  /** The document of the component that a process is, or of the one with this name. */
  componentOf(name: string): string {
    return this.of.get(name)?.component || (this.components.find((one) => one.name === name || one.path === name)?.path ?? "");
  }

  /** The entries that the document of an entry can name: an included one only knows its own. */
  named(by: Entry): Entry[] {
    return by.scope ? this.entries.filter((one) => one.scope === by.scope) : this.entries;
  }

  /** Who can serve an interface to an entry: others, and groups that act as one. */
  providers(wanted: string, by: Entry): string[] {
    const serves = (one: { serves: Offered[] }) => one.serves.some((each) => each.interface === wanted);
    return [...new Set([...this.named(by).filter(serves).map((one) => one.process),
      ...(by.scope ? [] : this.groups.filter((one) => one.closed && serves(one)).map((one) => one.name))])];
  }

  /** The ports of one process that another one could serve. */
  matching(source: string, target: string): Required[] {
    const by = this.of.get(source), other = this.of.get(target);
    if (!by || !other || (by.scope && by.scope !== other.scope)) return [];
    const offered = new Set(other.serves.map((one) => one.interface));
    return by.requires.filter((one) => offered.has(one.interface));
  }
}

export function process(path: string, name: string): Promise<{ parameters: Parameter[]; methods: Method[] }> {
  return ask(`${path}/process?name=${encodeURIComponent(name)}`);
}
