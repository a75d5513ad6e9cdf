// What is dragged in the picture, and the frames of its boxes.

import { Model, Node, Placed } from "./model";

/** A line to who could serve a port: these are framed. */
export interface Rubber { from: [number, number]; to: [number, number]; targets: Set<string> }
/** A node, and how far it was dragged. */
export interface Lifted { node: Node; dx: number; dy: number }
interface Where { context: CanvasRenderingContext2D; model: Model; colors: Record<string, string>; font: string }

export function framed(context: CanvasRenderingContext2D, box: Placed, fill: string, stroke: string, line: number): void {
  context.beginPath();
  context.roundRect(box.x, box.y, box.width, box.height, 5);
  context.fillStyle = fill;
  context.fill();
  context.strokeStyle = stroke;
  context.lineWidth = line;
  context.stroke();
}

export function dragged({ context, model, colors, font }: Where, lifted: Lifted | null, rubber: Rubber | null, line: number): void {
  if (lifted) {
    context.globalAlpha = 0.75;
    const { node, dx, dy } = lifted;
    framed(context, { x: node.x + dx, y: node.y + dy, width: node.width, height: node.height }, colors.node, colors.chosen, 2 * line);
    context.fillStyle = colors.text;
    context.font = `600 13px ${font}`;
    context.fillText(node.title, node.x + dx + 12, node.y + dy + 16);
    context.globalAlpha = 1;
  }
  if (!rubber) return;
  for (const name of rubber.targets) {
    const node = model.nodes.get(name)!;
    context.strokeStyle = colors.chosen;
    context.lineWidth = 2.5 * line;
    context.strokeRect(node.x - 3, node.y - 3, node.width + 6, node.height + 6);
  }
  context.strokeStyle = colors.chosen;
  context.lineWidth = 2 * line;
  context.setLineDash([6, 4]);
  context.beginPath();
  context.moveTo(...rubber.from);
  context.lineTo(...rubber.to);
  context.stroke();
  context.setLineDash([]);
}
