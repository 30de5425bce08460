"use strict";
// The page of `windlass report`: a bifurcation diagram on the left, the chosen equilibrium on the right.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  const capstan = data.info.has_cylinder;
  const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];
  const colourOf = (branch) => colours[(branch - 1) % colours.length];
  const pressureScale = [[0, "#fde725"], [0.33, "#f98e09"], [0.66, "#bc3754"], [1, "#57106e"]];
  const config = { responsive: true, displaylogo: false, toImageButtonOptions: { format: "svg" } };
  const plain = { responsive: true, displayModeBar: false };
  const font = { family: "DejaVu Sans, sans-serif", size: 12 };

  const state = { thick: data.radius > 0, x: "", y: "", xLog: false, yLog: false, hidden: new Set(), point: "", amplitude: 0, camera: null };
  const places = new Map(); // point name -> {branch, k}
  data.branches.forEach((b) => b.names.forEach((name, k) => places.set(name, { branch: b, k })));

  const short = (value) => (value === null || value === undefined ? "–" : Number(value.toPrecision(6)).toString());
  const titleOf = (name) => data.quantities.find((q) => q.name === name).title;
  const column = (branch, name) => branch.values[name] || [];
  const varies = (name) => {
    const all = data.branches.flatMap((b) => column(b, name)).filter((v) => v !== null);
    return all.length > 0 && Math.max(...all) - Math.min(...all) > 1e-9 * Math.max(1, ...all.map(Math.abs));
  };
  /** A logarithmic axis can show it; zeros, where contact is lost, fall out of it. */
  const positive = (name) => data.branches.every((b) => column(b, name).every((v) => v === null || v >= 0)) &&
    data.branches.some((b) => column(b, name).some((v) => v > 0));

  // ---- diagram --------------------------------------------------------------------------------------------------

  /** Stretches of a branch with one stability, without a contact event inside: there a branch may have a corner, which a
      spline would round off and overshoot. The stability changes at a point: the special one where there is one. */
  function arms(branch) {
    const corners = new Set(data.special.filter((s) => s.type === "contact").map((s) => s.label));
    const kind = (index) => (index === null ? "unknown" : index === 0 ? "stable" : "unstable");
    if (branch.between.length === 0) return [{ kind: kind(branch.index[0]), from: 0, to: 0 }];
    const list = [];
    branch.between.forEach((index, k) => {
      const last = list[list.length - 1];
      if (last && last.kind === kind(index) && !corners.has(branch.names[k])) last.to = k + 1;
      else list.push({ kind: kind(index), from: k, to: k + 1 });
    });
    return list;
  }

  /** The shown point nearest to a place of the diagram (in pixels from its upper left corner); "" where there is none.
      At the same place a special point comes first: an ordinary one of another branch may stand there too. */
  function nearest(left, top, xaxis, yaxis) {
    const inside = (pixel, axis) => Number.isFinite(pixel) && pixel >= 0 && pixel <= axis._length;
    const special = new Set(data.special.map((s) => s.label));
    let best = { name: "", distance: Infinity };
    data.branches.filter((b) => !state.hidden.has(b.branch)).forEach((b) => {
      const x = column(b, state.x), y = column(b, state.y);
      b.names.forEach((name, k) => {
        if (x[k] === null || y[k] === null) return;
        const px = xaxis.d2p(x[k]), py = yaxis.d2p(y[k]);
        if (!inside(px, xaxis) || !inside(py, yaxis)) return;
        const distance = Math.hypot(px - left, py - top) - (special.has(name) ? 0.5 : 0);
        if (distance < best.distance) best = { name, distance };
      });
    });
    return best.name;
  }

  /** A click anywhere in the diagram chooses the nearest visible point. */
  function click(event) {
    const { xaxis, yaxis } = element("diagram")._fullLayout, box = element("diagram").getBoundingClientRect();
    const left = event.clientX - box.left - xaxis._offset, top = event.clientY - box.top - yaxis._offset;
    if (left < 0 || top < 0 || left > xaxis._length || top > yaxis._length) return; // the legend, an axis
    const name = nearest(left, top, xaxis, yaxis);
    if (name) select(name);
  }

  function armTraces(branch) {
    const x = column(branch, state.x), y = column(branch, state.y);
    return arms(branch).map((arm) => ({
      type: "scatter", mode: "lines+markers", showlegend: false,
      x: x.slice(arm.from, arm.to + 1), y: y.slice(arm.from, arm.to + 1),
      customdata: branch.names.slice(arm.from, arm.to + 1),
      line: { color: colourOf(branch.branch), shape: "spline", width: arm.kind === "stable" ? 2.6 : 1.6, dash: arm.kind === "unstable" ? "dash" : "solid" },
      marker: { color: colourOf(branch.branch), size: 3.5, opacity: arm.kind === "stable" ? 1 : 0.6 },
      hovertemplate: `%{customdata}<br>${state.x} %{x:.6g}<br>${state.y} %{y:.6g}<br>${arm.kind}<extra>branch ${branch.branch}</extra>`,
    }));
  }

  function specialTraces() {
    const symbols = { fold: "triangle-up", branch_point: "circle", contact: "square-open" };
    return Object.entries(symbols).map(([type, symbol]) => {
      const found = data.special.filter((s) => s.type === type && places.has(s.label) && !state.hidden.has(s.branch));
      const at = found.map((s) => places.get(s.label));
      return {
        type: "scatter", mode: "markers+text", name: type.replace("_", " "), showlegend: found.length > 0,
        x: at.map((p) => column(p.branch, state.x)[p.k]), y: at.map((p) => column(p.branch, state.y)[p.k]),
        customdata: found.map((s) => s.label), text: found.map((s) => (found.length > 25 ? "" : s.label)),
        textposition: type === "contact" ? "bottom right" : "top left", textfont: { size: 10 },
        marker: { symbol, size: 9, color: "#111", line: { width: 1.5, color: "#111" } },
        hovertemplate: `%{customdata}, ${type.replace("_", " ")}<br>${state.x} %{x:.8g}<br>${state.y} %{y:.8g}<extra></extra>`,
      };
    });
  }

  function chosenTrace() {
    const place = places.get(state.point);
    return {
      type: "scatter", mode: "markers", showlegend: false, hoverinfo: "skip",
      x: place ? [column(place.branch, state.x)[place.k]] : [], y: place ? [column(place.branch, state.y)[place.k]] : [],
      marker: { size: 15, symbol: "circle-open", color: "#c00000", line: { width: 2.5, color: "#c00000" } },
    };
  }

  /** Ticks at 1, 2, 5 times powers of ten (branches often span less than a decade), and at most five decades. */
  function logAxis(name) {
    const all = data.branches.flatMap((b) => column(b, name)).filter((v) => v > 0);
    const high = Math.max(...all), low = Math.max(Math.min(...all), 1e-5 * high), tickvals = [];
    const digits = high / low > 300 ? [1] : [1, 2, 5];
    for (let e = Math.floor(Math.log10(low)) - 1; e <= Math.log10(high) + 1; ++e) digits.forEach((d) => tickvals.push(Number(`${d}e${e}`)));
    const margin = 0.05 * Math.log10(high / low) + 0.01;
    return {
      tickvals, ticktext: tickvals.map((v) => (v >= 1e-4 && v < 1e5 ? String(v) : v.toExponential())),
      range: [Math.log10(low) - margin, Math.log10(high) + margin],
    };
  }

  function drawDiagram() {
    const shown = data.branches.filter((b) => !state.hidden.has(b.branch));
    const legend = [["stable", "solid", 2.6], ["unstable", "dash", 1.6]].map(([name, dash, width]) => ({
      type: "scatter", mode: "lines", x: [null], y: [null], name, line: { color: "#333", dash, width },
    }));
    const axis = (name, log) => ({
      title: { text: titleOf(name), standoff: 8 }, type: log ? "log" : "linear", showline: true, mirror: true,
      ticks: "inside", zeroline: false, automargin: true, gridcolor: "#eee", ...(log ? logAxis(name) : {}),
    });
    Plotly.react("diagram", [...shown.flatMap(armTraces), ...specialTraces(), ...legend, chosenTrace()], {
      font, margin: { l: 62, r: 12, t: 8, b: 48 }, hovermode: "closest", dragmode: "pan", uirevision: `${state.x}|${state.y}|${state.xLog}|${state.yLog}`,
      xaxis: axis(state.x, state.xLog), yaxis: axis(state.y, state.yLog),
      legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    }, { ...config, scrollZoom: true, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
  }

  // ---- the chosen equilibrium -----------------------------------------------------------------------------------

  /** The rod of a point, or of the nearest point of its branch whose rod is in the page. */
  function rodOf(name) {
    if (data.rods[name]) return { name, rod: data.rods[name] };
    const place = places.get(name);
    let best = null;
    place.branch.names.forEach((other, k) => {
      if (data.rods[other] && (best === null || Math.abs(k - place.k) < Math.abs(best.k - place.k))) best = { k, other };
    });
    return best === null ? null : { name: best.other, rod: data.rods[best.other] };
  }

  function cylinderTrace(rod) {
    let low = 0, high = 0;
    rod.arcs.forEach((arc) => arc.z.forEach((z, i) => {
      if (Math.hypot(arc.x[i], arc.y[i]) < 1.6) { low = Math.min(low, z); high = Math.max(high, z); }
    }));
    low -= 0.9 + data.radius; high += 0.9 + data.radius;
    // The centre line touches at 1, the surface of a thick rod at 1 less its radius. A line is drawn with some width, too.
    const radius = data.radius > 0 ? 1 - data.radius : 0.97;
    const turns = 72, x = [[], []], y = [[], []], z = [[], []];
    for (let k = 0; k <= turns; ++k) {
      const a = (2 * Math.PI * k) / turns;
      [low, high].forEach((height, row) => { x[row].push(radius * Math.cos(a)); y[row].push(radius * Math.sin(a)); z[row].push(height); });
    }
    return {
      type: "surface", x, y, z, showscale: false, hoverinfo: "skip", opacity: 1,
      colorscale: [[0, "#eceef3"], [1, "#eceef3"]], lighting: { ambient: 0.88, diffuse: 0.35, specular: 0.02 },
      contours: { x: { highlight: false }, y: { highlight: false }, z: { highlight: false } },
    };
  }

  /** Plates round the cylinder: a ring each, as wide as the space shown. */
  function plateTraces() {
    const wide = 3, turns = 72, inner = 1;
    return (data.plates || []).map((plate) => {
      const x = [[], []], y = [[], []], z = [[], []], outer = plate.outer === null ? wide : Math.min(wide, plate.outer);
      for (let k = 0; k <= turns; ++k) {
        const a = (2 * Math.PI * k) / turns;
        [inner, outer].forEach((radius, row) => { x[row].push(radius * Math.cos(a)); y[row].push(radius * Math.sin(a)); z[row].push(plate.z); });
      }
      return { type: "surface", x, y, z, showscale: false, hoverinfo: "skip", opacity: 0.35, colorscale: [[0, "#8fa3bf"], [1, "#8fa3bf"]],
        contours: { x: { highlight: false }, y: { highlight: false }, z: { highlight: false } } };
    });
  }

  /** Walls: a rectangle each. */
  function sheetTraces() {
    return (data.sheets || []).map((corners) => {
      const [x, y, z] = [0, 1, 2].map((axis) => corners.map((corner) => corner[axis]));
      return { type: "mesh3d", x, y, z, i: [0, 0], j: [1, 2], k: [2, 3], color: "#c9ccd6", opacity: 0.45, hoverinfo: "skip" };
    });
  }

  const pressureBar = { title: { text: "p [EI/ρ³]", side: "right" }, thickness: 12, len: 0.75, x: 1.0 };

  function tubeTrace(arc, largest) {
    const texts = arc.s.map((s, i) => `s ${s.toPrecision(4)}${arc.line ? `<br>p ${short(arc.p[i])}` : ""}`);
    const places = tube.surface(arc, data.radius), ends = (values) => [values[0], ...values, values[values.length - 1]];
    const rows = (values) => ends(values).map((value, i) => places.x[i].map(() => value));
    return {
      type: "surface", ...places, surfacecolor: rows(arc.line ? arc.p : arc.s.map(() => 0)), cmin: 0, cmax: largest, showscale: false,
      colorscale: arc.line ? pressureScale : [[0, "#c9c7c1"], [1, "#c9c7c1"]], hovertext: rows(texts), hoverinfo: "text",
      lighting: { ambient: 0.7, diffuse: 0.55, specular: 0.15, roughness: 0.6 },
      contours: { x: { highlight: false }, y: { highlight: false }, z: { highlight: false } },
    };
  }

  function rodTraces(rod) {
    const largest = Math.max(1e-12, ...rod.arcs.flatMap((arc) => arc.p || []));
    let bar = false;
    return rod.arcs.filter((arc) => arc.s.length > 1).map((arc) => {
      if (state.thick) {
        const trace = tubeTrace(arc, largest);
        if (!arc.line || bar) return trace;
        bar = true;
        return { ...trace, showscale: true, colorbar: pressureBar };
      }
      const trace = { type: "scatter3d", mode: "lines", x: arc.x, y: arc.y, z: arc.z, showlegend: false, customdata: arc.s,
        hovertemplate: "s %{customdata:.4g}<br>(%{x:.4g}, %{y:.4g}, %{z:.4g})<extra></extra>" };
      if (!arc.line) return { ...trace, line: { color: "#303030", width: 6 } };
      const line = { color: arc.p, cmin: 0, cmax: largest, colorscale: pressureScale, width: 9, showscale: !bar,
        colorbar: pressureBar };
      bar = true;
      return { ...trace, line };
    });
  }

  const between = (force) => force.partner !== undefined; // strands, and not the cylinder
  const forceColour = (force) => (between(force) ? "#0072b2" : "#c00000");
  const forceText = (force) => (between(force)
    ? `force between strands f = ${short(force.f)}<br>on s = ${short(force.s)}, from the strand at s = ${short(force.partner)}`
    : `point force f = ${short(force.f)} at s = ${short(force.s)}`);

  /** Point forces as arrows along the outward normal from the rod's surface, the largest 0.8 ρ long. */
  function arrowTraces(forces, largest, unit) {
    const shafts = { x: [], y: [], z: [] }, heads = { x: [], y: [], z: [], u: [], v: [], w: [] };
    const begin = state.thick ? data.radius : 0, colour = forceColour(forces[0]);
    forces.forEach((force) => {
      const length = unit * Math.max(0.12, (0.8 * force.f) / largest);
      const at = force.r.map((c, i) => c + begin * force.d[i]), tip = at.map((c, i) => c + length * force.d[i]);
      ["x", "y", "z"].forEach((c, i) => { shafts[c].push(at[i], tip[i], null); heads[c].push(tip[i]); });
      ["u", "v", "w"].forEach((c, i) => heads[c].push(force.d[i]));
    });
    return [
      { type: "scatter3d", mode: "lines", ...shafts, line: { color: colour, width: 6 }, hoverinfo: "skip", showlegend: false },
      { type: "cone", ...heads, sizemode: "raw", sizeref: 0.3 * unit, anchor: "tip", showscale: false, text: forces.map(forceText),
        hoverinfo: "text", colorscale: [[0, colour], [1, colour]] },
    ];
  }

  /** Where strands touch: a disc between the two of a thick rod. */
  function touchTraces(rod) {
    if (!state.thick) return [];
    const list = rod.forces.filter((force) => between(force) && force.s < force.partner).map((force) => ({
      centre: force.r.map((c, i) => c - data.radius * force.d[i]), normal: force.d, radius: 1.3 * data.radius, text: forceText(force) }));
    return list.length === 0 ? [] : [{ type: "mesh3d", ...tube.discs(list), hoverinfo: "text", color: "#0072b2", opacity: 0.85, flatshading: true }];
  }

  function forceTraces(rod) {
    const forces = rod.forces.filter((force) => force.f > 0), unit = capstan ? 1 : 0.15;
    const largest = Math.max(...forces.map((force) => force.f));
    return [forces.filter((force) => !between(force)), forces.filter(between)].filter((list) => list.length > 0)
      .flatMap((list) => arrowTraces(list, largest, unit));
  }

  function modeTrace(rod) {
    const size = capstan ? 0.8 : 0.15;
    const moved = (axis) => (rod.mode ? rod.mode.r.map((r, i) => r[axis] + size * state.amplitude * rod.mode.d[i][axis]) : []);
    return {
      type: "scatter3d", mode: "lines", x: moved(0), y: moved(1), z: moved(2), showlegend: false, hoverinfo: "skip",
      visible: Boolean(rod.mode) && state.amplitude !== 0, line: { color: "#009e73", width: 5 },
    };
  }

  /** Seen from where the strands of the run's rods touch, if any do: that side of the cylinder, or else the south. */
  const seenFrom = (() => {
    const touch = Object.values(data.rods).flatMap((rod) => rod.forces.filter(between)).find((force) => Math.abs(force.r[1]) > 0.1);
    return touch && touch.r[1] > 0 ? 1 : -1;
  })();

  function drawRod(rod) {
    const axis = (text) => ({ title: { text }, backgroundcolor: "#fff", gridcolor: "#eee", zerolinecolor: "#ddd", nticks: 5 });
    const traces = [modeTrace(rod), ...(capstan ? [cylinderTrace(rod)] : []), ...sheetTraces(), ...plateTraces(), ...rodTraces(rod), ...touchTraces(rod), ...forceTraces(rod)];
    Plotly.react("rod", traces, {
      font, margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "rod",
      scene: { aspectmode: "data", xaxis: axis("x"), yaxis: axis("y"), zaxis: axis("z"),
        camera: { eye: capstan ? { x: -0.5 * seenFrom, y: seenFrom, z: 0.5 } : { x: 0.3, y: -1.6, z: 0.6 }, projection: { type: "orthographic" } } },
    }, config);
  }

  function drawPressure(rod) {
    const lines = rod.arcs.filter((arc) => arc.line);
    const traces = lines.map((arc) => ({ type: "scatter", mode: "lines", x: arc.s, y: arc.p, fill: "tozeroy", fillcolor: "#f3c6a5",
      line: { color: "#bc3754", width: 2, simplify: false }, showlegend: false, hovertemplate: "s %{x:.4g}<br>p %{y:.5g}<extra></extra>" }));
    rod.forces.forEach((force) => traces.push({ type: "scatter", mode: "lines+markers", x: [force.s, force.s], y: [0, force.f], yaxis: "y2",
      line: { color: forceColour(force), width: 3 }, marker: { symbol: "triangle-up", size: [0, 9], color: forceColour(force) },
      showlegend: false, hovertemplate: `${forceText(force)}<extra></extra>` }));
    Plotly.react("pressure", traces, {
      font: { ...font, size: 11 }, margin: { l: 48, r: 48, t: 6, b: 36 },
      xaxis: { title: { text: "arclength s [ρ]", standoff: 4 }, showline: true, zeroline: false, gridcolor: "#eee" },
      yaxis: { title: { text: "p [EI/ρ³]" }, rangemode: "tozero", showline: true, gridcolor: "#eee", visible: lines.length > 0 },
      yaxis2: { title: { text: "f [EI/ρ²]", font: { color: "#c00000" } }, overlaying: "y", side: "right", rangemode: "tozero", showgrid: false },
      annotations: rod.arcs.some((arc) => arc.line) || rod.forces.length ? [] : [{ text: "no contact", showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5 }],
    }, plain);
  }

  function drawEigenvalues(rod) {
    const values = rod.eigenvalues;
    Plotly.react("eigenvalues", [{ type: "scatter", mode: "markers", cliponaxis: false, x: values.map((_, i) => i + 1), y: values,
      marker: { size: 9, symbol: "diamond", color: values.map((v) => (v < 0 ? "#c00000" : "#0072b2")) }, hovertemplate: "%{y:.6g}<extra></extra>" }], {
      font: { ...font, size: 11 }, margin: { l: 48, r: 8, t: 6, b: 36 },
      xaxis: { title: { text: "number", standoff: 4 }, dtick: 1, range: [0.5, Math.max(values.length, 1) + 0.5], showline: true, gridcolor: "#eee" },
      yaxis: { title: { text: "eigenvalue", standoff: 8 }, automargin: true, rangemode: "tozero", zeroline: true, zerolinecolor: "#999", zerolinewidth: 2, showline: true, gridcolor: "#eee" },
      annotations: values.length ? [] : [{ text: "not computed", showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5 }],
    }, plain);
  }

  function describe(name, found) {
    const { branch, k } = places.get(name), special = data.special.find((s) => s.label === name);
    const index = branch.index[k];
    element("point").textContent = (special ? `${special.type.replace("_", " ")} ` : "point ") + name;
    const symbols = { phi: "φ", phi_star: "φ*", T_N: "T [N]", R_tot_N: "R_tot [N]", end_force: "thrust", end_moment: "axial moment", self_force: "between strands" };
    const names = capstan ? ["T", "phi", "R_tot", "phi_star", "tilt", "self_force", "T_N", "R_tot_N"] : ["shortening", "end_force", "end_moment", "self_force"];
    const facts = names.filter((n) => branch.values[n]).map((n) => `${symbols[n] || n} = ${short(branch.values[n][k])}`);
    facts.push(index === null ? "stability not computed" : index === 0 ? "stable" : `unstable, index ${index}`);
    if (found.rod.mode) facts.push(`lowest mode ${found.rod.mode.plane} of plane, ${found.rod.mode.parity}`.replace("in of plane", "in plane"));
    facts.push(branch.topology[k]);
    if (found.name !== name) facts.push(`rod shown: nearest stored, ${found.name}`);
    element("facts").textContent = facts.join("  ·  ");
  }

  function select(name) {
    if (!places.has(name)) return;
    const found = rodOf(name);
    if (found === null) return;
    state.point = name;
    describe(name, found);
    drawRod(found.rod);
    drawPressure(found.rod);
    drawEigenvalues(found.rod);
    ["amplitude", "animate"].forEach((id) => {
      element(id).disabled = !found.rod.mode;
      element(id).title = found.rod.mode ? "" : "no mode is stored for this point";
    });
    const traces = element("diagram").data;
    if (traces) {
      const mark = chosenTrace();
      Plotly.restyle("diagram", { x: [mark.x], y: [mark.y] }, [traces.length - 1]);
    }
    document.querySelectorAll("#special tbody tr").forEach((row) => row.classList.toggle("chosen", row.dataset.name === name));
    document.body.dataset.point = name;
  }

  function step(by) {
    const place = places.get(state.point);
    const name = place && place.branch.names[place.k + by];
    if (name) select(name);
  }

  // ---- lowest mode ----------------------------------------------------------------------------------------------

  function setAmplitude(value) {
    state.amplitude = value;
    element("amplitude").value = value;
    const found = rodOf(state.point);
    if (!found) return;
    const trace = modeTrace(found.rod);
    Plotly.restyle("rod", { x: [trace.x], y: [trace.y], z: [trace.z], visible: [trace.visible] }, [0]);
  }

  let animation = null;
  function toggleAnimation() {
    element("animate").textContent = animation === null ? "stop" : "animate";
    if (animation !== null) {
      clearInterval(animation);
      animation = null;
      return setAmplitude(0);
    }
    const start = performance.now();
    animation = setInterval(() => setAmplitude(0.7 * Math.sin((performance.now() - start) / 350)), 60);
  }

  // ---- controls -------------------------------------------------------------------------------------------------

  function fillSelect(id, chosen) {
    data.quantities.filter((q) => varies(q.name)).forEach((q) => element(id).add(new Option(q.title, q.name)));
    element(id).value = chosen;
  }

  function readAxes() {
    state.x = element("x").value; state.y = element("y").value;
    ["x", "y"].forEach((axis) => {
      const box = element(`${axis}-log`), possible = positive(state[axis]);
      box.disabled = !possible;
      state[`${axis}Log`] = possible && box.checked;
    });
    drawDiagram();
  }

  function branchBoxes() {
    data.branches.forEach((b) => {
      const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("span");
      box.type = "checkbox"; box.checked = true; box.dataset.branch = b.branch;
      swatch.className = "swatch"; swatch.style.background = colourOf(b.branch);
      box.addEventListener("change", () => {
        if (box.checked) state.hidden.delete(b.branch); else state.hidden.add(b.branch);
        drawDiagram();
      });
      label.append(box, swatch, `branch ${b.branch} (${b.names.length})`);
      element("branches").append(label);
    });
  }

  function specialTable() {
    if (data.special.length === 0) return;
    const own = data.info.parameter && !(capstan && ["load.tension", "load.angle"].includes(data.info.parameter));
    const value = (s) => [...(capstan ? [short(s.T), short(s.phi)] : []), ...(own ? [short(s.parameter)] : [])];
    const head = ["", "type", "branch", ...(capstan ? ["T", "φ"] : []), ...(own ? [data.info.parameter] : []), "± ", "mode or contact"];
    const table = element("special"), row = table.createTHead().insertRow(), body = table.createTBody();
    head.forEach((text) => { const cell = document.createElement("th"); cell.textContent = text; row.append(cell); });
    data.special.forEach((s) => {
      const detail = s.mode ? `${s.mode.plane === "in" ? "in plane" : "out of plane"}, ${s.mode.parity}${s.multiplicity > 1 ? `, ×${s.multiplicity}` : ""}`
        : s.before ? `${s.before} → ${s.after}` : "";
      const line = body.insertRow();
      line.dataset.name = s.label;
      [s.label, s.type.replace("_", " "), s.branch, ...value(s), s.precision === null ? "–" : s.precision.toExponential(0), detail]
        .forEach((text) => { line.insertCell().textContent = text; });
      line.addEventListener("click", () => select(s.label));
    });
  }

  function start() {
    const choice = (wanted) => wanted.find((name) => data.quantities.some((q) => q.name === name) && varies(name)) || data.quantities[0].name;
    element("title").textContent = data.info.scene;
    const points = data.branches.reduce((sum, b) => sum + b.names.length, 0), lost = data.info.lost_branches.length;
    element("summary").textContent = `windlass ${data.info.version}, ${data.info.command}, ${data.info.status}: ${data.branches.length} branches, ` +
      `${points} points, ${data.special.length} special points` + (lost ? `, ${lost} lost branches` : "");
    element("run").textContent = `${JSON.stringify(data.info, null, 2)}\n\n${data.scene}`;
    fillSelect("x", choice(capstan ? ["T", "phi", "parameter"] : ["shortening", "parameter", "end_force"]));
    fillSelect("y", choice(capstan ? ["R_tot", "energy"] : ["end_force", "energy"]));
    element("x-log").checked = element("x").value === "T";
    element("y-log").checked = element("x").value === "T" && element("y").value === "R_tot";
    ["x", "y", "x-log", "y-log"].forEach((id) => element(id).addEventListener("change", readAxes));
    branchBoxes();
    specialTable();
    readAxes();
    element("diagram").addEventListener("click", click);
    element("diagram").on("plotly_hover", (event) => {
      if (element("follow").checked && event.points[0].customdata) select(event.points[0].customdata);
    });
    element("previous").addEventListener("click", () => step(-1));
    element("next").addEventListener("click", () => step(1));
    document.addEventListener("keydown", (event) => {
      if (["INPUT", "SELECT"].includes(event.target.tagName)) return;
      if (event.key === "ArrowLeft") step(-1);
      if (event.key === "ArrowRight") step(1);
    });
    element("amplitude").addEventListener("input", () => setAmplitude(Number(element("amplitude").value)));
    element("animate").addEventListener("click", toggleAnimation);
    element("thick-label").hidden = !(data.radius > 0);
    element("thick").addEventListener("change", () => { state.thick = element("thick").checked; select(state.point); });
    const asked = decodeURIComponent(location.hash.replace("#", ""));
    select(places.has(asked) ? asked : (data.special.find((s) => places.has(s.label)) || { label: data.branches[0].names[0] }).label);
    document.body.dataset.ready = "yes";
  }

  start();
})();
