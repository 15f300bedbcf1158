// SPDX-License-Identifier: BSD-3-Clause
// Charts as SVG: lines over time, bars, and points on logarithmic axes. What the mouse is on is told in numbers.
"use strict";

const BOX = {width: 620, height: 270, left: 62, right: 14, top: 12, bottom: 40};

function show_tip(event, text) {
  const tip = by_id("tip");
  tip.hidden = !text;
  if (!text) return;
  tip.textContent = text;
  tip.style.left = Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 8) + "px";
  tip.style.top = Math.min(event.clientY + 14, window.innerHeight - tip.offsetHeight - 8) + "px";
}

function card(parent, title, words = "") {
  const made = element("div", {class: "card"}, element("h2", {}, title));
  if (words) made.append(element("p", {}, words));
  parent.append(made);
  return made;
}

function keys(parent, names, colours) {
  parent.append(element("div", {class: "keys"}, ...names.map((name, i) => element("span", {style: `--key: ${colours[i]}`}, name))));
}

// Axes in a box: x and y are {label, low, high, ticks, logarithmic}; returns {svg, px, py}, the places of values.
function axes(parent, x, y, box = BOX) {
  const {width, height, left, right, top, bottom} = box, svg = element("svg", {viewBox: `0 0 ${width} ${height}`, role: "img"});
  const place = (axis, from, to) => (value) => {
    const of = (v) => (axis.logarithmic ? Math.log10(v) : v);
    return from + (to - from) * (of(value) - of(axis.low)) / (of(axis.high) - of(axis.low));
  };
  const px = place(x, left, width - right), py = place(y, height - bottom, top);
  const text = (at_x, at_y, words, anchor, more = {}) => svg.append(element("text", {x: at_x, y: at_y, "text-anchor": anchor, ...more}, words));
  for (const tick of x.ticks) {
    svg.append(element("line", {class: "grid", x1: px(tick), x2: px(tick), y1: top, y2: height - bottom}));
    text(px(tick), height - bottom + 16, short(tick), "middle");
  }
  for (const tick of y.ticks) {
    svg.append(element("line", {class: tick === 0 ? "axis" : "grid", x1: left, x2: width - right, y1: py(tick), y2: py(tick)}));
    text(left - 7, py(tick) + 4, y.shown ? y.shown(tick) : short(tick), "end");
  }
  text((left + width - right) / 2, height - 6, x.label, "middle");
  text(0, 0, y.label, "middle", {transform: `translate(13 ${(top + height - bottom) / 2}) rotate(-90)`});
  parent.append(svg);
  return {svg, px, py};
}

function padded(low, high) {
  const room = 0.05 * (high - low || Math.abs(high) || 1);
  return [low - room, high + room];
}

