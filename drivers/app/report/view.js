// SPDX-License-Identifier: BSD-3-Clause
// Draws surfaces with WebGL 2, in parallel projection, and turns them with the mouse.
"use strict";

const RAMPS = { // for sizes, and for what may be below or above its rest
  size: ["#3d8fb3", "#8fcfb0", "#f6d365", "#f08a4b", "#b5233b"],
  two_sided: ["#2166ac", "#6aa5cf", "#c5dcec", "#f2efee", "#f6c4a8", "#d9705a", "#b2182b"],
};

const VERTEX = `#version 300 es
in vec3 corner, normal; in float value;
uniform mat3 turn; uniform vec3 focus, scale; uniform vec2 shift;
out vec3 n, edge; out float v;
void main() {
  vec3 p = turn * (corner - focus);
  gl_Position = vec4(p * scale + vec3(shift, 0.0), 1.0);
  n = turn * normal; v = value;
  int k = gl_VertexID % 3; edge = vec3(k == 0, k == 1, k == 2);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 n, edge; in float v;
uniform sampler2D ramp; uniform vec4 plain; uniform float edges; uniform bool only_edges;
out vec4 shown;
void main() {
  vec3 near = smoothstep(vec3(0.0), 1.3 * fwidth(edge), edge);
  float line = 1.0 - min(min(near.x, near.y), near.z);
  vec3 colour = v < 0.0 ? plain.rgb : texture(ramp, vec2(v, 0.5)).rgb;
  if (only_edges) { if (line < 0.3) discard; shown = vec4(colour, line); return; }
  vec3 m = normalize(n); if (m.z < 0.0) m = -m;
  float light = 0.52 + 0.4 * max(dot(m, vec3(-0.35, 0.6, 0.72)), 0.0) + 0.22 * max(dot(m, vec3(0.7, -0.1, 0.7)), 0.0);
  float gleam = 0.12 * pow(max(dot(m, vec3(-0.2, 0.35, 0.915)), 0.0), 40.0);
  shown = vec4(mix(colour * light + gleam, vec3(0.1), 0.35 * line * edges), plain.a);
}`;

