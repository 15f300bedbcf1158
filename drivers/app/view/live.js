// SPDX-License-Identifier: BSD-3-Clause
// The page of a live view: shows the frames that come, says what hands do.
"use strict";

const LOOKS = ["solid", "with edges", "glass", "edges", "off"];
const BODY = "#8fa9c4", BALL = "#d9a441", HAND = "#e000c0";
const QUANTITIES = {displacement: ["displacement", "m"], speed: ["speed", "m/s"], von_mises: ["von Mises stress", "Pa"],
  J: ["volume ratio J", ""], "": ["none", ""]};
const scene = JSON.parse(by_id("data").textContent);
const live = {frame: null, frames: 0, most: 0, obstacles: [], held: null, ball: {radius: 0.1 * scene.size, centre: null, on: false},
  controls: {running: true, restarts: 0, speed: 1, gravity: scene.gravity, stiffness: scene.stiffness, colour: "displacement", pull: null, tool: null, moved: []}};

// -- to the program, the newest state of the controls only

let saying = false, unsaid = false;
async function say(changes) {
  Object.assign(live.controls, changes), unsaid = true;
  if (saying) return;
  saying = true;
  while (unsaid) {
    unsaid = false;
    const answer = await fetch("/controls", {method: "POST", body: JSON.stringify(live.controls)}).catch(() => null);
    if (answer && !answer.ok) show_words(await answer.text());
  }
  saying = false;
}

// -- from the program

function listen_to_frames() {
  const frames = new EventSource("/frames");
  frames.onmessage = (event) => show_frame(JSON.parse(event.data));
  frames.onerror = () => set_status("not connected: the program has ended", true);
  frames.onopen = () => { say({}); }; // a program that was started anew does not know them
}

function show_frame(frame) {
  const points = decoded(frame.points, Float32Array);
  if (points.length !== scene.rest.length) return void location.reload(); // of another scene
  Object.assign(live, {frame, points}), ++live.frames;
  live.body.move(points);
  colour_body();
  for (const obstacle of live.obstacles) show_obstacle(obstacle);
  if (frame.tool && !(live.held && live.held.ball)) live.ball.centre = frame.tool;
  place_ball(frame.tool || live.ball.centre);
  show_words(frame.wrong);
  set_status(frame.wrong ? "diverged" : live.controls.running ? "running" : "at rest", Boolean(frame.wrong));
  by_id("clock").textContent = `${frame.time.toFixed(3)} s`;
  by_id("pace").textContent = `${short(frame.speed)} × real time (${short(frame.possible)} × is possible)`;
  redraw();
}

function set_status(words, bad) { by_id("status").textContent = words, by_id("status").className = bad ? "bad" : ""; }

function show_words(words) {
  by_id("warnings").replaceChildren(...(words ? [element("li", {}, `${words} — “start” goes back to the beginning.`)] : []));
}

// -- colours

function values_now() {
  const {points, frame} = live, {rest} = scene;
  if (live.controls.colour !== "displacement") return frame.values && frame.colour === live.controls.colour ? decoded(frame.values, Float32Array) : null;
  return Float32Array.from({length: rest.length / 3}, (_, i) =>
    Math.hypot(points[3 * i] - rest[3 * i], points[3 * i + 1] - rest[3 * i + 1], points[3 * i + 2] - rest[3 * i + 2]));
}

function colour_body() {
  const {body} = live, values = values_now(), two_sided = live.controls.colour === "J";
  if (!values) return void body.values.fill(-1);
  const most = values.reduce((m, v) => Math.max(m, two_sided ? Math.abs(v - 1) : v), 1e-12);
  if (most > live.most) live.most = 1.2 * most, show_legend();
  const low = two_sided ? 1 - live.most : 0, width = two_sided ? 2 * live.most : live.most;
  for (let i = 0; i < body.values.length; ++i) body.values[i] = Math.max(0, Math.min(1, (values[body.triangles[i]] - low) / width));
}

function show_legend() {
  const legend = by_id("legend"), [label, name] = QUANTITIES[live.controls.colour], two_sided = live.controls.colour === "J";
  legend.replaceChildren();
  if (!live.controls.colour || !live.most) return;
  const low = two_sided ? 1 - live.most : 0, high = two_sided ? 1 + live.most : live.most, {factor, unit: prefixed} = unit_for(high, name);
  const ramp = two_sided ? RAMPS.two_sided : RAMPS.size, stops = ramp.map((stop, i) => `${stop} ${100 * (i + 0.5) / ramp.length}%`).join(", ");
  legend.append(prefixed ? `${label} [${prefixed}]` : label, element("div", {class: "ramp", style: `background: linear-gradient(90deg, ${stops})`}),
    element("div", {class: "ticks"}, ...[low, (low + high) / 2, high].map((v) => element("span", {}, short(v * factor)))));
}

