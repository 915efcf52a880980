"use strict";
// What the pages of all reports share.
const data = JSON.parse(document.getElementById("data").textContent);
const pictures = JSON.parse(document.getElementById("pictures").textContent);
const colors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a8f98", "#b8a900",
                "#6a3d9a", "#b15928", "#2f9e44", "#e7298a"];
// Methods differ in colour and in shape, as in src/io/svg_plot.c: no two of sixty look alike.
const shapes = [
  r => `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0z`,
  r => `M${-0.93 * r} ${-0.93 * r}h${1.86 * r}v${1.86 * r}h${-1.86 * r}z`,
  r => `M0 ${-1.2 * r}L${1.18 * r} ${0.9 * r}h${-2.36 * r}z`,
  r => `M0 ${-1.3 * r}L${1.3 * r} 0L0 ${1.3 * r}L${-1.3 * r} 0z`,
  r => `M0 ${1.2 * r}L${1.18 * r} ${-0.9 * r}h${-2.36 * r}z`];
function marker(parent, number, x, y, radius) {
  const color = colors[number % colors.length];
  return element("path", {d: shapes[number % shapes.length](radius), transform: `translate(${x} ${y})`, fill: color}, parent);
}
function key(parent, number) {
  marker(element("svg", {width: 14, height: 14, viewBox: "-7 -7 14 14", class: "key"}, parent), number, 0, 0, 5);
}
const known = value => typeof value === "number" && isFinite(value);
const show = (value, digits) => known(value) ? value.toFixed(digits) : "–";
const $ = id => document.getElementById(id);
function element(name, attributes, parent, text) {
  const svg = ["svg", "g", "line", "path", "circle", "rect", "text", "polyline", "title"].includes(name);
  const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const key in attributes || {}) made.setAttribute(key, attributes[key]);
  if (text !== undefined) made.textContent = text;
  if (parent) parent.appendChild(made);
  return made;
}
function linearTicks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9; k++) ticks.push(k * step);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}
