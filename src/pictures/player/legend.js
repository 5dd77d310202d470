// What do the colours stand for? The colour bar beside the picture, and the same in captured pictures.
(function (P) {
  "use strict";

  const TICKS = 3;  // about; the bar is low

  // {title, stops, ticks} of a quantity, or null if no beam has it; a tick has its part of the bar's height and its
  // number.
  function legendOf(quantity, { amounts }) {
    const largest = quantity ? amounts[quantity.key] : -1;
    if (!(largest >= 0)) return null;
    const end = Math.max(largest, quantity.least) * quantity.factor, low = quantity.signed ? -end : 0;
    const step = P.niceStep(end - low, TICKS), ticks = [];
    for (let k = Math.ceil(low / step); k * step <= end * (1 + 1e-9); ++k) {
      ticks.push({ part: (k * step - low) / (end - low), text: P.format(k * step, 3) });
    }
    return { title: `${quantity.name} [${quantity.unit}]`, stops: P.mapOf(quantity).stops, ticks };
  }

  function showLegend(element, quantity, largest, arrows) {
    const legend = legendOf(quantity, largest);
    const key = JSON.stringify([legend, arrows.map((arrow) => arrow.name), largest.force, largest.moment]);
    if (element.dataset.key === key) return;
    element.dataset.key = key;
    element.replaceChildren();
    if (legend) {
      const bar = P.make("div", { class: "scale" });
      bar.style.background = `linear-gradient(to top, ${legend.stops.join(", ")})`;
      const labels = P.make("div", { class: "labels" }, ...legend.ticks.map(({ part, text }) => {
        const label = P.make("span", {}, text);
        label.style.bottom = `${100 * part}%`;
        return label;
      }));
      element.append(
        P.make("div", { class: "legend-title" }, legend.title), P.make("div", { class: "scale-row" }, bar, labels));
    }
    for (const { name, color } of arrows) {
      const dot = P.make("i", { class: "dot" });
      dot.style.background = color;
      element.append(P.make("div", { class: "arrow-kind" }, dot, name));
    }
    const longest = [];
    if (largest.force > 0) longest.push(`${P.format(largest.force, 3)} N`);
    if (largest.moment > 0) longest.push(`${P.format(largest.moment, 3)} N m`);
    if (arrows.length && longest.length) {
      element.append(P.make("div", { class: "arrow-scale" }, `longest: ${longest.join(", ")}`));
    }
    element.hidden = !element.childElementCount;
  }

  const textSize = (width, height) => Math.max(11, Math.round(Math.min(width, height) / 36));
  // The width of the colour bar in a captured picture.
  const overlayMargin = (width, height) => 9 * textSize(width, height);

  // The lines of a text in a width, at most `most`; what is cut has an ellipsis.
  function wrapped(context, text, width, most) {
    const fits = (line) => context.measureText(line).width <= width, lines = [];
    let line = "";
    for (const word of text.split(/(?<=\s)/).flatMap((part) => pieces(part, fits))) {
      if (line && !fits((line + word).trimEnd())) { lines.push(line.trimEnd()); line = ""; }
      line += word;
    }
    if (line) lines.push(line.trimEnd());
    if (lines.length > most) {
      let last = lines[most - 1];
      while (last && !fits(`${last}…`)) last = last.slice(0, -1);
      lines.splice(most - 1, lines.length, `${last}…`);
    }
    return lines;
  }
  // A word that is too long is broken.
  function pieces(word, fits) {
    const out = [];
    let rest = word;
    while (!fits(rest.trimEnd())) {
      let count = 1;
      while (count < rest.length && fits(rest.slice(0, count + 1))) ++count;
      out.push(rest.slice(0, count));
      rest = rest.slice(count);
    }
    return rest ? [...out, rest] : out;
  }

  // Draws caption, names of runs, time and colour bar over a captured picture.
  function drawOverlay(context, { width, height, caption, time, legend, names, colors }) {
    const size = textSize(width, height), gap = size, line = 1.3 * size;
    context.fillStyle = colors.text;
    context.textBaseline = "top";
    context.font = `600 ${Math.round(1.25 * size)}px ${FONT}`;
    let y = gap;
    for (const text of wrapped(context, caption, width - 2 * gap, 3)) { context.fillText(text, gap, y); y += 1.7 * size; }
    context.font = `${size}px ${FONT}`;
    context.fillText(time, gap, y);
    for (const cell of names) {
      const lines = wrapped(context, cell.name, cell.width - 2 * gap, 3);
      lines.forEach((text, k) =>
        context.fillText(text, cell.x + gap, cell.y + cell.height - 0.7 * size - line * (lines.length - k)));
    }
    if (!legend) return;
    const tall = Math.round(0.2 * height), wide = size, right = width - gap - 5 * size, top = height - gap - tall;
    const gradient = context.createLinearGradient(0, top + tall, 0, top);
    legend.stops.forEach((stop, k) => gradient.addColorStop(k / (legend.stops.length - 1), stop));
    context.fillStyle = gradient;
    context.fillRect(right, top, wide, tall);
    context.fillStyle = colors.text;
    context.textBaseline = "middle";
    for (const { part, text } of legend.ticks) {
      context.fillText(text, right + 1.5 * wide, top + tall * (1 - part), 4.5 * size);
    }
    context.textAlign = "right";
    context.fillText(legend.title, width - gap, top - 1.4 * size, width / 2);
    context.textAlign = "left";
  }
  const FONT = "system-ui, sans-serif";

  Object.assign(P, { legendOf, showLegend, drawOverlay, overlayMargin });
})(window.Player = window.Player || {});
