// Reads a run: its picture (what does not change) and its motion (numbers over time). The format: docs/notes/page.md.
(function (P) {
  "use strict";

  const POSE = 7, SECTION = 19, ARROW = 9;
  const MISSING = 65535, STEPS = 65534, ROUND_OFF = 1e-9;

  // ---------------------------------------------------------------- the picture

  const list = (value) => (Array.isArray(value) ? value : []);
  const objects = (value) => list(value).map((item) => (item && typeof item === "object" ? item : {}));
  const text = (value, otherwise = "") => (typeof value === "string" ? value : otherwise);
  const amount = (value, otherwise) => (Number.isFinite(value) ? value : otherwise);
  const whole = (value) => Math.max(0, Math.floor(amount(value, 0)));
  const index = (value, count) => (Number.isInteger(value) && value >= 0 && value < count ? value : -1);
  const numbers = (value, otherwise) =>
    Array.isArray(value) && value.length === otherwise.length && value.every(Number.isFinite) ? value : otherwise;
  const NO_MOTION = [0, 0, 0, 0, 0, 0, 1];

  function readShape(shape, meshCount) {
    const color = numbers(shape.color, [0, 0, 0, 0]);
    return {
      kind: text(shape.kind), pose: numbers(shape.pose, NO_MOTION),
      color: shape.color ? color : null, size: numbers(shape.size, [0, 0, 0]),
      radius: amount(shape.radius, 0), length: amount(shape.length, 0), mesh: index(shape.mesh, meshCount),
    };
  }

  function readExtent(extent) {
    const radius = Math.max(amount(extent.radius, 1), 1e-9);
    return { center: numbers(extent.center, [0, 0, 0]), radius, half: numbers(extent.half, [radius, radius, radius]) };
  }
  function readMass(mass) {
    return mass && typeof mass === "object" ? { at: numbers(mass.at, [0, 0, 0]), radius: amount(mass.radius, 0) } : null;
  }

  // A copy of the picture in which every member has its type, so nothing else needs to check it.
  function readPicture(raw) {
    const [links, beams, columns, meshes] = [raw.links, raw.beams, raw.columns, raw.meshes].map(objects);
    const frames = whole(raw.frames);
    const picture = {
      name: text(raw.name, "run"), title: text(raw.title), notes: list(raw.notes).map((note) => text(note)),
      extent: readExtent(raw.extent || {}),
      gravity: numbers(raw.gravity, [0, 0, 0]), frames,
      links: links.map((link) => ({
        name: text(link.name), parent: index(link.parent, links.length), beam: index(link.beam, beams.length),
        stick: list(link.stick).map((point) => numbers(point, [0, 0, 0])),
        shapes: objects(link.shapes).map((shape) => readShape(shape, meshes.length)), mass: readMass(link.mass),
      })),
      meshes: meshes.map((mesh) => ({
        name: text(mesh.name), vertices: whole(mesh.vertices), triangles: whole(mesh.triangles),
      })),
      beams: beams.map((beam) => ({
        link: index(beam.link, links.length), radius: amount(beam.radius, 0), tube: amount(beam.tube, amount(beam.radius, 0)),
        arcLengths: list(beam.arc_lengths), sections: list(beam.sections).map((pose) => numbers(pose, NO_MOTION)),
      })),
      joints: objects(raw.joints).map((joint) => ({
        name: text(joint.name), link: index(joint.link, links.length), kind: text(joint.kind),
        axis: joint.axis ? numbers(joint.axis, [0, 0, 1]) : null,
        columns: list(joint.columns).filter((column) => index(column, columns.length) >= 0),
      })),
      probes: objects(raw.probes).map((probe) => ({ name: text(probe.name), link: index(probe.link, links.length) })),
      lines: objects(raw.lines).map((line) => ({
        kind: text(line.kind), name: text(line.name), points: whole(line.points),
      })),
      floors: objects(raw.floors).map((floor) => ({
        pose: numbers(floor.pose, NO_MOTION), size: numbers(floor.size, [0, 0]), cell: amount(floor.cell, 0),
        isGround: floor.ground === true,
      })),
      arrows: objects(raw.arrows).map((arrow) => ({
        kind: text(arrow.kind), count: whole(arrow.count),
      })),
      columns: columns.map((column) => ({ name: text(column.name), unit: text(column.unit) })),
      clips: objects(raw.clips).map((clip) => ({
        name: text(clip.name), first: whole(clip.first), count: whole(clip.count),
      })).filter((clip) => clip.count > 0 && clip.first + clip.count <= frames),
      still: index(raw.still, frames),
    };
    breakCircles(picture.links);
    return picture;
  }

  // A link that is its own ancestor would make the tree endless.
  function breakCircles(links) {
    links.forEach((link, start) => {
      let above = link.parent;
      for (let k = 0; above >= 0 && k <= links.length; ++k) {
        if (above === start || k === links.length) { link.parent = -1; return; }
        above = links[above].parent;
      }
    });
  }

  // Where each thing's tracks begin.
  function layOut(picture) {
    let next = 0;
    const take = (count) => { const first = next; next += count; return first; };
    return {
      links: picture.links.map(() => take(POSE)),
      beams: picture.beams.map((beam) => take(SECTION * beam.sections.length)),
      probes: picture.probes.map(() => take(3)),
      lines: picture.lines.map((line) => take(3 * line.points)),
      arrows: picture.arrows.map((arrow) => take(ARROW * arrow.count)),
      columns: picture.columns.map(() => take(1)),
      count: next,
    };
  }

  // ---------------------------------------------------------------- the motion

  // The bytes of a Base64 text that holds a zlib stream. Of a damaged stream, the bytes before the damage.
  async function inflate(base64) {
    const clean = base64.replace(/\s+/g, "");
    const pieces = [];
    let failure = null, size = 0;
    try {
      const stream = new DecompressionStream("deflate");
      const writing = writePieces(stream.writable.getWriter(), clean).catch((error) => { failure = error; });
      const reader = stream.readable.getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        pieces.push(value);
        size += value.length;
      }
      await writing;
    } catch (error) { failure = failure || error; }
    const bytes = new Uint8Array(size);
    let at = 0;
    for (const piece of pieces) { bytes.set(piece, at); at += piece.length; }
    return { bytes, failure };
  }

  async function writePieces(writer, base64) {
    const LENGTH = 1 << 20;  // a multiple of 4
    try {
      for (let at = 0; at < base64.length; at += LENGTH) {
        await writer.write(bytesOf(base64.slice(at, at + LENGTH)));
      }
    } catch (error) {
      writer.abort(error).catch(() => {});
      throw error;
    }
    await writer.close();
  }

  function bytesOf(base64) {
    const characters = atob(base64), bytes = new Uint8Array(characters.length);
    for (let k = 0; k < characters.length; ++k) bytes[k] = characters.charCodeAt(k);
    return bytes;
  }

  // A recorded run's numbers. They stay as steps of 16 bits, and all numbers of an instant lie side by side, so that
  // showing an instant touches little memory.
  class Recording {
    constructor(trackCount) {
      this.count = 0;
      this.times = new Float64Array(0);
      this.low = new Float64Array(trackCount).fill(NaN);
      this.step = new Float64Array(trackCount);
      this.slot = new Int32Array(trackCount).fill(-1);  // place among the tracks that vary, or -1
      this.tracks = new Int32Array(0);                  // the tracks that vary
      this.steps = new Uint16Array(0);
    }
    time(instant) { return this.times[instant]; }
    value(track, instant) {
      const slot = this.slot[track];
      if (slot < 0) return this.low[track];
      const step = this.steps[instant * this.tracks.length + slot];
      return step === MISSING ? NaN : this.low[track] + this.step[track] * step;
    }
    // How much a track changes; what is only round-off counts as none.
    range(track) {
      const range = this.slot[track] < 0 ? 0 : this.step[track] * STEPS;
      return range > ROUND_OFF * Math.max(1, Math.abs(this.low[track])) ? range : 0;
    }
    // All values between an instant and the next one.
    sample(instant, part, values) {
      const { tracks, steps, low, step } = this, width = tracks.length;
      values.set(low);
      if (!this.count) return;
      const here = instant * width, there = Math.min(instant + 1, this.count - 1) * width;
      for (let slot = 0; slot < width; ++slot) {
        const track = tracks[slot];
        let a = steps[here + slot], b = steps[there + slot];
        if (a === MISSING) a = part < 0.5 ? NaN : b;
        if (b === MISSING) b = part < 0.5 ? a : NaN;
        values[track] = low[track] + step[track] * (a + (b - a) * part);
      }
    }
  }

  // Reads all tracks that are complete. Returns how many, and where the data after them begin.
  function readTracks(bytes, recording, frames) {
    const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const total = recording.low.length;
    if (bytes.length < 8 * frames) return { complete: 0, end: bytes.length };
    recording.times = new Float64Array(frames);
    for (let k = 0; k < frames; ++k) recording.times[k] = data.getFloat64(8 * k, true);
    const starts = [], tracks = [];
    let at = 8 * frames, track = 0;
    for (; track < total && at + 16 <= bytes.length; ++track) {
      const low = data.getFloat64(at, true), high = data.getFloat64(at + 8, true);
      const varies = high > low;
      if (varies && at + 16 + 2 * frames > bytes.length) break;
      at += 16;
      recording.low[track] = low;
      if (!varies) continue;
      recording.step[track] = (high - low) / STEPS;
      recording.slot[track] = tracks.length;
      tracks.push(track);
      starts.push(at);
      at += 2 * frames;
    }
    recording.count = frames;
    recording.tracks = Int32Array.from(tracks);
    recording.steps = readSteps(bytes, starts, frames);
    return { complete: track, end: at };
  }

  // Sums up the differences and turns tracks into instants, some tracks at a time so that the cache holds them.
  function readSteps(bytes, starts, frames) {
    const BLOCK = 64, width = starts.length;
    const steps = new Uint16Array(width * frames), block = new Uint16Array(BLOCK * frames);
    for (let first = 0; first < width; first += BLOCK) {
      const count = Math.min(BLOCK, width - first);
      for (let j = 0; j < count; ++j) {
        const low = starts[first + j], high = low + frames;
        let sum = 0;
        for (let k = 0; k < frames; ++k) {
          sum = (sum + bytes[low + k] + 256 * bytes[high + k]) & 65535;
          block[j * frames + k] = sum;
        }
      }
      for (let k = 0; k < frames; ++k) {
        for (let j = 0; j < count; ++j) steps[k * width + first + j] = block[j * frames + k];
      }
    }
    return steps;
  }

  function readMeshes(bytes, at, meshes) {
    const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    return meshes.map(({ vertices, triangles }) => {
      const size = 48 + 6 * vertices + 12 * triangles;
      if (at < 0 || at + size > bytes.length) { at = -1; return null; }
      const bounds = Array.from({ length: 6 }, (_, k) => data.getFloat64(at + 8 * k, true));
      const positions = new Float32Array(3 * vertices), corners = new Uint32Array(3 * triangles);
      at += 48;
      for (let k = 0; k < positions.length; ++k, at += 2) {
        const low = bounds[k % 3], high = bounds[3 + k % 3];
        positions[k] = low + (high - low) * data.getUint16(at, true) / 65535;
      }
      for (let k = 0; k < corners.length; ++k, at += 4) {
        corners[k] = Math.min(data.getUint32(at, true), vertices - 1);
      }
      return { positions, triangles: corners };
    });
  }

  // ---------------------------------------------------------------- a run

  class Run {
    constructor(picture) {
      this.picture = picture;
      this.layout = layOut(picture);
      this.store = new Recording(this.layout.count);
      this.meshes = picture.meshes.map(() => null);
      this.values = new Float64Array(this.layout.count);  // at the instant that is shown
      this.instant = 0;
      this.part = 0;
      this.isPlaced = false;  // false: no pose is known, and all links are drawn at the origin
    }
    // Of several runs, the titles say which is which.
    get label() { return this.picture.title || this.picture.name; }
    get start() { return this.store.count ? this.store.time(0) : 0; }
    get end() { return this.store.count ? this.store.time(this.store.count - 1) : 0; }
    get duration() { return this.end - this.start; }
    // The last instant at or before a time, from the instants first to last.
    find(time, first = 0, last = this.store.count - 1) {
      let low = first, high = Math.max(last, first);
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (this.store.time(middle) <= time) low = middle; else high = middle - 1;
      }
      return low;
    }
    show(time, first = 0, last = this.store.count - 1) {
      const { store } = this;
      this.instant = this.find(time, first, last);
      const here = store.count ? store.time(this.instant) : 0;
      const next = this.instant < last ? store.time(this.instant + 1) : here;
      this.part = next > here ? Math.min(Math.max((time - here) / (next - here), 0), 1) : 0;
      this.sampleInto(this.values, this.instant, this.part);
    }
    sampleInto(values, instant, part) {
      this.store.sample(instant, part, values);
      if (!this.isPlaced) this.layout.links.forEach((at) => values.set(NO_MOTION, at));
    }
    column(index, instant) { return this.store.value(this.layout.columns[index], instant); }
  }

  // Reads a run; `complain(sentence)` is told what could not be read.
  async function readRun(pictureText, motionText, number, complain) {
    let picture;
    try { picture = readPicture(JSON.parse(pictureText)); } catch (error) {
      complain(`The picture of run ${number} cannot be read, so this run is not shown: ${error.message}`);
      return null;
    }
    const run = new Run(picture), name = picture.name, { frames } = picture;
    const { bytes, failure } = await inflate(motionText);
    const { complete, end } = readTracks(bytes, run.store, frames);
    if (run.store.times.some((time, k) => !(k ? time >= run.store.times[k - 1] : Number.isFinite(time)))) {
      complain(`The times of “${name}” do not increase. Its instants are shown a second after one another.`);
      run.store.times = run.store.times.map((_, k) => k);
    }
    run.isPlaced = complete > 0 || picture.links.length === 0;
    run.meshes = readMeshes(bytes, complete === run.layout.count ? end : -1, picture.meshes);
    if (!bytes.length) {
      complain(`The motion of “${name}” is missing or damaged. Links are drawn at the origin, beams undeformed.`);
    } else if (failure || complete < run.layout.count || run.meshes.includes(null)) {
      complain(`The motion of “${name}” is incomplete: ${complete} of ${run.layout.count} numbers over time could be ` +
        "read. What they show is drawn.");
    }
    return run;
  }

  Object.assign(P, { POSE, SECTION, ARROW, Run, readRun, readPicture, readMeshes, bytesOf });
})(window.Player = window.Player || {});
