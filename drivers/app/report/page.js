// SPDX-License-Identifier: BSD-3-Clause
// The page of a report: puts the data into the view, the controls and the charts.
"use strict";

const LOOKS = ["solid", "with edges", "glass", "edges", "off"];
const FILM_COLOURS = ["#8fa9c4", "#c99a6b", "#86b291", "#a58fc0", "#c58a9a"];
const MARK = "#e000c0"; // unlike all colours of the ramps
const QUANTITIES = { // that need no field: label, unit, explanation
  displacement: ["displacement", "m", "from where it rests"], shape: ["deformation", "m", "distance from the best rigid fit"]};
const report = JSON.parse(by_id("data").textContent);
const page = {frame: 0, playing: false, quantity: "", films: [], obstacles: [], cursors: [], ranges: {}};

function show_head() {
  const s = report.summary, status = by_id("status");
  by_id("title").textContent = report.title;
  if (report.status) status.textContent = report.status;
  else status.remove();
  status.className = /completed$/.test(report.status) ? "" : "bad";
  if (s) {
    const speed = s.wall_time > 0 ? ` (${short(s.simulated_time / s.wall_time)} × real time)` : "";
    const tets = s.levels.map((level) => level.tets).filter((count) => count > 0).join(" + ");  // spaces have none
    by_id("subtitle").textContent = `${tets} tetrahedra, cycle ${s.cycle}, macro step ` +
      `${with_unit(s.macro_step, "s")}; ${with_unit(s.simulated_time, "s")} in ${with_unit(s.wall_time, "s")}${speed}, ${s.precision} on ` +
      `${s.backend}, ${s.threads} thread${s.threads === 1 ? "" : "s"}`;
  }
  const warnings = [...report.warnings, ...((s && s.warnings) || [])];
  if (s && s.diagnosis) warnings.unshift(diagnosis_words(s.diagnosis));
  by_id("warnings").append(...warnings.map((text) => element("li", {}, text)));
}

function diagnosis_words(d) {
  const marked = d.corners && d.corners.length && report.films.length ? ". It is marked in the last frame." : ".";
  return "Diverged: " + (d.text || `${d.kind}; ${d.remedy}`) + marked;
}

// The range of a quantity over all frames and films, of a field but for its outermost 0.2 per cent; its ramp of colours.
function range_of(quantity) {
  if (page.ranges[quantity]) return page.ranges[quantity];
  const sample = [];
  for (const film of page.films.filter((film) => film.has(quantity))) {
    const every = Math.max(1, Math.ceil(film.frames * film.vertices / 200000));
    for (let frame = 0; frame < film.frames; ++frame) film.values_at(quantity, frame).values.forEach((v, i) => { if ((i + frame) % every === 0) sample.push(v); });
  }
  sample.sort((a, b) => a - b);
  const cut = quantity in QUANTITIES ? 0 : 0.002, at = (part) => sample[Math.round(part * (sample.length - 1))] || 0;
  const most = at(1 - cut), least = at(cut);
  const away = Math.max(Math.abs(most - 1), Math.abs(least - 1), 1e-6);
  const range = quantity === "J" ? {low: 1 - away, high: 1 + away, ramp: RAMPS.two_sided}
    : {low: Math.min(0, least), high: most > Math.min(0, least) ? most : Math.min(0, least) + 1e-9, ramp: RAMPS.size};
  return page.ranges[quantity] = {...range, beyond: sample[sample.length - 1] > range.high * (1 + 1e-6)};
}

function label_of(quantity) {
  const field = page.films.map((film) => film.fields[quantity]).find(Boolean);
  return QUANTITIES[quantity] || [field.label, field.unit];
}

function show_legend() {
  const legend = by_id("legend");
  legend.replaceChildren();
  if (!page.quantity) return;
  const {low, high, ramp, beyond} = range_of(page.quantity), [label, name, words] = label_of(page.quantity);
  const {factor, unit: prefixed} = unit_for(Math.max(Math.abs(low), Math.abs(high)), name);
  const stops = ramp.map((stop, i) => `${stop} ${100 * (i + 0.5) / ramp.length}%`).join(", ");
  legend.append(prefixed ? `${label} [${prefixed}]` : label, ...(words ? [element("small", {}, words)] : []), element("div", {class: "ramp", style: `background: linear-gradient(90deg, ${stops})`}),
    element("div", {class: "ticks"}, ...[low, (low + high) / 2, high].map((v, i) => element("span", {}, (i === 2 && beyond ? "≥ " : "") + short(v * factor)))));
}

