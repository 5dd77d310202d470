// Where are a run's links and beams at an instant, and which colours do they have?
(function (P) {
  "use strict";

  // So many frames on all lines of a run, at most, unless it has more sections.
  const MOST_FRAMES = 6000, MOST_PARTS = 8;
  const MANY_SECTIONS = 3000, FEWER_SIDES = 8, SIDES = 16;  // of tubes, powers of two
  const THINNEST = 0.004;      // of a tube, per radius of the scene; a thinner one would be hard to see

  const SELECTED = { color: 0x2f7de1, amount: 0.55, brighter: 0.25 };
  const HOVERED = { color: 0x555555, amount: 0.4, brighter: 0.12 };
  const NORMAL = { color: 0, amount: 0, brighter: 0 };

  // One thing that is drawn: a rigid surface in its link's frame, or one that bends.
  class Part {
    constructor(link, beam, surface, isGhost, isClosed) {
      this.link = link;
      this.beam = beam;
      const alpha = isGhost ? 0.4 : surface.alpha;
      this.material = new THREE.MeshPhongMaterial({
        vertexColors: THREE.VertexColors, shininess: 24, specular: 0x1c1c1c, opacity: alpha, transparent: alpha < 1,
        depthWrite: alpha === 1, side: isClosed ? THREE.FrontSide : THREE.DoubleSide,
        // A little behind lines and grounds in the same plane, which would flicker.
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      });
      this.mesh = new THREE.Mesh(surface.geometry(), this.material);
      this.mesh.userData.part = this;
      this.bend = this.tube = null;
    }
    bendWith(beam, along) {
      const { geometry } = this.mesh, { position, normal } = geometry.attributes;
      this.bend = new P.Bend(along, position.array, normal.array, beam.rest);
      const colors = new Uint8Array(4 * along.length), plain = geometry.attributes.color.array;
      for (let k = 0; k < along.length; ++k) {
        for (let c = 0; c < 3; ++c) colors[4 * k + c] = 255 * Math.min(Math.max(plain[3 * k + c], 0), 1);
      }
      this.plain = colors.slice();
      geometry.setAttribute("color", new THREE.BufferAttribute(colors, 4, true));
      for (const name of ["position", "normal", "color"]) geometry.attributes[name].setUsage(THREE.DynamicDrawUsage);
      this.reach = 0;  // largest distance of a vertex from its frame
      for (let k = 0; k < this.bend.local.length; k += 9) {
        this.reach = Math.max(this.reach, Math.hypot(...this.bend.local.subarray(k, k + 3)));
      }
      geometry.boundingSphere = new THREE.Sphere();
    }
    follow(line) {
      const { geometry } = this.mesh, { position, normal } = geometry.attributes;
      this.bend.apply(line, position.array, normal.array);
      position.needsUpdate = normal.needsUpdate = true;
      boundLine(line, this.reach, geometry.boundingSphere);
    }
  }

  // A beam without shapes. Far away it has fewer triangles, which count where no graphics processor draws.
  class Tube {
    constructor(geometry, { frames, count }, radius, sides) {
      Object.assign(this, { geometry, radius, sides, count });
      let length = 0;
      for (let k = 12; k < frames.length; k += 12) {
        length += Math.hypot(frames[k] - frames[k - 12], frames[k + 1] - frames[k - 11], frames[k + 2] - frames[k - 10]);
      }
      this.distance = length / (count - 1);
      this.details = { "1 1": geometry.index };
      this.detail = "1 1";
    }
    // `pixels`: of a metre at its place.
    simplify(pixels) {
      const { count, sides, details } = this;
      const [step, skip] = P.coarseness(count, sides, pixels * this.radius, pixels * this.distance);
      const detail = `${step} ${skip}`;
      if (detail === this.detail) return;
      this.detail = detail;
      details[detail] = details[detail] ||
        new THREE.BufferAttribute(new Uint32Array(P.tubeTriangles(count, sides, step, skip)), 1);
      this.geometry.setIndex(details[detail]);
    }
  }

  const box = new THREE.Box3(), point = new THREE.Vector3();
  function boundLine(line, reach, sphere) {
    box.makeEmpty();
    for (let k = 0; k < line.frames.length; k += 12) {
      box.expandByPoint(point.set(line.frames[k], line.frames[k + 1], line.frames[k + 2]));
    }
    box.getBoundingSphere(sphere);
    sphere.radius += reach;
  }

  class Arm {
    constructor(run, isGhost = false) {
      this.run = run;
      this.root = new THREE.Group();
      this.hidden = new Set();
      this.parts = [];
      this.beams = this.makeBeams();
      this.links = run.picture.links.map((link, l) => this.makeLink(link, l, isGhost));
    }

    makeBeams() {
      const { beams } = this.run.picture;
      const sections = beams.reduce((sum, beam) => sum + beam.sections.length, 0);
      const parts = Math.min(Math.max(Math.floor(MOST_FRAMES / Math.max(sections, 1)), 1), MOST_PARTS);
      this.sides = sections > MANY_SECTIONS ? FEWER_SIDES : SIDES;
      return beams.map((beam) => {
        if (beam.sections.length < 2 || beam.link < 0) return null;
        const rest = new P.Line(beam.sections.length, parts);
        rest.follow(Float64Array.from(beam.sections.flat()), 0, P.POSE);
        return {
          rest,
          line: new P.Line(beam.sections.length, parts),
          amounts: new Float32Array(rest.count),
          isAtRest: false
        };
      });
    }

    makeLink(link, l, isGhost) {
      const frame = new THREE.Group();
      this.root.add(frame);
      const beam = link.beam >= 0 ? this.beams[link.beam] : null;
      const surfaces = P.surfacesOf(this.run, link);
      for (const surface of surfaces) {
        const along = beam ? P.splitAlong(surface, beam.rest) : null;
        this.addPart(new Part(l, beam ? link.beam : -1, surface, isGhost, false), beam, along, frame);
      }
      if (beam && !surfaces.length) {
        const radius = Math.max(this.run.picture.beams[link.beam].tube, THINNEST * this.run.picture.extent.radius);
        const { surface, along } = P.tube(beam.rest, radius, this.sides);
        const part = new Part(l, link.beam, surface, isGhost, true);
        part.tube = new Tube(part.mesh.geometry, beam.rest, radius, this.sides);
        this.addPart(part, beam, along, frame);
      }
      return frame;
    }
    addPart(part, beam, along, frame) {
      if (beam) part.bendWith(beam, along);
      this.parts.push(part);
      (beam ? this.root : frame).add(part.mesh);
    }

    place(values) {
      const { layout, picture } = this.run;
      this.links.forEach((frame, l) => {
        frame.visible = setPose(frame, values, layout.links[l]) && !this.hidden.has(l);
      });
      this.beams.forEach((beam, b) => {
        if (!beam) return;
        beam.isAtRest = !isComplete(values, layout.beams[b], picture.beams[b].sections.length);
        if (!beam.isAtRest) beam.line.follow(values, layout.beams[b], P.SECTION);
      });
      for (const part of this.parts) {
        if (!part.bend) continue;
        const beam = this.beams[part.beam], { mesh } = part, frame = this.links[part.link];
        mesh.visible = frame.visible;
        if (!mesh.visible) continue;
        // A beam of whose sections nothing is known is drawn undeformed.
        part.follow(beam.isAtRest ? beam.rest : beam.line);
        if (beam.isAtRest) { mesh.position.copy(frame.position); mesh.quaternion.copy(frame.quaternion); }
        else { mesh.position.set(0, 0, 0); mesh.quaternion.set(0, 0, 0, 1); }
      }
    }

    // Before it is drawn. `pixels`: of a metre at the distance of a metre.
    simplify(camera, pixels) {
      for (const { tube, mesh } of this.parts) {
        if (!tube || !mesh.visible) continue;
        const { center, radius } = mesh.geometry.boundingSphere;
        point.copy(center).applyQuaternion(mesh.quaternion).add(mesh.position);
        tube.simplify(pixels / Math.max(camera.position.distanceTo(point) - radius, camera.near));
      }
    }

    // Colours beams by a quantity, or by their own colours (null). `largest`: where the scale ends.
    color(quantity, largest) {
      // A beam that does not have the quantity at all of its sections has its own colours.
      const hasAmounts =
        this.beams.map((beam, b) => Boolean(beam && quantity && !beam.isAtRest && this.fillAmounts(beam, b, quantity)));
      for (const part of this.parts) {
        if (!part.bend || !part.mesh.visible) continue;
        const { color } = part.mesh.geometry.attributes;
        const isPlain = !hasAmounts[part.beam];
        if (isPlain && part.isPlain) continue;
        if (isPlain) color.array.set(part.plain);
        else colorBy(part.bend.along, this.beams[part.beam].amounts, quantity, largest, color.array);
        part.isPlain = isPlain;
        color.needsUpdate = true;
      }
    }
    // Returns whether all amounts are known.
    fillAmounts(beam, b, quantity) {
      const { run } = this, { values, layout } = run, { parts } = beam.rest;
      const { radius, sections } = run.picture.beams[b];
      const amount = (k) => {
        const at = layout.beams[b] + P.SECTION * k;
        return quantity.value ? quantity.value(values, at, radius) : P.sectionSpeed(run, at);
      };
      let here = amount(0);
      for (let k = 0; k + 1 < sections.length; ++k) {
        const next = amount(k + 1);
        for (let j = 0; j < parts; ++j) beam.amounts[k * parts + j] = here + (next - here) * j / parts;
        here = next;
      }
      beam.amounts[beam.amounts.length - 1] = here;
      return !beam.amounts.some(Number.isNaN);
    }

    highlight(selected, hovered) {
      for (const { link, material, bend } of this.parts) {
        const state = link === selected ? SELECTED : link === hovered ? HOVERED : NORMAL;
        // Beams only become brighter, since their colours must stay readable.
        material.emissive.setHex(bend ? 0xffffff : state.color);
        material.emissiveIntensity = bend ? state.brighter : state.amount;
      }
    }

    // Where on a beam a ray hit, as a number of sections from its root.
    sectionOf(part, face) {
      const { along } = part.bend;
      return (along[face.a] + along[face.b] + along[face.c]) / 3 / this.beams[part.beam].rest.parts;
    }
  }

  function setPose(object, values, at) {
    for (let k = 0; k < P.POSE; ++k) if (Number.isNaN(values[at + k])) return false;
    object.position.set(values[at], values[at + 1], values[at + 2]);
    object.quaternion.set(values[at + 3], values[at + 4], values[at + 5], values[at + 6]).normalize();
    return true;
  }
  function isComplete(values, at, sections) {
    for (let k = 0; k < sections; ++k, at += P.SECTION) {
      for (let c = 0; c < P.POSE; ++c) if (Number.isNaN(values[at + c])) return false;
    }
    return true;
  }
  function colorBy(along, amounts, quantity, largest, colors) {
    const { table } = P.mapOf(quantity), last = amounts.length - 1;
    const scale = Math.max(largest, quantity.least);
    for (let k = 0; k < along.length; ++k) {
      const first = Math.min(Math.floor(along[k]), last), part = along[k] - first;
      const amount = amounts[first] + (part > 0 ? (amounts[Math.min(first + 1, last)] - amounts[first]) * part : 0);
      const at = 3 * P.level(amount, scale, quantity.signed);
      colors[4 * k] = table[at];
      colors[4 * k + 1] = table[at + 1];
      colors[4 * k + 2] = table[at + 2];
    }
  }

  Object.assign(P, { Arm, setPose });
})(window.Player = window.Player || {});
