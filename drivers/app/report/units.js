// SPDX-License-Identifier: BSD-3-Clause
// Numbers as people read them, and small helpers of the page.
"use strict";

const by_id = (id) => document.getElementById(id);

// An element of HTML or SVG with attributes and children, text or elements.
function element(name, attributes = {}, ...children) {
  const space = /^(svg|g|path|line|text|rect|circle|polyline|title)$/.test(name) ? "http://www.w3.org/2000/svg" : null;
  const made = space ? document.createElementNS(space, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

// The unit, with a prefix, in which numbers up to `largest` are short: {factor, unit}, to be multiplied by the factor.
function unit_for(largest, unit) {
  if (!unit || !(largest > 0)) return {factor: 1, unit: unit || ""};
  const [size, prefix] = PREFIXES.find(([size]) => largest >= 0.9999 * size) || PREFIXES[PREFIXES.length - 1];
  return {factor: 1 / size, unit: prefix + unit};
}

// Three digits, without zeros at the end.
function short(number) {
  if (number === null || !Number.isFinite(number)) return "–";
  const size = Math.abs(number);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return number.toExponential(1).replace("e+", "e");
  return String(Number(number.toPrecision(3)));
}

function with_unit(number, unit) {
  const {factor, unit: prefixed} = unit_for(Math.abs(number), unit);
  return short(number * factor) + " " + prefixed;
}

// As one word of a shell's command line.
function shell_word(text) { return /^[\w./+=:,@%-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'"; }

function percent(part) { return part === null ? "–" : short(100 * part) + " %"; }

// Round numbers from low to high, about `count` of them.
function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((digit) => digit * power >= rough) * power, found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(i === 0 ? 0 : i * step);
  return found;
}

// The largest of 1, 2 and 5 times a power of ten that is not above a number.
function round_below(number) {
  const power = 10 ** Math.floor(Math.log10(number));
  return [5, 2, 1].find((digit) => digit * power <= number * (1 + 1e-9)) * power;
}

// The numbers behind a text in base64, of an array type such as Float32Array. Files of runs and pages are little-endian.
function decoded(text, Type) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
  return new Type(bytes.buffer);
}

// A colour of the page's style, such as "--ink".
function colour(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }
const series_colour = (i) => `var(--c${i % 12})`;
