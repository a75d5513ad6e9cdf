// A document as text beside the picture: with the diagnostics and the completion of rcyaml, and each side following
// the other. It is bundled apart, because it is most of the page.

import { autocompletion, closeBrackets, CompletionContext, completionKeymap, CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { HighlightStyle, ensureSyntaxTree, indentUnit, syntaxHighlighting, syntaxTree } from "@codemirror/language";
import { Diagnostic, forceLinting, linter, lintGutter, lintKeymap } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { Annotation, EditorState, StateEffect, StateField, Text } from "@codemirror/state";
import { Decoration, DecorationSet, drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers, tooltips } from "@codemirror/view";
import { SyntaxNode } from "@lezer/common";
import { tags } from "@lezer/highlight";
import { button, buttons, dialog, element, Message, messages } from "./dom";
import { versions } from "./edit";
import { Facts } from "./facts";
import type { Graph } from "./model";
import { Abilities, ask, Refusal } from "./server";

interface Document { document: string; version: string; text: string; diagnostics: Located[] }
interface Theirs { theirs: string; version: string }
interface Judged { diagnostics: Located[]; graph: Graph | null }
interface Located extends Message { line: number; column: number; end_line: number; end_column: number; hint?: string }
interface Piece { line: number; column: number; end_line: number; end_column: number; insert: string }
/** `insert` replaces the columns from `start` to `end` of the line of the cursor; `edits` are made as well. */
interface Item { label: string; detail: string; insert: string; start: number; end: number; doc?: string; edits?: Piece[] }

const byServer = Annotation.define<boolean>(), marked = StateEffect.define<{ from: number; to: number } | null>();
const WIRES = ["implements", "requires", "publishes", "subscribes"];
const PARSING = 500; // milliseconds at most, for a document that was just opened
const PAUSE = 300; // milliseconds without a key before the text is checked

const markField = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(value, transaction) {
    for (const effect of transaction.effects) {
      if (!effect.is(marked)) continue;
      if (!effect.value) return Decoration.none;
      const lines = [], { doc } = transaction.state;
      for (let at = doc.lineAt(effect.value.from).number; at <= doc.lineAt(effect.value.to).number; at += 1) lines.push(Decoration.line({ class: "marked" }).range(doc.line(at).from));
      return Decoration.set(lines);
    }
    return value.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

const colors = HighlightStyle.define([
  { tag: tags.definition(tags.propertyName), color: "var(--accent)" }, { tag: tags.propertyName, color: "var(--accent)" },
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" }, { tag: tags.string, color: "var(--ready)" },
  { tag: [tags.meta, tags.labelName, tags.keyword], color: "var(--topic)" }, { tag: tags.separator, color: "var(--soft)" },
]);

const theme = EditorView.theme({
  "&": { height: "100%", fontSize: "12.5px", color: "var(--text)", backgroundColor: "var(--back)" },
  ".cm-content": { caretColor: "var(--text)", fontFamily: "ui-monospace, 'Liberation Mono', monospace" },
  ".cm-cursor": { borderLeftColor: "var(--text)" },
  ".cm-gutters": { backgroundColor: "var(--host)", color: "var(--soft)", border: "none" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "transparent" },
  ".cm-line.marked": { backgroundColor: "var(--group)", boxShadow: "inset 3px 0 var(--chosen)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "var(--frame) !important" },
  ".cm-tooltip, .cm-panels": { backgroundColor: "var(--node)", color: "var(--text)", border: "1px solid var(--frame)" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--back)" },
  ".cm-panels .cm-textfield, .cm-panels .cm-button": { background: "var(--node)", color: "var(--text)", border: "1px solid var(--frame)", borderRadius: "5px", fontSize: "12px" },
  ".cm-panel.cm-search, .cm-panel.cm-search label": { fontSize: "12px" }, ".cm-panel.cm-search [name=close]": { color: "var(--text)" },
  ".cm-diagnostic-error": { borderLeftColor: "var(--down)" },
});

export class TextPane {
  private view: EditorView | null = null;
  private shown: Document = { document: "", version: "", text: "", diagnostics: [] };
  private readonly which = element("select", "", { "aria-label": "Document" });
  private readonly discarding = button("Discard", () => void this.discard());
  private readonly status = element("span", "", { role: "status" });
  private readonly saving = button("Save", () => void this.save());
  private readonly problem = element("p", "", { role: "alert", class: "fault", hidden: "" });
  private readonly place = element("div", "", { class: "editor" });
  private wanted = ""; // the process whose lines are marked next
  private later = ""; // the one that was selected before the first document was there
  private asked = 0;
  private isDrawn = false; // the picture is that of the unsaved text

  constructor(
    private readonly root: HTMLElement, private readonly can: Abilities, private readonly path: () => string, private readonly found: (nodes: string[]) => void,
    private readonly facts: Facts, private readonly changed: () => Promise<void>, private readonly opened: (isOpen: boolean) => void,
    private readonly drawn: (graph: Graph | null) => void, private readonly pictured: () => { closed: string[]; of: string },
  ) {
    const close = button("✕", () => this.close(), "close the document"), bar = buttons(this.which, this.saving, this.discarding, this.status);
    close.className = "close";
    this.saving.hidden = !this.mayWrite;
    root.append(close, bar, this.problem, this.place);
    this.place.attachShadow({ mode: "open" }); // its styles are allowed there, and none elsewhere
    this.which.addEventListener("change", () => void this.open(this.which.value));
  }

  private get mayWrite(): boolean {
    return this.can.may("edit") && this.can.has("write", "post");
  }

  get isChanged(): boolean {
    return this.view !== null && this.view.state.doc.toString() !== this.shown.text;
  }

  /** Whether something must wait, because the text is not saved: that is said. */
  keeps(): boolean {
    if (this.isChanged) this.complain(`${this.shown.document} is not saved`);
    return this.isChanged;
  }

  async open(document: string): Promise<void> {
    const isOther = document !== this.shown.document;
    if (isOther && this.keeps()) {
      this.which.value = this.shown.document;
      return;
    }
    this.root.hidden = false;
    this.opened(true);
    if (!isOther && this.view) {
      await this.reload();
      return;
    }
    const mine = this.asked += 1;
    const [{ documents }, read] = await Promise.all([ask<{ documents: string[] }>(`${this.path()}/documents`), this.read(document)]);
    if (mine !== this.asked || this.isChanged) return; // another one was wanted meanwhile, or this one was typed in
    this.which.replaceChildren(...documents.map((one) => element("option", one, { value: one })));
    this.which.value = document;
    this.shown = read;
    this.view?.destroy();
    this.view = this.editor(this.shown.text);
    this.say();
    if (this.later) this.mark(this.later);
    else this.remark();
  }

  close(): void {
    if (this.keeps()) return;
    this.root.hidden = true;
    this.opened(false);
    this.view?.destroy();
    this.view = null;
    this.shown.document = "";
  }

  /** Reads the document again, which has changed. What a person typed meanwhile stays. */
  async reload(): Promise<void> {
    if (!this.view) return;
    const now = await this.read(this.shown.document).catch(() => null);
    if (!now || !this.view) return;
    if (now.version === this.shown.version) {
      this.shown.diagnostics = now.diagnostics;
      forceLinting(this.view);
      return;
    }
    if (this.isChanged) {
      this.complain(`${now.document} was changed elsewhere; Save shows both versions`);
      return;
    }
    this.shown = now;
    this.replace(now.text);
    forceLinting(this.view);
    this.remark();
    this.say();
  }

  /** Marks the lines of a process, and goes there. If the document of a component is shown, it is then that of this
   * process. */
  mark(process: string): void {
    this.wanted = process;
    this.later = this.view || this.root.hidden ? "" : process;
    const component = this.facts.componentOf(process), isAbout = this.isComponent || !this.facts.entry(process);
    if (this.view && component && isAbout && component !== this.shown.document && !this.isChanged) void this.open(component);
    else this.remark();
  }

  /** Marks the lines of the process that is wanted, if the document has them. */
  remark(): void {
    const entry = this.facts.entry(this.wanted), { view } = this;
    if (!view) return;
    if (this.isComponent) {
      view.dispatch({ effects: marked.of(this.facts.componentOf(this.wanted) === this.shown.document ? this.wires() : null) });
      return;
    }
    if (entry?.document !== this.shown.document) return;
    const range = this.entries().find((one) => one.name === entry.entry);
    view.dispatch({ effects: range ? [marked.of(range), EditorView.scrollIntoView(range.from, { y: "center" })] : [marked.of(null)] });
  }

  private read(document: string): Promise<Document> {
    return ask<Document>(`${this.path()}/document?path=${encodeURIComponent(document)}`);
  }

  /** Replaces what differs, so that cursor and view stay where they are. */
  private replace(text: string): void {
    const old = this.view!.state.doc.toString();
    let from = 0, end = 0;
    while (from < Math.min(old.length, text.length) && old[from] === text[from]) from += 1;
    while (end < Math.min(old.length, text.length) - from && old[old.length - 1 - end] === text[text.length - 1 - end]) end += 1;
    this.view!.dispatch({ changes: { from, to: old.length - end, insert: text.slice(from, text.length - end) }, annotations: byServer.of(true) });
  }

  private editor(text: string): EditorView {
    const root = this.place.shadowRoot!;
    root.replaceChildren();
    return new EditorView({ root, parent: root as unknown as Element, state: EditorState.create({ doc: text, extensions: [
      lineNumbers(), history(), drawSelection(), highlightActiveLine(), highlightSelectionMatches(), closeBrackets(), search({ top: true }), EditorView.lineWrapping,
      yaml(), syntaxHighlighting(colors), indentUnit.of("  "), theme, markField, lintGutter(), tooltips({ position: "absolute" }),
      EditorState.readOnly.of(!this.mayWrite), EditorView.contentAttributes.of({ "aria-label": "text of the document", tabindex: "0" }),
      linter((view) => this.diagnostics(view), { delay: PAUSE }),
      ...(this.can.has("completion", "post") ? [autocompletion({ override: [(context) => this.complete(context)] })] : []),
      keymap.of([{ key: "Mod-s", preventDefault: true, run: () => { void this.save(); return true; } },
        ...completionKeymap, ...lintKeymap, ...searchKeymap, ...historyKeymap, ...defaultKeymap, indentWithTab,
      ]),
      EditorView.updateListener.of((update) => {
        if (update.docChanged) this.say();
        if (update.selectionSet && !update.docChanged) this.follow(update.state.selection.main.head);
      }),
    ] }) });
  }

  private get isComponent(): boolean {
    return this.facts.components.some((one) => one.path === this.shown.document);
  }

  /** The lines of a component's document that say what it is wired to. */
  private wires(): { from: number; to: number } | null {
    const found = this.pairs().filter((one) => WIRES.includes(one.name));
    return found.length ? { from: Math.min(...found.map((one) => one.from)), to: Math.max(...found.map((one) => one.to)) } : null;
  }

  /** The cursor is in an entry, or in the document of a component: its process is selected. */
  private follow(at: number): void {
    if (this.isComponent) {
      const processes = this.facts.entries.filter((one) => one.component === this.shown.document).map((one) => one.process);
      const components = this.facts.components.filter((one) => one.path === this.shown.document).flatMap((one) => [one.name, one.path]);
      this.found([...processes, ...components]);
      return;
    }
    const entry = this.entries().find((one) => one.from <= at && at <= one.to);
    this.view!.dispatch({ effects: marked.of(entry ?? null) });
    if (!entry) return;
    const process = this.facts.entries.find((one) => one.entry === entry.name && one.document === this.shown.document);
    if (process && process.process !== this.wanted) {
      this.wanted = process.process;
      this.found([process.process]);
    }
  }

  /** The entries of `components:`, where they are in the text as it is now. */
  private entries(): { name: string; from: number; to: number }[] {
    return this.pairs("components");
  }

  /** The keys of the document, or of the mapping below one of them. */
  private pairs(below = ""): { name: string; from: number; to: number }[] {
    const { state } = this.view!, top = (ensureSyntaxTree(state, state.doc.length, PARSING) ?? syntaxTree(state)).topNode.getChild("Document")?.firstChild;
    const value = (mapping: SyntaxNode | null | undefined, key: string) => pairs(mapping).find((pair) => name(pair) === key)?.lastChild;
    const name = (pair: SyntaxNode) => {
      const key = pair.getChild("Key");
      return key ? state.sliceDoc(key.from, key.to).replace(/^(["'])(.*)\1$/, "$2") : "";
    };
    return pairs(below ? value(top, below) : top).map((pair) => ({ name: name(pair), from: pair.from, to: pair.to }));
  }

  private async diagnostics(view: EditorView): Promise<Diagnostic[]> {
    const { doc } = view.state, text = doc.toString();
    let found = this.shown.diagnostics;
    if (text !== this.shown.text) found = (await this.judged(text))?.diagnostics ?? [];
    else if (this.isDrawn) await this.changed(); // as it was again
    const at = (line: number, column: number) => offset(doc, line, column);
    return found.filter((one) => !one.file || one.file === this.shown.document).map((one) => {
      const from = at(one.line, one.column);
      return {
        from, to: Math.max(at(one.end_line ?? one.line, one.end_column ?? one.column), from), severity: one.severity === "error" ? "error" : "warning",
        message: `${one.code}: ${one.message}${one.hint ? `\n${one.hint}` : ""}`,
      };
    });
  }

  /** What the server says of the unsaved text. Its picture is drawn, if the text has not changed meanwhile. */
  private async judged(text: string): Promise<Judged | null> {
    if (!this.can.has("diagnose", "post")) return null;
    const body = { path: this.shown.document, text, graph: true, ...this.pictured() };
    const found = await ask<Judged>(`${this.path()}/diagnose`, body).catch(() => null);
    if (found && this.view?.state.doc.toString() === text && text !== this.shown.text) {
      this.isDrawn = true;
      this.drawn(found.graph);
    }
    return found;
  }

  /** Draws the picture of the unsaved text; false if all is saved. */
  async draw(): Promise<boolean> {
    if (!this.isChanged || !this.can.has("diagnose", "post")) {
      this.isDrawn = false;
      return false;
    }
    return await this.judged(this.view!.state.doc.toString()) !== null;
  }

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    const { doc } = context.state, line = doc.lineAt(context.pos), before = line.text.slice(0, context.pos - line.from);
    if (!context.explicit && !/(\w|[:\-[,{]\s*)$/.test(before)) return null;
    const body = { path: this.shown.document, text: doc.toString(), line: line.number, column: [...before].length + 1 };
    const { items } = await ask<{ items: Item[] }>(`${this.path()}/completion`, body).catch(() => ({ items: [] }));
    if (!items.length) return null;
    const from = Math.min(...items.map((one) => offset(doc, line.number, one.start)));
    return { from, options: items.map((one) => ({ label: one.label, detail: one.detail, info: one.doc || undefined, apply: (view, _, __, to) => {
      const at = view.state.doc.lineAt(to), start = offset(view.state.doc, at.number, one.start);
      const others = (one.edits ?? []).map((each) => ({ from: offset(doc, each.line, each.column), to: offset(doc, each.end_line, each.end_column), insert: each.insert }));
      const changes = view.state.changes([{ from: start, to: Math.max(to, offset(doc, line.number, one.end)), insert: one.insert }, ...others]);
      view.dispatch({ changes, selection: { anchor: changes.mapPos(start, 1) }, userEvent: "input.complete" });
    } })) };
  }

  private async save(): Promise<void> {
    const { view } = this;
    if (!view || !this.mayWrite || !this.isChanged) return;
    await this.store(view.state.doc.toString(), this.shown.version, false);
  }

  private async store(text: string, version: string, force: boolean): Promise<void> {
    try {
      await this.write(text, version, force);
    } catch (error) {
      if (!(error instanceof Refusal)) this.complain((error as Error).message);
      else if (error.status === 409) this.conflict(error.message, error.data as unknown as Theirs, text);
      else if (Array.isArray(error.data.diagnostics)) this.faulty(error.data.diagnostics as Message[], text);
      else this.complain(error.message);
    }
  }

  private async write(text: string, version: string, force: boolean): Promise<void> {
    const done = await ask<{ version: string }>(`${this.path()}/write`, { path: this.shown.document, text, based_on: version, force });
    this.shown = { ...this.shown, text, version: done.version };
    this.complain("");
    this.say();
    await this.changed();
    await this.reload();
  }

  private faulty(found: Message[], text: string): void {
    const anyway = button("Save it although it has errors", () => { root.close(); void this.store(text, this.shown.version, true); });
    const root = dialog(`${this.shown.document} has errors`, messages(found), buttons(anyway, button("Back to the text", () => root.close())));
  }

  /** Somebody else changed the file: nothing is overwritten unless a person wants it. */
  private conflict(said: string, { theirs, version }: Theirs, ours: string): void {
    const take = button("Take theirs", () => { root.close(); void this.discard(); });
    const mine = button("Write mine over it", () => { root.close(); void this.store(ours, version, true); });
    const root = dialog("The file was changed elsewhere", element("p", said), versions(theirs, ours), buttons(take, mine, button("Back to the text", () => root.close())));
  }

  /** Takes the text as it is in the file. */
  private async again(): Promise<void> {
    this.shown.version = "";
    await this.reload();
    await this.changed();
  }

  private async discard(): Promise<void> {
    this.shown.text = this.view!.state.doc.toString();
    this.complain("");
    await this.again();
  }

  private complain(said: string): void {
    this.problem.hidden = !said;
    this.problem.textContent = said;
  }

  private say(): void {
    this.status.textContent = !this.mayWrite ? "read only" : this.isChanged ? "not saved" : "saved";
    this.saving.disabled = !this.isChanged;
    this.discarding.hidden = !this.mayWrite || !this.isChanged;
    if (!this.isChanged) this.complain("");
  }
}

/** The position of a line and column, which count characters from 1. */
function offset(doc: Text, line: number, column: number): number {
  const { from, text } = doc.line(Math.min(Math.max(line, 1), doc.lines));
  return from + [...text].slice(0, Math.max(column - 1, 0)).join("").length;
}

function pairs(mapping: SyntaxNode | null | undefined): SyntaxNode[] {
  return mapping && /Mapping$/.test(mapping.name) ? mapping.getChildren("Pair") : [];
}
