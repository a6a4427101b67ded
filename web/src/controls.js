// Pointer, wheel, touch and keys on one view: turning, moving, zooming, hovering and clicking.

const CLICK = 4; // pixels that a click may move

/**
 * Calls `on.hover(i, vertex)`, `on.click(i, vertex, event, grabbed)` and, where `on.grab(i, x, y)` answers something other
 * than null, `on.drag(i, vertex, grabbed, event)` while it is dragged and `on.drop(i, grabbed)` at the end.
 */
export function attach(stage, i, on) {
  const box = stage.views[i].box;
  const touches = new Map();
  let start = null, grabbed = null, waiting = null;

  const spread = () => {
    const [a, b] = [...touches.values()];
    return { size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };

  // One pick a frame, of the latest position only.
  const hover = (x, y) => {
    if (!waiting) {
      requestAnimationFrame(() => {
        const at = waiting;
        waiting = null;
        if (at && !at.gone) on.hover(i, stage.pick(i, at.x, at.y));
      });
    }
    waiting = { x, y };
  };

  box.addEventListener("pointerdown", (event) => {
    box.setPointerCapture(event.pointerId);
    touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (touches.size > 1) {
      start = grabbed = null;
      return;
    }
    start = { x: event.clientX, y: event.clientY, moved: false, button: event.button };
    grabbed = event.button === 0 && on.grab ? on.grab(i, event.clientX, event.clientY) : null;
  });

  box.addEventListener("pointermove", (event) => {
    const last = touches.get(event.pointerId);
    if (!last) {
      hover(event.clientX, event.clientY);
      return;
    }
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    const before = touches.size === 2 ? spread() : null;
    touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (before) {
      const after = spread();
      stage.zoom(i, after.size / Math.max(before.size, 1));
      stage.shift(i, after.x - before.x, after.y - before.y);
      return;
    }
    if (!start) return;
    start.moved ||= Math.hypot(event.clientX - start.x, event.clientY - start.y) > CLICK;
    if (!start.moved) return;
    if (grabbed !== null) {
      const vertex = stage.pick(i, event.clientX, event.clientY);
      if (vertex >= 0) on.drag(i, vertex, grabbed, event);
    } else if (start.button !== 0 || event.shiftKey) {
      stage.shift(i, dx, dy);
    } else {
      stage.rotate(i, dx * 0.008, dy * 0.008);
    }
  });

  const end = (event) => {
    touches.delete(event.pointerId);
    if (start && event.type === "pointerup") {
      if (grabbed !== null && start.moved) on.drop(i, grabbed);
      else if (!start.moved && start.button === 0) {
        on.click(i, stage.pick(i, event.clientX, event.clientY), event, grabbed);
      }
    }
    start = grabbed = null;
  };
  box.addEventListener("pointerup", end);
  box.addEventListener("pointercancel", end);
  box.addEventListener("pointerleave", () => {
    if (waiting) waiting.gone = true;
    if (!touches.size) on.hover(i, -1);
  });
  box.addEventListener("contextmenu", (event) => event.preventDefault());
  box.addEventListener("wheel", (event) => {
    event.preventDefault();
    stage.zoom(i, Math.exp(-Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * 0.0016));
  }, { passive: false });

  const step = Math.PI / 36;
  const keys = {
    ArrowLeft: () => stage.rotate(i, -step, 0),
    ArrowRight: () => stage.rotate(i, step, 0),
    ArrowUp: () => stage.rotate(i, 0, -step),
    ArrowDown: () => stage.rotate(i, 0, step),
    q: () => stage.rotate(i, 0, 0, step),
    e: () => stage.rotate(i, 0, 0, -step),
    "+": () => stage.zoom(i, 1.15),
    "=": () => stage.zoom(i, 1.15),
    "-": () => stage.zoom(i, 1 / 1.15),
    Enter: () => {
      const { left, top, width, height } = box.getBoundingClientRect();
      on.click(i, stage.pick(i, left + width / 2, top + height / 2), null);
    },
    Escape: () => on.click(i, -1, null),
  };
  box.addEventListener("keydown", (event) => {
    const does = keys[event.key] ?? keys[event.key.toLowerCase()];
    if (!does || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    does();
  });
}
