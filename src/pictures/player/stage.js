// The canvas: one scene for each run, side by side, seen by one camera.
(function (P) {
  "use strict";

  const VIEW_ANGLE = 35;                     // vertical [degrees]
  const START_DIRECTION = [0.55, -0.75, 0.36];  // from the scene to the camera, if up is z
  const FILLED = 0.9;  // of the picture by what moves; marks and arrows at its edge need the rest
  const FAR = 100;     // per radius of what is shown
  const ACROSS = 1.2;  // the best ratio of a run's width to its height
  const NEAR = 9;      // so far from the pointer a joint is found [CSS pixels]

  class Stage {
    // `redraw()` asks for a new picture.
    constructor(canvas, redraw) {
      this.canvas = canvas;
      this.redraw = redraw;
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
      this.renderer.setScissorTest(true);
      this.renderer.autoClear = false;
      this.camera = new THREE.PerspectiveCamera(VIEW_ANGLE, 1, 0.01, 100);
      this.ray = new THREE.Raycaster();
      this.views = [];
      this.shown = new Set();
      this.theme = { background: "#ffffff", grid: "#888888", ground: "#888888" };
      this.quantity = null;
      this.largest = new P.Largest();
      this.followed = null;  // {run, link}
      this.margin = 0;       // at the right, which several runs leave free [CSS pixels]
      this.setRuns([]);
    }

    setRuns(runs) {
      for (const { scene } of this.views) scene.traverse(dispose);
      const gravity = new THREE.Vector3(...(runs.length ? runs[0].picture.gravity : [0, 0, 0]));
      this.up = gravity.length() > 0 ? gravity.normalize().negate() : new THREE.Vector3(0, 0, 1);
      this.views = runs.map((run) => this.makeView(run));
      this.extent = commonExtent(runs);
      this.followed = null;
      this.makeControls();
      this.fit();
      this.setTheme(this.theme);
      this.setShown(this.shown);
    }
    makeView(run) {
      const scene = new THREE.Scene(), arm = new P.Arm(run), marks = new P.Marks(run, arm);
      const sky = new THREE.HemisphereLight(0xffffff, 0x9a9a9a, 0.62), lamp = new THREE.DirectionalLight(0xffffff, 0.5);
      sky.position.copy(this.up);
      scene.add(sky, lamp, lamp.target, arm.root, marks.root);
      let ghost = null;
      if (run.picture.still >= 0) {
        ghost = new P.Arm(run, true);
        const values = new Float64Array(run.layout.count);
        run.sampleInto(values, run.picture.still, 0);
        ghost.place(values);
        scene.add(ghost.root);
      }
      return { run, scene, arm, ghost, marks, lamp };
    }

    // ---------------------------------------------------------------- camera

    makeControls() {
      if (this.controls) this.controls.dispose();
      this.camera.up.copy(this.up);
      this.controls = new THREE.OrbitControls(this.camera, this.canvas);
      this.controls.enableKeys = false;  // the arrow keys step through time
      this.controls.screenSpacePanning = true;
      this.controls.addEventListener("change", this.redraw);
      this.controls.addEventListener("start", () => { this.isFitted = false; });
    }
    // Shows all that moves, from the direction of the start, or from another one.
    fit(direction = null) {
      const way = direction || this.startDirection();
      this.fitDirection = way.clone().normalize();
      this.isFitted = true;
      this.refit();
      this.redraw();
    }
    refit() {
      this.controls.target.copy(this.extent.center);
      this.camera.position.copy(this.extent.center).add(this.fitDirection);
      this.controls.update();  // turns the camera
      this.camera.position.copy(this.extent.center).addScaledVector(this.fitDirection, this.fitDistance());
      this.controls.update();
    }
    // From where the camera, which looks at the centre, sees the whole sphere or the whole box around what moves.
    fitDistance() {
      const { radius, half } = this.extent, vertical = FILLED * Math.tan(this.camera.fov * Math.PI / 360);
      const slopes = [vertical * this.aspect, vertical], inverse = this.camera.quaternion.clone().conjugate();
      const bySphere = radius / Math.sin(Math.atan(Math.min(...slopes)));
      let byBox = 0;
      for (let k = 0; k < 8; ++k) {
        corner.set(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
        corner.applyQuaternion(inverse);
        byBox = Math.max(byBox, corner.z + Math.abs(corner.x) / slopes[0], corner.z + Math.abs(corner.y) / slopes[1]);
      }
      return Math.min(bySphere, byBox);
    }
    startDirection() {
      const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
      return new THREE.Vector3(...START_DIRECTION).applyQuaternion(turn);
    }
    setCamera({ position, target, fov }) {
      this.isFitted = false;
      if (Number.isFinite(fov)) this.camera.fov = fov;
      if (target) this.controls.target.fromArray(target);
      if (position) this.camera.position.fromArray(position);
      this.controls.update();
      this.redraw();
    }
    // The camera keeps its place relative to the link.
    follow(run, link) {
      this.followed = link >= 0 ? { run, link, last: null } : null;
      this.moveWithFollowed();
      this.redraw();
    }
    moveWithFollowed() {
      const { followed } = this;
      if (!followed) return;
      const frame = this.views[followed.run].arm.links[followed.link];
      if (followed.last) {
        moved.copy(frame.position).sub(followed.last);
        this.camera.position.add(moved);
        this.controls.target.add(moved);
        this.isFitted = false;
      } else followed.last = new THREE.Vector3();
      followed.last.copy(frame.position);
    }
    prepareCamera() {
      const { camera } = this, { radius, center } = this.extent;
      camera.aspect = this.aspect;
      const distance = camera.position.distanceTo(center);
      camera.near = Math.max(distance - 4 * radius, 0.002 * (radius + distance));
      camera.far = distance + FAR * radius;
      camera.updateProjectionMatrix();
      camera.lookAt(this.controls.target);
      camera.updateMatrixWorld();
    }

    // ---------------------------------------------------------------- drawing

    // Sizes are in CSS pixels.
    resize(width, height, ratio, margin) {
      if (width === this.width && height === this.height && ratio === this.ratio && margin === this.margin) return;
      this.setSize(width, height, ratio, margin);
      this.redraw();
    }
    // `ratio`: pixels of the screen in one of CSS.
    setSize(width, height, ratio, margin) {
      Object.assign(this, { width, height, ratio, margin });
      if (this.isFitted) this.refit();
    }
    // The canvas gets its size when it is drawn, since a new size takes new memory.
    useSize() {
      const { width, height, ratio, renderer } = this, used = `${width} ${height} ${ratio}`;
      if (used === this.usedSize) return;
      this.usedSize = used;
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height, false);
    }
    get room() { return this.views.length > 1 ? this.width - this.margin : this.width; }
    // The grid in which runs are largest; of two such grids, the one with fewer empty places.
    get columns() {
      const count = Math.max(this.views.length, 1);
      let best = 1, most = 0;
      for (let columns = count; columns >= 1; --columns) {
        const rows = Math.ceil(count / columns), empty = rows * columns - count;
        const size = Math.min(this.room / columns / ACROSS, this.height / rows) * (1 - 0.01 * empty);
        if (size > most) { most = size; best = columns; }
      }
      return best;
    }
    // Where a run is in the canvas, from its upper left corner.
    cell(run) {
      const columns = this.columns, rows = Math.ceil(Math.max(this.views.length, 1) / columns);
      const width = this.room / columns, height = this.height / rows;
      return { x: (run % columns) * width, y: Math.floor(run / columns) * height, width, height };
    }
    get aspect() {
      const { width, height } = this.cell(0);
      return width > 0 && height > 0 ? width / height : 1;
    }

    // Moves everything to the instant that the runs show.
    place(parts, seconds) {
      this.views.forEach(({ run, arm, marks }, r) => {
        arm.place(run.values);
        marks.place(run.values, this.largest, seconds, parts[r].first, parts[r].last, arm.hidden);
      });
      this.colorBeams();
      this.moveWithFollowed();
    }
    colorBeams() {
      const { quantity } = this;
      for (const { arm } of this.views) arm.color(quantity, quantity ? this.largest.amounts[quantity.key] : 0);
    }
    draw() {
      this.useSize();
      this.prepareCamera();
      const { renderer, camera } = this;
      renderer.setScissor(0, 0, this.width, this.height);
      renderer.setViewport(0, 0, this.width, this.height);
      renderer.clear();
      this.views.forEach(({ scene, lamp, arm, ghost }, r) => {
        const { x, y, width, height } = this.cell(r), bottom = this.height - y - height;
        const pixels = height * this.ratio / (2 * Math.tan(camera.fov * Math.PI / 360));
        for (const drawn of [arm, ghost]) if (drawn) drawn.simplify(camera, pixels);
        renderer.setViewport(x, bottom, width, height);
        renderer.setScissor(x, bottom, width, height);
        // The light comes from behind the camera, a little from the left and from above.
        lamp.position.set(-0.6, 0.8, 1.6).applyQuaternion(camera.quaternion);
        lamp.target.position.set(0, 0, 0);
        renderer.render(scene, camera);
      });
    }
    // Draws at another size and calls `use(canvas)`. The next draw() is as before.
    drawAt(width, height, margin, use) {
      const before = [this.width, this.height, this.ratio, this.margin];
      const position = this.camera.position.clone(), isFitted = this.isFitted;
      this.setSize(width, height, 1, margin);
      this.draw();
      use(this.canvas);
      this.setSize(...before);
      if (!isFitted) this.camera.position.copy(position);
    }

    setTheme(colors) {
      this.theme = colors;
      this.renderer.setClearColor(colors.background, 1);
      for (const { marks } of this.views) marks.setTheme(colors);
      this.redraw();
    }
    setShown(shown) {
      this.shown = shown;
      for (const { marks, ghost } of this.views) {
        marks.show(shown);
        if (ghost) ghost.root.visible = shown.has("still");
      }
    }
    highlight(selected, hovered) {
      this.views.forEach(({ run, arm, marks }, r) => {
        arm.highlight(
          selected && selected.run === r ? selected.link : -1, hovered && hovered.run === r ? hovered.link : -1);
        marks.highlight(
          selected && selected.run === r && selected.joint >= 0 ? run.picture.joints[selected.joint] : null);
      });
      this.redraw();
    }

    // ---------------------------------------------------------------- points of the canvas

    project(position, run) {
      const { x, y, width, height } = this.cell(run);
      this.prepareCamera();
      const point = new THREE.Vector3(...position).project(this.camera);
      return [x + (point.x + 1) / 2 * width, y + (1 - point.y) / 2 * height];
    }
    // What is at a point of the canvas: {run, link, joint, joints, beam, section}, or null. `joints`: all at that place.
    pick(px, py) {
      for (let r = 0; r < this.views.length; ++r) {
        const { x, y, width, height } = this.cell(r);
        if (px < x || py < y || px >= x + width || py >= y + height) continue;
        pointer.set((px - x) / width * 2 - 1, 1 - (py - y) / height * 2);
        this.ray.setFromCamera(pointer, this.camera);
        return this.pickJoint(r, px, py) || this.pickIn(r);
      }
      return null;
    }
    // Joints have a place, but nothing is drawn there unless their axes are switched on.
    pickJoint(r, px, py) {
      const { arm, run } = this.views[r], near = [];
      run.picture.joints.forEach((joint, j) => {
        if (!joint.columns.length || joint.link < 0 || !arm.links[joint.link].visible) return;
        const [x, y] = this.project(arm.links[joint.link].position.toArray(), r), distance = Math.hypot(x - px, y - py);
        if (distance <= NEAR) near.push({ joint: j, distance });
      });
      if (!near.length) return null;
      near.sort((a, b) => a.distance - b.distance);
      const joints = near.filter(({ distance }) => distance <= near[0].distance + 1).map(({ joint }) => joint);
      const [joint] = joints;
      return { run: r, link: run.picture.joints[joint].link, joint, joints, beam: -1 };
    }
    pickIn(r) {
      const { arm, marks, run } = this.views[r];
      const objects = arm.parts.filter((part) => arm.links[part.link].visible).map((part) => part.mesh);
      objects.push(...marks.axes.filter((axis) => axis.visible && axis.parent.visible));
      const [hit] = this.ray.intersectObjects(objects);
      if (!hit) return null;
      const { part, joint } = hit.object.userData;
      if (joint) {
        const index = run.picture.joints.indexOf(joint);
        return { run: r, link: joint.link, joint: index, joints: [index], beam: -1 };
      }
      const section = part.bend ? arm.sectionOf(part, hit.face) : 0;
      return { run: r, link: part.link, joint: -1, beam: part.beam, section };
    }
  }
  const moved = new THREE.Vector3(), corner = new THREE.Vector3(), pointer = new THREE.Vector2();

  function dispose({ geometry, material }) {
    if (geometry) geometry.dispose();
    if (material) material.dispose();
  }
  function commonExtent(runs) {
    const box = new THREE.Box3(), extents = runs.map(({ picture }) => picture.extent).map(({ center, half, radius }) =>
      ({ center: new THREE.Vector3(...center), half: new THREE.Vector3(...half), radius }));
    for (const { center, half } of extents)
      box.expandByPoint(center.clone().add(half)).expandByPoint(center.clone().sub(half));
    const center = new THREE.Vector3(), half = new THREE.Vector3(1, 1, 1);
    if (!extents.length) return { center, half, radius: 1 };
    box.getCenter(center);
    box.getSize(half).multiplyScalar(0.5);
    return { center, half, radius: Math.max(...extents.map((extent) => center.distanceTo(extent.center) + extent.radius)) };
  }

  Object.assign(P, { Stage });
})(window.Player = window.Player || {});
