// Which triangles does a link have? Shapes as triangles, and surfaces that bend with a beam.
(function (P) {
  "use strict";

  const LINK_COLOR = [0.56, 0.6, 0.66];

  // Triangles in a link's frame, as lists that grow.
  class Surface {
    constructor(alpha = 1) {
      this.alpha = alpha;
      this.positions = [];
      this.normals = [];
      this.colors = [];
      this.triangles = [];
    }
    get count() { return this.positions.length / 3; }
    add(geometry, pose, color) {
      const first = this.count;
      geometry.applyMatrix(matrixOf(pose));
      const { position, normal } = geometry.attributes;
      for (let k = 0; k < position.array.length; ++k) this.positions.push(position.array[k]);
      for (let k = 0; k < normal.array.length; ++k) this.normals.push(normal.array[k]);
      for (let k = 0; k < position.count; ++k) this.colors.push(...color);
      for (let k = 0; k < geometry.index.count; ++k) this.triangles.push(first + geometry.index.array[k]);
      geometry.dispose();
    }
    geometry() {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(this.positions, 3));
      geometry.setAttribute("normal", new THREE.Float32BufferAttribute(this.normals, 3));
      geometry.setAttribute("color", new THREE.Float32BufferAttribute(this.colors, 3));
      geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(this.triangles), 1));
      return geometry;
    }
  }

  function matrixOf(pose) {
    return new THREE.Matrix4().compose(new THREE.Vector3(pose[0], pose[1], pose[2]),
      new THREE.Quaternion(pose[3], pose[4], pose[5], pose[6]).normalize(), new THREE.Vector3(1, 1, 1));
  }

  function shapeGeometry(shape, meshes) {
    const { radius } = shape;
    if (shape.kind === "box") return new THREE.BoxBufferGeometry(...shape.size);
    if (shape.kind === "sphere") return new THREE.SphereBufferGeometry(radius, 32, 20);
    if (shape.kind === "cylinder") {
      return new THREE.CylinderBufferGeometry(radius, radius, shape.length, 32).rotateX(Math.PI / 2);
    }
    const mesh = shape.kind === "mesh" && shape.mesh >= 0 ? meshes[shape.mesh] : null;
    if (!mesh) return null;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(mesh.positions.slice(), 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  // Lines to the places of a link's children and to its centre of mass, where it has no shapes.
  function addStick(points, radius, surface) {
    const along = new THREE.Vector3(), turn = new THREE.Quaternion(), up = new THREE.Vector3(0, 1, 0);
    for (const point of points) {
      const length = along.set(...point).length();
      if (length < radius) continue;
      turn.setFromUnitVectors(up, along.divideScalar(length));
      const pose = [point[0] / 2, point[1] / 2, point[2] / 2, turn.x, turn.y, turn.z, turn.w];
      surface.add(new THREE.CylinderBufferGeometry(radius, radius, length, 12), pose, LINK_COLOR);
    }
    if (points.length)
      surface.add(new THREE.SphereBufferGeometry(1.6 * radius, 16, 12), [0, 0, 0, 0, 0, 0, 1], LINK_COLOR);
  }

  // The surfaces of a link without those of its beam's tube: one for each transparency.
  function surfacesOf(run, link) {
    const byAlpha = new Map();
    for (const shape of link.shapes) {
      const geometry = shapeGeometry(shape, run.meshes);
      if (!geometry) continue;
      const color = shape.color || [...LINK_COLOR, 1], alpha = Math.min(Math.max(color[3], 0), 1);
      if (!byAlpha.has(alpha)) byAlpha.set(alpha, new Surface(alpha));
      byAlpha.get(alpha).add(geometry, shape.pose, color.slice(0, 3));
    }
    if (!byAlpha.size && link.beam < 0) {
      const surface = new Surface();
      addStick(link.stick, 0.008 * run.picture.extent.radius, surface);
      if (link.mass) {
        const ball = new THREE.SphereBufferGeometry(link.mass.radius, 32, 20);
        surface.add(ball, [...link.mass.at, 0, 0, 0, 1], LINK_COLOR);
      }
      if (surface.count) byAlpha.set(1, surface);
    }
    return [...byAlpha.values()];
  }

  // ---------------------------------------------------------------- the line of a beam

  const FRAME = 12;  // numbers of a frame: the place, then three axes

  // The sections of a beam and `parts` - 1 frames between two of them, on a smooth curve.
  class Line {
    constructor(sectionCount, parts) {
      this.sections = sectionCount;
      this.parts = parts;
      this.count = (sectionCount - 1) * parts + 1;
      this.frames = new Float32Array(FRAME * this.count);
    }
    // `values`: the poses of sections, each `stride` numbers after the one before.
    follow(values, at, stride) {
      for (let k = 0; k + 1 < this.sections; ++k, at += stride) this.followPiece(k, values, at, at + stride);
      this.setFrame(this.count - 1, values[at], values[at + 1], values[at + 2],
        values[at + 3], values[at + 4], values[at + 5], values[at + 6]);
    }
    followPiece(k, v, a, b) {
      const wx = v[b] - v[a], wy = v[b + 1] - v[a + 1], wz = v[b + 2] - v[a + 2];
      const ax = axisX(v, a), ay = axisY(v, a), az = axisZ(v, a), bx = axisX(v, b), by = axisY(v, b), bz = axisZ(v, b);
      // With this speed the curve between two sections of a circle is nearly a circle.
      const cosine = Math.min(Math.max(ax * bx + ay * by + az * bz, -1), 1);
      const speed = 2 * Math.hypot(wx, wy, wz) / (1 + Math.sqrt((1 + cosine) / 2));
      const dot = v[a + 3] * v[b + 3] + v[a + 4] * v[b + 4] + v[a + 5] * v[b + 5] + v[a + 6] * v[b + 6];
      const sign = dot < 0 ? -1 : 1;
      for (let j = 0; j < this.parts; ++j) {
        const u = j / this.parts, there = u * u * (3 - 2 * u);
        const out = speed * u * (1 - u) * (1 - u), into = speed * u * u * (u - 1);
        const p = 1 - u, q = sign * u;
        this.setFrame(k * this.parts + j,
          v[a] + there * wx + out * ax + into * bx, v[a + 1] + there * wy + out * ay + into * by,
          v[a + 2] + there * wz + out * az + into * bz,
          p * v[a + 3] + q * v[b + 3], p * v[a + 4] + q * v[b + 4],
          p * v[a + 5] + q * v[b + 5], p * v[a + 6] + q * v[b + 6]);
      }
    }
    setFrame(index, px, py, pz, x, y, z, w) {
      const f = this.frames, at = FRAME * index, scale = 2 / (x * x + y * y + z * z + w * w);
      f[at] = px; f[at + 1] = py; f[at + 2] = pz;
      f[at + 3] = 1 - scale * (y * y + z * z); f[at + 4] = scale * (x * y + z * w); f[at + 5] = scale * (x * z - y * w);
      f[at + 6] = scale * (x * y - z * w); f[at + 7] = 1 - scale * (x * x + z * z); f[at + 8] = scale * (y * z + x * w);
      f[at + 9] = scale * (x * z + y * w);
      f[at + 10] = scale * (y * z - x * w);
      f[at + 11] = 1 - scale * (x * x + y * y);
    }
  }
  const square = (v, a) => v[a + 3] ** 2 + v[a + 4] ** 2 + v[a + 5] ** 2 + v[a + 6] ** 2;
  const axisX = (v, a) => 1 - 2 * (v[a + 4] ** 2 + v[a + 5] ** 2) / square(v, a);
  const axisY = (v, a) => 2 * (v[a + 3] * v[a + 4] + v[a + 5] * v[a + 6]) / square(v, a);
  const axisZ = (v, a) => 2 * (v[a + 3] * v[a + 5] - v[a + 4] * v[a + 6]) / square(v, a);

  // ---------------------------------------------------------------- surfaces that bend

  // A surface whose vertices follow the frames of a line. A vertex moves with two frames, weighted by how near it is to
  // each; `along` counts frames, such as 2.5 in the middle between the third and the fourth.
  class Bend {
    constructor(along, positions, normals, rest) {
      const count = along.length;
      this.along = Float32Array.from(along);
      this.first = new Uint32Array(count);
      this.local = new Float32Array(9 * count);  // place in the first and in the second frame, normal in the first
      for (let k = 0; k < count; ++k) {
        const first = Math.min(Math.floor(along[k]), rest.count - 2);
        this.first[k] = first;
        toFrame(rest.frames, FRAME * first, positions, 3 * k, this.local, 9 * k, true);
        toFrame(rest.frames, FRAME * (first + 1), positions, 3 * k, this.local, 9 * k + 3, true);
        toFrame(rest.frames, FRAME * first, normals, 3 * k, this.local, 9 * k + 6, false);
      }
    }
    apply(line, positions, normals) {
      const { along, first, local } = this, f = line.frames;
      for (let k = 0, at = 0, l = 0; k < along.length; ++k, at += 3, l += 9) {
        const a = FRAME * first[k], b = a + FRAME, q = along[k] - first[k], p = 1 - q;
        const x = local[l], y = local[l + 1], z = local[l + 2], u = local[l + 3], v = local[l + 4], w = local[l + 5];
        const nx = local[l + 6], ny = local[l + 7], nz = local[l + 8];
        for (let c = 0; c < 3; ++c) {
          positions[at + c] = p * (f[a + c] + f[a + 3 + c] * x + f[a + 6 + c] * y + f[a + 9 + c] * z) +
            q * (f[b + c] + f[b + 3 + c] * u + f[b + 6 + c] * v + f[b + 9 + c] * w);
          // Two neighbouring frames differ by little, so the normal follows their mean.
          normals[at + c] = (p * f[a + 3 + c] + q * f[b + 3 + c]) * nx + (p * f[a + 6 + c] + q * f[b + 6 + c]) * ny +
            (p * f[a + 9 + c] + q * f[b + 9 + c]) * nz;
        }
      }
    }
  }
  function toFrame(f, a, from, at, to, into, isPlace) {
    const x = from[at] - (isPlace ? f[a] : 0), y = from[at + 1] - (isPlace ? f[a + 1] : 0);
    const z = from[at + 2] - (isPlace ? f[a + 2] : 0);
    for (let c = 0; c < 3; ++c) to[into + c] = f[a + 3 + 3 * c] * x + f[a + 4 + 3 * c] * y + f[a + 5 + 3 * c] * z;
  }

  // A tube around the line at rest: a ring of vertices at each frame, and two more for the ends. Returns the surface and
  // where its vertices are along the line.
  function tube(rest, radius, sides) {
    const surface = new Surface(), along = [], f = rest.frames;
    const ring = (k, ahead) => {
      const a = FRAME * k;
      for (let side = 0; side < sides; ++side) {
        const c = Math.cos(2 * Math.PI * side / sides), s = Math.sin(2 * Math.PI * side / sides);
        for (let i = 0; i < 3; ++i) {
          const way = c * f[a + 6 + i] + s * f[a + 9 + i];
          surface.positions.push(f[a + i] + radius * way);
          surface.normals.push(ahead ? ahead * f[a + 3 + i] : way);
        }
        surface.colors.push(...LINK_COLOR);
        along.push(k);
      }
    };
    for (let k = 0; k < rest.count; ++k) ring(k, 0);
    ring(0, -1);
    ring(rest.count - 1, 1);
    surface.triangles = tubeTriangles(rest.count, sides, 1, 1);
    return { surface, along };
  }
  // The triangles of a tube with `count` frames, of which every `step`th is used, and every `skip`th of the sides.
  function tubeTriangles(count, sides, step, skip) {
    const triangles = [], rings = [];
    for (let k = 0; k < count - 1; k += step) rings.push(k);
    rings.push(count - 1);
    for (let r = 0; r + 1 < rings.length; ++r) {
      const here = rings[r] * sides, next = rings[r + 1] * sides;
      for (let side = 0; side < sides; side += skip) {
        const other = (side + skip) % sides;
        triangles.push(here + side, here + other, next + other, here + side, next + other, next + side);
      }
    }
    const first = count * sides, last = first + sides;
    for (let side = skip; side + skip < sides; side += skip) {
      triangles.push(first, first + side + skip, first + side, last, last + side, last + side + skip);
    }
    return triangles;
  }

  // How coarse may a tube be whose radius and distance of frames are so many pixels? As [step, skip] of tubeTriangles().
  const LONGEST_STEP = 4, SMALLEST_STEP = 0.6;  // [pixels]: along the line; from a circle to the polygon
  function coarseness(count, sides, radius, distance) {
    let step = 1, skip = 1;
    while (2 * step < count && 2 * step * distance <= LONGEST_STEP) step *= 2;
    const isRound = (corners) => corners >= 4 && radius * (1 - Math.cos(Math.PI / corners)) <= SMALLEST_STEP;
    while (isRound(sides / (2 * skip))) skip *= 2;
    return [step, skip];
  }

  // An edge reaches over REACH frames at most, unless it is shorter than SHORTEST distances of frames: the nearest
  // point of the line may jump along any edge.
  const REACH = 2, SHORTEST = 0.25, MOST_TRIANGLES = 60000;

  // Splits triangles at the middle of the edge that reaches farthest along the line, so that they can bend. Neighbours
  // split their common edge at the same place, so there are no gaps. Returns where vertices are along the line.
  function splitAlong(surface, rest) {
    const { positions, normals, colors } = surface, f = rest.frames, along = [], middles = new Map();
    let length = 0;
    for (let k = 0; k + 1 < rest.count; ++k) length += distance(f, FRAME * k, FRAME * (k + 1));
    const shortest = SHORTEST * length / (rest.count - 1);
    for (let k = 0; k < surface.count; ++k) along.push(nearest(rest, positions, 3 * k));
    const reach = (a, b) => (distance(positions, 3 * a, 3 * b) < shortest ? 0 : Math.abs(along[a] - along[b]));
    const middleOf = (a, b) => {
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      if (!middles.has(key)) {
        middles.set(key, surface.count);
        for (const values of [positions, normals, colors]) {
          for (let c = 0; c < 3; ++c) values.push((values[3 * a + c] + values[3 * b + c]) / 2);
        }
        along.push(nearest(rest, positions, positions.length - 3));
      }
      return middles.get(key);
    };
    const waiting = surface.triangles, done = [];
    while (waiting.length) {
      let c = waiting.pop(), b = waiting.pop(), a = waiting.pop();
      const ab = reach(a, b), bc = reach(b, c), ca = reach(c, a), most = Math.max(ab, bc, ca);
      if (most <= REACH || (waiting.length + done.length) / 3 >= MOST_TRIANGLES) { done.push(a, b, c); continue; }
      if (most === bc && most !== ab) [a, b, c] = [b, c, a]; else if (most !== ab) [a, b, c] = [c, a, b];
      const middle = middleOf(a, b);
      waiting.push(a, middle, c, middle, b, c);
    }
    surface.triangles = done;
    return along;
  }
  const distance = (v, a, b) => Math.hypot(v[b] - v[a], v[b + 1] - v[a + 1], v[b + 2] - v[a + 2]);
  function nearest(rest, positions, at) {
    const f = rest.frames;
    let best = 0, least = Infinity;
    for (let k = 0; k + 1 < rest.count; ++k) {
      const a = FRAME * k, b = a + FRAME;
      let square = 0, dot = 0, far = 0;
      for (let c = 0; c < 3; ++c) {
        square += (f[b + c] - f[a + c]) ** 2;
        dot += (f[b + c] - f[a + c]) * (positions[at + c] - f[a + c]);
      }
      const part = square > 0 ? Math.min(Math.max(dot / square, 0), 1) : 0;
      for (let c = 0; c < 3; ++c) far += (f[a + c] + part * (f[b + c] - f[a + c]) - positions[at + c]) ** 2;
      if (far < least) { least = far; best = k + part; }
    }
    return best;
  }

  Object.assign(P, { Surface, Line, Bend, tube, tubeTriangles, coarseness, splitAlong, surfacesOf });
})(window.Player = window.Player || {});
