// Numbers as people read them.
"use strict";

const superscript = (n) => String(n).replace(/[-\d]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

/// 0.001234, −25.99, 3.2×10⁻¹²: at most `digits` significant ones.
function format(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (x === 0) return "0";
  const sign = x < 0 ? "−" : "";
  const exponent = Math.floor(Math.log10(Math.abs(x)));
  if (exponent >= -3 && exponent < 5) return sign + String(Number(Math.abs(x).toPrecision(digits)));
  const [mantissa, power] = Math.abs(x).toExponential(digits - 1).split("e");
  const factor = String(Number(mantissa));
  return `${sign}${factor === "1" ? "" : factor + "×"}10${superscript(Number(power))}`;
}

/// 1234567 -> "1 234 567".
const count = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");

/// The largest of 1, 2, 5 times a power of ten that is not above x > 0.
function niceBelow(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  const factor = x / power;
  return (factor >= 5 ? 5 : factor >= 2 ? 2 : 1) * power;
}

/// A time in seconds with as many decimals as tell two samples apart.
function timeFormatter(times) {
  const gap = times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 1;
  const decimals = Math.min(9, Math.max(1, Math.ceil(-Math.log10(gap))));
  return (t) => `${t.toFixed(decimals).replace("-", "−")} s`;
}

const largest = (values) => values.reduce((most, x) => Math.max(most, Math.abs(x ?? 0)), 0);

/// <tag attributes>children</tag>, as HTML.
function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/// The same as SVG.
function shape(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}
