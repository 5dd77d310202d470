// What do the colours stand for? The colour bar beside the picture, and the same in captured pictures.
(function (P) {
  "use strict";

  const TICKS = 4;

  // {title, stops, ticks} of a quantity; a tick has its part of the bar's height and its number.
  function legendOf(quantity, largest) {
    const end = Math.max(largest, quantity.least) * quantity.factor, low = quantity.signed ? -end : 0;
    const step = P.niceStep(end - low, TICKS), ticks = [];
    for (let k = Math.ceil(low / step); k * step <= end * (1 + 1e-9); ++k) {
      ticks.push({ part: (k * step - low) / (end - low), text: P.format(k * step, 3) });
    }
    return { title: `${quantity.name} [${quantity.unit}]`, stops: P.mapOf(quantity).stops, ticks };
  }

  function showLegend(element, quantity, largest, arrows) {
    const legend = quantity ? legendOf(quantity, largest.amounts[quantity.key]) : null;
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

  // Draws caption, names of runs, time and colour bar over a captured picture.
  function drawOverlay(context, { width, height, caption, time, legend, names, colors }) {
    const size = Math.max(11, Math.round(Math.min(width, height) / 36)), gap = size;
    context.fillStyle = colors.text;
    context.textBaseline = "top";
    context.font = `600 ${Math.round(1.25 * size)}px ${FONT}`;
    if (caption) context.fillText(caption, gap, gap, width - 2 * gap);
    context.font = `${size}px ${FONT}`;
    context.fillText(time, gap, gap + (caption ? 1.7 * size : 0));
    for (const cell of names)
      context.fillText(cell.name, cell.x + gap, cell.y + cell.height - 2 * size, cell.width / 2);
    if (!legend) return;
    const tall = Math.round(0.3 * height), wide = size, right = width - gap - 5 * size, top = height - gap - tall;
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

  Object.assign(P, { legendOf, showLegend, drawOverlay });
})(window.Player = window.Player || {});
