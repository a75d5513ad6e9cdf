// A menu for what is selected: by the right mouse button, or in the tree by Shift+F10, the menu key or m.

import { element } from "./dom";

/** `begins`: a line is above it. */
export interface Action { label: string; act: () => void; begins?: boolean }

export function menu(title: string, actions: Action[], x: number, y: number): void {
  document.querySelector(".menu")?.remove();
  const before = document.activeElement as HTMLElement | null;
  const root = element("ul", "", { role: "menu", class: "menu", "aria-label": title });
  const items = actions.map((one) => {
    const item = element("li", one.label, { role: "menuitem", tabindex: "-1" });
    if (one.begins && root.childElementCount) root.append(element("li", "", { role: "separator" }));
    item.addEventListener("click", () => { close(false); one.act(); });
    root.append(item);
    return item;
  });
  const outside = (event: Event) => { if (!root.contains(event.target as Node)) close(false); };
  const close = (isBack: boolean) => {
    document.removeEventListener("pointerdown", outside, true);
    root.remove();
    if (isBack) before?.focus();
  };
  root.addEventListener("keydown", (event) => {
    const at = items.indexOf(document.activeElement as HTMLLIElement);
    const starts = (item: HTMLElement) => item.textContent!.toLowerCase().startsWith(event.key.toLowerCase());
    switch (event.key) {
      case "ArrowDown": items[(at + 1) % items.length].focus(); break;
      case "ArrowUp": items[(at + items.length - 1) % items.length].focus(); break;
      case "Home": items[0].focus(); break;
      case "End": items[items.length - 1].focus(); break;
      case "Enter": case " ": before?.focus(); close(true); actions[at]?.act(); break;
      case "Escape": case "Tab": close(true); break;
      default: [...items.slice(at + 1), ...items].find(starts)?.focus(); return;
    }
    event.preventDefault();
    event.stopPropagation();
  });
  document.addEventListener("pointerdown", outside, true);
  document.body.append(root);
  root.style.left = `${Math.max(0, Math.min(x, innerWidth - root.offsetWidth - 4))}px`;
  root.style.top = `${Math.max(0, Math.min(y, innerHeight - root.offsetHeight - 4))}px`;
  items[0]?.focus();
}
