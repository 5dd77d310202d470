// Plots of chosen columns over time: one plot for each unit, with a cursor at the instant that is shown.
(function (P) {
  "use strict";

  const COLORS = ["#4c7fd9", "#e0813c", "#36a074", "#cf5585", "#8d68cf", "#b3901f", "#25a1b5", "#80858e"];
  const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3]];  // one for each run
  const LEFT = 64, RIGHT = 14, TOP = 8, BOTTOM = 22, HEIGHT = 132;
  const MOST_LISTED = 150, CHOSEN_AT_START = 4, ZERO = 1e-12;

  class Plots {
    // on: {seek(time), changed()}
    constructor(on) {
      this.on = on;
      this.element = P.byId("plot-list");
      this.chosen = [];  // names of columns
      this.plots = [];
      this.runs = [];
      P.byId("add-curve").onclick = () => this.openList(P.byId("column-list").hidden);
      P.byId("column-search").oninput = () => this.listColumns();
      P.byId("copy-plots").onclick = (event) => this.copy(event.currentTarget);
      P.byId("column-list").addEventListener("keydown", (event) => {
        if (event.key === "Escape") { this.openList(false); P.byId("add-curve").focus(); event.stopPropagation(); }
      });
      document.addEventListener("pointerdown", (event) => {
        if (!P.byId("curve-chooser").contains(event.target)) this.openList(false);
      });
      new ResizeObserver(() => this.draw()).observe(this.element);
      window.addEventListener("themechange", () => this.draw());
    }

    setRuns(runs) {
      this.runs = runs;
      this.columns = new Map();  // name -> unit, of all runs
      for (const run of runs) for (const { name, unit } of run.picture.columns) this.columns.set(name, unit);
      this.chosen = this.chosen.filter((name) => this.columns.has(name));
      if (!this.chosen.length) this.chosen = firstColumns(runs);
      P.byId("plots").classList.toggle("empty", !this.columns.size);
      P.byId("plots-button").disabled = !this.columns.size;
      this.rebuild();
    }

    // ---------------------------------------------------------------- choosing

    openList(isOpen) {
      P.byId("column-list").hidden = !isOpen;
      P.byId("add-curve").setAttribute("aria-expanded", String(isOpen));
      if (isOpen) { this.listColumns(); P.byId("column-search").focus(); }
    }
    listColumns() {
      const words = P.byId("column-search").value.toLowerCase().split(/\s+/).filter(Boolean);
      const found = [...this.columns].filter(([name]) => words.every((word) => name.toLowerCase().includes(word)));
      const options = found.slice(0, MOST_LISTED).map(([name, unit]) => {
        const box = P.make("input", { type: "checkbox" });
        box.checked = this.chosen.includes(name);
        box.onchange = () => this.choose(name, box.checked);
        return P.make("label", { class: "option", title: name }, box,
          P.make("span", { class: "name", dir: "auto" }, ...P.breakable(name)), P.make("span", { class: "unit" }, unitText(unit)));
      });
      const rest = found.length - options.length;
      const more = rest > 0 ? `… and ${rest} more. Type to find them.` : "";
      const note = found.length ? more : "No column has such a name.";
      P.byId("column-options").replaceChildren(...options, ...(note ? [P.make("p", { class: "hint" }, note)] : []));
    }
    choose(name, isChosen) {
      this.chosen = this.chosen.filter((other) => other !== name);
      if (isChosen) this.chosen.push(name);
      this.rebuild();
    }

    // ---------------------------------------------------------------- plots

    rebuild() {
      const byUnit = new Map();
      for (const name of this.chosen) {
        const unit = this.columns.get(name);
        if (!byUnit.has(unit)) byUnit.set(unit, []);
        byUnit.get(unit).push(name);
      }
      this.plots = [...byUnit].map(([unit, names]) => this.makePlot(unit, names));
      this.element.replaceChildren(...this.plots.map((plot) => plot.element));
      P.byId("plots-empty").hidden = this.plots.length > 0;
      P.byId("copy-plots").disabled = !this.plots.length;
      this.on.changed();
    }
    makePlot(unit, names) {
      const curves = [];
      for (const name of names) {
        this.runs.forEach((run, r) => {
          const column = run.picture.columns.findIndex((other) => other.name === name);
          if (column >= 0) curves.push({ name, run, r, column, color: this.colorOf(name) });
        });
      }
      const canvas = P.make("canvas", { height: HEIGHT }), cursor = P.make("div", { class: "cursor" });
      const area = P.make("div", { class: "plot-area" }, canvas, cursor);
      for (const curve of curves) {
        curve.value = P.make("output", { class: "value" });
        const line = P.make("i", { class: "line" });
        line.style.background = dashedLine(curve.color, DASHES[curve.r % DASHES.length]);
        const remove = P.make(
          "button", { class: "remove", "aria-label": `Remove ${curve.name}`, title: "Remove" }, P.icon("close"));
        remove.onclick = () => this.choose(curve.name, false);
        const name = this.runs.length > 1 ? `${curve.name} · ${curve.run.label}` : curve.name;
        curve.element = P.make("div", { class: "curve" }, line,
          P.make("span", { class: "name", dir: "auto", title: name }, ...P.breakable(name)), curve.value, remove);
      }
      const legend = P.make("div", { class: "curves" }, ...curves.map((curve) => curve.element));
      const plot = { unit, curves, canvas, cursor, area, element: P.make("div", { class: "plot" }, area, legend) };
      const seek = (event) => {
        const box = canvas.getBoundingClientRect();
        const part = (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT);
        this.on.seek(this.clock.start + Math.min(Math.max(part, 0), 1) * (this.clock.end - this.clock.start));
      };
      area.onpointerdown = (event) => { area.setPointerCapture(event.pointerId); seek(event); };
      area.onpointermove = (event) => { if (event.buttons) seek(event); };
      return plot;
    }
    colorOf(name) { return COLORS[this.chosen.indexOf(name) % COLORS.length]; }

    // `clock`: {start, end}; `parts`: for each run its first and last instant and its offset from the clock.
    setRange(clock, parts) {
      this.clock = { start: clock.start, end: clock.end };
      this.parts = parts;
      this.draw();
    }
    draw() {
      if (this.clock && this.element.offsetParent) this.plots.forEach((plot) => this.drawPlot(plot));
      if (this.now !== undefined) this.setCursor(this.now);
    }
    drawPlot(plot) {
      const { canvas } = plot, ratio = window.devicePixelRatio || 1, width = plot.area.clientWidth;
      if (!width) return;
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(HEIGHT * ratio);
      canvas.style.height = `${HEIGHT}px`;
      const context = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
      context.scale(ratio, ratio);
      context.font = "11px system-ui, sans-serif";
      const box = { left: LEFT, right: width - RIGHT, top: TOP, bottom: HEIGHT - BOTTOM };
      const [low, high] = this.valueRange(plot), { start, end } = this.clock;
      const x = (time) => box.left + (box.right - box.left) * (end > start ? (time - start) / (end - start) : 0.5);
      const y = (value) => box.bottom - (box.bottom - box.top) * (value - low) / (high - low);
      const colors = { text: style.getPropertyValue("--muted"), line: style.getPropertyValue("--line") };
      drawAxes(context, box, { x, y, low, high, start, end, unit: plot.unit, colors });
      context.save();
      context.beginPath();
      context.rect(box.left, box.top - 2, box.right - box.left, box.bottom - box.top + 4);
      context.clip();
      for (const curve of plot.curves) this.drawCurve(context, curve, x, y);
      context.restore();
    }
    valueRange(plot) {
      let low = Infinity, high = -Infinity;
      for (const { run, column, r } of plot.curves) {
        const { first, last } = this.parts[r];
        for (let instant = first; instant <= last; ++instant) {
          const value = run.column(column, instant);
          if (value < low) low = value;
          if (value > high) high = value;
        }
      }
      if (!(low <= high)) return [-1, 1];
      const least = 1e-9 * Math.max(Math.abs(low), Math.abs(high)) || 1;  // a constant is a line in the middle
      const gap = high - low > least ? 0.06 * (high - low) : Math.max(0.5 * Math.abs(low), least);
      return [low - gap, high + gap];
    }
    // Of many instants in one pixel only the smallest and the largest values are drawn.
    drawCurve(context, { run, column, r, color }, x, y) {
      const { first, last, offset } = this.parts[r];
      context.strokeStyle = color;
      context.lineWidth = 1.6;
      context.lineJoin = "round";
      context.setLineDash(DASHES[r % DASHES.length]);
      context.beginPath();
      let isDown = false, pixel = NaN, lowest = 0, highest = 0;
      for (let instant = first; instant <= last; ++instant) {
        const value = run.column(column, instant);
        if (Number.isNaN(value)) { isDown = false; pixel = NaN; continue; }
        const px = x(run.store.time(instant) - offset), py = y(value);
        if (Math.round(2 * px) === pixel && instant < last) {
          if (py < lowest) context.lineTo(px, lowest = py);
          if (py > highest) context.lineTo(px, highest = py);
          continue;
        }
        pixel = Math.round(2 * px);
        lowest = highest = py;
        if (isDown) context.lineTo(px, py); else context.moveTo(px, py);
        isDown = true;
      }
      context.stroke();
      if (last === first && isDown) {
        context.fillStyle = color;
        context.fillRect(x(this.clock.start) - 3, lowest - 3, 6, 6);
      }
    }
    setCursor(time) {
      this.now = time;
      if (!this.clock) return;
      const { start, end } = this.clock, part = end > start ? (time - start) / (end - start) : 0.5;
      for (const plot of this.plots) {
        const width = plot.area.clientWidth - LEFT - RIGHT;
        plot.cursor.style.transform = `translateX(${LEFT + Math.min(Math.max(part, 0), 1) * width}px)`;
        for (const { run, column, value } of plot.curves) {
          P.setText(value, P.format(run.values[run.layout.columns[column]]));
        }
      }
    }

    async copy(button) {
      const several = this.runs.length > 1, rows = [[...(several ? ["run"] : []), "time", ...this.chosen]];
      for (const run of this.runs) {
        const columns = this.chosen.map((name) => run.picture.columns.findIndex((column) => column.name === name));
        for (let instant = 0; instant < run.store.count; ++instant) {
          const values = columns.map((column) => (column < 0 ? "" : textOf(run.column(column, instant))));
          rows.push([...(several ? [run.label] : []), run.store.time(instant), ...values]);
        }
      }
      await P.copy(P.csv(rows));
      P.flash(button);
    }
  }

  function dashedLine(color, dashes) {
    let at = 0;
    const stops = dashes.map((length, k) => `${k % 2 ? "transparent" : color} ${at}px ${at += length}px`);
    return stops.length ? `repeating-linear-gradient(to right, ${stops.join(", ")})` : color;
  }
  const textOf = (value) => (Number.isNaN(value) ? "nan" : Number(value.toPrecision(9)));
  const unitText = (unit) => (unit && unit !== "-" ? unit : "–");

  // Positions of joints or places of probes, or else all columns: those that change with time or, if none does, that are
  // not zero.
  function firstColumns(runs) {
    if (!runs.length) return [];
    const { joints, columns } = runs[0].picture, names = columns.map((column) => column.name);
    const ofJoints = joints.flatMap((joint) => joint.columns).map((column) => names[column]);
    const places = [
      ofJoints.filter((name) => name.endsWith("/position")), names.filter((name) => /^probe\/.*\/[xyz]$/.test(name)),
    ];
    const tests = [(track, store) => store.range(track) > 0, (track, store) => Math.abs(store.value(track, 0)) > ZERO, () => true];
    const rest = [names.filter((name) => name !== "time")];
    const tries = [[places, 0], [places, 1], [rest, 0], [rest, 1], [rest, 2]];
    for (const [kinds, number] of tries) {
      const test = tests[number];
      const passes = (name) => runs.some(({ picture, layout, store }) => {
        const column = picture.columns.findIndex((other) => other.name === name);
        return column >= 0 && (!store.count || test(layout.columns[column], store));
      });
      const chosen = kinds.map((kind) => kind.filter(passes)).find((kind) => kind.length);
      if (chosen) return [...new Set(chosen)].slice(0, CHOSEN_AT_START);
    }
    return [];
  }

  function drawAxes(context, box, { x, y, low, high, start, end, unit, colors }) {
    context.strokeStyle = colors.line;
    context.fillStyle = colors.text;
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    const step = P.niceStep(high - low, (box.bottom - box.top) / 30);
    for (let k = Math.ceil(low / step); k * step <= high; ++k) {
      const py = Math.round(y(k * step)) + 0.5;
      line(context, box.left, py, box.right, py);
      context.fillText(P.format(Math.abs(k * step) < 1e-9 * step ? 0 : k * step, 4), box.left - 6, py);
    }
    context.textAlign = "center";
    context.textBaseline = "top";
    const wide = end > start ? P.niceStep(end - start, (box.right - box.left) / 90) : 1;
    for (let k = Math.ceil(start / wide - 1e-9); k * wide <= end + 1e-9 * wide; ++k) {
      const px = Math.round(x(k * wide)) + 0.5;
      line(context, px, box.top, px, box.bottom);
      if (px < box.right - 62)
        context.fillText(P.format(Math.abs(k * wide) < 1e-9 * wide ? 0 : k * wide, 6), px, box.bottom + 6);
    }
    context.textAlign = "right";
    context.fillText("time [s]", box.right, box.bottom + 6);
    context.save();
    context.translate(11, (box.top + box.bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(`[${unitText(unit)}]`, 0, 0, box.bottom - box.top);
    context.restore();
  }
  function line(context, x1, y1, x2, y2) {
    context.beginPath();
    context.moveTo(x1, y1);
    context.lineTo(x2, y2);
    context.stroke();
  }

  Object.assign(P, { Plots });
})(window.Player = window.Player || {});