class View {
  // up: against gravity. Where there is no WebGL 2, `gl` is null and nothing is drawn.
  constructor(canvas, up, moved) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true});
    this.surfaces = [];
    this.moved = moved;
    this.held = null; // while the mouse holds something, it does not turn the view
    const across = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.up = up, this.right = unit(minus(across, times(up, dot(across, up))));
    this.away = cross(up, this.right);
    this.reset();
    if (this.gl) this.set_up();
    this.listen();
  }

  reset() { this.azimuth = -17.6, this.elevation = 22.4, this.zoom = 1, this.shift = [0, 0]; }

  set_up() {
    const {gl} = this, program = this.program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source), gl.compileShader(shader), gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program), gl.useProgram(program);
    this.place = (name) => gl.getUniformLocation(program, name);
    gl.enable(gl.DEPTH_TEST), gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const [key, value] of [["MIN_FILTER", "LINEAR"], ["MAG_FILTER", "LINEAR"], ["WRAP_S", "CLAMP_TO_EDGE"],
      ["WRAP_T", "CLAMP_TO_EDGE"]]) gl.texParameteri(gl.TEXTURE_2D, gl["TEXTURE_" + key], gl[value]);
  }

  set_ramp(colours) {
    const {gl} = this, pixels = colours.flatMap((text) => [...rgb(text).map((part) => 255 * part), 255]);
    if (gl) gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, colours.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels));
  }

  // All of a box [low, high] is to be seen at first.
  fit(low, high) {
    this.focus = low.map((l, k) => (l + high[k]) / 2);
    this.depth = Math.hypot(...low.map((l, k) => high[k] - l)) || 1;
    const size = [0, 1].map((row) => Math.max(...corners_of(low, high).map((p) => Math.abs(dot(this.turn()[row], minus(p, this.focus))))));
    this.half = size.map((s) => 1.08 * s);
  }

  // Rows: to the right, upwards, towards the eye.
  turn() {
    const a = this.azimuth * Math.PI / 180, e = this.elevation * Math.PI / 180;
    const level = plus(times(this.right, Math.sin(a)), times(this.away, Math.cos(a)));
    const forward = minus(times(level, Math.cos(e)), times(this.up, Math.sin(e)));
    const across = cross(level, this.up);
    return [across, cross(across, forward), times(forward, -1)];
  }

  // Pixels per metre.
  resolution() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    return this.zoom * Math.min(width / 2 / this.half[0], height / 2 / this.half[1]);
  }

  draw() {
    const {gl, canvas} = this, dense = window.devicePixelRatio || 1;
    if (!gl || !canvas.clientWidth) return;
    const width = Math.round(canvas.clientWidth * dense), height = Math.round(canvas.clientHeight * dense);
    if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
    gl.viewport(0, 0, width, height), gl.clearColor(0, 0, 0, 0), gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const pixels = this.resolution(), x = 2 * pixels / canvas.clientWidth, y = 2 * pixels / canvas.clientHeight, rows = this.turn();
    gl.uniformMatrix3fv(this.place("turn"), false, [0, 1, 2].flatMap((k) => rows.map((row) => row[k])));
    gl.uniform3fv(this.place("focus"), this.focus), gl.uniform3f(this.place("scale"), x, y, -0.5 / this.depth);
    gl.uniform2f(this.place("shift"), 2 * this.shift[0] / canvas.clientWidth, -2 * this.shift[1] / canvas.clientHeight);
    const seen = (looks) => this.surfaces.filter((s) => looks.includes(s.look));
    for (const surface of seen(["solid", "with edges", "edges"])) this.draw_surface(surface, 1);
    gl.depthMask(false), gl.enable(gl.BLEND), gl.enable(gl.CULL_FACE);
    for (const side of [gl.FRONT, gl.BACK]) // of what is see-through, the far side is drawn first, and thicker
      for (const surface of seen(["glass"])) gl.cullFace(side), this.draw_surface(surface, side === gl.FRONT || surface.sheet ? 0.42 : 0.14);
    gl.disable(gl.CULL_FACE), gl.disable(gl.DEPTH_TEST);
    for (const surface of seen(["marked"])) this.draw_surface(surface, 0.85);
    gl.depthMask(true), gl.disable(gl.BLEND), gl.enable(gl.DEPTH_TEST);
  }

  draw_surface(surface, opacity) {
    const {gl, program} = this;
    for (const [name, array, size] of [["corner", surface.corners, 3], ["normal", surface.normals, 3], ["value", surface.values, 1]]) {
      const buffers = surface.buffers = surface.buffers || {}, at = gl.getAttribLocation(program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name] = buffers[name] || gl.createBuffer());
      if (surface.changed) gl.bufferData(gl.ARRAY_BUFFER, array, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(at), gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    }
    surface.changed = false;
    gl.uniform4f(this.place("plain"), ...rgb(surface.colour), opacity);
    gl.uniform1f(this.place("edges"), surface.look === "with edges" ? 1 : 0);
    gl.uniform1i(this.place("only_edges"), surface.look === "edges" ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, surface.values.length);
  }

  listen() {
    const {canvas} = this;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (this.held || !canvas.hasPointerCapture(event.pointerId)) return;
      if (event.shiftKey || event.buttons !== 1) this.shift = [this.shift[0] + event.movementX, this.shift[1] + event.movementY];
      else {
        this.azimuth += 0.4 * event.movementX;
        this.elevation = Math.max(-90, Math.min(90, this.elevation + 0.4 * event.movementY));
      }
      this.moved();
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const factor = Math.exp(-0.0015 * event.deltaY), {left, top, width, height} = canvas.getBoundingClientRect();
      const at = [event.clientX - left - width / 2, event.clientY - top - height / 2];
      this.shift = this.shift.map((s, k) => at[k] + (s - at[k]) * factor), this.zoom *= factor;
      this.moved();
    }, {passive: false});
  }
}

// The axes and a scale, into an SVG of the view's size.
function draw_axes(svg, view, width, height) {
  const rows = view.turn();
  ["x", "y", "z"].forEach((name, k) => {
    const x = 46 + 30 * rows[0][k], y = height - 46 - 30 * rows[1][k];
    svg.append(element("line", {x1: 46, y1: height - 46, x2: x, y2: y, stroke: colour("--c" + [4, 2, 0][k]), "stroke-width": 2}),
      element("text", {x: 46 + 41 * rows[0][k], y: height - 42 - 41 * rows[1][k], "text-anchor": "middle"}, name));
  });
  const length = round_below(150 / view.resolution()), end = width - 18, start = end - length * view.resolution();
  svg.append(element("path", {class: "axis", fill: "none", d: `M${start} ${height - 26}v8h${end - start}v-8`}),
    element("text", {x: (start + end) / 2, y: height - 26, "text-anchor": "middle"}, with_unit(length, "m")));
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b) => a.map((x, k) => x + b[k]);
const minus = (a, b) => a.map((x, k) => x - b[k]);
const times = (a, s) => a.map((x) => x * s);
const unit = (a) => times(a, 1 / (Math.hypot(...a) || 1));
const corners_of = (low, high) => [0, 1, 2, 3, 4, 5, 6, 7].map((i) => low.map((l, k) => (i >> k & 1 ? high[k] : l)));
const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
