// What can be changed, as dialogs: the same changes as those of `rcyaml edit`.

import { dialog, element } from "./dom";
import { Editing, Proposal } from "./edit";
import { Facts, Parameter, process } from "./facts";
import { Field, fieldOf, Values, valueOf } from "./form";
import { Action } from "./menu";

const text = (values: Values, name: string) => String(values[name] ?? "").trim();
const list = (values: Values, name: string) => (values[name] as string[] | undefined) ?? [];

export class Changes {
  constructor(private readonly editing: Editing, private readonly facts: Facts, private readonly path: () => string) {}

  private propose(title: string, make: Proposal["make"], fields?: Proposal["fields"], document?: string): void {
    this.editing.propose({ title, make, fields, document });
  }

  ofProcess(name: string): Action[] {
    const one = this.facts.entry(name);
    if (!one) return [];
    const is = (label: string, act: () => void, isPossible = true): Action[] => isPossible ? [{ label, act }] : [];
    return [
      ...is("Connect…", () => this.connect(name), one.requires.length > 0),
      ...is("Disconnect…", () => this.disconnect(name), one.requires.some((each) => each.to)),
      ...is("Topics…", () => this.topic(name), one.topics.length > 0),
      ...is("Move to host…", () => this.move(name), this.facts.hosts.length > 1),
      ...is("Add to group…", () => this.group([name])),
      ...is("Set a parameter…", () => void this.set(name), Boolean(one.component)),
      ...is("Port…", () => this.port(name), one.serves.length > 0),
      ...is("Instances…", () => this.instances(name)),
      ...is("Start after…", () => this.after(name)),
      ...is("Start independently of…", () => this.independently(name), one.after.length > 0),
      ...is("Interfaces of its component…", () => this.interfaces(one.component), Boolean(one.component)),
      ...is("Rename…", () => this.rename(one.entry)),
      ...is("Remove…", () => this.remove(name)),
    ];
  }

  /** Of a component of the workspace, which need not be in the network. */
  ofComponent(path: string): Action[] {
    return [
      { label: "Interfaces…", act: () => this.interfaces(path) },
      { label: "Add to the network…", act: () => this.add("", path) },
    ];
  }

  /** The members of an include are those of its document. */
  ofGroup(name: string): Action[] {
    if (!this.facts.groups.find((one) => one.name === name)?.written) return [];
    return [
      { label: "Add to it…", act: () => this.group([], name) },
      { label: "Remove from it…", act: () => this.ungroup(name) },
      { label: "Rename…", act: () => this.rename(name) },
      { label: "Remove the group…", act: () => this.propose(`Remove the group ${name}`, () => ({ change: "ungroup", group: name })) },
    ];
  }

  ofHost(name: string): Action[] {
    return [
      ...this.ofNetwork(name),
      ...(this.facts.hosts.some((one) => one.name === name) ? [{ label: "Remove the host…", act: () => this.propose(`Remove the host ${name}`, () => ({ change: "remove-host", name })) }] : []),
    ];
  }

  ofNetwork(host = ""): Action[] {
    return [
      { label: "Add a component…", act: () => this.add(host) },
      { label: "Add a new component…", act: () => this.created(host) },
      { label: "Add a program…", act: () => this.program(host) },
      ...(host ? [] : [{ label: "Add a host…", act: () => this.host() }, { label: "Add a group…", act: () => this.group([]) }]),
    ];
  }

  /** Connects two processes: by a drag, both are known. */
  connect(name: string, port = "", to = ""): void {
    const one = this.facts.entry(name)!;
    const ports = to ? this.facts.matching(name, to) : one.requires;
    if (!ports.length) return;
    this.propose(`Connect ${name}`, (values) => {
      const chosen = text(values, "to");
      return chosen ? { change: "connect", entry: one.entry, port: text(values, "port"), to: chosen } : null;
    }, (values): Field[] => {
      const chosen = ports.find((each) => each.port === (text(values, "port") || port)) ?? ports[0];
      const providers = this.facts.providers(chosen.interface, one).filter((each) => each !== name);
      return [
        { name: "port", label: "It requires", kind: "choice", choices: ports.map((each) => each.port), value: chosen.port },
        { name: "to", label: "Who serves it", kind: "text", choices: providers, value: to || (providers.length === 1 ? providers[0] : chosen.to),
          hint: providers.length ? `${providers.join(", ")}, or a proxy in quotes` : `nobody serves ${chosen.interface}; a proxy in quotes?` },
      ];
    });
  }