function choose_colour(colour) {
  live.most = 0;
  live.view.set_ramp(colour === "J" ? RAMPS.two_sided : RAMPS.size);
  say({colour}), show_legend();
  if (live.frame) colour_body(), redraw();
}

// -- the ball

function show_ball(on) {
  live.ball.on = on, live.ball.surface.look = on ? "solid" : "off", by_id("ball").checked = on;
  if (on && !live.ball.centre) { // above the body
    const up = unit(scene.up), top = Math.max(...corners_of(scene.low, scene.high).map((p) => dot(p, up))), middle = times(plus(scene.low, scene.high), 0.5);
    live.ball.centre = plus(middle, times(up, top - dot(middle, up) + 1.1 * live.ball.radius));
  }
  place_ball(live.ball.centre);
  say_ball();
}

function say_ball() { say({tool: live.ball.on ? {centre: live.ball.centre, radius: live.ball.radius} : null}); }

function place_ball(centre) {
  const {surface, radius, on} = live.ball;
  if (on) surface.move(surface.points.map((x) => radius * x), centre);
}

// -- obstacles of the scene

// Those that the mouse can take: a plane or a bowl is all around.
function can_move(obstacle) { return obstacle.shape !== "plane" && obstacle.shape !== "bowl" && obstacle.surface.look !== "off"; }

function moved_of(obstacle) { return live.frame.moved.find((one) => one.obstacle === obstacle.number); }

function show_obstacle(obstacle) {
  const moved = moved_of(obstacle);
  obstacle.shift = moved ? moved.displacement : obstacle.at(live.frame.time);
  obstacle.turned = obstacle.points(live.frame.time);
  obstacle.surface.move(obstacle.turned, obstacle.shift);
}

function say_obstacle(obstacle, displacement) {
  const others = live.controls.moved.filter((one) => one.obstacle !== obstacle.number);
  say({moved: [...others, {obstacle: obstacle.number, displacement}]});
}

// -- where the mouse is

function ray_of(event) {
  const {view} = live, {left, top, width, height} = view.canvas.getBoundingClientRect(), rows = view.turn();
  const x = (event.clientX - left - width / 2 - view.shift[0]) / view.resolution(), y = -(event.clientY - top - height / 2 - view.shift[1]) / view.resolution();
  return {rows, start: plus(view.focus, plus(times(rows[0], x), times(rows[1], y)))}; // rows[2] looks to the eye
}

// The place of a point along a ray at this depth.
function at_depth({rows, start}, depth) { return plus(start, times(rows[2], depth)); }

// The triangle that is seen there: its corners, where on it, its depth.
function seen_at(ray, points, triangles) {
  const [right, above, near] = ray.rows, px = dot(right, ray.start), py = dot(above, ray.start), pz = dot(near, ray.start);
  let best = null;
  const at = (row, p) => row[0] * points[3 * p] + row[1] * points[3 * p + 1] + row[2] * points[3 * p + 2];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const ax = at(right, a) - px, ay = at(above, a) - py, bx = at(right, b) - px, by = at(above, b) - py, cx = at(right, c) - px, cy = at(above, c) - py;
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay), u = (bx * cy - cx * by) / area, v = (cx * ay - ax * cy) / area, w = 1 - u - v;
    if (!(u >= 0 && v >= 0 && w >= 0)) continue;
    const depth = u * at(near, a) + v * at(near, b) + w * at(near, c) - pz;
    if (!best || depth > best.depth) best = {depth, corners: [a, b, c], weights: [u, v, w]};
  }
  return best;
}

// Of the body with the same place at rest.
function pick(ray) {
  const best = seen_at(ray, live.points, live.body.triangles);
  return best && {...best, rest: mixed(scene.rest, best), place: mixed(live.points, best)};
}

function pick_obstacle(ray, obstacle) {
  const best = seen_at({rows: ray.rows, start: minus(ray.start, obstacle.shift)}, obstacle.turned, obstacle.surface.triangles);
  return best && {obstacle, depth: best.depth, shift: obstacle.shift, place: at_depth(ray, best.depth)};
}

function mixed(points, {corners, weights}) {
  return [0, 1, 2].map((k) => corners.reduce((sum, p, i) => sum + weights[i] * points[3 * p + k], 0));
}

