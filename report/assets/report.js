// Read-outs. The page is complete without this: it only tells the values under the pointer, at the same time on all charts, and where
// the vehicles were then.
"use strict";
(() => {
  const axis = (text) => {
    const [min, max, kind] = text.split(" ");
    return { min: +min, max: +max, log: kind === "log" };
  };
  const valueAt = (a, place) => (a.log ? a.min * Math.pow(a.max / a.min, place) : a.min + place * (a.max - a.min));
  const placeOf = (a, value) => (a.log ? Math.log(value / a.min) / Math.log(a.max / a.min) : (value - a.min) / (a.max - a.min));
  const show = (v) => {
    const text = String(Number(v.toPrecision(3)));
    return text.replace("-", "\u2212");
  };

  // Lines hold their points in their path: "M x y x y M x y ..." in a frame of 1000 by data-height.
  const pointsOf = (path) => {
    const out = [];
    for (const piece of (path.getAttribute("d") || "").split("M")) {
      const n = piece.trim().split(/\s+/).map(Number);
      for (let i = 0; i + 1 < n.length; i += 2) out.push([n[i], n[i + 1]]);
      out.push(null);
    }
    return out;
  };
  const nearest = (points, x) => {
    let best = null, distance = 12;  // no value where the line has none
    for (const p of points) {
      if (p && Math.abs(p[0] - x) <= distance) { distance = Math.abs(p[0] - x); best = p; }
    }
    return best;
  };

  const charts = [...document.querySelectorAll(".chart")].map((chart) => ({
    chart,
    x: axis(chart.dataset.x),
    time: "time" in chart.dataset,
    plots: [...chart.querySelectorAll(".plot")].map((plot) => {
      const cursor = document.createElement("div");
      cursor.className = "cursor";
      cursor.hidden = true;
      plot.append(cursor);
      return { plot, cursor, readout: plot.parentElement.querySelector(".readout"), lines: null };
    }),
  }));

  const linesOf = (p) => {
    if (!p.lines) {
      p.lines = [...p.plot.querySelectorAll(".line")].map((path) => ({ path, name: path.dataset.name, points: pointsOf(path) })).reverse();
    }
    return p.lines;
  };
  const tell = (c, x) => {
    const place = placeOf(c.x, x);
    for (const p of c.plots) {
      p.cursor.hidden = !(place >= 0 && place <= 1);
      p.cursor.style.left = 100 * place + "%";
      if (!p.readout) continue;
      const words = [(c.time ? "t " : "") + show(x) + (c.time ? " s" : " m")];
      const y = axis(p.plot.dataset.y);
      for (const line of linesOf(p)) {
        if (getComputedStyle(line.path).display === "none") continue;
        const point = nearest(line.points, 1000 * place);
        if (point) words.push(line.name + " " + show(valueAt(y, 1 - point[1] / p.plot.dataset.height)));
      }
      p.readout.textContent = words.join(" \u00b7 ") + (p.plot.dataset.unit ? " " + p.plot.dataset.unit : "");
    }
  };
  const clear = (c) => {
    for (const p of c.plots) {
      p.cursor.hidden = true;
      if (p.readout) p.readout.textContent = "";
    }
  };

  const tracks = [...document.querySelectorAll(".track")].map((group) => ({
    group,
    start: +group.dataset.start,
    step: +group.dataset.step,
    truth: group.dataset.truth.split(" "),
    estimate: group.dataset.estimate.split(" "),
  }));
  const dots = (t) => {
    for (const track of tracks) {
      const i = Math.round((t - track.start) / track.step);
      track.group.replaceChildren();
      if (!(i >= 0 && 2 * i + 1 < track.truth.length)) continue;
      for (const [kind, list] of [["halo", track.truth], ["truth", track.truth], ["guess", track.estimate]]) {
        if (list[2 * i] === "-") continue;
        const dot = document.createElementNS(track.group.namespaceURI, "path");
        dot.setAttribute("class", kind);
        dot.setAttribute("d", "M" + list[2 * i] + " " + list[2 * i + 1] + "h.01");
        track.group.append(dot);
      }
    }
  };

  for (const c of charts) {
    for (const p of c.plots) {
      const move = (event) => {
        const box = p.plot.getBoundingClientRect();
        const x = valueAt(c.x, Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
        if (!c.time) return tell(c, x);
        for (const other of charts) if (other.time) tell(other, x);
        dots(x);
      };
      p.plot.addEventListener("pointermove", move);
      p.plot.addEventListener("pointerdown", move);
      p.plot.addEventListener("pointerleave", () => {
        for (const other of charts) if (other === c || (c.time && other.time)) clear(other);
        for (const track of tracks) track.group.replaceChildren();
      });
    }
  }
  document.documentElement.dataset.readouts = String(charts.length);
})();