  disconnect(name: string, port = ""): void {
    const one = this.facts.entry(name)!, ports = one.requires.filter((each) => each.to);
    this.propose(`Disconnect ${name}`, (values) => ({ change: "disconnect", entry: one.entry, port: text(values, "port") }), () => [
      { name: "port", label: "It does not use this any more", kind: "choice", choices: ports.map((each) => each.port), value: port },
    ]);
  }

  topic(name: string): void {
    const one = this.facts.entry(name)!;
    const known = (port: string) => one.topics.find((each) => each.port === port)?.topic ?? "";
    this.propose(`Topics of ${name}`, (values) => {
      const port = text(values, "port"), to = text(values, "to");
      return (to || port) === known(port) ? null : { change: "topic", entry: one.entry, port, to };
    }, (values) => {
      const chosen = one.topics.find((each) => each.port === text(values, "port")) ?? one.topics[0];
      return [
        { name: "port", label: "Publishes or subscribes to", kind: "choice", choices: one.topics.map((each) => each.port) },
        { name: "to", label: "The topic in this network", kind: "text", of: chosen.port, value: chosen.topic === chosen.port ? "" : chosen.topic, optional: true, hint: `empty: its own name, ${chosen.port}` },
      ];
    });
  }

  move(name: string, host = ""): void {
    const one = this.facts.entry(name)!;
    this.propose(`Move ${name}`, (values) => ({ change: "move", entry: one.entry, host: text(values, "host") }), () => [
      { name: "host", label: "To the host", kind: "choice", choices: this.facts.hosts.map((each) => each.name).filter((each) => each !== one.host), value: host },
    ]);
  }

  host(): void {
    this.propose("Add a host", (values) => ({
      change: "add-host", ...Object.fromEntries(["name", "address", "user", "path", "identity", "known_hosts"].map((key) => [key, text(values, key)])),
      port: Number(text(values, "port")) || null,
    }), () => [
      { name: "name", label: "Name", kind: "text", hint: this.facts.hosts.length ? "" : "the first host of the document: everything will run on it, and no longer on this machine" },
      { name: "address", label: "Address", kind: "text", hint: "a name or an IP address" },
      { name: "user", label: "User for ssh", kind: "text", optional: true, hint: "empty: your own" },
      { name: "path", label: "Folder there", kind: "text", optional: true, hint: "an absolute path; empty: the same as here" },
      { name: "port", label: "Port of ssh", kind: "number", low: 1, high: 65535, whole: true, optional: true, hint: "empty: 22, or as your ssh knows it" },
      { name: "identity", label: "Private key", kind: "text", optional: true, hint: "a file; empty: as your ssh knows it" },
      { name: "known_hosts", label: "Keys of hosts", kind: "text", optional: true, hint: "a file; empty: your known_hosts" },
    ]);
  }

  group(members: string[], group = ""): void {
    const has = new Set(this.facts.groups.find((one) => one.name === group)?.members);
    const all = [...new Set(this.facts.entries.filter((one) => !has.has(one.process)).map((one) => one.entry))];
    const entries = members.map((name) => this.facts.entry(name)?.entry ?? name);
    this.propose(group ? `Add to ${group}` : "Group", (values) => {
      const chosen = list(values, "members");
      return chosen.length ? { change: "group", group: text(values, "group"), members: chosen } : null;
    }, () => [
      { name: "group", label: "Group", kind: "text", choices: this.facts.groups.filter((one) => one.written).map((one) => one.name), value: group },
      { name: "members", label: "Members to add", kind: "many", choices: all, value: entries },
    ]);
  }

  ungroup(name: string): void {
    const members = this.facts.groups.find((one) => one.name === name)?.members ?? [];
    const entries = [...new Set(members.map((one) => this.facts.entry(one)?.entry ?? one))];
    this.propose(`Remove from ${name}`, (values) => {
      const chosen = list(values, "members");
      return chosen.length ? { change: "ungroup", group: name, members: chosen } : null;
    }, () => [{ name: "members", label: "Members that leave", kind: "many", choices: entries }]);
  }

