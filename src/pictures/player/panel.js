// The panel at the side: the tree of links and joints, and the numbers of what is selected.
(function (P) {
  "use strict";

  const DEEPEST = 9;  // levels of indentation; deeper links are not indented further

  class Panel {
    // on: {select(selection), hide(selection), isolate(selection), follow(selection), showAll()}
    constructor(on) {
      this.on = on;
      this.tree = P.byId("tree");
      this.rows = [];
      this.collapsed = new Set();
      this.selection = null;
      this.tree.addEventListener("keydown", (event) => this.onKey(event));
      P.byId("show-all").onclick = () => on.showAll();
      P.byId("follow").onclick = () => on.follow(this.selection);
      P.byId("hide").onclick = () => on.hide(this.selection);
      P.byId("isolate").onclick = () => on.isolate(this.selection);
      P.byId("copy").onclick = (event) => this.copy(event.currentTarget);
      P.byId("filter").oninput = () => this.filter();
    }

    // ---------------------------------------------------------------- tree

    setRuns(runs) {
      this.runs = runs;
      this.rows = [];
      this.tree.replaceChildren();
      runs.forEach((run, r) => {
        if (runs.length > 1) this.tree.append(P.make("div", { class: "tree-run", dir: "auto" }, run.label));
        const children = run.picture.links.map(() => []);
        run.picture.links.forEach((link, l) => { if (link.parent >= 0) children[link.parent].push(l); });
        // Not by recursion: a chain may have thousands of links.
        const waiting =
          run.picture.links.map((link, l) => (link.parent < 0 ? [l, 1, null] : null)).filter(Boolean).reverse();
        while (waiting.length) {
          const [link, depth, above] = waiting.pop();
          run.picture.joints.forEach((joint, j) => {
            if (joint.link === link) this.addRow(r, link, j, depth, above, 0);
          });
          const row = this.addRow(r, link, -1, depth, above, children[link].length);
          for (const child of children[link].slice().reverse()) waiting.push([child, depth + 1, row]);
        }
      });
      this.rows.forEach(({ element }, k) => { element.tabIndex = k ? -1 : 0; });
      this.select(null);
      P.byId("tree-empty").hidden = this.rows.length > 0;
    }
    // `above`: the row of the link's parent, or null.
    addRow(run, link, joint, depth, above, childCount) {
      const { links, joints } = this.runs[run].picture, isJoint = joint >= 0;
      const name = isJoint ? joints[joint].name : links[link].name;
      const element = P.make("div", { class: isJoint ? "row joint" : "row", role: "treeitem", "aria-level": depth,
        "aria-selected": "false", title: isJoint ? `joint ${name} (${joints[joint].kind})` : `link ${name}` });
      element.style.setProperty("--depth", Math.min(depth - 1, DEEPEST));
      const twist = P.make("span", { class: "twist" });
      if (childCount) {
        twist.append(P.icon("down"));
        element.setAttribute("aria-expanded", "true");
      }
      element.append(twist, P.icon(isJoint ? "joint" : links[link].beam >= 0 ? "beam" : "link"),
        P.make("span", { class: "name", dir: "auto" }, ...P.breakable(name)));
      const row = { element, run, link, joint, above, name: name.toLowerCase() };
      if (!isJoint) {
        row.eye = P.make("button",
          { class: "eye", tabindex: "-1", title: "Hide or show", "aria-label": "Hide or show" }, P.icon("eye"));
        row.eye.onclick = (event) => { event.stopPropagation(); this.on.hide(row); };
        element.append(row.eye);
      }
      twist.onclick = (event) => { if (childCount) { event.stopPropagation(); this.toggle(row); } };
      element.onclick = () => this.on.select(row);
      element.ondblclick = () => this.on.isolate(row);
      this.tree.append(element);
      this.rows.push(row);
      return row;
    }
    toggle(row) {
      const isOpen = row.element.getAttribute("aria-expanded") === "true";
      row.element.setAttribute("aria-expanded", String(!isOpen));
      if (isOpen) this.collapsed.add(row); else this.collapsed.delete(row);
      this.filter();
    }
    filter() {
      const wanted = P.byId("filter").value.trim().toLowerCase();
      for (const row of this.rows) {
        row.element.hidden = wanted ? !row.name.includes(wanted) : this.isFolded(row);
      }
    }
    isFolded({ above }) {
      while (above && !this.collapsed.has(above)) above = above.above;
      return Boolean(above);
    }
    onKey(event) {
      const visible = this.rows.filter((row) => !row.element.hidden);
      const at = visible.findIndex((row) => row.element === document.activeElement);
      if (at < 0) return;
      const row = visible[at], isOpen = row.element.getAttribute("aria-expanded");
      const go = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: visible.length - 1 }[event.key];
      if (go !== undefined) { if (visible[go]) visible[go].element.focus(); }
      else if (event.key === "Enter" || event.key === " ") this.on.select(row);
      else if ((event.key === "ArrowLeft" && isOpen === "true") || (event.key === "ArrowRight" && isOpen === "false"))
        this.toggle(row);
      else return;
      event.preventDefault();
      event.stopPropagation();
    }

    // ---------------------------------------------------------------- selection

    select(selection) {
      this.selection = selection;
      for (const row of this.rows) {
        const isSelected = Boolean(selection) && row.run === selection.run && row.link === selection.link &&
          row.joint === selection.joint;
        row.element.setAttribute("aria-selected", String(isSelected));
        if (isSelected) {
          for (const other of this.rows) other.element.tabIndex = -1;
          row.element.tabIndex = 0;
          if (!row.element.hidden) row.element.scrollIntoView({ block: "nearest" });
        }
      }
      P.byId("details").hidden = !selection;
      P.byId("details-rows").replaceChildren();
      this.update();
    }
    update() {
      if (!this.selection) return;
      const { name, kind, rows } = P.selectionOf(this.runs, this.selection);
      P.setText(P.byId("details-name"), name);
      P.setText(P.byId("details-kind"), kind);
      fillRows(P.byId("details-rows"), rows);
    }
    showHidden(isHidden) {
      let any = false;
      for (const row of this.rows) {
        const hidden = isHidden(row);
        any = any || hidden;
        row.element.classList.toggle("is-hidden", hidden);
        if (row.eye) P.setIcon(row.eye, hidden ? "eye-off" : "eye");
      }
      P.byId("show-all").hidden = !any;
    }
    async copy(button) {
      if (!this.selection) return;
      await P.copy(P.csv(P.tableOf(this.runs, this.selection, this.time)));
      flash(button);
    }
  }

  // Rows of numbers; elements are kept, since this is done many times a second.
  function fillRows(element, rows) {
    while (element.childElementCount > 2 * rows.length) element.lastChild.remove();
    while (element.childElementCount < 2 * rows.length) element.append(P.make("dt"), P.make("dd"));
    rows.forEach(([name, value, unit], k) => {
      P.setText(element.children[2 * k], name);
      P.setText(element.children[2 * k + 1], `${P.format(value)} ${unit === "-" ? "" : unit}`);
    });
  }
  // Shows for a moment that a button did its work.
  function flash(button) {
    button.classList.add("done");
    setTimeout(() => button.classList.remove("done"), 1200);
  }

  Object.assign(P, { Panel, fillRows, flash });
})(window.Player = window.Player || {});
