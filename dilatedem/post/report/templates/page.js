/* What a reader can do with two figures of the page: zoom into load histories, and see the ice move.
   Data stand in the page as JSON with base64 of little-endian numbers (dilatedem/post/pack.py). Nothing is loaded from elsewhere;
   without this script, and on paper, the figures stand as they were drawn. */
"use strict";
(() => {
  const INK = "#1d2730", GRID = "#d9dee3", BAND = "#56b4e9", LINE = "#0072b2", TOP = "#d55e00";
  const WATER = "#cfe0ec", ICE = "#ffffff", EDGE = "#42586b", STRUCTURE = "#d55e00", STRUCTURE_EDGE = "#6b2f00";
  const VIRIDIS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const FONT = "12px system-ui, 'DejaVu Sans', sans-serif";
  const NUMBERS = { f4: Float32Array, i2: Int16Array, u2: Uint16Array, u1: Uint8Array };

  const unpack = (text, kind) => new NUMBERS[kind](Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
  const digits = (value, count = 4) => String(+value.toPrecision(count)).replace("-", "−");

  /** An element with attributes, a text for its content, and the parent that it is put into. */
  function element(tag, parent, attributes = {}, text = "") {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.textContent = text;
    parent.append(made);
    return made;
  }

  function button(parent, text, label, act) {
    const made = element("button", parent, { type: "button", "aria-label": label, title: label }, text);
    made.addEventListener("click", act);
    return made;
  }

  /** Round values between two limits, about `count` of them. */
  function ticks(low, high, count) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw * 0.999);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
    return found;
  }

  /** Clear a canvas of `height` px as wide as its place, sharp on every screen; returns its context and width. */
  function prepare(canvas, height) {
    const width = canvas.clientWidth, ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.height = `${height}px`;
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = FONT;
    return [pen, width];
  }

  /** First of the ascending numbers that is above a value. */
  function above(numbers, value) {
    let low = 0, high = numbers.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (numbers[middle] > value) high = middle; else low = middle + 1;
    }
    return low;
  }

  /** Load histories: wheel and pinch zoom at the pointer, drags and arrow keys move, Home shows all. */
  function history(figure, data) {
    const LEFT = 58, RIGHT = 10, ROW = 118, HEAD = 20, FOOT = 34;
    const edges = unpack(data.edges, "f4"), first = edges[0], last = edges[edges.length - 1];
    const panels = data.panels.map((panel) => ({
      ...panel, ...Object.fromEntries(["mean", "low", "high"].filter((name) => panel[name]).map((name) => [name, unpack(panel[name], "i2")])),
    }));
    const shortest = Math.min(last - first, 4 * data.window);
    let from = first, to = last, mark = null;

    const box = element("div", figure, { class: "live", tabindex: "0", role: "group",
      "aria-label": `${figure.getAttribute("aria-label")}, to zoom into: plus and minus zoom, arrows move, Home shows all` });
    figure.prepend(box);
    const bar = element("div", box, { class: "bar" });
    const canvas = element("canvas", box, { "aria-hidden": "true" });
    const said = element("p", box, { class: "said", role: "status" });

    const place = (time) => LEFT + ((time - from) / (to - from)) * (canvas.clientWidth - LEFT - RIGHT);
    const timeAt = (x) => from + ((x - LEFT) / (canvas.clientWidth - LEFT - RIGHT)) * (to - from);

    function show(start, end) {
      const span = clamp(end - start, shortest, last - first);
      from = clamp(start + 0.5 * (end - start - span), first, last - span);
      to = from + span;
      box.dataset.from = from;
      box.dataset.to = to;
      draw();
    }
    const zoom = (factor, at = 0.5 * (from + to)) => show(at - (at - from) * factor, at + (to - at) * factor);
    const move = (share) => { const by = share * (to - from); show(clamp(from + by, first, last - to + from), clamp(to + by, first + to - from, last)); };

    /** Lowest, highest and mean of the columns k to l, of a panel in its unit. */
    function extremes(panel, k, l) {
      let low = Infinity, high = -Infinity, sum = 0;
      for (let i = k; i < l; i++) {
        low = Math.min(low, panel.low ? panel.low[i] : panel.high[i]);
        high = Math.max(high, panel.high[i]);
        if (panel.mean) sum += panel.mean[i] * (edges[i + 1] - edges[i]);
      }
      return [low * panel.scale, high * panel.scale, (sum / (edges[l] - edges[k])) * panel.scale];
    }

    /** Columns [k, l) of each pixel of the view, without those that hold none. */
    function pixels(width) {
      const found = [], count = Math.max(1, Math.floor(width - LEFT - RIGHT));
      const end = Math.min(above(edges, to), edges.length - 1);
      let k = Math.max(0, above(edges, from) - 1);
      for (let x = 1; x <= count && k < end; x++) {
        const l = Math.min(end, above(edges, from + ((to - from) * x) / count));
        if (l > k) { found.push([k, l]); k = l; }
      }
      return found;
    }

    function drawPanel(pen, width, top, panel, columns) {
      const values = columns.map(([k, l]) => extremes(panel, k, l));
      const low = Math.min(0, ...values.map((value) => value[0])), high = Math.max(0, ...values.map((value) => value[1]));
      const span = high - low || 1, bottom = top + ROW - HEAD;
      const y = (value) => bottom - 4 - ((value - low) / span) * (ROW - HEAD - 10);
      pen.fillStyle = INK;
      pen.textAlign = "left";
      pen.fillText(panel.label, LEFT, top - 5);
      pen.textAlign = "right";
      pen.textBaseline = "middle";
      pen.lineWidth = 1;
      for (const value of ticks(low, low + span, 4)) {
        pen.strokeStyle = value === 0 ? INK : GRID;
        pen.beginPath(); pen.moveTo(LEFT, y(value)); pen.lineTo(width - RIGHT, y(value)); pen.stroke();
        pen.fillText(digits(value), LEFT - 6, y(value));
      }
      pen.textBaseline = "alphabetic";
      pen.save();
      pen.beginPath(); pen.rect(LEFT, top, width - LEFT - RIGHT, ROW - HEAD); pen.clip();
      pen.fillStyle = panel.low ? BAND : TOP;
      columns.forEach(([k, l], i) => {
        const x = place(edges[k]), end = place(edges[l]), a = y(panel.low ? values[i][0] : 0), b = y(values[i][1]);
        pen.fillRect(x, b, Math.max(1, end - x), Math.max(1, a - b));
      });
      if (panel.mean) {
        pen.strokeStyle = LINE;
        pen.lineWidth = 1.3;
        pen.beginPath();
        columns.forEach(([k, l], i) => { pen.lineTo(place(edges[k]), y(values[i][2])); pen.lineTo(place(edges[l]), y(values[i][2])); });
        pen.stroke();
      }
      pen.restore();
    }

    function draw() {
      const height = panels.length * ROW + FOOT;
      const [pen, width] = prepare(canvas, height);
      if (width <= LEFT + RIGHT) return;
      const columns = pixels(width), bottom = panels.length * ROW;
      pen.textAlign = "center";
      for (const time of ticks(from, to, clamp(Math.floor(width / 110), 2, 10))) {
        pen.strokeStyle = GRID;
        pen.beginPath(); pen.moveTo(place(time), HEAD); pen.lineTo(place(time), bottom); pen.stroke();
        pen.fillStyle = INK;
        pen.fillText(String(+time.toFixed(4)), place(time), bottom + 13);
      }
      pen.fillText("Time (s)", 0.5 * (LEFT + width - RIGHT), bottom + 28);
      panels.forEach((panel, i) => drawPanel(pen, width, i * ROW + HEAD, panel, columns));
      if (mark !== null && mark >= from && mark <= to) {
        pen.strokeStyle = INK;
        pen.setLineDash([3, 3]);
        pen.beginPath(); pen.moveTo(place(mark), HEAD); pen.lineTo(place(mark), bottom); pen.stroke();
        pen.setLineDash([]);
      }
      said.textContent = mark === null
        ? `${digits(from)} to ${digits(to)} s. Orange and light blue: extremes of every time step; dark blue: mean of a window.`
        : reading(clamp(above(edges, mark) - 1, 0, edges.length - 2));
    }

    function reading(i) {
      const words = panels.map((panel) => {
        const [low, high, mean] = extremes(panel, i, i + 1), name = panel.label.replace(/ \((.*)\)/, ""), unit = panel.label.match(/\((.*)\)/)[1];
        return panel.mean ? `${name} ${digits(mean, 3)} (${digits(low, 3)} to ${digits(high, 3)}) ${unit}` : `${name} ${digits(high, 3)} ${unit}`;
      });
      return `${digits(edges[i], 6)} to ${digits(edges[i + 1], 6)} s: ${words.join("; ")}`;
    }

    button(bar, "+", "zoom in", () => zoom(0.5));
    button(bar, "−", "zoom out", () => zoom(2));
    button(bar, "←", "earlier", () => move(-0.5));
    button(bar, "→", "later", () => move(0.5));
    button(bar, "highest", "the highest load", () => { mark = data.peak - 0.5 * data.window; show(data.peak - 0.5, data.peak + 0.5); });
    button(bar, "all", "the whole time", () => { mark = null; show(first, last); });

    const keys = { "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), ArrowUp: () => zoom(0.5), ArrowDown: () => zoom(2),
      ArrowLeft: () => move(-0.2), ArrowRight: () => move(0.2), Home: () => show(first, last) };
    box.addEventListener("keydown", (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });

    const at = (event) => event.clientX - canvas.getBoundingClientRect().left;
    canvas.addEventListener("wheel", (event) => {
      const out = event.deltaY > 0;
      if (event.deltaY === 0 || (out && to - from >= last - first)) return; // all is shown: the page scrolls on
      event.preventDefault();
      zoom(out ? 1.25 : 0.8, clamp(timeAt(at(event)), from, to));
    }, { passive: false });

    const held = new Map(); // pointers that are down: where they are
    canvas.addEventListener("pointerdown", (event) => { held.set(event.pointerId, at(event)); canvas.setPointerCapture(event.pointerId); });
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, (event) => held.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => { if (!held.size) { mark = null; draw(); } });
    canvas.addEventListener("pointermove", (event) => {
      const x = at(event), before = held.get(event.pointerId);
      if (before === undefined) { mark = timeAt(x); draw(); return; }
      const other = [...held].find(([id]) => id !== event.pointerId);
      held.set(event.pointerId, x);
      if (other) { // two fingers: what is under each stays there
        const wide = Math.max(24, Math.abs(x - other[1])), was = Math.max(24, Math.abs(before - other[1]));
        zoom(was / wide, timeAt(other[1]));
      } else move((before - x) / (canvas.clientWidth - LEFT - RIGHT));
    });
    canvas.addEventListener("dblclick", () => show(first, last));
    new ResizeObserver(draw).observe(canvas);
    show(first, last);
  }

  /** The ice in plan, from snapshot to snapshot. */
  function plan(figure, data) {
    const LEFT = 40, FLOW = 24, RIGHT = 8, FOOT = 34, PACE = 100; // px; ms a picture
    const flows = Object.entries(data.flows), TOP = FLOW * Math.max(1, flows.length) - 2;
    const pictures = data.pictures.map((one) => ({ ...one, corners: unpack(one.corners, "u2"), points: unpack(one.points, "i2"), speeds: unpack(one.speeds, "u1") }));
    const [xLow, xHigh, yLow, yHigh] = data.view, [xSide, ySide] = data.sides;
    let shown = 0, timer = null;

    const box = element("div", figure, { class: "live", role: "group", "aria-label": "The ice in plan, moving" });
    figure.prepend(box);
    const bar = element("div", box, { class: "bar" });
    const play = button(bar, "▶", "play", () => (timer === null ? start() : stop()));
    const slider = element("input", bar, { type: "range", min: 0, max: pictures.length - 1, step: 1, value: 0, "aria-label": "time" });
    const told = element("output", bar);
    const label = element("label", bar), coloured = element("input", label, { type: "checkbox" });
    label.append(" speed");
    const canvas = element("canvas", box, { "aria-hidden": "true" });
    const said = element("p", box, { class: "said" });
    const count = pictures.length < data.of ? `${pictures.length} of ${data.of} snapshots.` : `${data.of} snapshots.`;
    said.textContent = count;

    function colour(share) {
      const at = clamp(share, 0, 1) * (VIRIDIS.length - 1), i = Math.min(Math.floor(at), VIRIDIS.length - 2);
      return `rgb(${VIRIDIS[i].map((from, c) => Math.round(from + (VIRIDIS[i + 1][c] - from) * (at - i))).join()})`;
    }

    /** Shifts that bring the images of an outline across periodic sides into the domain. */
    function shifts(points, start, count) {
      const found = [[0, 0]];
      [xSide, ySide].forEach(([low, high], axis) => {
        if (!data.periodic[axis]) return;
        let least = Infinity, most = -Infinity;
        for (let i = start; i < start + count; i++) {
          const value = points[2 * i + axis] * data.unit;
          least = Math.min(least, value); most = Math.max(most, value);
        }
        const by = most > high ? low - high : least < low ? high - low : 0;
        if (by) for (const shift of [...found]) found.push(axis ? [shift[0], shift[1] + by] : [shift[0] + by, shift[1]]);
      });
      return found;
    }

    function draw() {
      const wide = canvas.clientWidth - LEFT - RIGHT;
      const scale = Math.min(wide / (xHigh - xLow), 620 / (yHigh - yLow));
      if (!(scale > 0)) return;
      const height = scale * (yHigh - yLow), [pen] = prepare(canvas, height + TOP + FOOT);
      const left = LEFT + 0.5 * (wide - scale * (xHigh - xLow));
      const X = (x) => left + (x - xLow) * scale, Y = (y) => TOP + (yHigh - y) * scale;
      const one = pictures[shown], across = [data.periodic[0] ? xSide : [xLow, xHigh], data.periodic[1] ? ySide : [yLow, yHigh]];
      axes(pen, X, Y);
      pen.save();
      pen.beginPath(); pen.rect(X(across[0][0]), Y(across[1][1]), X(across[0][1]) - X(across[0][0]), Y(across[1][0]) - Y(across[1][1])); pen.clip();
      pen.fillStyle = WATER; pen.fill();
      pen.strokeStyle = EDGE; pen.lineWidth = 0.7;
      let start = 0;
      one.corners.forEach((count, floe) => {
        pen.fillStyle = coloured.checked ? colour(one.speeds[floe] / 255) : ICE;
        for (const [dx, dy] of shifts(one.points, start, count)) {
          pen.beginPath();
          for (let i = start; i < start + count; i++) pen.lineTo(X(one.points[2 * i] * data.unit + dx), Y(one.points[2 * i + 1] * data.unit + dy));
          pen.closePath(); pen.fill(); pen.stroke();
        }
        start += count;
      });
      pen.fillStyle = STRUCTURE; pen.strokeStyle = STRUCTURE_EDGE; pen.lineWidth = 1;
      for (const { outline } of one.structures || data.structures) {
        pen.beginPath(); outline.forEach(([x, y]) => pen.lineTo(X(x), Y(y))); pen.closePath(); pen.fill(); pen.stroke();
      }
      pen.restore();
      pen.strokeStyle = INK;
      drawSides(pen, data.boundaries[0], xSide.map((x) => [X(x), Y(ySide[0]), X(x), Y(ySide[1])]));
      drawSides(pen, data.boundaries[1], ySide.map((y) => [X(xSide[0]), Y(y), X(xSide[1]), Y(y)]));
      told.textContent = `${digits(one.time, 6)} s`;
      slider.value = shown;
      slider.setAttribute("aria-valuetext", told.textContent);
      box.dataset.time = one.time;
    }

    /** Two sides of the domain: full lines where walls stand, dashes where periodic, dots where ice may pass. */
    function drawSides(pen, kind, lines) {
      pen.lineWidth = kind === "wall" ? 2 : 1;
      pen.setLineDash({ wall: [], periodic: [6, 4] }[kind] || [1.5, 3]);
      for (const [x0, y0, x1, y1] of lines) { pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x1, y1); pen.stroke(); }
      pen.setLineDash([]);
    }

    /** An arrow along a velocity (u, v) about a point of the canvas. */
    function arrow(pen, x, y, u, v) {
      pen.save();
      pen.translate(x, y); pen.rotate(-Math.atan2(v, u));
      pen.strokeStyle = INK; pen.lineWidth = 1.4;
      pen.beginPath(); pen.moveTo(-13, 0); pen.lineTo(13, 0); pen.moveTo(7, -4); pen.lineTo(13, 0); pen.lineTo(7, 4); pen.stroke();
      pen.restore();
    }

    function axes(pen, X, Y) {
      pen.fillStyle = INK; pen.textAlign = "center";
      for (const x of ticks(xLow, xHigh, clamp(Math.floor((X(xHigh) - X(xLow)) / 70), 2, 8))) pen.fillText(digits(x), X(x), Y(yLow) + 15);
      pen.fillText("x (m)", X(0.5 * (xLow + xHigh)), Y(yLow) + 30);
      pen.textAlign = "right"; pen.textBaseline = "middle";
      for (const y of ticks(yLow, yHigh, clamp(Math.floor((Y(yLow) - Y(yHigh)) / 50), 2, 8))) pen.fillText(digits(y), X(xLow) - 5, Y(y));
      pen.textBaseline = "alphabetic";
      pen.textAlign = "left"; pen.fillText("y (m)", X(xLow) - 34, TOP - 9);
      pen.textAlign = "right";
      flows.forEach(([what, [u, v]], line) => {
        const below = TOP - 9 - FLOW * line;
        pen.fillText(`${what} ${digits(Math.hypot(u, v), 3)} m/s`, X(xHigh) - 44, below);
        arrow(pen, X(xHigh) - 20, below - 4, u, v);
      });
    }

    function show(k) { shown = clamp(k, 0, pictures.length - 1); draw(); }
    function stop() { clearInterval(timer); timer = null; play.textContent = "▶"; play.setAttribute("aria-label", "play"); }
    function start() {
      if (shown === pictures.length - 1) shown = 0;
      play.textContent = "❚❚"; play.setAttribute("aria-label", "pause");
      timer = setInterval(() => { if (shown < pictures.length - 1) show(shown + 1); else stop(); }, PACE);
    }
    slider.addEventListener("input", () => { stop(); show(+slider.value); });
    coloured.addEventListener("change", () => {
      draw();
      said.textContent = coloured.checked ? `Dark: at rest; yellow: ${digits(data.fastest, 3)} m/s or more.` : count;
    });
    new ResizeObserver(draw).observe(canvas);
    show(0);
  }

  const kinds = { history, plan };
  for (const figure of document.querySelectorAll("figure[data-live]")) {
    const data = JSON.parse(figure.querySelector("script[type='application/json']").textContent);
    kinds[figure.dataset.live](figure, data);
    figure.classList.add("is-live");
  }
})();
