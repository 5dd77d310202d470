// Which colour does a value have? Quantities of beams, colour maps, and numbers as text.
(function (P) {
  "use strict";

  const POSE = 7;
  const norm = Math.hypot;

  // The same bound as edge_strain() of the simulator: as if bending and torsion were largest at the same point.
  function edgeStrain(v, at, radius) {
    const s = at + POSE;
    const normal = Math.abs(v[s]) + radius * norm(v[s + 4], v[s + 5]);
    const shear = norm(v[s + 1], v[s + 2]) + radius * Math.abs(v[s + 3]);
    return norm(normal, shear / Math.sqrt(3));
  }

  // value(values, place of a section, radius of its beam); null: from the motion. `factor` is from SI to the unit that
  // is shown, and smaller values than `least` are round-off.
  const quantity = (key, name, unit, value, { signed = false, factor = 1, least = 1e-6 } = {}) =>
    ({ key, name, unit, value, signed, factor, least });
  const quantities = [
    quantity("strain", "Edge strain", "%", edgeStrain, { factor: 100, least: 1e-9 }),
    quantity("axial", "Axial force", "N", (v, at) => v[at + 13], { signed: true }),
    quantity("shear", "Shear force", "N", (v, at) => norm(v[at + 14], v[at + 15])),
    quantity("torsion", "Torsion moment", "N m", (v, at) => v[at + 16], { signed: true }),
    quantity("bending", "Bending moment", "N m", (v, at) => norm(v[at + 17], v[at + 18])),
    quantity("velocity", "Velocity", "m/s", null),
  ];

  // The writer of the page has the scales of colours, for amounts and for values of both signs.
  const { amounts, signed } = P.settings.colors;
  const channels = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
  const LEVELS = 256;

  function table(stops) {
    const colors = stops.map(channels), levels = new Uint8Array(3 * LEVELS);
    for (let level = 0; level < LEVELS; ++level) {
      const along = level / (LEVELS - 1) * (colors.length - 1);
      const k = Math.min(Math.floor(along), colors.length - 2), part = along - k;
      for (let c = 0; c < 3; ++c) levels[3 * level + c] = colors[k][c] + (colors[k + 1][c] - colors[k][c]) * part;
    }
    return levels;
  }
  const maps = [amounts, signed].map((stops) => ({ stops, table: table(stops) }));
  const mapOf = ({ signed }) => maps[signed ? 1 : 0];

  // The level of a value on the scale that ends at `largest`.
  function level(value, largest, signed) {
    const part = signed ? 0.5 + 0.5 * value / largest : value / largest;
    return part >= 1 ? LEVELS - 1 : part > 0 ? Math.round(part * (LEVELS - 1)) : 0;
  }

  const UNKNOWN = -1;  // no beam has this quantity at any time

  // The largest amounts in a run: of each quantity, and of forces and moments that arrows stand for.
  class Largest {
    constructor() {
      this.amounts = Object.fromEntries(quantities.map((quantity) => [quantity.key, UNKNOWN]));
      this.force = this.moment = 0;
      this.strainedAt = NaN;  // time of the largest strain
    }
    // `before`: the values of the instant before, or null; `step`: the time between them.
    note(run, values, before, step) {
      const { picture, layout } = run, { amounts } = this;
      picture.beams.forEach((beam, b) => {
        for (let k = 0; k < beam.sections.length; ++k) {
          const at = layout.beams[b] + P.SECTION * k;
          for (const { key, value } of quantities) {
            const now = value ? Math.abs(value(values, at, beam.radius)) : before ? speed(values, before, at, step) : NaN;
            if (now > amounts[key]) amounts[key] = now;
          }
        }
      });
      picture.arrows.forEach((arrow, a) => {
        for (let k = 0; k < arrow.count; ++k) {
          const at = layout.arrows[a] + P.ARROW * k;
          const force = norm(values[at + 3], values[at + 4], values[at + 5]);
          const moment = norm(values[at + 6], values[at + 7], values[at + 8]);
          if (force > this.force) this.force = force;
          if (moment > this.moment) this.moment = moment;
        }
      });
    }
    add(other) {
      if (other.amounts.strain > this.amounts.strain) this.strainedAt = other.strainedAt;
      for (const key of Object.keys(this.amounts)) this.amounts[key] = Math.max(this.amounts[key], other.amounts[key]);
      this.force = Math.max(this.force, other.force);
      this.moment = Math.max(this.moment, other.moment);
    }
  }
  const speed = (now, before, at, step) =>
    (step > 0 ? norm(now[at] - before[at], now[at + 1] - before[at + 1], now[at + 2] - before[at + 2]) / step : 0);

  // Over some instants of a run.
  function largestOf(run, first, last) {
    const largest = new Largest(), { store } = run;
    let values = new Float64Array(run.layout.count), before = new Float64Array(run.layout.count);
    for (let instant = first; instant <= last; ++instant) {
      run.sampleInto(values, instant, 0);
      const isFirst = instant === first, strain = largest.amounts.strain;
      largest.note(run, values, isFirst ? null : before, isFirst ? 0 : store.time(instant) - store.time(instant - 1));
      if (largest.amounts.strain > strain) largest.strainedAt = store.time(instant);
      [values, before] = [before, values];
    }
    return largest;
  }

  // Velocity of a section at the instant that a run shows, between the instants around it [m/s].
  function sectionSpeed(run, at) {
    const { store } = run;
    if (store.count < 2) return NaN;
    const next = Math.min(run.instant + 1, store.count - 1), here = next - 1;
    let square = 0;
    for (let c = 0; c < 3; ++c) square += (store.value(at + c, next) - store.value(at + c, here)) ** 2;
    const step = store.time(next) - store.time(here);
    return step > 0 ? Math.sqrt(square) / step : 0;
  }

  // ---------------------------------------------------------------- numbers as text

  const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  function format(value, digits = 4) {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits))).replace("-", "−");
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const raised = String(Math.abs(exponent)).split("").map((digit) => SUPERSCRIPTS[digit]).join("");
    return `${String(Number(mantissa)).replace("-", "−")}·10${exponent < 0 ? "⁻" : ""}${raised}`;
  }
  // Round steps (1, 2, 5 times a power of ten) between two numbers, about `count` of them.
  function niceStep(length, count) {
    const raw = length / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(raw)), rest = raw / power;
    return power * (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10);
  }

  Object.assign(P, { quantities, edgeStrain, mapOf, level, Largest, largestOf, sectionSpeed, format, niceStep });
})(window.Player = window.Player || {});
