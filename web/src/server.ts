// Questions to the server. Its errors have texts for people.

export class Refusal extends Error {
  constructor(message: string, readonly data: Record<string, unknown>) { super(message); }
}

export async function ask<T>(path: string, body?: unknown): Promise<T> {
  const sent = body === undefined ? {} : { method: "POST", body: JSON.stringify(body) };
  const answer = await fetch(`api/${path}`, sent);
  const isData = answer.headers.get("content-type")?.includes("json");
  const data = isData ? await answer.json() : { error: await answer.text() };
  if (!answer.ok) throw new Refusal(String(data.error), data);
  return data as T;
}

export function names(chosen: string[]): string {
  return chosen.map((name) => `name=${encodeURIComponent(name)}`).join("&");
}
