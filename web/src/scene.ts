// The picture on the canvas: it is drawn from the model whenever something changed, at most once in a frame.

import { dragged, framed, Lifted, Rubber } from "./dragged";
import { around, FAINT, lines } from "./lines";
import { CLOSED, Edge, isInside, Look, Model, Node, Placed, SIGNS, touch } from "./model";

const MOVING = 200; // milliseconds after a move until the picture is painted anew
const MANY = 200; // nodes from which on the view moves a still picture
const READABLE = 11; // pixels of the screen
const READ = 0.9, SMALLEST = 6, MARGIN = 16, REACH = 9;
const COLORS = ["back", "text", "soft", "host", "group", "node", "frame", "line", "topic", "ready", "busy", "down", "idle", "other", "alarm", "chosen"] as const;

export type Hit = { kind: "end"; edge: Edge } | { kind: "handle" | "node"; node: Node } | { kind: "host" | "group"; name: string };

export class Scene {
  zoom = 1;
  x = 0;
  y = 0;
  drawn = 0;
  covered: () => number = () => 0; // pixels on the right, by the details
  hovered = ""; // the node under the pointer
  rubber: Rubber | null = null;
  lifted: Lifted | null = null;
  hasHandle: (name: string) => boolean = () => false;
  private dirty = false;
  private isFitted = true;
  private before: { zoom: number; x: number; y: number; isFitted: boolean } | null = null; // the view before it went to a node by itself
  private context: CanvasRenderingContext2D;
  private size = { width: 0, height: 0 }; // of what is painted
  private readonly still = document.createElement("canvas"); // the picture while the view moves
  private stillAt = { zoom: 0, x: 0, y: 0 };
  private movedAt = -MOVING;
  private settling = 0;
  private colors: Record<string, string> = {};
  private font = "";
  private readonly widths = new Map<string, number>();

