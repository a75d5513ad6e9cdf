// Operations on the running network: their plans, calls of methods, and values of parameters.

import { button, buttons, dialog, element, Message, messages } from "./dom";
import { Method, Parameter, process } from "./facts";
import { fieldOf, Form, leaves, nested, valueOf } from "./form";
import { ask, names } from "./server";

interface Step { name: string; action: string; reason: string; changes: { field: string; old: unknown; new: unknown }[] }
interface Reply { returns?: unknown; out?: unknown; throws?: unknown }
interface Running { path: string; data: unknown; unit: string; editable: boolean }

/** Shows what an operation would do, and does it when that is confirmed. `called` is what all that is `chosen` is called. */
export async function plan(path: string, action: string, chosen: string[], called: string, done: (text: string) => void): Promise<void> {
  const title = `${{ up: "Start", restart: "Restart", down: "Stop", rollback: "Roll back" }[action]!} ${called}`;
  const list = element("ul");
  let isPossible = true;
  try {
    if (action === "rollback") list.append(element("li", "Go back to the last start at which all were ready."));
    else isPossible = steps(list, await ask(`${path}/plan?action=${action}&${names(chosen)}`));
  } catch (error) {
    list.append(element("li", (error as Error).message, { class: "fault" }));
    isPossible = false;
  }
  const row: HTMLElement[] = [button("Cancel", () => root.close())];
  if (isPossible) row.unshift(button("Do it", () => { root.close(); void run(path, action, chosen, done); }));
  const root = dialog(title, list, buttons(...row));
}

function steps(list: HTMLElement, found: { plan?: Step[]; stop?: string[]; reasons?: Record<string, string>; diagnostics: Message[] }): boolean {
  const planned = found.plan?.filter((step) => step.action !== "keep") ?? found.stop!.map((name) => ({ name, action: "stop", reason: found.reasons?.[name] ?? "" }));
  for (const step of planned) list.append(element("li", `${step.action} ${step.name}${step.reason ? `: ${step.reason}` : ""}`));
  list.append(...messages(found.diagnostics).children);
  if (!planned.length) list.append(element("li", "Nothing to do."));
  return planned.length > 0 && !found.diagnostics.some((one) => one.severity === "error");
}

async function run(path: string, action: string, chosen: string[], done: (text: string) => void): Promise<void> {
  done("");
  try {
    const found = await ask<{ ok: boolean; diagnostics: Message[] }>(`${path}/${action}`, { names: chosen });
    done(found.diagnostics.filter((one) => one.severity === "error").map((one) => `${one.code}: ${one.message}`).join("\n"));
  } catch (error) {
    done((error as Error).message);
  }
}

/** A dialog in which a method of a process is called, as often as one wants. */
export async function call(path: string, name: string): Promise<void> {
  const { methods } = await process(path, name);
  if (!methods.length) {
    dialog(`Call a method of ${name}`, element("p", "It serves no interface of these documents."));
    return;
  }
  const result = element("pre", "", { role: "status", "aria-label": "answer", class: "answer" });
  const of = (chosen: unknown): Method => methods.find((one) => one.name.slice(name.length + 1) === chosen) ?? methods[0];
  const form = new Form((values) => {
    const method = of(values.method);
    return [
      { name: "method", label: "Method", kind: "choice", choices: methods.map((one) => one.name.slice(name.length + 1)), hint: method.doc },
      ...leaves(method.inputs).map(({ path: steps, input }) => fieldOf(input, `${method.name} ${steps.join(".")}`, steps.join("."), input.zero)),
    ];
  }, () => undefined);
  const send = async () => {
    const method = of(form.values.method);
    result.textContent = "…";
    try {
      const values = leaves(method.inputs).map(({ path: steps, input }) => {
        try {
          return { path: steps, value: valueOf(input, form.values[`${method.name} ${steps.join(".")}`]) };
        } catch (error) {
          throw new Error(`${steps.join(".")}: ${(error as Error).message}`);
        }
      });
      const reply = await ask<Reply>(`${path}/call`, { method: method.name, arguments: nested(values) });
      result.textContent = Object.keys(reply).length ? JSON.stringify(reply, null, 2) : "done";
      result.classList.toggle("fault", "throws" in reply);
    } catch (error) {
      result.textContent = (error as Error).message;
      result.classList.add("fault");
    }
  };
  const now = button("Call", () => void send());
  now.className = "main";
  const root = dialog(`Call a method of ${name}`, form.root, result, buttons(now, button("Close", () => root.close())));
  form.root.addEventListener("submit", () => void send());
}

/** The type of an element of a list: what the component does not accept, it says. */
function elementOf({ path, data }: Running, types: Map<string, Parameter>): Parameter | undefined {
  const list = types.get(path.replace(/\[\d+\]$/, "")), type = { number: "double", boolean: "bool", string: "string" }[typeof data as "number"];
  return list && type && list.type === "other" ? { ...list, path, type } : undefined;
}

/** The values that a running component has now; those that are editable can be changed until it ends. */
export class RunningValues {
  readonly root = element("div");
  private readonly list = element("dl");
  private readonly problem = element("p", "", { class: "fault", role: "alert" });

  constructor(private readonly path: string, private readonly name: string, private readonly types: (() => Promise<Parameter[]>) | null) {
    this.root.append(button("Read the values that it has now", () => void this.read()), this.problem, this.list);
  }

  private async read(): Promise<void> {
    this.list.replaceChildren(element("dt", "…"));
    this.problem.textContent = "";
    try {
      const found = await ask<{ parameters: Running[] }>(`${this.path}/parameters?process=${encodeURIComponent(this.name)}`);
      const types = new Map((await this.types?.() ?? []).map((one) => [one.path, one]));
      this.list.replaceChildren(...found.parameters.flatMap((one) => this.row(one, types.get(one.path) ?? elementOf(one, types))));
    } catch (error) {
      this.list.replaceChildren();
      this.problem.textContent = (error as Error).message;
    }
  }

  private row(one: Running, type: Parameter | undefined): HTMLElement[] {
    const value = element("dd", `${typeof one.data === "string" ? one.data : JSON.stringify(one.data)} ${one.unit}`);
    if (this.types && one.editable && type) value.append(" ", button("Change…", () => this.change(one, type), `change ${one.path}`));
    return [element("dt", one.path), value];
  }

  private change(one: Running, type: Parameter): void {
    const problem = element("p", "", { role: "alert", class: "fault" });
    const form = new Form(() => [fieldOf(type, "value", one.path, type.secret ? "" : one.data)], () => undefined);
    const send = async () => {
      if (!form.root.reportValidity()) return;
      try {
        const value = valueOf(type, form.values.value);
        await ask(`${this.path}/parameters`, { process: this.name, parameter: one.path, value: typeof value === "string" ? value : JSON.stringify(value) });
        root.close();
        await this.read();
      } catch (error) {
        problem.textContent = (error as Error).message;
      }
    };
    const now = button("Set it until the process ends", () => void send());
    now.className = "main";
    const root = dialog(`${one.path} of ${this.name}`, form.root, problem, buttons(now, button("Cancel", () => root.close())));
    form.root.addEventListener("submit", () => void send());
  }
}