  add(host = "", path = ""): void {
    const known = this.facts.components.map((one) => one.path);
    this.propose("Add a component", (values) => {
      const entry = text(values, "entry");
      return entry ? { change: "add", entry, component: text(values, "component"), host: text(values, "host") } : null;
    }, (values) => {
      const wanted = text(values, "component") || path;
      const chosen = this.facts.components.find((one) => one.path === wanted) ?? this.facts.components[0];
      return [
        { name: "component", label: "Component", kind: "choice", choices: known, value: wanted },
        { name: "entry", label: "Its name here", kind: "text", value: chosen && free(chosen.name, this.facts) },
        ...this.hosts(host),
      ];
    });
  }

  /** A component that does not exist yet: its documents are written, too. */
  created(host = ""): void {
    const names = (isTopic: boolean) => this.facts.interfaces.filter(([, topic]) => topic === isTopic).map(([name]) => name);
    this.propose("Add a new component", (values) => {
      const component = text(values, "component"), entry = text(values, "entry");
      if (!component || !entry) return null;
      const lists = Object.fromEntries(["implements", "requires", "publishes", "subscribes"].map((key) => [key, list(values, key)]));
      return { change: "add-new", entry, component, language: text(values, "language"), host: text(values, "host"), ...lists };
    }, () => [
      { name: "component", label: "Name of the component", kind: "text" },
      { name: "entry", label: "Its name here", kind: "text" },
      { name: "language", label: "Language", kind: "choice", choices: ["python", "cpp", "java"] },
      ...this.hosts(host),
      ...(names(false).length ? [["implements", "It implements"], ["requires", "It requires"]] : []).map(([name, label]): Field => ({ name, label, kind: "many", choices: names(false) })),
      ...(names(true).length ? [["publishes", "It publishes"], ["subscribes", "It subscribes to"]] : []).map(([name, label]): Field => ({ name, label, kind: "many", choices: names(true) })),
    ]);
  }

  program(host = ""): void {
    this.propose("Add a program", (values) => {
      const words = wordsOf(text(values, "program")), entry = text(values, "entry");
      return entry && words[0] ? { change: "add", entry, program: words[0], args: words.slice(1), host: text(values, "host") } : null;
    }, () => [
      { name: "program", label: "Program and arguments", kind: "text", hint: "quotes keep an argument together: sh -c 'sleep 1; exit 3'" },
      { name: "entry", label: "Its name here", kind: "text" },
      ...this.hosts(host),
    ]);
  }

  private hosts(host: string): Field[] {
    if (!this.facts.hosts.length) return [];
    return [{ name: "host", label: "Host", kind: "choice", choices: this.facts.hosts.map((one) => one.name), value: host }];
  }

  rename(name: string): void {
    this.propose(`Rename ${name}`, (values) => {
      const to = text(values, "name");
      return to && to !== name ? { change: "rename", entry: name, name: to } : null;
    }, () => [{ name: "name", label: "New name", kind: "text", value: name }]);
  }

  remove(name: string): void {
    const entry = this.facts.entry(name)!.entry;
    this.propose(`Remove ${entry}`, () => ({ change: "remove", entry }));
  }

  port(name: string): void {
    const one = this.facts.entry(name)!;
    this.propose(`Port of ${name}`, (values) => {
      const number = text(values, "number"), now = one.serves.find((each) => each.port === text(values, "interface"))?.number;
      return number === String(now ?? "") ? null : { change: "port", entry: one.entry, number: number ? Number(number) : null, interface: text(values, "interface") };
    }, (values) => {
      const chosen = one.serves.find((each) => each.port === text(values, "interface")) ?? one.serves[0];
      return [
        { name: "interface", label: "Interface", kind: "choice", choices: one.serves.map((each) => each.port) },
        { name: "number", label: "TCP port", kind: "number", low: 1, high: 65535, whole: true, optional: true, of: chosen.port,
          value: String(chosen.number ?? ""), hint: one.component ? "empty: rcyaml chooses it" : "" },
      ];
    });
  }

  instances(name: string): void {
    const one = this.facts.entry(name)!;
    this.propose(`Instances of ${one.entry}`, (values) => ({ change: "instances", entry: one.entry, count: Number(text(values, "count")) }), () => [
      { name: "count", label: "Number of processes", kind: "number", low: 1, whole: true, value: String(one.instances ?? 1) },
    ]);
  }

