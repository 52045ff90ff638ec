// Whatever goes wrong in this page is said in it; a test reads it from the root element, as data-ready.
"use strict";

const failures = [];

function fail(what) {
  failures.push(String(what));
  document.documentElement.dataset.ready = "failed";
  const box = document.getElementById("failure");
  box.hidden = false;
  box.textContent = `This page could not draw all of the run; its CSV and JSON files have the numbers. ${failures.join(" · ")}`;
}

window.addEventListener("error", (event) => fail(event.message || "a resource failed"));
window.addEventListener("unhandledrejection", (event) => fail(event.reason));
document.addEventListener("securitypolicyviolation", (event) => fail(`refused: ${event.blockedURI}`));
for (const kind of ["error", "warn"]) {
  const print = console[kind].bind(console);
  console[kind] = (...words) => {
    fail(words.join(" "));
    print(...words);
  };
}
