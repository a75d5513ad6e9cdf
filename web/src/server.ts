// Questions to the server. Its errors have texts for people.

export class Refusal extends Error {
  constructor(message: string, readonly status: number, readonly data: Record<string, unknown>) { super(message); }
}

export async function ask<T>(path: string, body?: unknown): Promise<T> {
  const sent = body === undefined ? {} : { method: "POST", body: JSON.stringify(body) };
  const answer = await fetch(`api/${path}`, sent);
  const isData = answer.headers.get("content-type")?.includes("json");
  const data = isData ? await answer.json() : { error: await answer.text() };
  if (!answer.ok) throw new Refusal(String(data.error), answer.status, data);
  return data as T;
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
