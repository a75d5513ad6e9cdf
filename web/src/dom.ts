// Elements of the page. Texts are always texts, never markup.

export function element<K extends keyof HTMLElementTagNameMap>(name: K, text = "", attributes: Record<string, string> = {}): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  if (text) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

export function button(text: string, act: () => void, label = ""): HTMLButtonElement {
  const made = element("button", text, { type: "button", ...(label ? { "aria-label": label } : {}) });
  made.addEventListener("click", act);
  return made;
}

export const find = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

export interface Message { severity: string; message: string; code: string; file?: string; line?: number }

export function inWords(one: Message): string {
  return one.code ? `${one.code}: ${one.message}` : one.message;
}

/** A list of diagnostics, the errors in red. */
export function messages(found: Message[]): HTMLUListElement {
  const list = element("ul");
  for (const one of found) list.append(element("li", inWords(one), one.severity === "error" ? { class: "fault" } : {}));
  return list;
}

/** A unified diff in colours. */
export function diff(text: string): HTMLElement {
  const made = element("pre", "", { class: "diff", tabindex: "0", "aria-label": "the change" });
  for (const line of text.split("\n")) {
    if (/^(---|\+\+\+) /.test(line)) continue;
    const kind = { "+": "added", "-": "removed", "@": "where" }[line.slice(0, 1)];
    made.append(element("span", `${line}\n`, kind ? { class: kind } : {}));
  }
  return made;
}

let opened = 0;

/** A modal dialog with a title and a content; it is removed when it is closed. */
export function dialog(title: string, ...content: (Node | string)[]): HTMLDialogElement {
  const id = `dialog-${opened += 1}`, made = element("dialog", "", { "aria-labelledby": id });
  made.append(element("h2", title, { id }), ...content);
  made.addEventListener("close", () => made.remove());
  if (!made.querySelector("button")) made.append(buttons(button("Close", () => made.close())));
  document.body.append(made);
  made.showModal();
  return made;
}

export function buttons(...made: HTMLElement[]): HTMLElement {
  const row = element("p", "", { class: "buttons" });
  row.append(...made);
  return row;
}