function show_frame(frame) {
  page.frame = Math.max(0, Math.min(report.times.length - 1, frame));
  const time = report.times[page.frame], {low, high} = page.quantity ? range_of(page.quantity) : {low: 0, high: 1};
  const part = (value) => Math.max(0, Math.min(1, (value - low) / (high - low)));
  for (const film of page.films) if (film.surface.look !== "off") film.show(page.frame, page.quantity, part);
  for (const obstacle of page.obstacles) obstacle.show(time);
  if (page.mark) page.mark.look = page.frame === report.times.length - 1 ? "marked" : "off";
  by_id("time").value = page.frame;
  const {factor, unit: prefixed} = unit_for(report.times[report.times.length - 1], "s");
  by_id("clock").textContent = `${(time * factor).toFixed(factor === 1 ? 3 : 2)} ${prefixed}`;
  for (const move of page.cursors) move(time);
  redraw();
}

function redraw() {
  page.view.draw();
  draw_marks();
}

// The axes, a scale, and where the diagnosis is.
function draw_marks() {
  const {view} = page, svg = by_id("marks"), {clientWidth: width, clientHeight: height} = svg.parentNode, rows = view.turn();
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  draw_axes(svg, view, width, height);
  if (!page.mark || page.mark.look === "off") return;
  const at = minus(page.mark.middle, view.focus), x = width / 2 + view.shift[0] + dot(rows[0], at) * view.resolution();
  const y = height / 2 + view.shift[1] - dot(rows[1], at) * view.resolution();
  svg.append(element("circle", {cx: x, cy: y, r: 16, fill: "none", stroke: MARK, "stroke-width": 2.5}),
    element("text", {class: "strong", x: x + 22, y: y - 10}, page.mark.words));
}

function play(on) {
  page.playing = on;
  by_id("play").textContent = on ? "⏸" : "▶";
  if (!on) return;
  const {times: t} = report, last = t.length - 1;
  if (page.frame === last) show_frame(0);
  let before = performance.now(), time = t[page.frame];
  const tick = (now) => {
    if (!page.playing) return;
    time += Number(by_id("speed").value) * (now - before) / 1000, before = now;
    if (time > t[last] + 0.3 * Number(by_id("speed").value)) time = t[0]; // rests for a moment, then starts anew
    const frame = t.findIndex((_, i) => i === last || t[i + 1] > time);
    if (frame !== page.frame) show_frame(frame);
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function add_layer(name, words, surface, look, looks = LOOKS) {
  surface.look = look;
  const choice = element("select", {"aria-label": name}, ...looks.map((one) => element("option", one === look ? {selected: ""} : {}, one)));
  choice.addEventListener("change", () => { surface.look = choice.value, show_frame(page.frame); });
  by_id("layers").append(element("label", {}, element("span", {}, name, element("small", {}, words)), choice));
  page.view.surfaces.push(surface);
}

function add_mark(diagnosis) {
  const corners = diagnosis && diagnosis.corners;
  if (!corners || !corners.length) return;
  const triangles = corners.length === 4 ? [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2] : [];
  page.mark = new Surface(new Float32Array(corners.flat()), new Uint32Array(triangles));
  page.mark.move(page.mark.points);
  const words = diagnosis.element !== null ? `element ${diagnosis.element}` : `vertex ${diagnosis.vertex}`;
  Object.assign(page.mark, {colour: MARK, middle: times(corners.reduce(plus), 1 / corners.length), words: `${words}, level ${diagnosis.level}`});
  page.view.surfaces.push(page.mark);
}

function add_choices() {
  const quantities = [...new Set(["displacement", "shape", ...page.films.flatMap((film) => Object.keys(film.fields))]), ""];
  page.quantity = page.films[0].held ? "displacement" : "shape";
  by_id("colour").append(...quantities.map((q) => element("option", {value: q, ...(q === page.quantity ? {selected: ""} : {})}, q ? label_of(q)[0] : "none")));
  by_id("colour").addEventListener("change", (event) => choose_quantity(event.target.value));
  const span = report.times[report.times.length - 1] - report.times[0], speeds = [0.001, 0.003, 0.01, 0.03, 0.1, 0.25, 0.5, 1, 2, 5];
  const fit = speeds.filter((speed) => speed <= Math.max(span / 2.5, 0.001)).pop();
  by_id("speed").append(...speeds.map((speed) => element("option", {value: speed, ...(speed === Math.min(fit, 1) ? {selected: ""} : {})}, `${speed} ×`)));
  by_id("time").max = report.times.length - 1;
}

function choose_quantity(quantity) {
  page.quantity = quantity;
  page.view.set_ramp(quantity ? range_of(quantity).ramp : RAMPS.size);
  show_legend();
  show_frame(page.frame);
}

// The box around the films at all times; beside it obstacles that are not much larger.
function extent() {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const add = (points, shift = [0, 0, 0]) => points.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x + shift[i % 3]), high[i % 3] = Math.max(high[i % 3], x + shift[i % 3]);
  });
  for (const film of page.films) for (let frame = 0; frame < film.frames; ++frame) add(film.points_at(frame));
  page.obstacles = report.summary ? obstacles_of(report.summary, low.slice(), high.slice()) : [];
  const size = Math.max(...minus(high, low));
  for (const {surface, at, points} of page.obstacles) {
    const widths = [0, 1, 2].map((k) => { const own = surface.points.filter((_, i) => i % 3 === k); return Math.max(...own) - Math.min(...own); });
    if (Math.max(...widths) < 8 * size) for (const time of report.times) add(points(time), at(time));
  }
  return [low, high];
}

