// The lines of the picture. They are painted as rectangles, which is fast without a graphics card.

import { Edge, Model, Placed } from "./model";

export const FAINT = 0.16;
const FAR = 0.3;

/** Where and how they are painted: `x` and `y` are the corner of the picture on the canvas. */
export interface View {
  context: CanvasRenderingContext2D; model: Model; colors: Record<string, string>; zoom: number; isFar: boolean; x: number; y: number;
  size: { width: number; height: number };
}

/** The lines, faint ones first. Their pieces are horizontal or vertical, so that they are filled as rectangles of
 * whole pixels without transparency: without a graphics card, strokes would take most of the time. */
export function lines(view: View, edges: Edge[], line: number): void {
  const { context, model, isFar, zoom, colors } = view, ratio = devicePixelRatio || 1;
  const alike = new Map<string, { edges: Edge[]; alpha: number; color: string; isChosen: boolean; isDashed: boolean }>();
  for (const edge of edges) {
    const isClear = model.selected ? touches(model, edge) : model.shows(edge.from) && model.shows(edge.to);
    const isBad = edge.faults.some((fault) => fault.severity === "error");
    const name = isBad ? "down" : edge.kind === "uses" ? "line" : edge.kind === "after" ? "soft" : "topic";
    const alpha = !isClear ? FAINT : isFar && !model.selected && !isBad ? FAR : 1;
    const isDashed = edge.kind === "after" && !isFar, isChosen = isClear && Boolean(model.selected);
    const key = `${name} ${alpha} ${isDashed} ${isChosen}`;
    const found = alike.get(key) ?? { edges: [], alpha, color: mixed(colors, name, alpha), isChosen, isDashed };
    found.edges.push(edge);
    alike.set(key, found);
  }
  const [left, top] = [-view.x / zoom, -view.y / zoom], [right, bottom] = [left + view.size.width / zoom, top + view.size.height / zoom];
  context.globalAlpha = 1;
  for (const one of [...alike.values()].sort((a, b) => a.alpha - b.alpha)) {
    const width = Math.max(1, Math.round((one.isChosen ? 2 : 1) * line * zoom * ratio));
    context.fillStyle = one.color;
    context.setTransform(1, 0, 0, 1, 0, 0);
    for (const edge of one.edges) pieces(view, edge, width, one.isDashed ? Math.round(4 * zoom * ratio) || 1 : 0);
    context.setTransform(ratio * zoom, 0, 0, ratio * zoom, ratio * view.x, ratio * view.y);
    if (isFar) continue;
    context.beginPath();
    for (const edge of one.edges) {
      // Messages flow from a topic to its subscriber, at which the line begins.
      const isBack = edge.kind === "subscribes", [x, y] = edge.points[isBack ? 0 : edge.points.length - 1], end = isBack ? x + 6 : x - 6;
      if (Math.max(x, end) < left || Math.min(x, end) > right || y < top - 4 || y > bottom + 4) continue;
      context.moveTo(x, y);
      context.lineTo(end, y - 3.5);
      context.lineTo(end, y + 3.5);
    }
    context.fill();
  }
}

/** The pieces of a line, in pixels of the screen; `dash` is the length of dashes, 0 for none. */
function pieces(view: View, edge: Edge, width: number, dash: number): void {
  const { context } = view, ratio = devicePixelRatio || 1, scale = ratio * view.zoom, half = width >> 1;
  const [wide, high] = [view.size.width * ratio, view.size.height * ratio];
  let [x, y] = [0, 0];
  edge.points.forEach((point, at) => {
    const [left, top] = [x, y];
    x = Math.round(point[0] * scale + view.x * ratio) - half;
    y = Math.round(point[1] * scale + view.y * ratio) - half;
    if (!at) return;
    const [u, v] = [Math.min(x, left), Math.min(y, top)], [w, h] = [Math.abs(x - left) + width, Math.abs(y - top) + width];
    if (u > wide || v > high || u + w < 0 || v + h < 0) return;
    if (!dash) context.fillRect(u, v, w, h);
    else if (w > h) for (let from = hidden(u, dash); from < Math.min(w, wide - u); from += 2 * dash) context.fillRect(u + from, v, Math.min(dash, w - from), width);
    else for (let from = hidden(v, dash); from < Math.min(h, high - v); from += 2 * dash) context.fillRect(u, v + from, width, Math.min(dash, h - from));
  });
}

/** A colour as it looks on the background with this transparency. */
function mixed(colors: View["colors"], name: string, alpha: number): string {
  if (alpha === 1) return colors[name];
  const [over, under] = [parts(colors[name]), parts(colors.host)];
  return `rgb(${over.map((one, at) => Math.round(one * alpha + under[at] * (1 - alpha))).join(" ")})`;
}

/** Whether a line begins or ends at what is selected, or at the closed box around it. */
function touches(model: Model, edge: Edge): boolean {
  const { selected } = model, isIt = (name: string) => name === selected || Boolean(model.nodes.get(name)?.members?.some((one) => one.name === selected));
  return isIt(edge.from) || isIt(edge.to);
}

/** How much of a dashed line is before the edge of the canvas: whole dashes. */
function hidden(from: number, dash: number): number {
  return from < 0 ? Math.floor(-from / (2 * dash)) * 2 * dash : 0;
}

/** Red, green and blue of #rgb or #rrggbb. */
function parts(color: string): number[] {
  const digits = color.slice(1), wide = digits.length === 3 ? [...digits].map((one) => one + one).join("") : digits;
  return [0, 2, 4].map((at) => parseInt(wide.slice(at, at + 2), 16));
}

const boxes = new WeakMap<Edge["points"], Placed>();

/** The box around a line. */
export function around(edge: Edge): Placed {
  const known = boxes.get(edge.points);
  if (known) return known;
  const xs = edge.points.map(([x]) => x), ys = edge.points.map(([, y]) => y), x = Math.min(...xs), y = Math.min(...ys);
  const made = { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
  boxes.set(edge.points, made);
  return made;
}
