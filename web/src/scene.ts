// The picture on the canvas: it is drawn from the model whenever something changed, at most once in a frame.

import { Edge, Model, Node, Placed, SIGNS } from "./model";

const FAINT = 0.16, FAR = 0.3, READ = 0.9, SMALLEST = 6, MARGIN = 16;

export class Scene {
  zoom = 1;
  x = 0;
  y = 0;
  drawn = 0;
  covered = 0; // pixels on the right, by the details
  private dirty = false;
  private isFitted = true;
  private readonly context: CanvasRenderingContext2D;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly model: Model) {
    this.context = canvas.getContext("2d")!;
    new ResizeObserver(() => this.resize()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.change());
  }

  change(): void {
    if (this.dirty) return;
    this.dirty = true;
    requestAnimationFrame(() => { this.dirty = false; this.draw(); });
  }

  private resize(): void {
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    if (this.isFitted) this.fit();
    this.change();
  }

  fit(): void {
    const graph = this.model.graph;
    if (!graph || !graph.width) return;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.zoom = Math.min((width - MARGIN) / graph.width, (height - MARGIN) / graph.height, 1.6);
    this.x = (width - graph.width * this.zoom) / 2;
    this.y = (height - graph.height * this.zoom) / 2;
    this.isFitted = true;
    this.change();
  }

  pan(dx: number, dy: number): void {
    this.x += dx;
    this.y += dy;
    this.isFitted = false;
    this.change();
  }

  zoomAt(factor: number, x: number, y: number): void {
    const zoom = Math.min(Math.max(this.zoom * factor, 0.02), 4);
    this.x = x - (x - this.x) * zoom / this.zoom;
    this.y = y - (y - this.y) * zoom / this.zoom;
    this.zoom = zoom;
    this.isFitted = false;
    this.change();
  }

  /** Moves the picture so that a node is seen, and if wanted, its texts are read. */
  show(name: string, isRead = false): void {
    const node = this.model.nodes.get(name);
    if (!node) return;
    if (isRead && 12 * this.zoom < SMALLEST) this.zoomAt(READ / this.zoom, this.x + node.x * this.zoom, this.y + node.y * this.zoom);
    const [left, top] = [this.x + node.x * this.zoom, this.y + node.y * this.zoom];
    const { clientWidth, clientHeight: height } = this.canvas;
    const width = clientWidth - this.covered;
    if (left < 0 || top < 0 || left + node.width * this.zoom > width || top + node.height * this.zoom > height) {
      this.pan(width / 2 - left - node.width * this.zoom / 2, height / 2 - top - node.height * this.zoom / 2);
    }
    this.change();
  }

  /** The node at a point of the canvas. */
  at(x: number, y: number): Node | undefined {
    const [px, py] = [(x - this.x) / this.zoom, (y - this.y) / this.zoom];
    return this.model.graph?.nodes.find((one) => px >= one.x && px <= one.x + one.width && py >= one.y && py <= one.y + one.height);
  }

  private draw(): void {
    const { context, model, zoom } = this;
    const graph = model.graph, ratio = devicePixelRatio || 1;
    const style = getComputedStyle(this.canvas);
    const color = (name: string) => style.getPropertyValue(`--${name}`).trim();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    if (!graph) return;
    context.setTransform(ratio * zoom, 0, 0, ratio * zoom, ratio * this.x, ratio * this.y);
    const font = style.fontFamily, line = Math.max(1, 1 / zoom);
    context.textBaseline = "alphabetic";
    const frame = (box: Placed, fill: string, title: string, size: number) => {
      this.box(box, fill, color("frame"), line);
      if (size * zoom < SMALLEST) return;
      context.font = `${size}px ${font}`;
      context.fillStyle = color("soft");
      context.fillText(title, box.x + 8, box.y + 15);
    };
    for (const host of graph.hosts) if (host.width) frame(host as Placed, color("host"), host.title, 12);
    for (const group of graph.groups) frame(group, color("group"), group.name, 12);
    context.lineJoin = "round";
    const isFar = 12 * zoom < SMALLEST;
    this.lines(graph.edges, color, line, isFar);
    const [left, top] = [-this.x / zoom, -this.y / zoom];
    const [right, bottom] = [left + this.canvas.clientWidth / zoom, top + this.canvas.clientHeight / zoom];
    for (const node of graph.nodes) {
      if (node.x > right || node.y > bottom || node.x + node.width < left || node.y + node.height < top) continue;
      this.node(node, color, font, line);
    }
    context.globalAlpha = 1;
    if (isFar) this.far([...graph.hosts.map((host) => [host, host.title]), ...graph.groups.map((group) => [group, group.name])] as [Placed, string][], color, font);
    this.drawn += 1;
  }

  /** The lines, all that look alike at once: a stroke for each would take most of the time. */
  private lines(edges: Edge[], color: (name: string) => string, line: number, isFar: boolean): void {
    const { context, model } = this;
    const alike = new Map<string, { edges: Edge[]; alpha: number; color: string; isChosen: boolean; isDashed: boolean }>();
    for (const edge of edges) {
      const isClear = model.selected ? edge.from === model.selected || edge.to === model.selected
        : model.shows(edge.from) && model.shows(edge.to);
      const isBad = edge.faults.some((fault) => fault.severity === "error");
      const name = isBad ? "down" : edge.kind === "uses" ? "line" : edge.kind === "after" ? "soft" : "topic";
      const alpha = !isClear ? FAINT : isFar && !model.selected && !isBad ? FAR : 1;
      const isDashed = edge.kind === "after", isChosen = isClear && Boolean(model.selected);
      const key = `${name} ${alpha} ${isDashed} ${isChosen}`;
      const found = alike.get(key) ?? { edges: [], alpha, color: color(name), isChosen, isDashed };
      found.edges.push(edge);
      alike.set(key, found);
    }
    for (const one of [...alike.values()].sort((a, b) => a.alpha - b.alpha)) {
      context.globalAlpha = one.alpha;
      context.strokeStyle = context.fillStyle = one.color;
      context.lineWidth = one.isChosen ? 2 * line : line;
      context.setLineDash(one.isDashed ? [4, 4] : []);
      context.beginPath();
      for (const edge of one.edges) edge.points.forEach(([x, y], at) => at ? context.lineTo(x, y) : context.moveTo(x, y));
      context.stroke();
      if (isFar) continue;
      context.beginPath();
      for (const edge of one.edges) {
        const [x, y] = edge.points[edge.points.length - 1];
        context.moveTo(x, y);
        context.lineTo(x - 6, y - 3.5);
        context.lineTo(x - 6, y + 3.5);
      }
      context.fill();
    }
    context.setLineDash([]);
  }

  /** The names of hosts and groups from afar, where the texts of their boxes are too small: as long as there is room. */
  private far(boxes: [Placed, string][], color: (name: string) => string, font: string): void {
    const { context, zoom } = this, size = 12 / zoom;
    context.font = `600 ${size}px ${font}`;
    for (const [box, title] of boxes) {
      const width = context.measureText(title).width;
      if (!box.width || width + size > box.width || 2 * size > box.height) continue;
      const top = box.y + 22 - size * 1.35; // above the first nodes
      context.globalAlpha = 0.85;
      context.fillStyle = color("back");
      context.fillRect(box.x + size / 3, top, width + size / 2, size * 1.35);
      context.globalAlpha = 1;
      context.fillStyle = color("text");
      context.fillText(title, box.x + size / 2, top + size);
    }
  }

  private node(node: Node, color: (name: string) => string, font: string, line: number): void {
    const { context, model, zoom } = this;
    const look = model.look(node.name);
    context.globalAlpha = model.isClear(node.name) ? 1 : FAINT * 1.6;
    const isFar = 13 * zoom < SMALLEST;
    const isChosen = node.name === model.selected;
    this.box(node, isFar && look !== "other" ? color(look) : look === "down" ? color("alarm") : color("node"),
      isChosen ? color("chosen") : color(look === "down" ? "down" : "frame"), isChosen ? 2.5 * line : line);
    if (isFar) return;
    context.fillStyle = color(look);
    if (look !== "other") context.fillRect(node.x, node.y + 6, 4, node.height - 12);
    context.textAlign = "right";
    context.font = `11px ${font}`;
    context.fillText(SIGNS[look], node.x + node.width - 6, node.y + 16);
    context.textAlign = "left";
    node.texts.forEach((text, at) => {
      const size = at ? 12 : 13;
      if (size * zoom < SMALLEST) return;
      context.font = `${at ? "" : "600 "}${size}px ${font}`;
      context.fillStyle = color(at ? "soft" : "text");
      context.fillText(text, node.x + 12, node.y + 16 + 16 * at);
    });
  }

  private box(box: Placed, fill: string, stroke: string, line: number): void {
    const { context } = this;
    context.beginPath();
    context.roundRect(box.x, box.y, box.width, box.height, 5);
    context.fillStyle = fill;
    context.fill();
    context.strokeStyle = stroke;
    context.lineWidth = line;
    context.stroke();
  }
}
