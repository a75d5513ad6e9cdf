// What the server says: the picture of the network, and the states of its processes.

import { Message } from "./dom";

export interface Box { name: string; title: string; x?: number; y?: number; width?: number; height?: number }
export interface Placed { x: number; y: number; width: number; height: number }
export interface Group extends Placed { name: string; host: string }
export interface Node extends Placed {
  name: string; title: string; kind: string; host: string; groups: string[]; texts: string[]; enabled: boolean;
  serves: { interface: string; port: number | null }[]; faults: Message[]; members?: Omit<Node, keyof Placed>[];
}
export interface Edge {
  from: string; to: string; kind: string; label: string; points: [number, number][]; faults: Message[];
}
export interface Graph {
  name: string; width: number; height: number; hosts: Box[]; groups: Group[]; nodes: Node[]; edges: Edge[];
  faults: Message[]; document: string; version: string; of: "network" | "components";
}
/** `cpu` are seconds in all, `load` the percentage of a core now, `memory` bytes. */
export interface State {
  name: string; host: string; state: string; words: string; ready: boolean; down: boolean; pid: number;
  restarts: number; last_exit: string; memory: number | null; cpu: number | null; load?: number | null;
}
export type Look = "ready" | "busy" | "down" | "idle" | "other";
export type Positions = Record<string, [number, number]>;

export const TOPIC = "topic", COMPONENT = "component", CLOSED = "closed";
export const SIGNS: Record<Look, string> = { ready: "●", busy: "◐", down: "✕", idle: "○", other: "" };
const WORST: Look[] = ["down", "busy", "idle", "ready"];

/** How a node looks; what is no process, such as a topic, has no state. */
export function look(node: { faults: Message[] } | undefined, state: State | undefined): Look {
  if (node?.faults.some((fault) => fault.severity === "error") || state?.down) return "down";
  if (!state) return "other";
  if (state.ready) return "ready";
  return state.pid ? "busy" : "idle";
}

export class Model {
  graph: Graph | null = null;
  states = new Map<string, State>();
  rates = new Map<string, number>(); // of topics
  nodes = new Map<string, Node>(); // also those in closed boxes, with the place of the box
  near = new Map<string, Set<string>>();
  positions: Positions = {}; // of the nodes that a person moved
  selected = "";
  search = "";
  filter = "";

  take(graph: Graph): void {
    this.graph = graph;
    this.nodes = new Map();
    for (const node of graph.nodes) {
      this.nodes.set(node.name, node);
      for (const one of node.members ?? []) this.nodes.set(one.name, { ...one, x: node.x, y: node.y, width: node.width, height: node.height });
    }
    this.near = new Map([...this.nodes.keys()].map((name) => [name, new Set([name])]));
    for (const edge of graph.edges) {
      this.near.get(edge.from)?.add(edge.to);
      this.near.get(edge.to)?.add(edge.from);
    }
    for (const node of graph.nodes) {
      for (const one of node.members ?? []) {
        this.near.set(one.name, new Set([one.name, ...this.near.get(node.name)!]));
      }
    }
    if (!this.nodes.has(this.selected)) this.selected = "";
  }

  look(name: string): Look {
    const node = this.nodes.get(name);
    if (!node?.members) return look(node, this.states.get(name));
    const looks = new Set(node.members.map((one) => this.look(one.name)));
    return WORST.find((one) => looks.has(one)) ?? "other";
  }

  /** How many of these processes look how. */
  counts(names: Iterable<string>): Map<Look, number> {
    const found = new Map<Look, number>();
    for (const name of names) found.set(this.look(name), (found.get(this.look(name)) ?? 0) + 1);
    return found;
  }

  title(name: string): string {
    return this.nodes.get(name)?.title ?? name;
  }

  /** What a host is called: this machine has no name in a document without hosts. */
  hostTitle(name: string): string {
    return this.graph?.hosts.find((one) => one.name === name)?.title ?? name;
  }

  /** Whether search and filter show a node in full. */
  shows(name: string): boolean {
    const node = this.nodes.get(name);
    if (!node) return false;
    if (!this.search && !this.filter) return true;
    if (node.members) return node.members.some((one) => this.shows(one.name));
    if (this.search) {
      const text = [node.name, ...node.texts, node.host, ...node.groups].join(" ").toLowerCase();
      if (!text.includes(this.search.toLowerCase())) return false;
    }
    const [kind, value] = [this.filter.slice(0, 1), this.filter.slice(1)];
    if (kind === "h") return node.host === value;
    if (kind === "s") return this.look(name) === value;
    if (kind === "i") return this.graph!.edges.some((edge) => edge.label === value && (edge.from === name || edge.to === name)) ||
      node.serves.some((one) => one.interface === value);
    return true;
  }

  /** Whether the selection, the search and the filter show a node in full. */
  isClear(name: string): boolean {
    return this.shows(name) && (!this.selected || this.near.get(this.selected)!.has(name));
  }

  /** The memory and the CPU of a running process, in words; '' if they are not known. */
  use(name: string): string {
    const state = this.states.get(name);
    if (!state?.pid || !state.memory) return "";
    const load = state.load === null || state.load === undefined ? "" : `  ${state.load} %`;
    return `${(state.memory / 2 ** 20).toFixed(0)} MiB${load}`;
  }

  /** The rate of the messages of a topic, in words; '' if it is unknown. */
  rate(node: Node): string {
    const rate = node.kind === TOPIC ? this.rates.get(node.title) ?? this.rates.get(node.name) : undefined;
    return rate === undefined ? "" : `${rate < 10 ? rate.toFixed(1) : rate.toFixed(0)} Hz`;
  }
}

export function isInside(box: Placed, [x, y]: [number, number]): boolean {
  return x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + box.height;
}

export function touch(one: Placed, other: Placed): boolean {
  return one.x < other.x + other.width && other.x < one.x + one.width && one.y < other.y + other.height && other.y < one.y + one.height;
}
