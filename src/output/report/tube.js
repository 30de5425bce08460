"use strict";
// What a thickness adds to a rod in 3D: the surface round an arc, and a disc where two strands touch. Used by page.js.
const tube = (() => {
  const around = 20;
  const minus = (a, b) => a.map((c, i) => c - b[i]);
  const dot = (a, b) => a.reduce((sum, c, i) => sum + c * b[i], 0);
  const unit = (a) => a.map((c) => c / Math.hypot(...a));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  /** Some direction perpendicular to a unit vector. */
  const perpendicular = (a) => {
    const k = a.map(Math.abs).indexOf(Math.min(...a.map(Math.abs)));
    return unit(cross(a, [0, 1, 2].map((i) => (i === k ? 1 : 0))));
  };
  const circle = (centre, radius, u, v, k) => {
    const angle = (2 * Math.PI * k) / around, c = radius * Math.cos(angle), s = radius * Math.sin(angle);
    return centre.map((x, i) => x + c * u[i] + s * v[i]);
  };

  /** Places on the surface round an arc {x, y, z} as {x, y, z}, a row of each for every place of the arc and one more
      at either end, which closes it. The directions across are carried along without turning about the rod, so that the
      surface does not twist. */
  function surface(arc, radius) {
    const places = arc.x.map((x, i) => [x, arc.y[i], arc.z[i]]), last = places.length - 1;
    const rows = { x: [], y: [], z: [] };
    let u = null;
    places.forEach((place, i) => {
      const t = unit(minus(places[Math.min(i + 1, last)], places[Math.max(i - 1, 0)]));
      u = u === null ? perpendicular(t) : unit(minus(u, t.map((c) => c * dot(u, t))));
      const v = cross(t, u), ring = Array.from({ length: around + 1 }, (_, k) => circle(place, radius, u, v, k));
      ["x", "y", "z"].forEach((axis, k) => rows[axis].push(ring.map((r) => r[k])));
    });
    const close = (i) => ["x", "y", "z"].map((axis, k) => Array(around + 1).fill(places[i][k]));
    ["x", "y", "z"].forEach((axis, k) => { rows[axis].unshift(close(0)[k]); rows[axis].push(close(last)[k]); });
    return rows;
  }

  /** Discs {centre, normal, radius, text} as one mesh. */
  function discs(list) {
    const mesh = { x: [], y: [], z: [], i: [], j: [], k: [], text: [] };
    list.forEach(({ centre, normal, radius, text }) => {
      const first = mesh.x.length, u = perpendicular(normal), v = cross(normal, u);
      const rim = Array.from({ length: around }, (_, k) => circle(centre, radius, u, v, k));
      [centre, ...rim].forEach((r) => { ["x", "y", "z"].forEach((axis, k) => mesh[axis].push(r[k])); mesh.text.push(text); });
      rim.forEach((_, k) => { mesh.i.push(first); mesh.j.push(first + 1 + k); mesh.k.push(first + 1 + ((k + 1) % around)); });
    });
    return mesh;
  }

  return { surface, discs };
})();
