// SPDX-License-Identifier: BSD-3-Clause
// The obstacles of a run as triangles, and where they are at a time. Their values are those of summary.json.
"use strict";

// A grid of points at(u, v) with i of `across` and j of `along` steps, normals to the side of d/du x d/dv.
function patch(at, across, along) {
  const points = [], triangles = [];
  for (let i = 0; i <= across; ++i) for (let j = 0; j <= along; ++j) points.push(...at(i / across, j / along));
  for (let i = 0; i < across; ++i)
    for (let j = 0; j < along; ++j) {
      const a = i * (along + 1) + j, b = a + along + 1;
      triangles.push(a, b, b + 1, a, b + 1, a + 1);
    }
  return {points, triangles};
}

// A profile of [along the axis, radius], turned about the axis between two points.
function round_solid({from, to}, profile) {
  const length = Math.hypot(...minus(to, from)), axis = times(minus(to, from), 1 / length);
  const side = unit(cross(axis, Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), other = cross(axis, side);
  const ring = profile(length), count = ring.length - 1;
  return patch((u, v) => {
    const [along, radius] = ring[Math.round(v * count)], turn = 2 * Math.PI * u;
    return plus(plus(from, times(axis, along)), plus(times(side, radius * Math.cos(turn)), times(other, radius * Math.sin(turn))));
  }, 64, count);
}

function on_sphere(centre, radius, steepest) {
  return patch((u, v) => {
    const around = 2 * Math.PI * u, polar = steepest * (1 - v);
    return [centre[0] + radius * Math.sin(polar) * Math.cos(around), centre[1] + radius * Math.sin(polar) * Math.sin(around),
      centre[2] - radius * Math.cos(polar)];
  }, 72, 40);
}

const SHAPES = {
  sphere: (o) => on_sphere(o.centre, o.radius, Math.PI),
  bowl: (o) => on_sphere(o.centre, o.radius, Math.acos(1 - o.rim / o.radius)),
  capsule: (o) => round_solid(o, (length) => Array.from({length: 34}, (_, i) => {
    const turn = Math.PI * (i < 17 ? i : i - 1) / 32;
    return [(i < 17 ? 0 : length) - o.radius * Math.cos(turn), o.radius * Math.sin(turn)];
  })),
  cylinder: (o) => round_solid(o, (length) => [[0, 0], [0, o.radius], [length, o.radius], [length, 0]]),
  cone: (o) => round_solid(o, (length) => [[0, 0], [0, o.radius], [length, o.to_radius], [length, 0]]),
  box({centre, size, rotation}) { // its rotation is an axis times an angle (Rodrigues)
    const angle = Math.hypot(...rotation), k = unit(rotation), c = Math.cos(angle), s = Math.sin(angle);
    const points = corners_of(times(size, -0.5), times(size, 0.5)).flatMap((p) =>
      plus(centre, plus(plus(times(p, c), times(cross(k, p), s)), times(k, dot(k, p) * (1 - c)))));
    const sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    return {points, triangles: sides.flatMap(([a, b, d, e]) => [a, b, d, a, d, e])};
  },
  // All that a run keeps of a triangulated surface is its bounding box.
  surface: ({min, max}) => SHAPES.box({centre: times(plus(min, max), 0.5), size: minus(max, min), rotation: [0, 0, 0]}),
  plane({point, normal}, low, high) { // a square part of it, wide enough for the body
    const n = unit(normal), along = unit(cross(n, Math.abs(n[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), across = cross(n, along);
    const middle = times(plus(low, high), 0.5), foot = minus(middle, times(n, dot(n, minus(middle, point))));
    const half = 0.7 * Math.hypot(...minus(high, low));
    const at = (u, v) => plus(foot, plus(times(along, half * (2 * u - 1)), times(across, half * (2 * v - 1))));
    return {...patch(at, 12, 12), sheet: true};
  },
};

// Displacement [m] at a time [s].
function motion_of(obstacle, time) {
  if (obstacle.velocity) return times(obstacle.velocity, time);
  if (obstacle.sine) {
    const {amplitude, frequency, phase} = obstacle.sine;
    return times(amplitude, Math.sin(2 * Math.PI * frequency * time + phase) - Math.sin(phase));
  }
  if (!obstacle.path) return [0, 0, 0];
  const next = obstacle.path.findIndex((knot) => knot.time > time);
  if (next < 0) return obstacle.path[obstacle.path.length - 1].displacement;
  if (next === 0) return obstacle.path[0].displacement;
  const a = obstacle.path[next - 1], b = obstacle.path[next], part = (time - a.time) / (b.time - a.time);
  return plus(times(a.displacement, 1 - part), times(b.displacement, part));
}

// Those of the run whose shape is known here: {number, shape, name, surface, at(time)}; low and high: the box around the body.
function obstacles_of(summary, low, high) {
  const found = [];
  (summary.obstacles || []).forEach((obstacle, number) => {
    const shape = Object.keys(SHAPES).find((name) => name in obstacle);
    if (!shape) return;
    const {points, triangles, sheet} = SHAPES[shape](obstacle[shape], low, high);
    const surface = new Surface(new Float32Array(points), new Uint32Array(triangles));
    Object.assign(surface, {look: "glass", colour: "#7d92a8", sheet});
    const at = (time) => motion_of(obstacle, time);
    found.push({number, shape, name: obstacle.name || `${shape} ${number}`, surface, at, show: (time) => surface.move(surface.points, at(time))});
  });
  return found;
}
