// What the server says: the picture of the network, and the states of its processes.

export interface Box { name: string; title: string; x?: number; y?: number; width?: number; height?: number }
export interface Placed { x: number; y: number; width: number; height: number }
export interface Group extends Placed { name: string; host: string }
export interface Fault { code: string; severity: string; message: string }
export interface Node extends Placed {
  name: string; title: string; kind: string; host: string; groups: string[]; texts: string[]; enabled: boolean;
  serves: { interface: string; port: number | null }[]; faults: Fault[];
}
export interface Edge {
  from: string; to: string; kind: string; label: string; points: [number, number][]; faults: Fault[];
}
export interface Graph {
  name: string; width: number; height: number; hosts: Box[]; groups: Group[]; nodes: Node[]; edges: Edge[];
  faults: Fault[]; document: string; version: string;
}
export interface State {
  name: string; host: string; state: string; words: string; ready: boolean; down: boolean; pid: number;
  restarts: number; last_exit: string; memory: number | null; cpu: number | null;
}
export type Look = "ready" | "busy" | "down" | "idle" | "other";

/** How a node looks; what is no process, such as a topic, has no state. */
export function look(node: Node | undefined, state: State | undefined): Look {
  if (node?.faults.some((fault) => fault.severity === "error") || state?.down) return "down";
  if (!state) return "other";
  if (state.ready) return "ready";
  return state.pid ? "busy" : "idle";
}

export const SIGNS: Record<Look, string> = { ready: "●", busy: "◐", down: "✕", idle: "○", other: "" };

export class Model {
  graph: Graph | null = null;
  states = new Map<string, State>();
  nodes = new Map<string, Node>();
  near = new Map<string, Set<string>>();
  selected = "";
  search = "";
  filter = "";

  take(graph: Graph): void {
    this.graph = graph;
    this.nodes = new Map(graph.nodes.map((node) => [node.name, node]));
    this.near = new Map(graph.nodes.map((node) => [node.name, new Set([node.name])]));
    for (const edge of graph.edges) {
      this.near.get(edge.from)?.add(edge.to);
      this.near.get(edge.to)?.add(edge.from);
    }
    if (!this.nodes.has(this.selected)) this.selected = "";
  }

  look(name: string): Look {
    return look(this.nodes.get(name), this.states.get(name));
  }

  /** Whether search and filter show a node in full. */
  shows(name: string): boolean {
    const node = this.nodes.get(name);
    if (!node) return false;
    const text = [node.name, ...node.texts, node.host, ...node.groups].join(" ").toLowerCase();
    if (this.search && !text.includes(this.search.toLowerCase())) return false;
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
}
