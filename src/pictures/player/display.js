// What is shown and how: colours of beams, switches, views, light and dark, panels that fold, keys.
(function (P) {
  "use strict";

  const byId = P.byId;
  const SWITCHES = [
    ["grid", "Ground"], ["world", "Axes of the world"], ["axes", "Axes of joints"], ["still", "Arm at rest"],
    ["effort", null], ["load", null], ["reaction", null], ["contact", null], ["probes", "Probes"],
    ["trails", "Trails of probes"], ["lines", "Springs and tendons"]
  ];
  const LEGEND_EDGE = 10;  // from the legend to the edge of the picture [pixels]
  const AT_START = ["grid", "world", "still", "load", "contact", "probes", "trails", "lines"];
  const THEMES = {
    light: { background: "#edf0f4", grid: "#a9b1bd", ground: "#c3cad4", text: "#1d2129" },
    dark: { background: "#171b21", grid: "#4a5361", ground: "#313945", text: "#e6e9ee" },
  };

  class Display {
    // `page`: {stage, redraw(), keepClear(width)}; the stage may be null. Several runs stay clear of the legend.
    constructor(page) {
      this.page = page;
      this.shown = new Set(AT_START);
      this.quantity = P.quantities[0];
      this.hasBeams = false;
      this.kinds = [];
      const choice = byId("color");
      choice.append(...P.quantities.map(({ key, name }) => P.make("option", { value: key }, name)),
        P.make("option", { value: "plain" }, "Plain"));
      choice.onchange = () => this.setQuantity(choice.value);
    }
    setRuns(runs) {
      this.hasBeams = runs.some((run) => run.picture.beams.length > 0);
      const has = (list, check) => runs.some((run) => run.picture[list].some(check));
      const isThere = {
        grid: true,
        world: true,
        axes: has("joints", (joint) => joint.axis),
        still: runs.some((run) => run.picture.still >= 0),
        probes: has("probes", () => true),
        trails: has("probes", () => true),
        lines: has("lines", () => true),
      };
      for (const kind of Object.keys(P.arrowKinds))
        isThere[kind] = has("arrows", (arrow) => arrow.kind === kind && arrow.count > 0);
      this.kinds = Object.keys(P.arrowKinds).filter((kind) => isThere[kind]);
      byId("switches").replaceChildren(...SWITCHES.filter(([key]) => isThere[key])
        .map(([key, name]) => this.makeSwitch(key, name)));
      byId("color-choice").hidden = !this.hasBeams;
      this.apply();
    }
    makeSwitch(key, name) {
      const box = P.make("input", { type: "checkbox", "data-key": key });
      box.checked = this.shown.has(key);
      box.onchange = () => { if (box.checked) this.shown.add(key); else this.shown.delete(key); this.apply(); };
      const label = P.make("label", { class: "option" }, box);
      if (P.arrowKinds[key]) {
        const dot = P.make("i", { class: "dot" });
        dot.style.background = P.arrowKinds[key].color;
        label.append(dot);
      }
      label.append(name || P.arrowKinds[key].name);
      return label;
    }
    setQuantity(key) {
      this.quantity = P.quantities.find((quantity) => quantity.key === key) || null;
      byId("color").value = this.quantity ? key : "plain";
      this.apply();
    }
    get color() { return this.quantity ? this.quantity.key : "plain"; }
    setShown(keys) {
      this.shown = new Set(keys);
      for (const box of byId("switches").querySelectorAll("input")) box.checked = this.shown.has(box.dataset.key);
      this.apply();
    }
    nextQuantity() {
      const options = byId("color").options;
      this.setQuantity(options[(byId("color").selectedIndex + 1) % options.length].value);
    }
    apply() {
      const { stage } = this.page;
      if (!stage) return;
      stage.quantity = this.hasBeams ? this.quantity : null;
      stage.setShown(this.shown);
      this.showLegend();
      this.page.redraw();
    }
    showLegend() {
      const { stage } = this.page;
      if (!stage) return;
      P.showLegend(byId("legend"), stage.quantity, stage.largest,
        this.kinds.filter((kind) => this.shown.has(kind)).map((kind) => P.arrowKinds[kind]));
      this.page.keepClear(byId("legend").hidden ? 0 : byId("legend").offsetWidth + 2 * LEGEND_EDGE);
    }
    get legend() {
      const { quantity, largest } = this.page.stage;
      return P.legendOf(quantity, largest);
    }
    setTheme(theme) {
      document.documentElement.dataset.theme = theme;
      P.setIcon(byId("theme"), theme === "dark" ? "sun" : "moon");
      if (this.page.stage) this.page.stage.setTheme(THEMES[theme]);
    }
  }

  function showNotes(runs) {
    const notes =
      runs.flatMap((run) => run.picture.notes.map((note) => (runs.length > 1 ? `${run.label}: ${note}` : note)));
    byId("notes").hidden = !notes.length;
    P.setText(byId("notes-count"), `${notes.length} ${notes.length === 1 ? "note" : "notes"}`);
    byId("notes-list").replaceChildren(...notes.map((note) => P.make("li", { dir: "auto" }, note)));
  }

  // Connects everything on the page that is not about one of its parts.
  function connectPage({ clock, panel, display, follow, stage, selection, select }) {
    const fold = (button, element, isOpen) => {
      byId(element).hidden = !isOpen;
      byId(button).setAttribute("aria-expanded", String(isOpen));
    };
    const flip = (button, element) => { fold(button, element, byId(element).hidden); };
    const isNarrow = window.matchMedia("(max-width: 760px)");
    const foldPanels = () => {
      fold("side-button", "side", !isNarrow.matches);
      fold("plots-button", "plots", !isNarrow.matches);
    };
    foldPanels();
    isNarrow.addEventListener("change", foldPanels);
    byId("side-button").onclick = () => flip("side-button", "side");
    byId("plots-button").onclick = () => flip("plots-button", "plots");
    byId("show-button").onclick = () => flip("show-button", "show-list");
    document.addEventListener("pointerdown", (event) => {
      if (!byId("show-chooser").contains(event.target)) fold("show-button", "show-list", false);
    });
    byId("help-button").onclick = () => byId("help").showModal();
    byId("problems-close").onclick = () => { byId("problems").hidden = true; };

    const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
    const themeNow = () => document.documentElement.dataset.theme;
    const setTheme = (theme) => {
      display.setTheme(theme === "dark" ? "dark" : "light");
      window.dispatchEvent(new Event("themechange"));
    };
    setTheme(prefersDark.matches ? "dark" : "light");
    prefersDark.addEventListener("change", () => setTheme(prefersDark.matches ? "dark" : "light"));
    byId("theme").onclick = () => setTheme(themeNow() === "dark" ? "light" : "dark");

    // Views along the axes of the world, towards its origin, and the one at the start.
    const look = (x, y, z) => { if (stage()) stage().fit(new THREE.Vector3(x, y, z)); };
    const views = {
      "view-x": () => look(1, 0, 0),
      "view-y": () => look(0, -1, 0),
      "view-z": () => look(0, 0, 1),
      "view-all": () => stage() && stage().fit()
    };
    for (const [id, action] of Object.entries(views)) byId(id).onclick = action;

    const keys = {
      " ": () => clock.toggle(),
      k: () => clock.toggle(),
      ArrowLeft: () => clock.step(-1),
      ArrowRight: () => clock.step(1),
      ArrowUp: () => clock.changeSpeed(1),
      ArrowDown: () => clock.changeSpeed(-1),
      Home: () => clock.seek(clock.start),
      End: () => clock.seek(clock.end),
      PageUp: () => clock.seek(clock.time - 0.1 * (clock.end - clock.start)),
      PageDown: () => clock.seek(clock.time + 0.1 * (clock.end - clock.start)),
      l: () => byId("loop").click(),
      x: views["view-x"],
      y: views["view-y"],
      z: views["view-z"],
      r: views["view-all"],
      f: follow,
      c: () => display.nextQuantity(),
      t: () => byId("theme").click(),
      p: () => byId("plots-button").click(),
      h: () => selection() && panel.on.hide(selection()),
      i: () => selection() && panel.on.isolate(selection()),
      a: () => panel.on.showAll(),
      s: () => byId("side-button").click(),
      Escape: () => {
        select(null);
        fold("show-button", "show-list", false);
      },
      "?": () => byId("help").showModal(),
    };
    document.addEventListener("keydown", (event) => {
      const { target } = event, tag = target.tagName;
      if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open) return;
      if (tag === "SELECT" || tag === "TEXTAREA" || (tag === "INPUT" && target.type !== "range")) return;
      const isButton =
        (tag === "BUTTON" || tag === "SUMMARY") && target.getClientRects().length;  // not in a closed dialog
      if ((event.key === " " || event.key === "Enter") && isButton) return;
      const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action) return;
      event.preventDefault();
      action();
    });
    return { setTheme };
  }

  Object.assign(P, { Display, showNotes, connectPage });
})(window.Player = window.Player || {});
