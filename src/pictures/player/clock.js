// Which time is shown, and which instant of each run is that? The buttons and the slider of the clock.
(function (P) {
  "use strict";

  const ALL = "all";  // the value of the choice of all clips
  const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
  const LEAST_SHOWN = 3;   // of real time that a clip is played before the next one [s]
  const LONGEST_STEP = 1;  // of real time between two pictures [s]; a page that was hidden goes on where it was

  class Clock {
    // on: {time(), parts(), playing()}: what has changed.
    constructor(on) {
      this.on = on;
      this.runs = [];
      this.time = this.start = this.end = 0;
      this.speed = 1;
      this.clip = -1;
      this.isTour = false;      // all clips, one after the other
      this.shownFor = 0;        // how long the clip has been played, of real time [s]
      this.isPlaying = this.isLooping = false;
      this.isLive = false;      // the runs come from a server
      this.isFollowing = true;  // a live page shows the newest instant
      this.slider = P.byId("slider");
      this.connectButtons();
    }
    connectButtons() {
      const speed = P.byId("speed");
      for (const value of SPEEDS) speed.append(P.make("option", { value }, `${value}×`));
      speed.value = 1;
      speed.onchange = () => this.setSpeed(Number(speed.value));
      P.byId("play").onclick = () => this.toggle();
      P.byId("to-start").onclick = () => this.seek(this.start);
      P.byId("to-end").onclick = () => this.seek(this.end);
      P.byId("step-back").onclick = () => this.step(-1);
      P.byId("step-on").onclick = () => this.step(1);
      P.byId("loop").onclick = () => this.setLooping(!this.isLooping);
      P.byId("live").onclick = () => this.goLive();
      this.slider.oninput = () => this.seek(this.start + this.slider.value / this.slider.max * (this.end - this.start));
      P.byId("clips").onchange = ({ target }) => {
        const isTour = target.value === ALL;
        this.setClip(isTour ? 0 : Number(target.value), isTour);
      };
    }

    setRuns(runs) {
      this.runs = runs;
      this.isLive = runs.some((run) => run.isLive);
      this.leader = Math.max(runs.findIndex((run) => run.picture.clips.length), 0);
      const clips = runs.length ? runs[this.leader].picture.clips : [];
      const isTour = clips.length > 1 && clips.some((clip) => clip.count > 1);
      P.byId("clips").replaceChildren(...(isTour ? [P.make("option", { value: ALL }, "All, one after the other")] : []),
        ...clips.map((clip, k) => P.make("option", { value: k }, clip.name)));
      P.byId("clip-chooser").hidden = !clips.length;
      P.byId("live").hidden = !this.isLive;
      P.byId("loop").hidden = this.isLive;
      if (clips.length) this.setLooping(true);
      this.pause();
      this.setClip(clips.length ? 0 : -1, isTour);
    }
    setClip(clip, isTour = false) {
      this.useClip(clip, isTour);
      this.seek(this.start, true);
    }
    useClip(clip, isTour) {
      Object.assign(this, { clip, isTour, shownFor: 0 });
      P.byId("clips").value = isTour ? ALL : clip;
      P.setText(P.byId("clip-name"), isTour ? this.runs[this.leader].picture.clips[clip].name : "");
      this.findParts();
    }
    // The part of each run that is shown: its first and last instant, and how far its times are ahead of the clock.
    findParts() {
      this.parts = this.runs.map(({ picture, store }) => {
        const clip = this.clip >= 0 ? picture.clips[Math.min(this.clip, picture.clips.length - 1)] : null;
        const first = clip ? clip.first : 0, last = clip ? clip.first + clip.count - 1 : store.count - 1;
        return { first, last, offset: 0 };
      });
      const spans = this.parts.map(({ first, last }, r) => {
        const { store } = this.runs[r];
        return last >= first ? [store.time(first), store.time(last)] : null;
      });
      const known = this.clip >= 0 ? [spans[this.leader]] : spans.filter(Boolean);
      this.start = known.length ? Math.min(...known.map(([start]) => start)) : 0;
      this.end = known.length ? Math.max(...known.map(([, end]) => end)) : 0;
      if (this.clip >= 0) spans.forEach((span, r) => { if (span) this.parts[r].offset = span[0] - this.start; });
      this.on.parts();
      this.showState();
    }

    // Tells each run which instant it shows. A clip that is shorter than the clock's begins anew.
    showRuns() {
      this.runs.forEach((run, r) => {
        const { first, last, offset } = this.parts[r];
        let time = this.time + offset;
        if (this.clip >= 0 && r !== this.leader && last > first) {
          const begin = run.store.time(first), length = run.store.time(last) - begin;
          if (length > 0 && time > begin + length) time = begin + (time - begin) % length;
        }
        run.show(time, first, last);
      });
    }

    // ---------------------------------------------------------------- moving

    seek(time, isSilent = false) {
      if (this.isLive && !isSilent) this.isFollowing = false;
      if (this.clip >= 0 && (time < this.start || time > this.end)) this.changeClipTo(time);
      this.time = Math.min(Math.max(time, this.start), this.end);
      this.showState();
      this.on.time();
    }
    changeClipTo(time) {
      const { picture, store } = this.runs[this.leader];
      const clip = picture.clips.findIndex(({ first, count }) =>
        time >= store.time(first) && time <= store.time(first + count - 1));
      if (clip >= 0 && clip !== this.clip) this.useClip(clip, this.isTour);
    }
    // To the next instant of any run.
    step(way) {
      this.pause();
      let best = way > 0 ? this.end : this.start;
      const small = 1e-9 * Math.max(this.end - this.start, 1e-9);
      this.runs.forEach((run, r) => {
        const { first, last, offset } = this.parts[r];
        if (this.clip >= 0 && r !== this.leader) return;
        const at = run.find(this.time + offset + (way > 0 ? small : -small), first, last) + (way > 0 ? 1 : 0);
        if (at < first || at > last) return;
        const time = run.store.time(at) - offset;
        best = way > 0 ? Math.min(best, time) : Math.max(best, time);
      });
      this.seek(best);
    }
    play() {
      if (!this.canMove) return;
      if (this.time >= this.end) {
        if (this.isLive) { this.goLive(); return; }
        this.time = this.start;
      }
      this.isPlaying = true;
      this.showState();
      this.on.playing();
    }
    pause() {
      this.isPlaying = false;
      if (this.isLive) this.isFollowing = false;
      this.showState();
    }
    toggle() { if (this.isPlaying || (this.isLive && this.isFollowing)) this.pause(); else this.play(); }
    // Goes on by a time of the real clock [s].
    advance(seconds) {
      const length = this.end - this.start;
      let time = this.time + this.speed * Math.min(seconds, LONGEST_STEP);
      this.shownFor += Math.min(seconds, LONGEST_STEP);
      if (time >= this.end) {
        if (this.isTour && this.shownFor >= LEAST_SHOWN && this.goToNextClip()) return;
        if ((this.isLooping || this.mustRepeat) && length > 0) time = this.start + (time - this.start) % length;
        else if (this.isLive) { this.goLive(); return; }
        else { time = this.end; this.isPlaying = false; }
      }
      this.time = time;
      this.showState();
      this.on.time();
    }
    // Of a tour: each clip is played for a while, also if the page does not begin anew at the end.
    get mustRepeat() { return this.isTour && this.shownFor < LEAST_SHOWN; }
    // Returns whether there is one.
    goToNextClip() {
      const { clips } = this.runs[this.leader].picture, next = this.clip + 1;
      if (next >= clips.length && !this.isLooping) return false;
      this.setClip(next % clips.length, true);
      return true;
    }
    get canMove() { return this.end > this.start; }

    setSpeed(speed) {
      if (!(speed > 0)) return;
      this.speed = speed;
      const nearest = SPEEDS.reduce((a, b) => (Math.abs(Math.log(b / speed)) < Math.abs(Math.log(a / speed)) ? b : a));
      P.byId("speed").value = nearest;
    }
    changeSpeed(way) {
      const at = SPEEDS.indexOf(Number(P.byId("speed").value));
      this.setSpeed(SPEEDS[Math.min(Math.max(at + way, 0), SPEEDS.length - 1)]);
    }
    setLooping(isLooping) {
      this.isLooping = isLooping;
      P.byId("loop").setAttribute("aria-pressed", String(isLooping));
    }

    // ---------------------------------------------------------------- live

    goLive() {
      this.isPlaying = false;
      this.isFollowing = true;
      this.noteNewest();
    }
    // There is a new instant.
    noteNewest() {
      this.findParts();
      if (this.isFollowing || this.time < this.start || this.time > this.end) {
        this.time = this.isFollowing ? this.end : Math.min(Math.max(this.time, this.start), this.end);
        this.on.time();
      }
      this.showState();
    }

    // ---------------------------------------------------------------- the buttons

    showState() {
      const { slider, canMove } = this, length = this.end - this.start;
      const isMoving = this.isPlaying || (this.isLive && this.isFollowing);
      P.setIcon(P.byId("play"), isMoving ? "pause" : "play");
      P.byId("play").setAttribute("aria-label", isMoving ? "Pause" : "Play");
      for (const id of ["play", "to-start", "to-end", "step-back", "step-on"]) P.byId(id).disabled = !canMove;
      slider.disabled = !canMove;
      slider.value = canMove ? (this.time - this.start) / length * slider.max : 0;
      slider.style.setProperty("--part", canMove ? (this.time - this.start) / length : 0);
      slider.setAttribute("aria-valuetext", this.text);
      P.setText(P.byId("time"), this.timeText(this.time));
      P.setText(P.byId("duration"), `/ ${this.timeText(this.end)} s`);
      if (this.isLive) {
        P.byId("live").setAttribute("aria-pressed", String(this.isFollowing));
        P.setText(P.byId("live-text"), this.isFollowing ? "live" : "paused");
      }
    }
    get text() { return `${this.timeText(this.time)} s`; }
    timeText(time) {
      const shown = this.clip >= 0 ? time - this.start : time, length = this.end - this.start;
      const digits = length >= 100 ? 2 : length >= 1 || !length ? 3 : Math.min(3 + Math.ceil(-Math.log10(length)), 9);
      return shown.toFixed(digits).replace("-", "−");
    }
  }

  Object.assign(P, { Clock });
})(window.Player = window.Player || {});
