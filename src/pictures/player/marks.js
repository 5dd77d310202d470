// What is drawn beside the arm: joints' axes, arrows, lines, probes and their trails, grounds, grid, axes of the world.
(function (P) {
  "use strict";

  // Lengths per radius of the scene.
  const LONGEST_ARROW = 0.35, LARGEST_CIRCLE = 0.15, SHAFT = 0.006, HEAD = 0.018, HEAD_LENGTH = 0.06;
  const AXIS_LENGTH = 0.2, AXIS_RADIUS = 0.004, LINE = 0.005, PROBE = 0.014, WORLD_AXES = 0.2;
  const SHORTEST = 0.02;   // per length of the longest arrow; shorter ones are not drawn
  const SMALLEST = 1e-6;   // smaller forces and moments are round-off in any scene [N, N m]
  const TURN = 1.6 * Math.PI;
  const TRAIL_POINTS = 200;

  // Without a prototype, since kinds are names from a file.
  const arrowKinds = Object.assign(Object.create(null), {
    effort: { name: "Joint efforts", color: "#e8871e" }, load: { name: "Loads", color: "#d6409f" },
    reaction: { name: "Reactions", color: "#3d8ee0" }, contact: { name: "Contacts", color: "#3fa34d" },
  });

  // ---------------------------------------------------------------- arrows

  function circleGeometry() {
    const surface = new P.Surface(), white = [1, 1, 1];
    surface.add(new THREE.TorusBufferGeometry(1, 0.045, 8, 48, TURN - 0.35), [0, 0, 0, 0, 0, 0, 1], white);
    // The head points along the tangent at the end of the arc.
    const end = TURN - 0.35, along = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), end + 0.12);
    surface.add(new THREE.ConeBufferGeometry(0.13, 0.42, 16),
      [Math.cos(end + 0.12), Math.sin(end + 0.12), 0, along.x, along.y, along.z, along.w], white);
    return surface.geometry();
  }

  class Arrows {
    constructor(count, radius, color) {
      const material = new THREE.MeshLambertMaterial({ color, emissive: new THREE.Color(color).multiplyScalar(0.4) });
      const make = (geometry) => {
        const mesh = new THREE.InstancedMesh(geometry, material, count);
        mesh.frustumCulled = false;
        mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
        mesh.count = 0;
        return mesh;
      };
      this.size = count;
      this.radius = radius;
      this.shafts = make(new THREE.CylinderBufferGeometry(1, 1, 1, 12).translate(0, 0.5, 0));
      this.heads = make(new THREE.ConeBufferGeometry(1, 1, 16).translate(0, 0.5, 0));
      this.circles = make(circleGeometry());
      this.group = new THREE.Group().add(this.shafts, this.heads, this.circles);
    }
    place(run, at, largest, last) {
      const { values } = run;
      let straight = 0, round = 0;
      for (let k = 0; k < this.size; ++k, at += P.ARROW) {
        if (Number.isNaN(values[at] + values[at + 3] + values[at + 6])) continue;
        placeStart(run, at, largest, last);
        if (this.placeForce(way.set(values[at + 3], values[at + 4], values[at + 5]), largest.force, straight))
          ++straight;
        if (this.placeMoment(way.set(values[at + 6], values[at + 7], values[at + 8]), largest.moment, round)) ++round;
      }
      this.shafts.count = this.heads.count = straight;
      this.circles.count = round;
      for (const mesh of [this.shafts, this.heads, this.circles]) {
        mesh.visible = mesh.count > 0;
        mesh.instanceMatrix.needsUpdate = true;
      }
    }
    placeForce(force, largest, k) {
      const part = shownPart(force.length(), largest), { radius } = this;
      if (!part) return false;
      const length = LONGEST_ARROW * radius * part, head = Math.min(HEAD_LENGTH * radius, 0.5 * length);
      const thickness = Math.min(1, head / (HEAD_LENGTH * radius)) * radius;
      turn.setFromUnitVectors(Y, force.normalize());
      this.shafts.setMatrixAt(
        k, matrix.compose(start, turn, scale.set(SHAFT * thickness, length - head, SHAFT * thickness)));
      start2.copy(start).addScaledVector(force, length - head);
      this.heads.setMatrixAt(k, matrix.compose(start2, turn, scale.set(HEAD * thickness, head, HEAD * thickness)));
      return true;
    }
    placeMoment(moment, largest, k) {
      const part = shownPart(moment.length(), largest);
      if (!part) return false;
      const size = LARGEST_CIRCLE * this.radius * part;
      turn.setFromUnitVectors(Z, moment.normalize());
      this.circles.setMatrixAt(k, matrix.compose(start, turn, scale.set(size, size, size)));
      return true;
    }
  }
  const start = new THREE.Vector3(), start2 = new THREE.Vector3(), way = new THREE.Vector3();
  const scale = new THREE.Vector3();
  const turn = new THREE.Quaternion(), matrix = new THREE.Matrix4();
  const Y = new THREE.Vector3(0, 1, 0), Z = new THREE.Vector3(0, 0, 1);
  // A place that is not in use at one of the two instants has no position there, so the other's position counts.
  function placeStart({ values, store, instant, part }, at, largest, last) {
    start.set(values[at], values[at + 1], values[at + 2]);
    if (part === 0 || instant >= last) return;
    const amount = (c, k) => Math.hypot(store.value(at + c, k), store.value(at + c + 1, k), store.value(at + c + 2, k));
    // Zero, too, is only right to a step of its track.
    const isUsed = (k) => amount(3, k) > 1e-4 * largest.force || amount(6, k) > 1e-4 * largest.moment;
    const here = isUsed(instant), next = isUsed(instant + 1);
    if (here === next) return;
    const used = here ? instant : instant + 1;
    start.set(store.value(at, used), store.value(at + 1, used), store.value(at + 2, used));
  }
  function shownPart(amount, largest) {
    const part = largest > SMALLEST ? amount / largest : 0;
    return part < SHORTEST ? 0 : Math.min(part, 1);
  }

  // ---------------------------------------------------------------- lines

  // A spring between points or a tendon: a rod from each of its points to the next one.
  class Line {
    constructor(points, radius) {
      this.count = Math.max(points - 1, 0);
      this.thickness = LINE * radius;
      const material = new THREE.MeshPhongMaterial({ color: 0x8a7a55 });
      this.rods = new THREE.InstancedMesh(
        new THREE.CylinderBufferGeometry(1, 1, 1, 8).translate(0, 0.5, 0), material, Math.max(this.count, 1));
      this.rods.frustumCulled = false;
      this.rods.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    }
    place(values, at) {
      let shown = 0;
      for (let k = 0; k < this.count; ++k, at += 3) {
        start.set(values[at], values[at + 1], values[at + 2]);
        way.set(values[at + 3], values[at + 4], values[at + 5]).sub(start);
        const length = way.length();
        if (!(length > 0)) continue;  // a repeated point, or one that is not known
        turn.setFromUnitVectors(Y, way.divideScalar(length));
        this.rods.setMatrixAt(shown++, matrix.compose(start, turn, scale.set(this.thickness, length, this.thickness)));
      }
      this.rods.count = shown;
      this.rods.instanceMatrix.needsUpdate = true;
    }
  }

  // ---------------------------------------------------------------- trails

  // The way of a probe in the last `seconds`, which fades into the background.
  class Trail {
    constructor(track) {
      this.track = track;
      this.positions = new Float32Array(3 * TRAIL_POINTS);
      this.colors = new Float32Array(3 * TRAIL_POINTS);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 3).setUsage(THREE.DynamicDrawUsage));
      geometry.setAttribute("color", new THREE.BufferAttribute(this.colors, 3));
      this.line = new THREE.Line(geometry, new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors }));
      this.line.frustumCulled = false;
    }
    place(run, seconds, first, last) {
      const { store } = run, { track, positions } = this;
      const now = store.count ? store.time(run.instant) + run.part * stepAfter(store, run.instant, last) : 0;
      const begin = store.count ? Math.max(now - seconds, store.time(first)) : 0;
      let instant = store.count ? run.find(begin, first, last) : 0, at = 0;
      for (let k = 0; k < TRAIL_POINTS && store.count; ++k) {
        const time = begin + (now - begin) * k / (TRAIL_POINTS - 1);
        while (instant < run.instant && store.time(instant + 1) <= time) ++instant;
        const step = stepAfter(store, instant, last);
        const part = step > 0 ? Math.min((time - store.time(instant)) / step, 1) : 0;
        const next = Math.min(instant + 1, last);
        for (let c = 0; c < 3; ++c) {
          const a = store.value(track + c, instant), b = store.value(track + c, next);
          positions[at + c] = part > 0 ? a + (b - a) * part : a;
        }
        if (!Number.isNaN(positions[at] + positions[at + 1] + positions[at + 2])) at += 3;
      }
      this.line.geometry.setDrawRange(0, at / 3);
      this.line.geometry.attributes.position.needsUpdate = true;
    }
    fade(color, background) {
      const from = new THREE.Color(background), to = new THREE.Color(color), mixed = new THREE.Color();
      for (let k = 0; k < TRAIL_POINTS; ++k)
        mixed.copy(from).lerp(to, k / (TRAIL_POINTS - 1)).toArray(this.colors, 3 * k);
      this.line.geometry.attributes.color.needsUpdate = true;
    }
  }
  const stepAfter = (store, instant, last) => (instant < last ? store.time(instant + 1) - store.time(instant) : 0);

  // ---------------------------------------------------------------- things that stand still

  // The grid lines of a floor, around its centre.
  function flatGrid({ size: [length, width], cell }, material) {
    const points = [], x = length / 2, y = width / 2;
    const columns = cell > 0 ? Math.round(length / cell) : 0, rows = cell > 0 ? Math.round(width / cell) : 0;
    for (let k = 0; k <= columns; ++k) points.push(k * cell - x, -y, 0, k * cell - x, y, 0);
    for (let k = 0; k <= rows; ++k) points.push(-x, k * cell - y, 0, x, k * cell - y, 0);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    return new THREE.LineSegments(geometry, material);
  }
  function jointAxis(joint, radius) {
    const geometry =
      new THREE.CylinderBufferGeometry(AXIS_RADIUS * radius, AXIS_RADIUS * radius, AXIS_LENGTH * radius, 10);
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: 0x8b5cf6 }));
    mesh.quaternion.setFromUnitVectors(Y, new THREE.Vector3(...joint.axis).normalize());
    return mesh;
  }

  class Marks {
    // `arm`: whose link frames carry the joints' axes.
    constructor(run, arm) {
      const { picture, layout } = run, { radius } = picture.extent;
      this.run = run;
      this.root = new THREE.Group();
      this.gridMaterial = new THREE.LineBasicMaterial({ transparent: true, depthWrite: false });
      this.groundMaterial = new THREE.MeshBasicMaterial({
        transparent: true, opacity: 0.35, side: THREE.DoubleSide, depthWrite: false,
      });
      this.addFloors(picture);
      this.world = this.root.add(new THREE.AxesHelper(WORLD_AXES * radius)).children.slice(-1)[0];
      this.axes = picture.joints.filter((joint) => joint.axis && joint.link >= 0).map((joint) => {
        const axis = jointAxis(joint, radius);
        axis.userData.joint = joint;
        arm.links[joint.link].add(axis);
        return axis;
      });
      this.arrows = picture.arrows.map(({ kind, count }, a) => {
        const arrows = new Arrows(count, radius, (arrowKinds[kind] || { color: "#888888" }).color);
        this.root.add(arrows.group);
        return { kind, arrows, at: layout.arrows[a] };
      });
      this.lines = picture.lines.map(({ points }, l) => {
        const line = new Line(points, radius);
        this.root.add(line.rods);
        return { line, at: layout.lines[l] };
      });
      const ball = new THREE.SphereBufferGeometry(PROBE * radius, 16, 12);
      this.probeMaterial = new THREE.MeshPhongMaterial({ color: 0xe0a100 });
      this.probes = picture.probes.map((probe, p) => {
        const mesh = new THREE.Mesh(ball, this.probeMaterial), trail = new Trail(layout.probes[p]);
        this.root.add(mesh, trail.line);
        return { mesh, trail, link: probe.link, at: layout.probes[p] };
      });
    }
    addFloors(picture) {
      this.grid = new THREE.Group();
      for (const floor of picture.floors) {
        const frame = new THREE.Group();
        frame.add(flatGrid(floor, this.gridMaterial));
        if (floor.isGround) frame.add(new THREE.Mesh(new THREE.PlaneBufferGeometry(...floor.size), this.groundMaterial));
        P.setPose(frame, floor.pose, 0);
        this.grid.add(frame);
      }
      this.root.add(this.grid);
    }
    setTheme(colors) {
      this.gridMaterial.color.set(colors.grid);
      this.gridMaterial.opacity = 0.55;
      this.groundMaterial.color.set(colors.ground);
      for (const { trail } of this.probes) trail.fade("#e0a100", colors.background);
    }
    // `shown`: names of what is switched on.
    show(shown) {
      this.grid.visible = shown.has("grid");
      this.world.visible = shown.has("world");
      for (const axis of this.axes) axis.visible = shown.has("axes");
      for (const { kind, arrows } of this.arrows) arrows.group.visible = shown.has(kind);
      for (const { line } of this.lines) line.rods.visible = shown.has("lines");
      this.hasProbes = shown.has("probes");
      this.hasTrails = shown.has("trails");
    }
    // `hidden`: links that are not shown, nor their probes.
    place(values, largest, seconds, first, last, hidden) {
      for (const { arrows, at } of this.arrows) if (arrows.group.visible) arrows.place(this.run, at, largest, last);
      for (const { line, at } of this.lines) if (line.rods.visible) line.place(values, at);
      for (const { mesh, trail, link, at } of this.probes) {
        const isKnown = !Number.isNaN(values[at] + values[at + 1] + values[at + 2]);
        if (isKnown) mesh.position.set(values[at], values[at + 1], values[at + 2]);
        mesh.visible = isKnown && this.hasProbes && !hidden.has(link);
        trail.line.visible = this.hasTrails && !hidden.has(link);
        if (trail.line.visible) trail.place(this.run, seconds, first, last);
      }
    }
    highlight(joint) {
      for (const axis of this.axes) {
        const isSelected = axis.userData.joint === joint;
        axis.material.color.setHex(isSelected ? 0x2f7de1 : 0x8b5cf6);
        axis.scale.set(isSelected ? 2 : 1, isSelected ? 1.4 : 1, isSelected ? 2 : 1);
      }
    }
  }

  Object.assign(P, { Marks, arrowKinds });
})(window.Player = window.Player || {});
