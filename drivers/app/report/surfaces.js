// SPDX-License-Identifier: BSD-3-Clause
// Triangles in time: where they are, their normals, and the values that colour them. Corners are kept apart, three a
// triangle, so that values and creases need not be shared between neighbours.
"use strict";

const CREASE = Math.cos(40 * Math.PI / 180); // sharper edges than this stay sharp

class Surface {
  // rest: Float32Array of points; triangles: Uint32Array
  constructor(rest, triangles) {
    this.points = rest;
    this.triangles = triangles;
    this.corners = new Float32Array(3 * triangles.length);
    this.normals = new Float32Array(3 * triangles.length);
    this.values = new Float32Array(triangles.length).fill(-1); // below 0: in the plain colour
    this.look = "solid";
    this.changed = true; // since it was drawn
    this.neighbours = this.corners_of_points();
  }

  // Per point the corners that it is, in one array; point p has those from starts[p] to starts[p + 1].
  corners_of_points() {
    const starts = new Uint32Array(this.points.length / 3 + 1), corners = new Uint32Array(this.triangles.length);
    for (const p of this.triangles) ++starts[p + 1];
    for (let p = 1; p < starts.length; ++p) starts[p] += starts[p - 1];
    const next = starts.slice();
    this.triangles.forEach((p, corner) => { corners[next[p]++] = corner; });
    return {starts, corners};
  }

  // Takes new points, or the same shifted.
  move(points, shift = [0, 0, 0]) {
    const {triangles, corners} = this;
    for (let i = 0; i < triangles.length; ++i)
      for (let k = 0; k < 3; ++k) corners[3 * i + k] = points[3 * triangles[i] + k] + shift[k];
    this.shade();
    this.changed = true;
  }

  // At each corner the mean normal of the triangles around its point that do not bend away from its own.
  shade() {
    const {corners: c, normals, triangles, neighbours: {starts, corners}} = this;
    const count = triangles.length / 3, areas = new Float32Array(3 * count), units = new Float32Array(3 * count);
    for (let t = 0; t < count; ++t) {
      const a = 9 * t, b = a + 3, d = a + 6;
      const ux = c[b] - c[a], uy = c[b + 1] - c[a + 1], uz = c[b + 2] - c[a + 2];
      const vx = c[d] - c[a], vy = c[d + 1] - c[a + 1], vz = c[d + 2] - c[a + 2];
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], size = Math.hypot(...n) || 1;
      for (let k = 0; k < 3; ++k) areas[3 * t + k] = n[k], units[3 * t + k] = n[k] / size;
    }
    for (let i = 0; i < triangles.length; ++i) {
      const own = 3 * Math.floor(i / 3), p = triangles[i];
      let x = 0, y = 0, z = 0;
      for (let j = starts[p]; j < starts[p + 1]; ++j) {
        const t = 3 * Math.floor(corners[j] / 3);
        if (units[t] * units[own] + units[t + 1] * units[own + 1] + units[t + 2] * units[own + 2] < CREASE) continue;
        x += areas[t], y += areas[t + 1], z += areas[t + 2];
      }
      const size = Math.hypot(x, y, z) || 1;
      normals[3 * i] = x / size, normals[3 * i + 1] = y / size, normals[3 * i + 2] = z / size;
    }
  }
}

// A body's surface at the times of a run: what the program calls a film.
class Film {
  constructor(data) {
    Object.assign(this, data);
    this.name = data.level === null ? "surface" : "level " + data.level;
    this.rest = decoded(data.rest, Float32Array);
    this.steps = decoded(data.motion, Uint16Array);
    this.surface = new Surface(this.rest, decoded(data.triangles, Uint32Array));
    this.frames = this.steps.length / this.rest.length;
    this.fields = Object.fromEntries(data.fields.map((f) => [f.name, {...f, values: decoded(f.values, Uint16Array)}]));
    this.points = new Float32Array(this.rest.length);
  }

  // The points at a frame [m].
  points_at(frame) {
    const {rest, steps, low, high, points} = this, start = frame * rest.length;
    const size = low.map((l, k) => (high[k] - l) / 65535);
    for (let i = 0; i < rest.length; ++i) points[i] = rest[i] + low[i % 3] + size[i % 3] * steps[start + i];
    return points;
  }

  has(quantity) { return quantity === "displacement" || quantity === "shape" || quantity in this.fields; }

  // The values of a quantity at a frame: {values, of_triangles}.
  values_at(quantity, frame) {
    if (quantity === "displacement") return {values: this.distances(frame, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0])};
    if (quantity === "shape") return {values: this.distances(frame, this.fits[frame])};
    const {values, low, high, still, of_triangles} = this.fields[quantity];
    const count = of_triangles ? this.surface.triangles.length / 3 : this.vertices, start = still ? 0 : frame * count;
    return {values: Float32Array.from({length: count}, (_, i) => low + (high - low) * values[start + i] / 65535), of_triangles};
  }

  // How far the points are from where they rest, moved rigidly by rows of rotation and translation [m].
  distances(frame, m) {
    const p = this.points_at(frame), r = this.rest, found = new Float32Array(this.vertices);
    for (let i = 0; i < found.length; ++i) {
      const x = r[3 * i], y = r[3 * i + 1], z = r[3 * i + 2];
      found[i] = Math.hypot(p[3 * i] - (m[0] * x + m[1] * y + m[2] * z + m[3]),
        p[3 * i + 1] - (m[4] * x + m[5] * y + m[6] * z + m[7]), p[3 * i + 2] - (m[8] * x + m[9] * y + m[10] * z + m[11]));
    }
    return found;
  }

  // Goes to a frame and takes the colours of a quantity; part(value) is its place on the ramp of colours.
  show(frame, quantity, part) {
    const {surface} = this;
    surface.move(this.points_at(frame));
    if (!this.has(quantity)) return void surface.values.fill(-1);
    const {values, of_triangles} = this.values_at(quantity, frame);
    for (let i = 0; i < surface.values.length; ++i)
      surface.values[i] = part(values[of_triangles ? Math.floor(i / 3) : surface.triangles[i]]);
  }
}
