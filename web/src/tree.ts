// The tree of hosts, groups and processes beside the picture: everything can be done from it with the keyboard.

import { Model, Node, Placed, SIGNS } from "./model";

type One = Omit<Node, keyof Placed>;
export type Kind = "network" | "host" | "group" | "node";

export class Tree {
  private readonly closed = new Set<string>();
  private focused = "";
  private readonly items = new Map<string, HTMLElement>();

  /** `select` is called with the name of a node; `ask` for the menu of an item, with where it is;
   * `nudge` with the direction in which a node is to be moved in the picture. */
  constructor(
    private readonly root: HTMLElement, private readonly model: Model, private readonly select: (name: string) => void,
    private readonly ask: (kind: Kind, name: string, x: number, y: number) => void,
    private readonly nudge: (name: string, dx: number, dy: number) => void,
  ) {
    root.addEventListener("keydown", (event) => this.key(event));
    root.addEventListener("click", (event) => {
      const item = (event.target as Element).closest<HTMLElement>("[role=treeitem]");
      if (item) this.choose(item);
    });
    root.addEventListener("focusin", (event) => {
      const item = event.target as HTMLElement;
      if (item.dataset.key && item.dataset.key !== this.focused) this.focus(item);
    });
    root.addEventListener("contextmenu", (event) => {
      const item = (event.target as Element).closest<HTMLElement>("[role=treeitem]");
      event.preventDefault();
      if (!item) return;
      this.focus(item);
      this.menu(item, event.clientX, event.clientY);
    });
  }

  build(): void {
    const graph = this.model.graph, hadFocus = this.root.contains(document.activeElement);
    const place = [...this.items.keys()].indexOf(this.focused);
    this.root.replaceChildren();
    this.items.clear();
    if (!graph) return;
    const all: One[] = graph.nodes.flatMap((node) => node.members ?? [node]);
    for (const host of [...graph.hosts, { name: "", title: graph.of === "components" ? "components" : "elsewhere" }]) {
      const nodes = all.filter((node) => node.host === host.name);
      if (!nodes.length) continue;
      const list = this.branch("host", host.name, host.title, this.root);
      const groups = new Map<string, HTMLElement>();
      for (const node of nodes) {
        const group = node.groups[0];
        if (group && !groups.has(group)) groups.set(group, this.branch("group", group, group, list, host.name));
        this.item("node", node.name, node.title, groups.get(group) ?? list);
      }
    }
    // What was renamed or removed has a neighbour where it was.
    if (!this.items.has(this.focused)) this.focused = [...this.items.keys()].at(Math.max(0, Math.min(place, this.items.size - 1))) ?? "";
    this.show();
    if (hadFocus) this.items.get(this.focused)?.focus();
  }

  private branch(kind: Kind, name: string, title: string, parent: HTMLElement, host = ""): HTMLElement {
    const item = this.item(kind, name, title, parent, host), list = document.createElement("ul");
    list.setAttribute("role", "group");
    item.append(list);
    this.open(item, !this.closed.has(item.dataset.key!));
    return list;
  }

  private item(kind: Kind, name: string, title: string, parent: HTMLElement, host = ""): HTMLElement {
    const item = document.createElement("li"), sign = document.createElement("span"), text = document.createElement("span");
    item.setAttribute("role", "treeitem");
    Object.assign(item.dataset, { name, kind, key: kind === "node" ? name : `${kind} ${host} ${name}` });
    sign.className = "sign";
    sign.setAttribute("aria-hidden", "true");
    text.textContent = title;
    item.append(sign, text);
    parent.append(item);
    this.items.set(item.dataset.key!, item);
    return item;
  }

  /** Shows the states, the selection and what is searched. */
  show(): void {
    for (const [name, item] of this.items) {
      set(item, "tabindex", name === this.focused ? "0" : "-1");
      if (item.dataset.kind !== "node") continue;
      const node = this.model.nodes.get(name), state = this.model.states.get(name);
      if (!node) continue;
      const look = this.model.look(name), rate = this.model.rate(node);
      set(item, "aria-selected", String(name === this.model.selected));
      const isWrong = !state?.down && node.faults.some((fault) => fault.severity === "error");
      set(item, "aria-label", [node.title, state?.words ?? (node.enabled ? "" : "not started"), isWrong ? "has errors" : "", rate].filter(Boolean).join(", "));
      const isHidden = !this.model.shows(name);
      if (item.hidden !== isHidden) item.hidden = isHidden;
      const sign = item.firstElementChild as HTMLElement;
      if (sign.dataset.look === look) continue;
      sign.textContent = SIGNS[look];
      sign.dataset.look = look;
    }
  }

  private open(item: HTMLElement, isOpen: boolean): void {
    item.setAttribute("aria-expanded", String(isOpen));
    item.querySelector<HTMLElement>("[role=group]")!.hidden = !isOpen;
    if (isOpen) this.closed.delete(item.dataset.key!);
    else this.closed.add(item.dataset.key!);
  }

  private choose(item: HTMLElement): void {
    this.focus(item);
    if (item.hasAttribute("aria-expanded")) this.open(item, item.getAttribute("aria-expanded") !== "true");
    else this.select(item.dataset.name!);
  }

  private menu(item: HTMLElement, x: number, y: number): void {
    this.ask(item.dataset.kind as Kind, item.dataset.name!, x, y);
  }

  /** Puts the keyboard on the item that is its turn. */
  enter(): void {
    this.items.get(this.focused)?.focus();
  }

  private focus(item: HTMLElement | undefined): void {
    if (!item) return;
    this.items.get(this.focused)?.setAttribute("tabindex", "-1");
    this.focused = item.dataset.key!;
    item.tabIndex = 0;
    if (document.activeElement !== item) item.focus();
  }

  private key(event: KeyboardEvent): void {
    const visible = [...this.root.querySelectorAll<HTMLElement>("[role=treeitem]")].filter((item) => item.offsetParent !== null);
    const at = visible.findIndex((item) => item.dataset.key === this.focused);
    const item = visible[at];
    const isBranch = item?.hasAttribute("aria-expanded"), isOpen = item?.getAttribute("aria-expanded") === "true";
    if (item && (event.key === "ContextMenu" || event.key === "m" || (event.key === "F10" && event.shiftKey))) {
      const place = item.getBoundingClientRect();
      event.preventDefault();
      this.menu(item, place.left + 30, Math.min(place.top + 22, place.bottom));
      return;
    }
    const way = event.altKey ? { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] : undefined;
    if (way) {
      event.preventDefault();
      if (item?.dataset.kind === "node") this.nudge(item.dataset.name!, way[0], way[1]);
      return;
    }
    switch (event.key) {
      case "ArrowDown": this.focus(visible[at + 1]); break;
      case "ArrowUp": this.focus(visible[at - 1]); break;
      case "Home": this.focus(visible[0]); break;
      case "End": this.focus(visible[visible.length - 1]); break;
      case "ArrowRight": if (isBranch && !isOpen) this.open(item, true); else if (isBranch) this.focus(visible[at + 1]); break;
      case "ArrowLeft":
        if (isBranch && isOpen) this.open(item, false);
        else this.focus(item?.parentElement?.closest<HTMLElement>("[role=treeitem]") ?? undefined);
        break;
      case "Enter": case " ": if (item) this.choose(item); break;
      case "Escape": this.select(""); break;
      default: return;
    }
    event.preventDefault();
  }
}

function set(item: HTMLElement, name: string, value: string): void {
  if (item.getAttribute(name) !== value) item.setAttribute(name, value);
}
