// Small helpers for the page: elements, icons, the clipboard. Texts of scenes only ever become text nodes.
(function (P) {
  "use strict";

  function make(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (value === true) element.setAttribute(name, "");
      else if (value !== false && value !== null) element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
  }

  // An icon of the page's sprite.
  function icon(name) {
    const SVG = "http://www.w3.org/2000/svg";
    const svg = document.createElementNS(SVG, "svg"), use = document.createElementNS(SVG, "use");
    svg.setAttribute("class", "icon");
    svg.setAttribute("aria-hidden", "true");
    use.setAttribute("href", `#i-${name}`);
    svg.append(use);
    return svg;
  }
  const setIcon = (button, name) => button.querySelector("use").setAttribute("href", `#i-${name}`);
  // The parts of a name, which may be broken behind its separators.
  const breakable = (name) => name.split(/(?<=[/_:.\-])/).flatMap((part, k) => (k ? [make("wbr"), part] : [part]));
  const setText = (element, text) => { if (element.textContent !== text) element.textContent = text; };
  const byId = (id) => document.getElementById(id);

  const cell = (value) => {
    const text = String(value);
    return /[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
  };
  const csv = (rows) => rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";

  // Pages from files have no clipboard in some browsers; a hidden text field has one everywhere.
  async function copy(text) {
    P.copied = text;  // for tests, which cannot read the clipboard
    try { await navigator.clipboard.writeText(text); return true; } catch (error) {
      const field = make("textarea", { class: "off-screen" });
      field.value = text;
      document.body.append(field);
      field.select();
      const done = document.execCommand("copy");
      field.remove();
      return done;
    }
  }

  // What all runs of the page share.
  const settingsElement = document.querySelector("script.flexarm-settings");
  const settings = { colors: { amounts: ["#444444", "#eeeeee"], signed: ["#444444", "#eeeeee"] }, first_time: null,
    ...(settingsElement ? JSON.parse(settingsElement.textContent) : {}) };

  Object.assign(P, { settings, make, breakable, icon, setIcon, setText, byId, csv, copy });
})(window.Player = window.Player || {});
