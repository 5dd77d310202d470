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

  // A beam at a number of sections from its root, such as 2.5: {arcLength, numbers, edgeStrain}; `numbers` are those of
  // a section.
  function sectionAt(run, b, section) {
    const beam = run.picture.beams[b], first = Math.min(Math.floor(section), beam.sections.length - 2);
    const part = section - first, { values } = run, numbers = new Float64Array(P.SECTION);
    const at = run.layout.beams[b] + P.SECTION * first, next = at + P.SECTION;
    let dot = 0;
    for (let k = 3; k < P.POSE; ++k) dot += values[at + k] * values[next + k];
    for (let k = 0; k < P.SECTION; ++k) {
      const sign = dot < 0 && k >= 3 && k < P.POSE ? -1 : 1;
      numbers[k] = part ? values[at + k] + (sign * values[next + k] - values[at + k]) * part : values[at + k];
    }
    const length = Math.hypot(...numbers.subarray(3, P.POSE));
    for (let k = 3; k < P.POSE; ++k) numbers[k] /= length;
    const [s, end] = [beam.arcLengths[first], beam.arcLengths[first + 1]];
    return { arcLength: s + (end - s) * part, numbers, edgeStrain: P.edgeStrain(numbers, 0, beam.radius) };
  }
  function sectionRows(run, b, section) {
    const { arcLength, numbers, edgeStrain } = sectionAt(run, b, section);
    return [
      ["arc length", arcLength, "m"], ["edge strain", 100 * edgeStrain, "%"],
      ...STRAINS.map(([name, unit], k) => [name, numbers[P.POSE + k], unit]),
      ...RESULTANTS.map(([name, unit], k) => [name, numbers[P.POSE + 6 + k], unit]),
    ];
  }
  function beamRows(run, b) {
    const beam = run.picture.beams[b];
    let most = NaN, place = NaN;
    beam.sections.forEach((_, k) => {
      const strain = P.edgeStrain(run.values, run.layout.beams[b] + P.SECTION * k, beam.radius);
      if (!Number.isNaN(strain) && !(strain <= most)) { most = strain; place = beam.arcLengths[k]; }
    });
    return [["largest edge strain", 100 * most, "%"], ["… at arc length", place, "m"]];
  }

  // `selection`: {run, link, joint, section}; a joint if that is not -1; else `section` is the place on a beam that was
  // clicked, or -1.
  function selectionOf(runs, { run: r, link, joint, section }) {
    const run = runs[r], { picture } = run;
    if (joint >= 0) {
      const { name, kind } = picture.joints[joint];
      return { name, kind: `${kind || "unknown"} joint`, rows: jointRows(run, picture.joints[joint]) };
    }
    const { name, beam } = picture.links[link];
    const rows = poseRows(run.values, run.layout.links[link]);
    return beam < 0 ? { name, kind: "rigid link", rows }
      : { name, kind: "flexible link",
        rows: [...(section >= 0 ? sectionRows(run, beam, section) : []), ...beamRows(run, beam), ...rows] };
  }

  // Names of the numbers of a section, as in results.
  const SECTION_COLUMNS = ["x [m]", "y [m]", "z [m]", "qx [1]", "qy [1]", "qz [1]", "qw [1]", "ex [1]", "ey [1]", "ez [1]",
    "kx [1/m]", "ky [1/m]", "kz [1/m]", "fx [N]", "fy [N]", "fz [N]", "mx [N m]", "my [N m]", "mz [N m]"];

  // What is copied of a selection, as rows of CSV: its numbers, or of a beam a row for each section, after one for the
  // place that was clicked.
  function tableOf(runs, selection, time) {
    const { run: r, link, joint, section } = selection, run = runs[r], { name, beam } = run.picture.links[link];
    if (joint >= 0 || beam < 0) {
      const { name: shown, rows } = selectionOf(runs, selection);
      return [["name", "quantity", "value", "unit"], ...[["time", time, "s"], ...rows].map((row) => [shown, ...row])];
    }
    const row = (place, at) => {
      const { arcLength, numbers, edgeStrain } = sectionAt(run, beam, at);
      return [name, place, time, arcLength, edgeStrain, ...numbers].map((value) => (Number.isNaN(value) ? "nan" : value));
    };
    return [
      ["name", "place", "time [s]", "arc_length [m]", "edge_strain [1]", ...SECTION_COLUMNS],
      ...(section >= 0 ? [row("clicked", section)] : []),
      ...run.picture.beams[beam].sections.map((_, k) => row(`section ${k}`, k)),
    ];
  }

  // Joints at one place.
  function jointsOf(run, indices) {
    const joints = indices.map((index) => run.picture.joints[index]), isOne = joints.length === 1;
    return {
      name: joints.map((joint) => joint.name).join(", "),
      kind: isOne ? `${joints[0].kind || "unknown"} joint` : "joints",
      rows: joints.flatMap((joint) => jointRows(run, joint)
        .map(([label, ...rest]) => [isOne ? label : `${joint.name} ${label}`, ...rest])),
    };
  }

  // What the pointer is over: `hit` as Stage.pick() returns it.
  function hitOf(runs, hit) {
    const run = runs[hit.run], { picture } = run;
    if (hit.joint >= 0) return jointsOf(run, hit.joints);
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

  Object.assign(P, { selectionOf, tableOf, hitOf });
})(window.Player = window.Player || {});
