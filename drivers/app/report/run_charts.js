// SPDX-License-Identifier: BSD-3-Clause
// What a run was like: energies, forces of obstacles, probes, where the time went, levels.
"use strict";

const ENERGIES = ["kinetic", "elastic", "potential", "contact", "total"];
const INSIDE_INTEGRATE = ["force", "contact", "solve"]; // stages that the stage "integrate" contains

function choose_time(time) {
  if (page.films.length) play(false), show_frame(nearest(report.times, time));
}

function sizes(columns, names) { return columns[names[0]].map((_, i) => Math.hypot(...names.map((name) => columns[name][i]))); }

function show_charts() {
  const parent = by_id("charts"), {history, probes, summary} = report;
  if (history && history.time.length > 1) show_history(parent, history, summary);
  if (probes && probes.time.length > 1) show_probes(parent, probes);
  if (summary && Object.keys(summary.stages).length) show_stages(parent, summary);
}

function show_history(parent, history, summary) {
  const moved = (name) => history[name + "_energy"] && history[name + "_energy"].some((v) => v !== 0);
  const energies = ENERGIES.filter(moved).map((name) => ({name, values: history[name + "_energy"]}));
  if (energies.length) page.cursors.push(line_chart(parent, "Energy of level 0", history.time, energies, "J", choose_time));
  const pushed = Object.keys(history).filter((name) => name.endsWith(".force_x")).map((name) => name.slice(0, -8));
  const forces = pushed.map((name) => ({name, values: sizes(history, ["x", "y", "z"].map((axis) => `${name}.force_${axis}`))}));
  const supports = (summary && summary.reactions) || {}, [holding, touching] = [true, false].map((held) => forces.filter(({name}) => name in supports === held));
  if (touching.length) page.cursors.push(line_chart(parent, "Size of the contact force on obstacles", history.time, touching, "N", choose_time));
  if (holding.length) page.cursors.push(line_chart(parent, "Size of the force on supports", history.time, holding, "N", choose_time));
  const holders = Object.keys(history).filter((name) => name.endsWith(".held")).map((name) => ({name: name.slice(0, -5), values: history[name]}));
  if (holders.length) page.cursors.push(line_chart(parent, "Points that obstacles hold", history.time, holders, "", choose_time));
}

function show_probes(parent, probes) {
  const names = Object.keys(probes).filter((name) => name.endsWith("_vx")).map((name) => name.slice(0, -3));
  const series = names.map((name) => {
    const at = ["x", "y", "z"].map((axis) => probes[`${name}_${axis}`]);
    return {name, values: at[0].map((_, i) => Math.hypot(...at.map((values) => values[i] - values[0])))};
  });
  page.cursors.push(line_chart(parent, "Probes: distance from where they started", probes.time, series, "m", choose_time));
  const axis_of = report.up.map(Math.abs).indexOf(Math.max(...report.up.map(Math.abs))), axis = "xyz"[axis_of];
  const along = names.map((name) => ({name, values: probes[`${name}_${axis}`].map((v, _, all) => v - all[0])}));
  page.cursors.push(line_chart(parent, `Probes: displacement along ${axis}`, probes.time, along, "m", choose_time));
}

// Wall time of each level by stage, none of them inside another.
function show_stages(parent, summary) {
  const levels = {};
  for (const [name, seconds] of Object.entries(summary.stages)) {
    const found = name.match(/^(.*) (\d+)$/);
    if (found) (levels[found[2]] = levels[found[2]] || {})[found[1]] = seconds;
  }
  const rows = Object.entries(levels).map(([level, parts]) => {
    if (parts.integrate !== undefined) {
      const inside = INSIDE_INTEGRATE.reduce((sum, stage) => sum + (parts[stage] || 0), 0);
      parts["integrate: the rest"] = Math.max(parts.integrate - inside, 0);
      delete parts.integrate;
    }
    const all = Object.values(parts).reduce((a, b) => a + b, 0), own = summary.levels[level];
    return {name: "level " + level, parts, note: with_unit(all, "s") + (own ? `, ${own.tets} tets` : "")};
  });
  if (rows.length) bar_chart(parent, "Wall time by stage", rows, "s", `${with_unit(summary.wall_time, "s")} of stepping in all`);
}

function show_facts() {
  const {summary: s} = report, parent = by_id("facts");
  if (!s) return;
  const heads = ["level", "vertices", "tetrahedra", "elements", "critical step", "share", "sub-steps", "integrator"];
  const table = element("table", {}, element("tr", {}, ...heads.map((head) => element("th", {}, head))));
  s.levels.forEach((level, i) => {
    const cells = [i, level.vertices, level.tets || "–", level.element, level.critical_step > 0 ? with_unit(level.critical_step, "s") : "–", short(level.share),
      level.substeps, level.integrator];
    table.append(element("tr", {}, ...cells.map((cell) => element("td", {}, String(cell ?? "–")))));
  });
  card(parent, "Levels, finest first").append(element("div", {class: "scroll"}, table));
  const facts = {scene: s.scene, command: (s.arguments || []).map(shell_word).join(" "), "macro steps": `${s.macro_steps} of ${with_unit(s.macro_step, "s")}`,
    "set-up": with_unit(s.setup_time, "s"), "peak memory": with_unit(s.peak_memory, "B"),
    "written by": `plica ${s.version} (${s.git_revision}), ${s.compiler}`,
    frames: report.frames_there > report.times.length ? `${report.times.length} of the ${report.frames_there} written` : report.times.length};
  const list = element("dl");
  for (const [name, value] of Object.entries(facts)) list.append(element("dt", {}, name), element("dd", {}, String(value)));
  card(parent, "The run").append(list);
}

start();
