// Forms from descriptions of their fields, which may depend on the values of other fields.

import { element } from "./dom";
import { Input, Parameter } from "./facts";
import { exact, whole } from "./server";

export interface Field {
  name: string; label: string; kind: "text" | "number" | "choice" | "many" | "check" | "secret" | "long";
  choices?: string[]; value?: string | string[] | boolean; hint?: string; low?: number; high?: number; whole?: boolean; optional?: boolean;
  of?: string; // what the value is of: that of something else does not stay
}
export type Values = Record<string, string | string[] | boolean>;

let made = 0;

export class Form {
  readonly root = element("form");
  private readers = new Map<string, () => string | string[] | boolean>();
  private of = new Map<string, string | undefined>();

  /** `describe` returns the fields for the values that there are; `changed` is told about every change. */
  constructor(private readonly describe: (values: Values) => Field[], private readonly changed: () => void) {
    this.root.addEventListener("submit", (event) => event.preventDefault());
    this.root.addEventListener("input", (event) => {
      const changed = event.target as HTMLInputElement;
      if (changed.tagName === "SELECT" || changed.dataset.shapes) this.build();
      this.changed();
    });
    this.build();
  }

  get values(): Values {
    return Object.fromEntries([...this.readers].map(([name, read]) => [name, read()]));
  }

  get isValid(): boolean {
    return this.root.checkValidity();
  }

  private build(): void {
    const before = this.values, focused = (document.activeElement as HTMLElement | null)?.dataset.field;
    this.readers = new Map();
    const fields = this.describe(before);
    this.root.replaceChildren();
    for (const field of fields) {
      const stays = field.name in before && this.of.get(field.name) === field.of && isPossible(field, before[field.name]);
      this.of.set(field.name, field.of);
      this.add(stays ? { ...field, value: before[field.name] } : field);
    }
    if (focused) this.root.querySelector<HTMLElement>(`[data-field="${CSS.escape(focused)}"]`)?.focus();
  }

  private add(field: Field): void {
    const id = `field-${made += 1}`;
    if (field.kind === "many") {
      this.many(field);
      return;
    }
    const row = element("p", "", { class: "field" }), label = element("label", field.label, { for: id });
    const input = this.input(field);
    input.id = id;
    input.dataset.field = field.name;
    row.append(label, input);
    if (field.hint) {
      row.append(element("span", field.hint, { id: `${id}-hint`, class: "hint" }));
      input.setAttribute("aria-describedby", `${id}-hint`);
    }
    this.root.append(row);
  }

  private input(field: Field): HTMLElement {
    if (field.kind === "choice") {
      const chosen = element("select");
      for (const one of field.choices ?? []) chosen.append(element("option", one || "—", { value: one }));
      if (typeof field.value === "string" && field.choices?.includes(field.value)) chosen.value = field.value;
      this.readers.set(field.name, () => chosen.value);
      return chosen;
    }
    if (field.kind === "long") {
      const long = element("textarea", typeof field.value === "string" ? field.value : "", { rows: "4" });
      this.readers.set(field.name, () => long.value);
      return long;
    }
    const input = element("input", "", { type: { number: "number", check: "checkbox", secret: "password" }[field.kind as "number"] ?? "text", autocomplete: "off" });
    if (field.kind === "check") {
      input.dataset.shapes = "yes";
      input.checked = field.value === true || field.value === "true";
      this.readers.set(field.name, () => input.checked);
      return input;
    }
    if (field.kind === "number") {
      input.step = field.whole ? "1" : "any";
      if (field.low !== undefined) input.min = String(field.low);
      if (field.high !== undefined) input.max = String(field.high);
    }
    if (field.choices?.length) {
      const list = element("datalist", "", { id: `choices-${made}` });
      for (const one of field.choices) list.append(element("option", "", { value: one }));
      input.setAttribute("list", list.id);
      this.root.append(list);
    }
    input.required = !field.optional;
    input.value = typeof field.value === "string" ? field.value : "";
    this.readers.set(field.name, () => input.value);
    return input;
  }

  private many(field: Field): void {
    const set = element("fieldset"), boxes: HTMLInputElement[] = [], chosen = new Set(Array.isArray(field.value) ? field.value : []);
    set.append(element("legend", field.label));
    for (const one of field.choices ?? []) {
      const label = element("label"), box = element("input", "", { type: "checkbox", value: one });
      box.checked = chosen.has(one);
      box.dataset.field = `${field.name} ${one}`;
      label.append(box, ` ${one}`);
      boxes.push(box);
      set.append(label);
    }
    this.readers.set(field.name, () => boxes.filter((box) => box.checked).map((box) => box.value));
    this.root.append(set);
  }
}

/** Whether a value that another field left can stay. */
function isPossible(field: Field, value: Values[string]): boolean {
  if (field.kind === "check") return typeof value === "boolean";
  if (field.kind === "many") return Array.isArray(value);
  if (typeof value !== "string") return false;
  return field.kind !== "choice" || Boolean(field.choices?.includes(value));
}

/** The field of a value of a parameter, or of an argument of a method. */
export function fieldOf(one: Parameter | Input, name: string, label: string, value: unknown): Field {
  const unit = one.unit ? ` (${one.unit})` : "";
  const about = { name, label: `${label}${unit}`, hint: [one.words, one.doc].filter(Boolean).join(". "), optional: true };
  const limits = one as Parameter;
  if (limits.secret) return { ...about, kind: "secret" };
  if (one.choices) return { ...about, kind: "choice", choices: one.choices.map(String), value: String(value ?? one.choices[0]) };
  if (one.type === "bool") return { ...about, kind: "check", value: value === true };
  if (one.type === "string") return { ...about, kind: "text", value: String(value ?? "") };
  if (WHOLE.has(one.type) || one.type === "float" || one.type === "double") {
    return { ...about, kind: "number", value: value === undefined ? "" : JSON.stringify(value), low: limits.low, high: limits.high, whole: WHOLE.has(one.type), optional: false };
  }
  return { ...about, kind: "long", value: JSON.stringify(value ?? (one as Input).zero ?? null) };
}

/** The arguments of a method with the paths of their fields: each member of a struct has a field of its own. */
export function leaves(inputs: Input[], above: string[] = []): { path: string[]; input: Input }[] {
  return inputs.flatMap((one) => {
    const path = [...above, one.name];
    return one.members?.length ? leaves(one.members, path) : [{ path, input: one }];
  });
}

/** The arguments that the values of these fields make. */
export function nested(values: { path: string[]; value: unknown }[]): Record<string, unknown> {
  const made: Record<string, unknown> = {};
  for (const { path, value } of values) {
    let inner = made;
    for (const step of path.slice(0, -1)) inner = (inner[step] ??= {}) as Record<string, unknown>;
    inner[path[path.length - 1]] = value;
  }
  return made;
}

const WHOLE = new Set(["byte", "short", "int", "long"]);

/** The value in a field, as data. Throws an Error with a text for people. */
export function valueOf(one: Parameter | Input, read: Values[string]): unknown {
  if (typeof read === "boolean") return read;
  const text = String(read);
  if (one.choices) return one.choices.find((each) => String(each) === text);
  if (one.type === "string") return text;
  if (WHOLE.has(one.type) || one.type === "float" || one.type === "double") {
    if (!text.trim() || !Number.isFinite(Number(text))) throw new Error(`this must be ${one.words}`);
    return WHOLE.has(one.type) ? whole(text.trim()) : Number(text);
  }
  try {
    return exact(text);
  } catch {
    throw new Error(`write it as JSON: ${one.words}`);
  }
}
