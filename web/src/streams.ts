// Lines that the server sends as they come: of logs, and the messages of topics.

import { button, buttons, element } from "./dom";
import { Events, exact, names } from "./server";

const LONGEST = 2000; // lines that are kept

/** A list of lines, which follows its end unless it was scrolled up. */
class Lines {
  readonly root = element("div");
  protected readonly list: HTMLPreElement;
  private search = "";
  protected readonly events: Events;

  constructor(label: string, address: string, kind: string, private readonly text: (data: never) => string) {
    this.list = element("pre", "", { tabindex: "0", role: "log", "aria-label": label, class: "lines" });
    this.root.append(this.list);
    this.events = new Events(address);
    this.events.on(kind, (event) => this.add(this.text(exact(event.data) as never)));
    // A browser that connects again gets the last lines once more.
    this.events.on("open", () => this.list.replaceChildren());
  }

  protected add(text: string): void {
    const { list } = this, isAtEnd = list.scrollTop + list.clientHeight >= list.scrollHeight - 4;
    const line = element("span", `${text}\n`);
    line.hidden = !this.has(text);
    list.append(line);
    while (list.childNodes.length > LONGEST) list.firstChild!.remove();
    if (isAtEnd) list.scrollTop = list.scrollHeight;
  }

  private has(text: string): boolean {
    return !this.search || text.toLowerCase().includes(this.search.toLowerCase());
  }

  /** Leaves the lines with a text. */
  find(search: string): void {
    this.search = search;
    for (const line of this.list.children as Iterable<HTMLElement>) line.hidden = !this.has(line.textContent!);
    this.list.scrollTop = this.list.scrollHeight;
  }

  clear(): void {
    this.list.replaceChildren();
  }

  close(): void {
    this.events.close();
  }
}

/** The logs of processes, all of the network without a name. */
export class LogLines extends Lines {
  constructor(path: string, chosen: string[], last: number) {
    const isOne = chosen.length === 1;
    super(isOne ? `log of ${chosen[0]}` : "logs", `api/${path}/log-events?last=${last}&${names(chosen)}`, "line",
      (line: { name: string; time: string; text: string }) => `${line.time.slice(11, 19)} ${isOne ? "" : `${line.name}  `}${line.text}`);
    if (isOne) this.list.id = "log";
  }
}

/** The messages of a topic. */
export class Echo extends Lines {
  constructor(path: string, topic: string) {
    super(`messages of ${topic}`, `api/${path}/topic?topic=${encodeURIComponent(topic)}`, "message",
      (one: { time: number; method: string; value: unknown; size?: number }) => `${clock(one.time)} ${one.method} ${one.size ? `${one.size} characters` : JSON.stringify(one.value)}`);
    this.events.on("storm", (event) => this.add((JSON.parse(event.data) as { text: string }).text));
    this.root.append(buttons(button("Clear", () => this.clear())));
  }
}

export function clock(seconds: number): string {
  return new Date(seconds * 1000).toLocaleTimeString("en-GB");
}