function pick_ball(ray) {
  const {ball} = live;
  if (!ball.on) return null;
  const to = minus(ball.centre, ray.start), depth = dot(ray.rows[2], to);
  const beside = Math.hypot(dot(ray.rows[0], to), dot(ray.rows[1], to)), front = depth + Math.sqrt(Math.max(ball.radius ** 2 - beside ** 2, 0));
  return beside > ball.radius ? null : {ball: true, depth, front, offset: minus(ball.centre, at_depth(ray, depth))};
}

// What the mouse would take hold of, the nearest: the ball, an obstacle, the body or nothing.
function target_of(event) {
  const ray = ray_of(event), nearness = (one) => one.front ?? one.depth;
  const seen = [live.body.look === "off" ? null : pick(ray), pick_ball(ray), ...live.obstacles.filter(can_move).map((one) => pick_obstacle(ray, one))];
  return seen.filter(Boolean).reduce((best, one) => !best || nearness(one) > nearness(best) ? one : best, null);
}

function take(event) {
  if (!live.frame || event.button !== 0 || event.shiftKey) return;
  live.held = live.view.held = target_of(event);
  if (live.held) by_id("view").classList.add("held"), draw_to(event);
}

function draw_to(event) {
  const {held} = live, place = at_depth(ray_of(event), held.depth);
  if (held.ball) live.ball.centre = plus(place, held.offset), say_ball();
  else if (held.obstacle) say_obstacle(held.obstacle, plus(held.shift, minus(place, held.place)));
  else held.target = place, say({pull: {at: held.rest, target: place}});
  redraw();
}

function let_go() {
  if (!live.held) return;
  live.held = live.view.held = null;
  by_id("view").classList.remove("held");
  say({pull: null}), redraw();
}

// -- the picture

function redraw() {
  live.view.draw();
  const {view} = live, svg = by_id("marks"), {clientWidth: width, clientHeight: height} = svg.parentNode, rows = view.turn();
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  draw_axes(svg, view, width, height);
  if (!live.frame) return;
  const on_screen = (p) => { const at = minus(p, view.focus); return [width / 2 + view.shift[0] + dot(rows[0], at) * view.resolution(), height / 2 + view.shift[1] - dot(rows[1], at) * view.resolution()]; };
  const words = [];
  const held_obstacle = live.held && live.held.obstacle && moved_of(live.held.obstacle);
  if (held_obstacle && held_obstacle.push > 0)
    words.push([...on_screen(plus(live.held.place, minus(held_obstacle.displacement, live.held.shift))), with_unit(held_obstacle.push, "N")]);
  if (live.held && live.held.target) {
    const [x, y] = on_screen(mixed(live.points, live.held)), [tx, ty] = on_screen(live.held.target);
    svg.append(element("line", {x1: x, y1: y, x2: tx, y2: ty, stroke: HAND, "stroke-width": 2.5}), element("circle", {cx: x, cy: y, r: 5, fill: HAND}));
    words.push([tx, ty, with_unit(live.frame.pull, "N")]);
  }
  if (live.ball.on && live.frame.push > 0) words.push([...on_screen(live.frame.tool || live.ball.centre), with_unit(live.frame.push, "N")]);
  for (const [x, y, text] of words) svg.append(element("text", {class: "strong", x: x + 12, y: y - 10}, text));
}

// -- controls

// A slider over powers of ten, or evenly over [low, high].
function add_knob(name, {low, high, value, even, words, set}) {
  const to = even ? (x) => x : Math.log10, from = even ? (x) => x : (x) => 10 ** x;
  const slider = element("input", {type: "range", min: to(low), max: to(high), step: (to(high) - to(low)) / 200, id: name.replace(/ /g, "_"), "aria-label": name});
  const shown = element("output", {}, words(value));
  slider.value = to(value);
  slider.addEventListener("input", () => { const now = from(Number(slider.value)); shown.textContent = words(now), set(now); });
  by_id("knobs").append(element("label", {}, element("span", {}, name), shown, slider));
}

