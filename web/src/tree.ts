// The tree of hosts and processes beside the picture: everything in it can be reached with the keyboard.

import { Model, SIGNS } from "./model";

export class Tree {
  private readonly closed = new Set<string>();
  private focused = "";
  private readonly items = new Map<string, HTMLElement>();

  constructor(private readonly root: HTMLElement, private readonly model: Model, private readonly select: (name: string) => void) {
    root.addEventListener("keydown", (event) => this.key(event));
    root.addEventListener("click", (event) => {
      const item = (event.target as Element).closest<HTMLElement>("[role=treeitem]");
      if (item) this.choose(item);
    });
  }

  build(): void {
    const graph = this.model.graph;
    this.root.replaceChildren();
    this.items.clear();
    if (!graph) return;
    for (const host of [...graph.hosts, { name: "", title: "elsewhere" }]) {
      const nodes = graph.nodes.filter((node) => node.host === host.name);
      if (!nodes.length) continue;
      const item = this.item(`host ${host.name}`, host.title, this.root);
      const list = document.createElement("ul");
      list.setAttribute("role", "group");
      item.append(list);
      item.setAttribute("aria-expanded", "true");
      for (const node of nodes) this.item(node.name, node.title, list);
      this.open(item, !this.closed.has(item.dataset.name!));
    }
    if (!this.items.has(this.focused)) this.focused = this.items.keys().next().value ?? "";
    this.show();
  }

  private item(name: string, title: string, parent: HTMLElement): HTMLElement {
    const item = document.createElement("li"), sign = document.createElement("span"), text = document.createElement("span");
    item.setAttribute("role", "treeitem");
    item.dataset.name = name;
    sign.className = "sign";
    sign.setAttribute("aria-hidden", "true");
    text.textContent = title;
    item.append(sign, text);
    parent.append(item);
    this.items.set(name, item);
    return item;
  }

  /** Shows the states, the selection and what is searched. */
  show(): void {
    for (const [name, item] of this.items) {
      const node = this.model.nodes.get(name), state = this.model.states.get(name);
      item.tabIndex = name === this.focused ? 0 : -1;
      if (!node) continue;
      const look = this.model.look(name);
      item.setAttribute("aria-selected", String(name === this.model.selected));
      item.setAttribute("aria-label", state ? `${node.title}, ${state.words}` : node.title);
      item.hidden = !this.model.shows(name);
      const sign = item.firstElementChild as HTMLElement;
      sign.textContent = SIGNS[look];
      sign.dataset.look = look;
    }
  }

  private open(item: HTMLElement, isOpen: boolean): void {
    item.setAttribute("aria-expanded", String(isOpen));
    item.querySelector<HTMLElement>("[role=group]")!.hidden = !isOpen;
    if (isOpen) this.closed.delete(item.dataset.name!);
    else this.closed.add(item.dataset.name!);
  }

  private choose(item: HTMLElement): void {
    this.focus(item);
    if (item.hasAttribute("aria-expanded")) this.open(item, item.getAttribute("aria-expanded") !== "true");
    else this.select(item.dataset.name!);
  }

  private focus(item: HTMLElement | undefined): void {
    if (!item) return;
    this.items.get(this.focused)?.setAttribute("tabindex", "-1");
    this.focused = item.dataset.name!;
    item.tabIndex = 0;
    item.focus();
  }

  private key(event: KeyboardEvent): void {
    const visible = [...this.items.values()].filter((item) => item.offsetParent !== null);
    const at = visible.findIndex((item) => item.dataset.name === this.focused);
    const item = visible[at];
    const isBranch = item?.hasAttribute("aria-expanded"), isOpen = item?.getAttribute("aria-expanded") === "true";
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