  after(name: string): void {
    const one = this.facts.entry(name)!;
    const others = this.facts.named(one).map((each) => each.entry), already = one.after.map((each) => `${one.scope}${each}`);
    if (!one.scope) others.push(...this.facts.services, ...this.facts.groups.map((each) => each.name));
    const all = [...new Set(others)].filter((each) => each !== one.entry && !already.includes(each));
    this.order(`When ${name} starts`, "after", one.entry, "It starts when these are ready", all);
  }

  independently(name: string): void {
    const one = this.facts.entry(name)!;
    this.order(`When ${name} starts`, "not-after", one.entry, "It does not wait for these any more", one.after);
  }

  private order(title: string, change: string, entry: string, label: string, choices: string[]): void {
    this.propose(title, (values) => {
      const needed = list(values, "needed");
      return needed.length ? { change, entry, needed } : null;
    }, () => [{ name: "needed", label, kind: "many", choices }]);
  }

  async set(name: string, parameter = ""): Promise<void> {
    const one = this.facts.entry(name)!, { parameters } = await process(this.path(), name);
    if (!parameters.length) {
      dialog(`Set a parameter of ${name}`, element("p", "It has no parameters, or their document has errors."));
      return;
    }
    const of = (values: Values): Parameter => parameters.find((each) => each.path === (text(values, "parameter") || parameter)) ?? parameters[0];
    this.propose(`Set a parameter of ${name}`, (values) => {
      const chosen = of(values);
      const value = values.own === true ? null : valueOf(chosen, values[`value ${chosen.path}`]);
      if (chosen.secret && value === "") return null; // its value is not shown: nothing was typed
      return { change: "set", entry: one.entry, parameter: chosen.path, value };
    }, (values) => {
      const chosen = of(values);
      return [
        { name: "parameter", label: "Parameter", kind: "choice", choices: parameters.map((each) => each.path), value: chosen.path },
        fieldOf(chosen, `value ${chosen.path}`, "Value", chosen.present ?? chosen.default),
        { name: "own", label: "The value of the component's own configuration instead", kind: "check" },
      ];
    });
  }

  /** What a component implements, requires, publishes and subscribes to: in its own document. */
  interfaces(component: string): void {
    const known = this.facts.components.find((each) => each.path === component);
    const keys = ["implements", "requires", "publishes", "subscribes"] as const;
    if (!known) return;
    this.propose(`Interfaces of ${known.name}`, (values) => {
      const chosen = list(values, "interfaces"), change = { implements: "implement", requires: "require", publishes: "publish", subscribes: "subscribe" }[text(values, "key")];
      return chosen.length && change ? { change: values.remove === true ? `un${change}` : change, interface: chosen } : null;
    }, (values) => {
      const key = (text(values, "key") || "requires") as (typeof keys)[number], isTopic = key === "publishes" || key === "subscribes";
      const all = this.facts.interfaces.filter(([, topic]) => topic === isTopic).map(([name]) => name);
      return [
        { name: "key", label: "It", kind: "choice", choices: [...keys], value: key },
        { name: "remove", label: "not any more", kind: "check" },
        { name: "interfaces", label: isTopic ? "Topics" : "Interfaces", kind: "many", choices: values.remove === true ? known[key] : all.filter((name) => !known[key].includes(name)) },
      ];
    }, component);
  }
}

/** The words of a command line, with quotes as a shell has them. */
function wordsOf(line: string): string[] {
  const words: string[] = [];
  let word: string | null = null, quote = "";
  for (let at = 0; at < line.length; at += 1) {
    const one = line[at];
    if (one === "\\" && quote !== "'" && at + 1 < line.length) word = (word ?? "") + line[at += 1];
    else if (quote ? one === quote : one === "'" || one === '"') [quote, word] = [quote ? "" : one, word ?? ""];
    else if (!quote && /\s/.test(one)) {
      if (word !== null) words.push(word);
      word = null;
    } else word = (word ?? "") + one;
  }
  if (quote) throw new Error(`a ${quote} is not closed`);
  return word === null ? words : [...words, word];
}

/** A name that no entry has. */
function free(name: string, facts: Facts): string {
  const used = new Set(facts.entries.flatMap((one) => [one.process, one.entry])), base = name.replace(/Comp$/, "").toLowerCase();
  let made = base;
  for (let at = 2; used.has(made); at += 1) made = `${base}${at}`;
  return made;
}