function add_knobs() {
  const {controls, ball} = live, g = scene.gravity || 9.81;
  add_knob("speed", {low: 0.01, high: 10, value: 1, words: (v) => `at most ${short(v)} × real time`, set: (speed) => say({speed})});
  add_knob("gravity", {low: -g, high: 3 * g, value: controls.gravity, even: true, words: (v) => `${short(v)} m/s²`,
    set: (gravity) => say({gravity: Math.abs(gravity) < 0.011 * g ? 0 : gravity})});
  add_knob("pull stiffness", {low: scene.stiffness / 30, high: 30 * scene.stiffness, value: scene.stiffness, words: (v) => with_unit(v, "N/m"),
    set: (stiffness) => say({stiffness})});
  const box = element("input", {type: "checkbox", id: "ball"});
  box.addEventListener("change", () => { show_ball(box.checked), redraw(); });
  by_id("knobs").append(element("label", {}, element("span", {}, box, " a ball to push with")));
  add_knob("ball radius", {low: 0.02 * scene.size, high: 0.5 * scene.size, value: ball.radius, words: (v) => with_unit(v, "m"),
    set: (radius) => { ball.radius = radius, place_ball(ball.centre), say_ball(), redraw(); }});
}

function add_layer(name, words, surface, look, looks) {
  surface.look = look;
  const choice = element("select", {"aria-label": name}, ...looks.map((one) => element("option", one === look ? {selected: ""} : {}, one)));
  choice.addEventListener("change", () => { surface.look = choice.value, redraw(); });
  by_id("layers").append(element("label", {}, element("span", {}, name, element("small", {}, words)), choice));
  live.view.surfaces.push(surface);
}

function run(on) {
  by_id("play").textContent = on ? "⏸" : "▶";
  say({running: on});
}

function restart() { live.most = 0, say({restarts: live.controls.restarts + 1, moved: []}); }

function dark(on) {
  document.documentElement.classList.toggle("dark", on);
  redraw();
}

function listen_to_hands() {
  const canvas = by_id("view"), toggle = () => dark(!document.documentElement.classList.contains("dark"));
  canvas.addEventListener("pointerdown", take);
  canvas.addEventListener("pointermove", (event) => {
    if (live.held) return draw_to(event);
    if (live.frame && !event.buttons) canvas.classList.toggle("ready", Boolean(target_of(event)));
  });
  for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(kind, let_go);
  window.addEventListener("resize", redraw);
  const actions = {" ": () => run(!live.controls.running), s: restart, b: () => { show_ball(!live.ball.on), redraw(); }, r: () => { live.view.reset(), redraw(); }, d: toggle};
  window.addEventListener("keydown", (event) => {
    if (!actions[event.key] || event.ctrlKey || event.metaKey || /SELECT|BUTTON/.test(event.target.tagName)) return;
    event.preventDefault();
    actions[event.key]();
  });
  by_id("play").addEventListener("click", () => run(!live.controls.running));
  by_id("restart").addEventListener("click", restart);
  by_id("theme").addEventListener("click", toggle);
}

function start() {
  by_id("title").textContent = scene.title, by_id("subtitle").textContent = scene.method;
  scene.rest = decoded(scene.rest, Float32Array);
  const along = (k) => scene.rest.filter((_, i) => i % 3 === k), extremes = (of) => [0, 1, 2].map((k) => along(k).reduce((a, b) => of(a, b)));
  scene.low = extremes(Math.min), scene.high = extremes(Math.max);
  live.view = new View(by_id("view"), unit(scene.up), redraw);
  if (!live.view.gl) by_id("clock").after(element("p", {style: "padding: 60px 20px"}, "This browser does not show WebGL 2: the body cannot be drawn."));
  live.body = Object.assign(new Surface(scene.rest, decoded(scene.triangles, Uint32Array)), {colour: BODY});
  live.obstacles = obstacles_of(scene, scene.low.slice(), scene.high.slice());
  const room = times(minus(scene.high, scene.low), 0.25);
  live.view.fit(minus(scene.low, room), plus(scene.high, room));
  add_layer("body", `${scene.rest.length / 3} boundary vertices`, live.body, "solid", LOOKS);
  for (const {name, surface} of live.obstacles) add_layer(name, "obstacle", surface, "glass", ["glass", "solid", "edges", "off"]);
  const {points, triangles} = on_sphere([0, 0, 0], 1, Math.PI);
  live.ball.surface = Object.assign(new Surface(new Float32Array(points), new Uint32Array(triangles)), {colour: BALL, look: "off"});
  live.view.surfaces.push(live.ball.surface);
  by_id("colour").append(...Object.entries(QUANTITIES).map(([q, [label]]) => element("option", {value: q}, label)));
  by_id("colour").addEventListener("change", (event) => choose_colour(event.target.value));
  add_knobs();
  listen_to_hands();
  choose_colour("displacement");
  dark(window.matchMedia("(prefers-color-scheme: dark)").matches);
  listen_to_frames();
}

start();
