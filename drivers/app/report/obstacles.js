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

// Between the entries of a path: the one before, the one after and the part of the way.
function on_path(path, time) {
  const next = path.findIndex((knot) => knot.time > time);
  if (next < 0) return [path[path.length - 1], path[path.length - 1], 0];
  if (next === 0) return [path[0], path[0], 0];
  const a = path[next - 1], b = path[next];
  return [a, b, (time - a.time) / (b.time - a.time)];
}

function swing({frequency, phase}, time) { return Math.sin(2 * Math.PI * frequency * time + phase) - Math.sin(phase); }

// Displacement [m] at a time [s].
function motion_of(obstacle, time) {
  if (obstacle.velocity) return times(obstacle.velocity, time);
  if (obstacle.sine) return times(obstacle.sine.amplitude, swing(obstacle.sine, time));
  if (!obstacle.path) return [0, 0, 0];
  const [a, b, part] = on_path(obstacle.path, time);
  return plus(times(a.displacement, 1 - part), times(b.displacement, part));
}

// Angle [rad] about the axis of a turn.
function angle_of(turn, time) {
  if (turn.sine) return turn.sine.amplitude * swing(turn.sine, time);
  if (!turn.path) return turn.angular_velocity * time;
  const [a, b, part] = on_path(turn.path, time);
  return a.angle * (1 - part) + b.angle * part;
}

// Points [x, y, z, ...], turned by an angle about a unit vector through a point (Rodrigues).
function turned_points(points, k, angle, about) {
  const c = Math.cos(angle), s = Math.sin(angle), found = new Float32Array(points.length);
  for (let i = 0; i < points.length; i += 3) {
    const p = minus([points[i], points[i + 1], points[i + 2]], about);
    found.set(plus(about, plus(plus(times(p, c), times(cross(k, p), s)), times(k, dot(k, p) * (1 - c)))), i);
  }
  return found;
}

// An obstacle's points at a time, before its displacement.
function points_of({turn}, points, time) {
  if (!turn) return points;
  const angle = Math.hypot(...turn.rotation), still = angle > 0 ? turned_points(points, unit(turn.rotation), angle, turn.about) : points;
  return turned_points(still, turn.axis, angle_of(turn, time), turn.about);
}

// Those of the run whose shape is known here: {number, shape, name, surface, at(time), points(time)}, displacement and points before that;
// low and high: the box around the body.
function obstacles_of(summary, low, high) {
  const found = [];
  (summary.obstacles || []).forEach((obstacle, number) => {
    const shape = Object.keys(SHAPES).find((name) => name in obstacle);
    if (!shape) return;
    const {points, triangles, sheet} = SHAPES[shape](obstacle[shape], low, high);
    const surface = new Surface(new Float32Array(points), new Uint32Array(triangles));
    Object.assign(surface, {look: "glass", colour: "#7d92a8", sheet});
    const at = (time) => motion_of(obstacle, time), places = (time) => points_of(obstacle, surface.points, time);
    found.push({number, shape, name: obstacle.name || `${shape} ${number}`, surface, at, points: places, show: (time) => surface.move(places(time), at(time))});
  });
  return found;
}