// Lines over time: series are {name, values}. Returns a function that puts the cursor at a time; choose(time) is called where
// the chart is clicked.
function line_chart(parent, title, times_, series, unit_name, choose, words) {
  const made = card(parent, title, words), all = series.flatMap((s) => s.values).filter(Number.isFinite);
  const largest = Math.max(...all.map(Math.abs), 0), {factor, unit: prefixed} = unit_for(largest, unit_name);
  const of_time = unit_for(times_[times_.length - 1], "s");
  const [low, high] = padded(Math.min(0, ...all) * factor, Math.max(0, ...all) * factor);
  const end = Math.max(times_[times_.length - 1] * of_time.factor, 1e-12);
  const {svg, px, py} = axes(made, {label: `time [${of_time.unit}]`, low: 0, high: end, ticks: ticks(0, end, 6)},
    {label: prefixed ? `[${prefixed}]` : "", low, high, ticks: ticks(low, high, 5)});
  series.forEach((s, i) => {
    let pen = "M";
    const path = s.values.map((v, k) => {
      if (!Number.isFinite(v)) { pen = "M"; return ""; }
      const piece = `${pen}${px(times_[k] * of_time.factor).toFixed(1)} ${py(v * factor).toFixed(1)}`;
      pen = "L";
      return piece;
    }).join("");
    svg.append(element("path", {d: path, fill: "none", stroke: series_colour(i), "stroke-width": 1.8, "stroke-linejoin": "round"}));
  });
  if (series.length > 1) keys(made, series.map((s) => s.name), series.map((_, i) => series_colour(i)));
  const cursor = element("line", {class: "cursor", x1: 0, x2: 0, y1: BOX.top, y2: BOX.height - BOX.bottom});
  svg.append(cursor);
  const time_at = (event) => {
    const {left, width} = svg.getBoundingClientRect(), x = (event.clientX - left) / width * BOX.width;
    return Math.max(0, Math.min(1, (x - BOX.left) / (BOX.width - BOX.left - BOX.right))) * end / of_time.factor;
  };
  svg.addEventListener("pointermove", (event) => {
    const k = nearest(times_, time_at(event));
    show_tip(event, [`${with_unit(times_[k], "s")}`, ...series.map((s) => `${s.name}: ${short(s.values[k] * factor)} ${prefixed}`)].join("\n"));
  });
  svg.addEventListener("pointerleave", (event) => show_tip(event, ""));
  svg.addEventListener("click", (event) => choose(time_at(event)));
  return (time) => { for (const end of ["x1", "x2"]) cursor.setAttribute(end, px(time * of_time.factor)); };
}

// The place of the number nearest to `value` in an ascending list.
function nearest(list, value) {
  const after = list.findIndex((x) => x >= value);
  if (after <= 0) return after < 0 ? list.length - 1 : 0;
  return value - list[after - 1] < list[after] - value ? after - 1 : after;
}

// A bar for each row {name, parts: {key: seconds}, note}.
function bar_chart(parent, title, rows, unit_name, words) {
  const made = card(parent, title, words), names = [...new Set(rows.flatMap((row) => Object.keys(row.parts)))];
  const sum = (row) => Object.values(row.parts).reduce((a, b) => a + b, 0), largest = Math.max(...rows.map(sum), 1e-9);
  const {factor, unit: prefixed} = unit_for(largest, unit_name), box = {...BOX, height: 60 + 40 * rows.length, left: 62, right: 130};
  const {svg, px} = axes(made, {label: `[${prefixed}]`, low: 0, high: largest * factor, ticks: ticks(0, largest * factor, 6)},
    {label: "", low: 0, high: rows.length, ticks: []}, box);
  rows.forEach((row, i) => {
    let from = 0;
    const y = box.top + i * (box.height - box.top - box.bottom) / rows.length + 4, middle = y + 20;
    svg.append(element("text", {x: box.left - 8, y: middle, "text-anchor": "end"}, row.name));
    for (const [key, value] of Object.entries(row.parts)) {
      const bar = element("rect", {x: px(from * factor), y, height: 28, width: Math.max(px((from + value) * factor) - px(from * factor), 0),
        fill: series_colour(names.indexOf(key))});
      bar.addEventListener("pointermove", (event) => show_tip(event, `${row.name}, ${key}: ${with_unit(value, unit_name)}`));
      bar.addEventListener("pointerleave", (event) => show_tip(event, ""));
      svg.append(bar);
      from += value;
    }
    svg.append(element("text", {x: px(from * factor) + 6, y: middle}, row.note));
  });
  keys(made, names, names.map((_, i) => series_colour(i)));
}

// Powers of ten from low to high; with 2 and 5 between them where there are few.
function powers(low, high) {
  const found = [], digits = high / low < 500 ? [1, 2, 5] : [1];
  for (let e = Math.floor(Math.log10(low)); 10 ** e <= high; ++e)
    for (const digit of digits) if (digit * 10 ** e >= low && digit * 10 ** e <= high) found.push(Number((digit * 10 ** e).toPrecision(1)));
  return found;
}
