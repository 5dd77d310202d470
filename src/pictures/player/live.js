// A run that a server sends while it happens.
(function (P) {
  "use strict";

  const KEPT = 60;              // seconds
  const MOST_BYTES = 256 << 20;  // large scenes are kept for less than a minute
  const FIRST_WAIT = 500, LONGEST_WAIT = 5000;  // until the next attempt to connect [ms]

  // The latest instants, with the same interface as a recording. Instants begin at `first` in the lists, so that
  // forgetting one is cheap.
  class LatestInstants {
    constructor(trackCount) {
      this.trackCount = trackCount;
      this.most = Math.max(2, Math.floor(MOST_BYTES / (4 * trackCount + 8)));
      this.clear();
    }
    clear() {
      this.first = 0;
      this.instants = [];
      this.clock = [];
    }
    get count() { return this.instants.length - this.first; }
    time(instant) { return this.clock[this.first + instant]; }
    value(track, instant) { return this.instants[this.first + instant][track]; }
    range() { return Infinity; }  // may still change
    add(time, values) {
      if (this.count && time <= this.time(this.count - 1)) this.clear();  // the simulation began anew
      this.instants.push(values);
      this.clock.push(time);
      while (this.count > this.most || this.time(0) < time - KEPT) this.instants[this.first++] = null;
      if (this.first > 1000 && this.first > this.count) {
        this.instants.splice(0, this.first);
        this.clock.splice(0, this.first);
        this.first = 0;
      }
    }
    sample(instant, part, values) {
      if (!this.count) { values.fill(NaN); return; }
      const a = this.instants[this.first + instant];
      const b = this.instants[this.first + Math.min(instant + 1, this.count - 1)];
      for (let k = 0; k < values.length; ++k) values[k] = part > 0 ? a[k] + (b[k] - a[k]) * part : a[k];
    }
  }

  function readLivePicture(message) {
    const raw = JSON.parse(message), run = new P.Run(P.readPicture(raw));
    run.store = new LatestInstants(run.layout.count);
    const bytes = P.bytesOf(typeof raw.mesh_data === "string" ? raw.mesh_data.replace(/\s+/g, "") : "");
    run.meshes = P.readMeshes(bytes, 0, run.picture.meshes);
    run.isLive = true;
    return run;
  }

  function addInstant(run, buffer) {
    const expected = 8 * (1 + run.layout.count);
    if (buffer.byteLength !== expected) {
      throw new Error(`an instant has ${buffer.byteLength} bytes, but ${expected} were expected`);
    }
    const data = new DataView(buffer), values = new Float32Array(run.layout.count);
    for (let k = 0; k < values.length; ++k) values[k] = data.getFloat64(8 * (k + 1), true);
    run.store.add(data.getFloat64(0, true), values);
    run.isPlaced = true;
  }

  // Connects, and again after each loss. on: {picture(run), instant(run), state(text), problem(sentence)}
  function connect(path, on) {
    const address = new URL(path, window.location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    let wait = FIRST_WAIT, run = null;
    const open = () => {
      on.state("connecting");
      const socket = new WebSocket(address.href);
      socket.binaryType = "arraybuffer";
      socket.onopen = () => { wait = FIRST_WAIT; on.state("connected"); };
      socket.onmessage = ({ data }) => {
        try {
          if (typeof data === "string") { run = readLivePicture(data); on.picture(run); }
          else if (run) { addInstant(run, data); on.instant(run); }
        } catch (error) { on.problem(`A message of the server cannot be read: ${error.message}`); }
      };
      socket.onclose = () => {
        on.state("lost");
        setTimeout(open, wait);
        wait = Math.min(2 * wait, LONGEST_WAIT);
      };
    };
    open();
  }

  Object.assign(P, { LatestInstants, connect });
})(window.Player = window.Player || {});
