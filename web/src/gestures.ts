// What the pointer does in the picture: it moves the view, selects, connects, moves nodes, and asks for menus.

import { Edge, Node, TOPIC } from "./model";
import { handle, Hit, Scene } from "./scene";

export interface Deeds {
  canEdit: boolean;
  canPlace: boolean; // positions are kept
  select(name: string): void;
  ask(hit: Hit | null, x: number, y: number): void;
  toggle(kind: "host" | "group", name: string): void;
  targets(source: string): Set<string>; // who could serve it
  connect(source: string, target: string): void;
  reconnect(edge: Edge, target: string | null): void; // null: disconnect
  move(name: string, host: string): void;
  place(name: string, x: number, y: number): Promise<void>;
}

const STILL = 4; // pixels that a click may move

type Drag = { kind: "view" } | { kind: "line"; source: string; edge: Edge | null } | { kind: "node"; node: Node };

export function gestures(canvas: HTMLCanvasElement, scene: Scene, deeds: Deeds): void {
  let last: { x: number; y: number } | null = null, begin = { x: 0, y: 0 }, moved = 0, drag: Drag = { kind: "view" };

  const what = (x: number, y: number): Drag => {
    const hit = scene.hit(x, y);
    if (deeds.canEdit && hit?.kind === "handle") return { kind: "line", source: hit.node.name, edge: null };
    if (deeds.canEdit && hit?.kind === "end" && hit.edge.kind === "uses") return { kind: "line", source: hit.edge.from, edge: hit.edge };
    const isFree = hit?.kind === "node" && !scene.isFar && (deeds.canPlace || (deeds.canEdit && hit.node.kind !== TOPIC));
    return isFree ? { kind: "node", node: hit.node } : { kind: "view" };
  };
  const follow = (x: number, y: number) => {
    const at = scene.point(x, y);
    if (drag.kind === "line") {
      const from = drag.edge ? drag.edge.points[0] : handle(scene.model.nodes.get(drag.source)!);
      scene.rubber = { from, to: at, targets: scene.rubber?.targets ?? deeds.targets(drag.source) };
    } else if (drag.kind === "node") {
      const from = scene.point(begin.x, begin.y);
      scene.lifted = { node: drag.node, dx: at[0] - from[0], dy: at[1] - from[1] };
    }
    scene.change();
  };
  /** Does what was dragged. Returns whether the node stays lifted until it has its new place. */
  const drop = (x: number, y: number): boolean => {
    const target = scene.at(x, y)?.name ?? null;
    if (drag.kind === "line") {
      const isPossible = target !== null && scene.rubber?.targets.has(target);
      if (drag.edge && target !== drag.edge.to && (isPossible || target === null)) deeds.reconnect(drag.edge, target);
      else if (!drag.edge && isPossible) deeds.connect(drag.source, target!);
    } else if (drag.kind === "node" && scene.lifted) {
      const { node, dx, dy } = scene.lifted, [px, py] = scene.point(x, y);
      const host = scene.model.graph!.hosts.find((one) => one.width && px >= one.x! && px <= one.x! + one.width && py >= one.y! && py <= one.y! + one.height!);
      if (deeds.canEdit && host && host.name !== node.host && node.kind !== TOPIC) deeds.move(node.name, host.name);
      else if (deeds.canPlace) void deeds.place(node.name, Math.round(node.x + dx), Math.round(node.y + dy)).then(end);
      return deeds.canPlace && host?.name === node.host;
    }
    return false;
  };
  const end = () => {
    last = scene.rubber = scene.lifted = null;
    scene.change();
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    last = begin = { x: event.offsetX, y: event.offsetY };
    moved = 0;
    drag = what(begin.x, begin.y);
  });
  canvas.addEventListener("pointermove", (event) => {
    const { offsetX: x, offsetY: y } = event;
    if (!last) {
      const hit = scene.hit(x, y), name = hit && "node" in hit ? hit.node.name : "";
      const cursor = !hit || hit.kind === "host" || hit.kind === "group" ? "grab" : hit.kind === "node" ? "pointer" : deeds.canEdit ? "crosshair" : "grab";
      if (canvas.style.cursor !== cursor) canvas.style.cursor = cursor;
      if (name !== scene.hovered) {
        scene.hovered = name;
        scene.change();
      }
      return;
    }
    const [dx, dy] = [x - last.x, y - last.y];
    moved += Math.abs(dx) + Math.abs(dy);
    last = { x, y };
    if (moved <= STILL) return;
    if (drag.kind === "view") scene.pan(dx, dy);
    else follow(x, y);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (last && moved <= STILL) deeds.select(scene.at(event.offsetX, event.offsetY)?.name ?? "");
    else if (last && drop(event.offsetX, event.offsetY)) {
      last = null;
      return;
    }
    end();
  });
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("dblclick", (event) => {
    const hit = scene.hit(event.offsetX, event.offsetY);
    if (hit?.kind === "host" || hit?.kind === "group") deeds.toggle(hit.kind, hit.name);
    else if (hit?.kind === "node" && hit.node.members) {
      const [kind, name] = box(hit.node);
      deeds.toggle(kind, name);
    }
  });
  canvas.addEventListener("contextmenu", (event) => {
    event.preventDefault();
    deeds.ask(scene.hit(event.offsetX, event.offsetY), event.clientX, event.clientY);
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    scene.zoomAt(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), event.offsetX, event.offsetY);
  }, { passive: false });
  window.addEventListener("keydown", (event) => { if (event.key === "Escape" && last) end(); });
}

/** The box that a node stands for while it is closed: its name is `host NAME` or `group NAME@HOST`. */
export function box(node: Node): ["host" | "group", string] {
  const [kind, ...name] = node.name.split(" ");
  return [kind as "host", name.join(" ").replace(/@.*/, "")];
}
