// What are the numbers of a thing at the instant that is shown? Rows of [name, value, unit].
(function (P) {
  "use strict";

  const degrees = (angle) => Math.round(angle * 180 / Math.PI * 1e3) / 1e3;  // poses are not more accurate than that
  const STRAINS = [["axial strain", "-"], ["shear strain y", "-"], ["shear strain z", "-"],
    ["torsion", "1/m"], ["curvature y", "1/m"], ["curvature z", "1/m"]];
  const RESULTANTS = [["axial force", "N"], ["shear force y", "N"], ["shear force z", "N"],
    ["torsion moment", "N m"], ["bending moment y", "N m"], ["bending moment z", "N m"]];

  function poseRows(values, at) {
    const [x, y, z, w] = [3, 4, 5, 6].map((k) => values[at + k]);
    const pitch = Math.asin(Math.min(Math.max(2 * (w * y - z * x), -1), 1));
    return [
      ["x", values[at], "m"], ["y", values[at + 1], "m"], ["z", values[at + 2], "m"],
      ["roll", degrees(Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))), "°"],
      ["pitch", degrees(pitch), "°"],
      ["yaw", degrees(Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))), "°"],
      ["qx", x, ""], ["qy", y, ""], ["qz", z, ""], ["qw", w, ""],
    ];
  }

  // The columns of a joint, by the last part of their names unless these are equal.
  function jointRows(run, joint) {
    const { columns } = run.picture;
    const shorts = joint.columns.map((column) => columns[column].name.split("/").pop());
    const areDifferent = new Set(shorts).size === shorts.length;
    return joint.columns.map((column, k) =>
      [areDifferent ? shorts[k] : columns[column].name, run.values[run.layout.columns[column]], columns[column].unit]);
  }

  // A beam's numbers at a number of sections from its root, such as 2.5.
  function sectionRows(run, b, section) {
    const beam = run.picture.beams[b], first = Math.min(Math.floor(section), beam.sections.length - 2);
    const part = section - first, { values } = run;
    const at = run.layout.beams[b] + P.SECTION * first, mixed = new Float64Array(P.SECTION);
    for (let k = 0; k < P.SECTION; ++k)
      mixed[k] = values[at + k] + (values[at + P.SECTION + k] - values[at + k]) * part;
    const [s, next] = [beam.arcLengths[first], beam.arcLengths[first + 1]];
    return [
      ["arc length", s + (next - s) * part, "m"], ["edge strain", 100 * P.edgeStrain(mixed, 0, beam.radius), "%"],
      ...STRAINS.map(([name, unit], k) => [name, mixed[P.POSE + k], unit]),
      ...RESULTANTS.map(([name, unit], k) => [name, mixed[P.POSE + 6 + k], unit]),
    ];
  }
  function beamRows(run, b) {
    const beam = run.picture.beams[b];
    let most = 0, place = 0;
    beam.sections.forEach((_, k) => {
      const strain = P.edgeStrain(run.values, run.layout.beams[b] + P.SECTION * k, beam.radius);
      if (strain > most) { most = strain; place = beam.arcLengths[k]; }
    });
    return [["largest edge strain", 100 * most, "%"], ["… at arc length", place, "m"]];
  }

  // `selection`: {run, link, joint}; a joint if that is not -1.
  function selectionOf(runs, { run: r, link, joint }) {
    const run = runs[r], { picture } = run;
    if (joint >= 0) {
      const { name, kind } = picture.joints[joint];
      return { name, kind: `${kind || "unknown"} joint`, rows: jointRows(run, picture.joints[joint]) };
    }
    const { name, beam } = picture.links[link];
    const rows = poseRows(run.values, run.layout.links[link]);
    return beam < 0 ? { name, kind: "rigid link", rows }
      : { name, kind: "flexible link", rows: [...beamRows(run, beam), ...rows] };
  }

  // What the pointer is over: `hit` as Stage.pick() returns it.
  function hitOf(runs, hit) {
    const run = runs[hit.run], { picture } = run;
    if (hit.joint >= 0) return selectionOf(runs, hit);
    const { name } = picture.links[hit.link];
    if (hit.beam >= 0) return { name, kind: "beam", rows: sectionRows(run, hit.beam, hit.section) };
    const carrying = picture.joints.filter((joint) => joint.link === hit.link);
    const rows = carrying.flatMap(
      (joint) => jointRows(run, joint).map(([label, ...rest]) => [`${joint.name} ${label}`, ...rest]));
    return {
      name,
      kind: "rigid link",
      rows: [...poseRows(run.values, run.layout.links[hit.link]).slice(0, 3), ...rows]
    };
  }

  Object.assign(P, { selectionOf, hitOf });
})(window.Player = window.Player || {});