  constructor(private readonly canvas: HTMLCanvasElement, readonly model: Model) {
    this.context = canvas.getContext("2d", { alpha: false })!;
    new ResizeObserver(() => this.resize()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.restyle(); this.change(); });
    this.restyle();
  }

  /** Paints the picture anew with the next frame. */
  change(): void {
    this.stillAt.zoom = 0;
    this.again();
  }

  private again(): void {
    if (this.dirty) return;
    this.dirty = true;
    requestAnimationFrame(() => { this.dirty = false; this.draw(); });
  }

  /** Reads the colours of the style, which is slow. */
  private restyle(): void {
    const style = getComputedStyle(this.canvas);
    this.colors = Object.fromEntries(COLORS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
    this.font = style.fontFamily;
    this.widths.clear();
  }

  private resize(): void {
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    if (this.isFitted) this.fit();
    this.draw();
  }

  fit(): void {
    const graph = this.model.graph;
    if (!graph || !graph.width) return;
    const { clientHeight: height } = this.canvas, width = this.canvas.clientWidth - this.covered();
    this.zoom = Math.min((width - MARGIN) / graph.width, (height - MARGIN) / graph.height, 1.6);
    this.x = (width - graph.width * this.zoom) / 2;
    this.y = (height - graph.height * this.zoom) / 2;
    this.isFitted = true;
    this.before = null;
    this.change();
  }

  pan(dx: number, dy: number): void {
    this.x += dx;
    this.y += dy;
    this.moved();
  }

  private moved(): void {
    this.isFitted = false;
    this.before = null;
    this.movedAt = performance.now();
    this.again();
    clearTimeout(this.settling);
    this.settling = window.setTimeout(() => this.again(), MOVING);
  }

  zoomAt(factor: number, x: number, y: number): void {
    const zoom = Math.min(Math.max(this.zoom * factor, 0.02), 4);
    this.x = x - (x - this.x) * zoom / this.zoom;
    this.y = y - (y - this.y) * zoom / this.zoom;
    this.zoom = zoom;
    this.moved();
  }

  /** Moves the picture so that a node is seen, and if wanted, its texts are read. */
  show(name: string, isRead = false): void {
    const node = this.model.nodes.get(name);
    if (!node) return;
    const { x, y, zoom, isFitted } = this, before = this.before ?? { x, y, zoom, isFitted };
    if (isRead && this.isFar) this.zoomAt(READ / this.zoom, this.x + node.x * this.zoom, this.y + node.y * this.zoom);
    // No further than necessary, so that what is around it stays in view.
    const hidden = (from: number, size: number, room: number) => Math.min(0, room - MARGIN - from - size) || Math.max(0, MARGIN - from);
    const width = this.canvas.clientWidth - this.covered(), height = this.canvas.clientHeight;
    this.x += hidden(this.x + node.x * this.zoom, node.width * this.zoom, width);
    this.y += hidden(this.y + node.y * this.zoom, node.height * this.zoom, height);
    if (this.x !== x || this.y !== y || this.zoom !== zoom) this.before = before;
    this.change();
  }

  /** To the view before it went to a node by itself, unless a person moved it since. */
  back(): void {
    if (!this.before) return;
    Object.assign(this, this.before);
    this.before = null;
    this.change();
  }

  /** Whether the texts of nodes are too small to be read. */
  get isFar(): boolean {
    return 12 * this.zoom < SMALLEST;
  }

  /** The point of the picture below a point of the canvas. */
  point(x: number, y: number): [number, number] {
    return [(x - this.x) / this.zoom, (y - this.y) / this.zoom];
  }

  /** As `fit`, unless a person chose another view. */
  refit(): void {
    if (this.isFitted) this.fit();
  }

  /** The node at a point of the canvas. */
  at(x: number, y: number): Node | undefined {
    const at = this.point(x, y);
    return this.model.graph?.nodes.find((one) => isInside(one, at));
  }

  /** What is at a point of the canvas: the end of a line, the handle of a node, a node, or the innermost box. */
  hit(x: number, y: number): Hit | null {
    const graph = this.model.graph, at = this.point(x, y), reach = REACH / this.zoom;
    if (!graph) return null;
    const near = (other: [number, number]) => Math.hypot(at[0] - other[0], at[1] - other[1]) <= reach;
    const withHandle = this.isFar ? undefined : graph.nodes.find((one) => this.showsHandle(one) && near(handle(one)));
    if (withHandle) return { kind: "handle", node: withHandle };
    const edge = this.isFar ? undefined : graph.edges.find((one) => {
      const [px, py] = one.points[one.points.length - 1];
      return at[0] >= px - 2 * reach && at[0] <= px && Math.abs(at[1] - py) <= reach / 1.5;
    });
    const node = graph.nodes.find((one) => isInside(one, at));
    if (edge && !node) return { kind: "end", edge };
    if (node) return { kind: "node", node };
    const group = [...graph.groups].reverse().find((one) => isInside(one, at));
    if (group) return { kind: "group", name: group.name };
    const host = graph.hosts.find((one) => one.width && isInside(one as Placed, at));
    return host ? { kind: "host", name: host.name } : null;
  }

  private showsHandle(node: Node): boolean {
    return (node.name === this.hovered || node.name === this.model.selected) && this.hasHandle(node.name);
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.drawn += 1;
    const isMoving = performance.now() - this.movedAt < MOVING && !this.rubber && !this.lifted;
    if (isMoving && (this.model.graph?.nodes.length ?? 0) >= MANY) this.drawStill(width, height);
    else {
      this.size = { width, height };
      this.paint();
    }
  }

  /** Shows the still picture where it is now, which is much faster than to paint. It is twice as wide and high as the
   * view, and painted again when the view leaves it, or something else changed. */
  private drawStill(width: number, height: number): void {
    const { context, still } = this, ratio = devicePixelRatio || 1;
    const place = () => {
      const scale = this.zoom / this.stillAt.zoom;
      return { scale, left: this.x - this.stillAt.x * scale, top: this.y - this.stillAt.y * scale };
    };
    let at = place();
    const isOutside = at.left > 0 || at.top > 0 || at.left + 2 * width * at.scale < width || at.top + 2 * height * at.scale < height;
    if (!this.stillAt.zoom || at.scale > 1.5 || isOutside || still.width !== 2 * this.canvas.width || still.height !== 2 * this.canvas.height) {
      if (still.width !== 2 * this.canvas.width) still.width = 2 * this.canvas.width;
      if (still.height !== 2 * this.canvas.height) still.height = 2 * this.canvas.height;
      const { x, y } = this;
      [this.x, this.y, this.context] = [x + width / 2, y + height / 2, still.getContext("2d", { alpha: false })!];
      this.size = { width: 2 * width, height: 2 * height };
      this.paint();
      this.stillAt = { zoom: this.zoom, x: this.x, y: this.y };
      [this.x, this.y, this.context] = [x, y, context];
      at = place();
    }
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 1;
    context.imageSmoothingEnabled = at.scale !== 1;
    context.drawImage(still, Math.round(at.left * ratio), Math.round(at.top * ratio), still.width * at.scale, still.height * at.scale);
  }

  private paint(): void {
    const { context, model, zoom, colors } = this;
    const graph = model.graph, ratio = devicePixelRatio || 1;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = colors.back;
    context.globalAlpha = 1;
    context.fillRect(0, 0, this.size.width * ratio, this.size.height * ratio);
    if (!graph) return;
    context.setTransform(ratio * zoom, 0, 0, ratio * zoom, ratio * this.x, ratio * this.y);
    const line = Math.max(1, 1 / zoom);
    context.textBaseline = "alphabetic";
    const frame = (box: Placed, fill: string, title: string, size: number) => {
      framed(context, box, fill, colors.frame, line);
      if (size * zoom < SMALLEST) return;
      context.font = `${this.size12(title, box.width - 12)}px ${this.font}`;
      context.fillStyle = colors.soft;
      context.fillText(title, box.x + 8, box.y + 15);
    };
    for (const host of graph.hosts) if (host.width) frame(host as Placed, colors.host, host.title, 12);
    for (const group of graph.groups) frame(group, colors.group, group.name, 12);
    context.lineJoin = "round";
    const [left, top] = this.point(0, 0), [right, bottom] = this.point(this.size.width, this.size.height);
    const isSeen = (box: Placed) => box.x <= right && box.y <= bottom && box.x + box.width >= left && box.y + box.height >= top;
    const { isFar, size, x, y } = this;
    lines({ context, model, colors, zoom, isFar, size, x, y }, graph.edges.filter((edge) => isSeen(around(edge))), line);
    this.nodes(graph.nodes.filter(isSeen), line);
    context.globalAlpha = 1;
    if (this.isFar) this.far([...graph.hosts.map((host) => [host, host.title]), ...graph.groups.map((group) => [group, group.name])] as [Placed, string][]);
    dragged({ context, model, colors, font: this.font }, this.lifted, this.rubber, line);
  }

  /** The names of hosts and groups from afar, where the texts of their boxes are too small: as long as there is room.
   * One that would be on another is on its right. */
  private far(boxes: [Placed, string][]): void {
    const { context, zoom, colors } = this, size = 12 / zoom, height = size * 1.35, said: Placed[] = [];
    context.font = `600 ${size}px ${this.font}`;
    for (const [box, title] of boxes) {
      if (!box.width || 2 * size > box.height) continue;
      const label = { x: box.x + size / 3, y: box.y + 22 - height, width: context.measureText(title).width + size / 2, height }; // above the first nodes
      for (let other; (other = said.find((one) => touch(one, label)));) label.x = other.x + other.width + size / 3;
      if (label.x + label.width > box.x + box.width) continue;
      said.push(label);
      context.globalAlpha = 0.85;
      context.fillStyle = colors.back;
      context.fillRect(label.x, label.y, label.width, height);
      context.globalAlpha = 1;
      context.fillStyle = colors.text;
      context.fillText(title, label.x + size / 6, label.y + size);
    }
  }

  /** The nodes: from afar, all blocks of a colour at once. */
  private nodes(nodes: Node[], line: number): void {
    if (!this.isFar) {
      for (const node of nodes) this.node(node, line);
      return;
    }
    const { context, model, colors } = this, alike = new Map<string, { look: Look; alpha: number; nodes: Node[] }>();
    for (const node of nodes) {
      const look = model.look(node.name), alpha = model.isClear(node.name) ? 1 : FAINT * 1.6, key = `${look} ${alpha}`;
      const found = alike.get(key) ?? { look, alpha, nodes: [] };
      found.nodes.push(node);
      alike.set(key, found);
    }
    for (const one of alike.values()) {
      context.globalAlpha = one.alpha;
      context.fillStyle = one.look === "other" ? colors.node : colors[one.look];
      for (const node of one.nodes) context.fillRect(node.x, node.y, node.width, node.height);
    }
    const chosen = nodes.find((node) => this.isChosen(node));
    if (!chosen) return;
    context.globalAlpha = 1;
    context.strokeStyle = colors.chosen;
    context.lineWidth = 3 * line;
    context.strokeRect(chosen.x, chosen.y, chosen.width, chosen.height);
  }

  private isChosen(node: Node): boolean {
    const { selected } = this.model;
    return node.name === selected || Boolean(selected && node.members?.some((one) => one.name === selected));
  }

  private node(node: Node, line: number): void {
    const { context, model, zoom, colors, font } = this;
    const look = model.look(node.name), isChosen = this.isChosen(node);
    context.globalAlpha = model.isClear(node.name) || isChosen ? 1 : FAINT * 1.6;
    framed(context, node, look === "down" ? colors.alarm : colors.node,
      isChosen ? colors.chosen : look === "down" ? colors.down : colors.frame, isChosen ? 2.5 * line : line);
    context.fillStyle = colors[look];
    if (look !== "other") context.fillRect(node.x, node.y + 6, 4, node.height - 12);
    context.textAlign = "right";
    context.font = `11px ${font}`;
    const sign = SIGNS[look] || model.rate(node), room = node.width - 24 - (sign ? this.wide(sign) : 0);
    context.fillText(sign, node.x + node.width - 6, node.y + 16);
    context.textAlign = "left";
    this.texts(node).forEach((text, at) => {
      const size = at ? 12 : 13;
      if (size * zoom < SMALLEST) return;
      context.font = at ? `${this.size12(text, node.width - 18)}px ${font}` : `600 ${size}px ${font}`;
      context.fillStyle = at ? colors.soft : colors.text;
      context.fillText(text, node.x + 12, node.y + 16 + 16 * at, at ? undefined : room);
    });
    this.use(node);
    if (!this.showsHandle(node)) return;
    const [x, y] = handle(node);
    context.beginPath();
    context.arc(x, y, 5.5, 0, 2 * Math.PI);
    context.fillStyle = colors.back;
    context.fill();
    context.strokeStyle = colors.chosen;
    context.lineWidth = 2 * line;
    context.stroke();
  }

  /** Memory and CPU of a process beside what it is, if there is room. */
  private use(node: Node): void {
    const { context } = this, all = node.kind === CLOSED ? "" : this.model.use(node.name), about = node.texts[1] ?? "";
    if (!all || 11 * this.zoom < SMALLEST) return;
    const room = node.width - 26 - this.wide(about) * this.size12(about, node.width - 18) / 12;
    const use = [all, all.split("  ")[0]].find((one) => this.wide(one) <= room);
    if (!use) return;
    context.textAlign = "right";
    context.font = `11px ${this.font}`;
    context.fillStyle = this.colors.soft;
    context.fillText(use, node.x + node.width - 6, node.y + 32);
    context.textAlign = "left";
  }

  /** The size of a text that is 12 by itself: up to an eighth more, so that it is READABLE on the screen, if there is
   * room. */
  private size12(text: string, room: number): number {
    const wanted = READABLE / this.zoom;
    if (wanted <= 12 || wanted > 13.5) return 12;
    return Math.max(12, Math.min(wanted, 12 * room / this.wide(text)));
  }

  /** The width of a text of size 12. */
  private wide(text: string): number {
    let found = this.widths.get(text);
    if (found === undefined) {
      const { font } = this.context;
      this.context.font = `12px ${this.font}`;
      found = this.context.measureText(text).width;
      this.context.font = font;
      if (this.widths.size > 20_000) this.widths.clear();
      this.widths.set(text, found);
    }
    return found;
  }

  /** The texts of a node; those of a closed box count its processes by their states. */
  private texts(node: Node): string[] {
    if (node.kind !== CLOSED) return node.texts;
    const counts = [...this.model.counts(node.members!.map((one) => one.name))].filter(([look]) => look !== "other");
    return [...node.texts.slice(0, 2), counts.map(([look, count]) => `${SIGNS[look]} ${count}`).join("  ")];
  }
}

/** Where a line to be connected begins. */
export function handle(node: Placed): [number, number] {
  return [node.x + node.width, node.y + node.height - 9];
}
