// Questions to the server. Its errors have texts for people.

export class Refusal extends Error {
  constructor(message: string, readonly status: number, readonly data: Record<string, unknown>) { super(message); }
}

type Reviver = (key: string, value: unknown, context?: { source?: string }) => unknown;
const { parse, rawJSON } = JSON as unknown as { parse: (text: string, revive?: Reviver) => unknown; rawJSON?: (text: string) => unknown };
const ROUNDED = /\d{16}/; // a whole number that may have more digits than JavaScript's numbers

/** A whole number as it is spelled: JSON.stringify writes it without rounding it, where browsers can. */
export function whole(spelled: string): unknown {
  return Number.isSafeInteger(Number(spelled)) || !rawJSON || !/^-?\d+$/.test(spelled) ? Number(spelled) : rawJSON(spelled);
}

/** The data of JSON, in which long whole numbers, such as times in nanoseconds, are as `whole` has them. */
export function exact(text: string): unknown {
  if (!ROUNDED.test(text)) return parse(text);
  return parse(text, (_, value, context) => typeof value === "number" && context?.source ? Number.isInteger(value) ? whole(context.source) : value : value);
}

export async function ask<T>(path: string, body?: unknown): Promise<T> {
  const sent = body === undefined ? {} : { method: "POST", body: JSON.stringify(body) };
  const answer = await fetch(`api/${path}`, sent);
  const isData = answer.headers.get("content-type")?.includes("json"), text = await answer.text();
  const data = isData ? exact(text) as Record<string, unknown> : { error: text };
  if (!answer.ok) throw new Refusal(String(data.error), answer.status, data);
  return data as T;
}

/** Events of the server, as long as the page is seen: browsers have six connections to a server, for all tabs together,
 * so that tabs that nobody sees would take those of the one that is used. */
export class Events {
  private source: EventSource | null = null;
  private readonly handlers: [string, (event: MessageEvent<string>) => void][] = [];
  private readonly look = () => { if (document.visibilityState === "hidden") this.leave(); else this.open(); };

  constructor(private readonly address: string) {
    document.addEventListener("visibilitychange", this.look);
    this.look();
  }

  on(kind: string, handle: (event: MessageEvent<string>) => void): void {
    this.handlers.push([kind, handle]);
    this.source?.addEventListener(kind, handle as EventListener);
  }

  close(): void {
    document.removeEventListener("visibilitychange", this.look);
    this.leave();
  }

  private open(): void {
    if (this.source) return;
    this.source = new EventSource(this.address);
    for (const [kind, handle] of this.handlers) this.source.addEventListener(kind, handle as EventListener);
  }

  private leave(): void {
    this.source?.close();
    this.source = null;
  }
}

export function names(chosen: string[]): string {
  return chosen.map((name) => `name=${encodeURIComponent(name)}`).join("&");
}

/** What the server has: the commands of a deployment, by their methods and names, and what this manager may do. */
export class Abilities {
  private readonly commands = new Set<string>();
  rights: string[] = [];

  async learn(): Promise<void> {
    const { paths } = await ask<{ paths: Record<string, Record<string, unknown>> }>("openapi.json");
    for (const [path, methods] of Object.entries(paths)) {
      for (const method of Object.keys(methods)) this.commands.add(`${method} ${path.slice(path.lastIndexOf("/") + 1)}`);
    }
  }

  has(name: string, method = "get"): boolean {
    return this.commands.has(`${method} ${name}`);
  }

  may(right: string): boolean {
    return this.rights.includes(right);
  }
}
