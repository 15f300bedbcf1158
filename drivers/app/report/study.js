// SPDX-License-Identifier: BSD-3-Clause
// A study: each method's error against its run time, and the front of those that are best for their time.
"use strict";

const STUDY_BOX = {width: 980, height: 470, left: 70, right: 16, top: 12, bottom: 44};

function family_of(row) { return row.method.split("/").slice(0, row.method.startsWith("single") ? 1 : 2).join("/"); }

function name_of(row, rows) {
  const several = (key) => new Set(rows.map((other) => other[key])).size > 1;
  const parts = [row.method, row.distribution, row.variant && "+" + row.variant, several("element") && row.element,
    several("precision") && row.precision, several("threads") && `${row.threads} threads`];
  return parts.filter(Boolean).join(", ");
}

function row_words(row, rows) {
  const words = [name_of(row, rows), `macro step ${with_unit(row.macro_step, "s")}, ${short(row.macro_step_over_critical)} × the critical step`];
  if (row.status !== "completed") return [...words, row.status + (row.reason ? ": " + row.reason : "")].join("\n");
  if (has_total(row)) words.push(`total error ${percent(row.total_error)}; of the time step ${percent(row.error)}`);
  else words.push(`error ${percent(row.error)}`);
  return [...words, `run time ${with_unit(row.wall_time, "s")}`, row.pareto ? "the best for its time" : ""].filter(Boolean).join("\n");
}

// Levels alone are squares, cycles circles.
function marker_of(row, x, y, tone) {
  if (row.status !== "completed") return element("path", {d: `M${x - 5} ${y - 5}l10 10m0 -10l-10 10`, stroke: tone, "stroke-width": 2, fill: "none"});
  const size = row.pareto ? 6.5 : 5;
  const look = {stroke: tone, "stroke-width": 1.6, fill: row.variant ? "var(--card)" : tone, "fill-opacity": row.pareto || row.variant ? 1 : 0.55};
  if (row.method.startsWith("cycle")) return element("circle", {cx: x, cy: y, r: size, ...look});
  return element("rect", {x: x - 0.9 * size, y: y - 0.9 * size, width: 1.8 * size, height: 1.8 * size, ...look});
}

function draw_points(plot, rows, all, place, families) {
  for (const row of rows) {
    const {x, y} = place(row), marker = marker_of(row, x, y, series_colour(families.indexOf(family_of(row))));
    marker.addEventListener("pointermove", (event) => show_tip(event, row_words(row, all)));
    marker.addEventListener("pointerleave", (event) => show_tip(event, ""));
    plot.svg.append(marker);
  }
}

function front_table(parent, front, rows) {
  const table = element("table", {}, element("tr", {}, ...["best for its time", "macro step", "× critical", "error", "run time"]
    .map((head) => element("th", {}, head))));
  front.forEach((row, i) => {
    const cells = [`${i + 1}  ${name_of(row, rows)}`, with_unit(row.macro_step, "s"), short(row.macro_step_over_critical), percent(error_of(row)),
      with_unit(row.wall_time, "s")];
    table.append(element("tr", {}, ...cells.map((cell) => element("td", {}, cell))));
  });
  parent.append(element("div", {class: "scroll"}, table));
}

// Against the truth, where the study knows it.
const has_total = (row) => Number.isFinite(row.total_error);
const error_of = (row) => (has_total(row) ? row.total_error : row.error);

function show_study(study) {
  const rows = study.rows, done = rows.filter((row) => row.status === "completed" && error_of(row) > 0);
  const true_errors = done.some(has_total), section = by_id("study");
  section.hidden = false;
  const made = card(section, "Error against run time", `${study.name}: ${short(study.duration)} s, ${study.tets.join(" / ")} tetrahedra; ` +
    `${study.machine.cpu}, ${study.machine.threads} thread${study.machine.threads === 1 ? "" : "s"}; study ${study.status}. ` +
    "Point at a mark for its numbers; squares are levels alone, circles cycles, hollow ones variants; crosses did not come to their end.");
  if (!done.length) return void made.append(element("p", {}, "No run of it has come to its end yet."));
  const rates = done.filter((row) => row.work).map((row) => row.wall_time / row.work).sort((a, b) => a - b);
  const rate = rates[Math.floor(rates.length / 2)] || 1, time_of = (row) => (row.status === "completed" ? row.wall_time : row.work * rate);
  const shown = [...done, ...rows.filter((row) => row.status === "diverged" && row.work)];
  const times_ = shown.map(time_of), errors = done.map(error_of), families = [...new Set(shown.map(family_of))];
  const x = {label: "run time of the steps [s]: less to the left", low: Math.min(...times_) / 1.5, high: Math.max(...times_) * 1.5, logarithmic: true};
  const y = {label: (true_errors ? "total " : "") + "error of displacement: less below", low: Math.min(...errors) / 2,
    high: Math.min(Math.max(...errors) * 2, 100), logarithmic: true, shown: percent};
  for (const axis of [x, y]) axis.ticks = powers(axis.low, axis.high);
  const failed = [...new Set(shown.filter((row) => row.status !== "completed").map(family_of))]; // a line for each, above the plot
  const box = {...STUDY_BOX, top: STUDY_BOX.top + 13 * failed.length}, plot = axes(made, x, y, box);
  const height = (row) => (row.status === "completed" ? Math.max(plot.py(error_of(row)), box.top) : box.top - 8 - 13 * failed.indexOf(family_of(row)));
  const place = (row) => ({x: plot.px(time_of(row)), y: height(row)});
  const front = done.filter((row) => row.pareto).sort((a, b) => a.wall_time - b.wall_time);
  let path = "";
  front.forEach((row, i) => {
    const at = place(row);
    const before = i > 0 ? place(front[i - 1]) : {x: -1e9, y: 0}, near = Math.hypot(at.x - before.x, at.y - before.y) < 12;
    plot.svg.append(element("text", {class: "strong", x: at.x + (near ? 13 : -12), y: at.y + (near ? -8 : 16), "text-anchor": "middle"}, String(i + 1)));
    path += i === 0 ? `M${at.x} ${at.y}` : `H${at.x}V${at.y}`;
  });
  const told = 10 * study.reference.own_error;
  if (told > y.low) {
    const at = plot.py(told);
    plot.svg.append(element("rect", {x: STUDY_BOX.left, y: at, width: STUDY_BOX.width - STUDY_BOX.left - STUDY_BOX.right,
      height: STUDY_BOX.height - STUDY_BOX.bottom - at, fill: "var(--soft)", "fill-opacity": 0.12}));
    plot.svg.append(element("text", {x: STUDY_BOX.width - STUDY_BOX.right - 4, y: STUDY_BOX.height - STUDY_BOX.bottom - 6, "text-anchor": "end"}, "grey: not to be told by this reference"));
  }
  plot.svg.append(element("path", {d: path, fill: "none", stroke: "var(--ink)", "stroke-width": 1.5}));
  draw_points(plot, shown, rows, place, families);
  keys(made, families, families.map((_, i) => series_colour(i)));
  front_table(made, front, rows);
}
