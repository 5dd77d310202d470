// Puts the page together: runs, clock, picture, panel and plots, and the object for programs, window.flexarm.
(function (P) {
  "use strict";

  const PANEL_PERIOD = 80, HOVER_PERIOD = 60, LIVE_PLOT_PERIOD = 300;  // [ms]
  const TRAIL = 0.15, SHORTEST_TRAIL = 0.5, LONGEST_TRAIL = 10;  // of the run's length; [s]
  const QUIET = 250;  // [ms] after a captured picture: who takes one often takes many, and each size costs time
  const WIDEST_MARGIN = 0.25;  // beside several runs, for the legend, per width of the picture
  const CLICK = 5;  // pixels that the pointer may move between down and up

  const byId = P.byId, errors = [], largest = new Map();  // of parts of runs
  let runs = [], selection = null, hovered = null, stage = null, isWaiting = false, isMoved = true;
  let legendWidth = 0, lastTick = 0, quietUntil = 0, lastPanel = 0, livePlot = 0, lastRange = null;
  const canvas = byId("canvas");

  // ---------------------------------------------------------------- errors

  function complain(sentence) {
    if (errors.includes(sentence)) return;
    errors.push(sentence);
    byId("problems").append(P.make("p", { dir: "auto" }, sentence));
    byId("problems").hidden = false;
  }
  window.addEventListener("error", ({ message }) => {
    // Browsers tell in this way that panels were resized twice at once, which does no harm.
    if (!String(message).startsWith("ResizeObserver")) complain(`The player failed: ${message}`);
  });
  window.addEventListener(
    "unhandledrejection", ({ reason }) => complain(`The player failed: ${reason && reason.message}`));

  function makeStage() {
    try { return new P.Stage(canvas, redraw); } catch (error) {
      complain(
        "This browser cannot draw in three dimensions: WebGL is missing or switched off. Plots and numbers work.");
      return null;
    }
  }

  // ---------------------------------------------------------------- drawing

  // Asks for a new picture; `moved`: the instant is another one.
  function redraw() {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(tick);
  }
  function tick(now) {
    isWaiting = false;
    if (now < quietUntil) { setTimeout(redraw, QUIET); return; }
    if (clock.isPlaying) {
      if (lastTick) clock.advance((now - lastTick) / 1000);
      lastTick = now;
      redraw();
    } else lastTick = 0;
    draw(now);
  }
  function draw(now) {
    if (isMoved) place();
    if (stage) stage.draw();
    if (now - lastPanel > PANEL_PERIOD || !clock.isPlaying) {
      lastPanel = now;
      panel.time = clock.time;
      panel.update();
      if (hovered) showTip();
    }
  }
  // Moves everything to the clock's time.
  function place() {
    isMoved = false;
    clock.showRuns();
    const seconds = Math.min(Math.max(TRAIL * (clock.end - clock.start), SHORTEST_TRAIL), LONGEST_TRAIL);
    if (stage) stage.place(clock.parts, seconds);
    plots.setCursor(clock.time);
  }

  const clock = new P.Clock({
    time() { isMoved = true; redraw(); },
    playing() { redraw(); },
    parts() {
      if (!clock.isLive) findLargest();
      const range = `${clock.start} ${clock.end} ${clock.clip}`;
      if (range === lastRange || livePlot) return;
      lastRange = range;
      if (clock.isLive) livePlot = setTimeout(() => { livePlot = 0; drawPlots(); }, LIVE_PLOT_PERIOD);
      else drawPlots();
    },
  });
  // Of the parts that are shown, so that each mode has its own scale.
  function findLargest() {
    if (!stage) return;
    stage.largest = new P.Largest();
    clock.parts.forEach(({ first, last }, r) => {
      const key = `${r} ${first} ${last}`;
      if (!largest.has(key)) largest.set(key, P.largestOf(runs[r], first, last));
      stage.largest.add(largest.get(key));
    });
    display.showLegend();
  }
  const drawPlots = () => plots.setRange(clock, clock.parts);
  const plots = P.plots = new P.Plots({
    seek: (time) => clock.seek(time),
    changed() { lastRange = null; if (clock.parts) drawPlots(); },
  });
  const panel = new P.Panel({
    select, follow,
    hide: (thing) => setHidden(thing.run, (hidden) => { if (!hidden.delete(thing.link)) hidden.add(thing.link); }),
    isolate: (thing) => setHidden(thing.run, (hidden, links) => {
      const isAlone = hidden.size === links.length - 1 && !hidden.has(thing.link);
      hidden.clear();
      if (!isAlone) links.forEach((_, link) => { if (link !== thing.link) hidden.add(link); });
    }),
    showAll: () => runs.forEach((_, r) => setHidden(r, (hidden) => hidden.clear())),
  });

  // ---------------------------------------------------------------- selection

  function select(thing) {
    const section = thing && thing.beam >= 0 ? thing.section : -1;
    selection = thing ? { run: thing.run, link: thing.link, joint: thing.joint, section } : null;
    panel.select(selection);
    if (stage) stage.highlight(selection, hovered);
    redraw();
  }
  function setHidden(r, change) {
    if (!stage) return;
    change(stage.views[r].arm.hidden, runs[r].picture.links);
    panel.showHidden((row) => stage.views[row.run].arm.hidden.has(row.link));
    isMoved = true;
    redraw();
  }
  function follow(thing) {
    if (!stage) return;
    const { followed } = stage;
    const isOn = thing && !(followed && followed.run === thing.run && followed.link === thing.link);
    stage.follow(isOn ? thing.run : 0, isOn ? thing.link : -1);
    byId("follow").setAttribute("aria-pressed", String(Boolean(isOn)));
  }

  function connectPointer() {
    let down = null, last = 0;
    const at = (event) => [event.offsetX, event.offsetY];
    canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; setHover(null); });
    canvas.addEventListener("pointerup", (event) => {
      const isClick = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < CLICK;
      down = null;
      if (!isClick || event.button !== 0) return;
      const hit = stage.pick(...at(event));
      select(hit);
      if (event.pointerType === "touch") setHover(hit, event);  // on a phone the panel is folded
    });
    canvas.addEventListener("dblclick", (event) => {
      const hit = stage.pick(...at(event));
      if (hit) panel.on.isolate(hit); else panel.on.showAll();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons || event.pointerType === "touch" || event.timeStamp - last < HOVER_PERIOD) return;
      last = event.timeStamp;
      setHover(stage.pick(...at(event)), event);
    });
    canvas.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") setHover(null); });
  }
  function setHover(hit, event) {
    const nameOf = (thing) => (thing ? `${thing.run} ${thing.link}` : "");
    const isChanged = nameOf(hit) !== nameOf(hovered);
    hovered = hit;
    byId("tip").hidden = !hit;
    if (isChanged) stage.highlight(selection, hovered);
    if (!hit) return;
    showTip();
    const tip = byId("tip"), { clientWidth, clientHeight } = byId("picture");
    const x = event.offsetX + 16, y = event.offsetY + 12;
    tip.style.left = `${x + tip.offsetWidth > clientWidth ? Math.max(event.offsetX - tip.offsetWidth - 12, 4) : x}px`;
    tip.style.top = `${Math.max(Math.min(y, clientHeight - tip.offsetHeight - 6), 4)}px`;
  }
  function showTip() {
    const { name, kind, rows } = P.hitOf(runs, hovered);
    P.setText(byId("tip-name"), name);
    P.setText(byId("tip-kind"), kind);
    P.fillRows(byId("tip-rows"), rows);
  }

  // ---------------------------------------------------------------- runs

  function useRuns(newRuns) {
    runs = newRuns;
    largest.clear();
    const [first] = runs;
    const title = first ? first.label : "flexarm";
    document.title = `${title} – flexarm`;
    P.setText(byId("title"), runs.length > 1 ? `${title} and ${runs.length - 1} more` : title);
    byId("title").title = title;
    if (stage) {
      stage.largest = new P.Largest();
      stage.setRuns(runs);
    }
    P.showNotes(runs);
    display.setRuns(runs);
    selection = hovered = null;
    byId("tip").hidden = true;
    byId("follow").setAttribute("aria-pressed", "false");
    panel.setRuns(runs);
    lastRange = null;
    clock.setRuns(runs);
    if (clock.clip < 0 && !clock.isLive) clock.seek(firstTime(), true);
    plots.setRuns(runs);
    if (stage) measure();  // panels may have another size now
    redraw();
  }
  // What the page shows when it opens: what its writer wants, or the instant of the largest strain.
  function firstTime() {
    const { first_time: wanted } = P.settings;
    if (Number.isFinite(wanted)) return wanted;
    const { amounts, strainedAt } = stage ? stage.largest : new P.Largest();
    return amounts.strain > P.quantities[0].least ? strainedAt : clock.start;
  }
  function measure() {
    const { clientWidth, clientHeight } = byId("picture");
    const margin = Math.min(legendWidth, WIDEST_MARGIN * clientWidth);
    if (clientWidth && clientHeight)
      stage.resize(clientWidth, clientHeight, Math.min(window.devicePixelRatio || 1, 2), margin);
    nameCells();
  }
  function nameCells() {
    if (!stage) return;
    byId("cells").replaceChildren(...(runs.length > 1 ? runs : []).map((run, r) => {
      const { x, y, width, height } = stage.cell(r);
      const label = P.make("div", { class: "cell-name", dir: "auto", title: run.label }, P.make("span", {}, run.label));
      Object.assign(
        label.style, { left: `${x}px`, bottom: `${byId("picture").clientHeight - y - height}px`, maxWidth: `${width}px` });
      return label;
    }));
  }

  const display = new P.Display({
    get stage() { return stage; },
    redraw() { isMoved = true; redraw(); },
    keepClear(width) {
      if (width === legendWidth) return;
      legendWidth = width;
      measure();
    },
    follow: () => follow(selection),
  });

  async function readAll() {
    const pictures = [...document.querySelectorAll("script.flexarm-picture")];
    const motions = [...document.querySelectorAll("script.flexarm-motion")];
    const read = [];
    for (let k = 0; k < pictures.length; ++k) {
      const run = await P.readRun(pictures[k].textContent, motions[k] ? motions[k].textContent : "", k + 1, complain);
      if (run) read.push(run);
      if (motions[k]) motions[k].remove();  // its text is large
    }
    if (!pictures.length) complain("This page contains no run.");
    useRuns(read);
  }

  // Fulfilled when the first picture has come.
  function goLive(element) {
    let before = null, tellFirst = null;
    const first = new Promise((resolve) => { tellFirst = resolve; });
    P.connect(JSON.parse(element.textContent).stream, {
      picture(run) { before = null; useRuns([run]); clock.goLive(); tellFirst(); },
      instant(run) {
        if (stage) {
          const values = run.store.instants[run.store.instants.length - 1], time = run.store.time(run.store.count - 1);
          stage.largest.note(run, values, before && before.values, before ? time - before.time : 0);
          before = { values, time };
          display.showLegend();
        }
        clock.noteNewest();
      },
      state(state) {
        document.documentElement.dataset.connection = state;
        const text = { connecting: "connecting …", connected: "", lost: "connection lost, trying again" }[state];
        P.setText(byId("connection"), text);
      },
      problem: complain,
    });
    return first;
  }

  // ---------------------------------------------------------------- pictures for programs

  function capture(width, height, caption = "") {
    return new Promise((resolve, reject) => {
      if (!stage) { reject(new Error("This browser cannot draw in three dimensions.")); return; }
      if (isMoved) place();
      const picture = P.make("canvas", { width, height }), context = picture.getContext("2d");
      const { legend } = display;
      stage.drawAt(width, height, legend ? P.overlayMargin(width, height) : 0, (drawn) => {
        context.drawImage(drawn, 0, 0, width, height);
        const names = runs.length > 1 ? runs.map((run, r) => ({ name: run.label, ...stage.cell(r) })) : [];
        P.drawOverlay(context, { width, height, caption: String(caption), time: `t = ${clock.text}`, names,
          legend, colors: stage.theme });
      });
      quietUntil = performance.now() + QUIET;
      redraw();
      picture.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture is too large."))), "image/png");
    });
  }

  window.flexarm = {
    get runs() { return runs; },
    get time() { return clock.time; },
    setTime(time) { clock.pause(); clock.seek(time); },
    play() { clock.play(); },
    pause() { clock.pause(); },
    get color() { return display.color; },
    set color(key) { display.setQuantity(key); },
    get theme() { return document.documentElement.dataset.theme; },
    set theme(theme) { page.setTheme(theme); },
    get shown() { return [...display.shown]; },
    set shown(keys) { display.setShown(keys); },
    get speed() { return clock.speed; },
    set speed(speed) { clock.setSpeed(speed); },
    project(position, run = 0) {
      if (!stage) return null;
      if (isMoved) place();
      return stage.project(position, run);
    },
    get camera() {
      return stage && {
        position: stage.camera.position.toArray(),
        target: stage.controls.target.toArray(),
        fov: stage.camera.fov
      };
    },
    set camera(camera) { if (stage) stage.setCamera(camera); },
    // Shows all that moves, from this direction.
    lookFrom([x, y, z]) { if (stage) stage.fit(new THREE.Vector3(x, y, z)); },
    capture,
    errors,
  };

  stage = P.stage = makeStage();
  const page = P.connectPage({ clock, panel, display, follow: () => follow(selection), stage: () => stage,
    selection: () => selection, select });
  if (stage) {
    connectPointer();
    measure();
    new ResizeObserver(measure).observe(byId("picture"));
  }
  const liveElement = document.querySelector("script.flexarm-live");
  window.flexarm.ready = (liveElement ? goLive(liveElement) : readAll()).then(() => {
    byId("loading").hidden = true;
    draw(performance.now());
  });
})(window.Player = window.Player || {});
