// Changes of documents: each is shown with its diff and its diagnostics before it is written.

import { button, buttons, dialog, diff, element, Message, messages } from "./dom";
import { Field, Form, Values } from "./form";
import { ask, Refusal } from "./server";

export type Change = { change: string } & Record<string, unknown>;
interface Revised { document: string; change: string; version: string; based_on: string; diff: string; errors: Message[]; diagnostics: Message[]; written: boolean }
export interface Proposal {
  title: string;
  fields?: (values: Values) => Field[];
  /** The change for these values; null as long as something is missing. Throws an Error with a text for people. */
  make: (values: Values) => Change | null;
  document?: string;
}

const PAUSE = 150; // milliseconds without a key before a change is shown

export class Editing {
  constructor(
    private readonly path: () => string, private readonly shown: () => { document: string; version: string },
    private readonly written: (what: string) => Promise<void>, private readonly complain: (text: string) => void,
  ) {}

  private past: string[] = []; // the documents that were changed here, the last one last
  private future: string[] = [];
  private newest = ""; // the version of the deployment's document after the last change that was made here
  private readonly replaced = new Set<string>(); // those before it, of which one may still be shown

  /** A dialog with the fields of a change, and what it would do. */
  propose(proposal: Proposal): void {
    const { document, version } = this.shown();
    new ProposalDialog(proposal, this.path(), { document, version: this.replaced.has(version) ? this.newest : version }, (done) => {
      this.past.push(done.document);
      this.future = [];
      return this.show(done);
    });
  }

  /** Until the new document is shown, a further change means it all the same: a change of one's own is no change
   * meanwhile. */
  private async show(done: Revised): Promise<void> {
    const { document, version } = this.shown();
    if (done.document === document) {
      this.replaced.add(version).add(this.newest);
      this.replaced.delete(done.version);
      this.newest = done.version;
    }
    await this.written(done.change);
    if (this.shown().version === this.newest) this.replaced.clear();
  }

  /** Undoes the last change, or makes it again: of the document that was changed last, else of the deployment's. */
  async back(way: "undo" | "redo"): Promise<void> {
    const [from, to] = way === "undo" ? [this.past, this.future] : [this.future, this.past], document = from.pop() ?? "";
    this.complain("");
    try {
      const done = await ask<Revised>(`${this.path()}/${way}`, { document });
      to.push(document);
      await this.show(done);
    } catch (error) {
      this.complain((error as Error).message);
    }
  }
}

class ProposalDialog {
  private readonly form: Form;
  private readonly preview = element("div", "", { class: "preview", "aria-live": "polite" });
  private readonly write = button("Write", () => void this.finish(false));
  private readonly force = button("Write it although it causes errors", () => void this.finish(true));
  private readonly root: HTMLDialogElement;
  private version = "";
  private asked = 0;
  private waiting = 0;

  /** `shown` is what the picture shows of the document of the deployment. */
  constructor(private readonly proposal: Proposal, private readonly path: string, private readonly shown: { document: string; version: string },
    private readonly written: (done: Revised) => Promise<void>) {
    this.document = proposal.document ?? "";
    this.form = new Form(proposal.fields ?? (() => []), () => this.later());
    this.force.hidden = true;
    this.write.className = "main";
    const close = button("Cancel", () => this.root.close());
    this.root = dialog(proposal.title, this.form.root, this.preview, buttons(this.write, this.force, close));
    this.form.root.addEventListener("submit", () => { if (!this.write.disabled) void this.finish(false); });
    const first = this.form.root.querySelector<HTMLElement>("input, select, textarea");
    (first ?? this.write).focus();
    void this.show();
  }

  private readonly document: string;

  private later(): void {
    this.write.disabled = true;
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => void this.show(), PAUSE);
  }

  private change(): Change | null {
    return this.form.isValid ? this.proposal.make(this.form.values) : null;
  }

  private async show(): Promise<void> {
    const asked = this.asked += 1;
    this.write.disabled = true;
    this.force.hidden = true;
    try {
      const change = this.change();
      if (!change) {
        this.preview.replaceChildren();
        return;
      }
      const found = await this.ask(change, false, false);
      if (asked !== this.asked) return;
      if (!this.version && found.document === this.shown.document && found.based_on !== this.shown.version) {
        this.version = this.shown.version; // the document as the picture shows it is meant: the server says what differs
        await this.show();
        return;
      }
      this.version = found.based_on; // what is written is what was shown; other documents are meant as they are now
      const news = found.diagnostics.filter((one) => found.errors.some((error) => error.code === one.code && error.message === one.message));
      const parts: Node[] = [element("h3", found.document), diff(found.diff)];
      if (!found.diff) parts.splice(1, 1, element("p", "This changes nothing."));
      if (news.length) parts.push(element("h3", "It causes errors:"), messages(news));
      this.preview.replaceChildren(...parts);
      this.write.disabled = !found.diff || news.length > 0;
      this.force.hidden = !found.diff || !news.length;
    } catch (error) {
      if (asked === this.asked) this.fail(error);
    }
  }

  private ask(change: Change, write: boolean, force: boolean): Promise<Revised> {
    return ask<Revised>(`${this.path}/edit`, { change, document: this.document, based_on: this.version, write, force });
  }

  private async finish(force: boolean): Promise<void> {
    this.write.disabled = this.force.disabled = true;
    try {
      const done = await this.ask(this.change()!, true, force);
      this.root.close();
      await this.written(done);
    } catch (error) {
      this.fail(error);
    }
    this.force.disabled = false;
  }

  private fail(error: unknown): void {
    const data = error instanceof Refusal ? error.data : {};
    if (error instanceof Refusal && error.status === 409) this.conflict(error.message, String(data.theirs), String(data.ours), String(data.version));
    else if (Array.isArray(data.diagnostics)) this.preview.replaceChildren(messages(data.diagnostics as Message[]));
    else this.refuse((error as Error).message);
  }

  private refuse(text: string): void {
    this.preview.replaceChildren(element("p", text, { class: "fault", role: "alert" }));
  }

  /** Somebody else changed the document: both versions, and the choice to make the change in theirs. */
  private conflict(text: string, theirs: string, ours: string, version: string): void {
    const again = button("Make the change in the file as it is", () => {
      this.version = version;
      void this.show();
    });
    this.preview.replaceChildren(element("p", text, { class: "fault", role: "alert" }), versions(theirs, ours), buttons(again));
    again.focus();
  }
}

/** Two versions of a document, side by side, with the lines that only one of them has. */
export function versions(theirs: string, ours: string): HTMLElement {
  const both = element("div", "", { class: "versions" });
  for (const [title, text, other, kind] of [["In the file now", theirs, ours, "removed"], ["What you meant", ours, theirs, "added"]]) {
    const others = new Set(other.split("\n")), pre = element("pre", "", { tabindex: "0", "aria-label": title });
    for (const line of text.split("\n")) pre.append(element("span", `${line}\n`, others.has(line) ? {} : { class: kind }));
    const first = pre.querySelector<HTMLElement>("[class]");
    if (first) requestAnimationFrame(() => { pre.scrollTop = first.offsetTop - pre.offsetTop - pre.clientHeight / 3; });
    const side = element("section");
    side.append(element("h3", title), pre);
    both.append(side);
  }
  return both;
}