function show_films() {
  if (!report.films.length) return;
  by_id("film").hidden = false;
  page.films = report.films.map((data) => new Film(data));
  page.view = new View(by_id("view"), unit(report.up), redraw);
  if (!page.view.gl) by_id("clock").after(element("p", {style: "padding: 60px 20px"}, "This browser does not show WebGL 2: the body cannot be drawn."));
  page.films.forEach((film, i) => {
    film.surface.colour = FILM_COLOURS[i % FILM_COLOURS.length];
    add_layer(film.name, `${film.vertices} ${film.level === null ? "" : "boundary "}vertices`, film.surface, i === 0 ? "solid" : "off");
  });
  page.view.fit(...extent());
  for (const {name, surface} of page.obstacles) add_layer(name, "obstacle", surface, "glass", ["glass", "solid", "edges", "off"]);
  add_mark(report.summary && report.summary.diagnosis);
  add_choices();
  listen();
}

function listen() {
  const step = (by) => { play(false), show_frame(page.frame + by); };
  by_id("play").addEventListener("click", () => play(!page.playing));
  by_id("time").addEventListener("input", (event) => { play(false), show_frame(Number(event.target.value)); });
  window.addEventListener("resize", redraw);
  const actions = {ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => step(-1e9), End: () => step(1e9),
    " ": () => play(!page.playing), r: () => { page.view.reset(), redraw(); }};
  window.addEventListener("keydown", (event) => {
    if (!actions[event.key] || event.ctrlKey || event.metaKey || /SELECT|BUTTON/.test(event.target.tagName)) return;
    event.preventDefault();
    actions[event.key]();
  });
}

function dark(on) {
  document.documentElement.classList.toggle("dark", on);
  if (page.view) redraw();
}

function start() {
  const toggle = () => dark(!document.documentElement.classList.contains("dark"));
  by_id("theme").addEventListener("click", toggle);
  window.addEventListener("keydown", (event) => { if (event.key === "d" && event.target.tagName !== "SELECT") toggle(); });
  show_head();
  show_films();
  show_charts();
  if (report.study) show_study(report.study);
  show_facts();
  dark(window.matchMedia("(prefers-color-scheme: dark)").matches);
  if (page.films.length) choose_quantity(page.quantity);
}
