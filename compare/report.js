"use strict";
(() => {
  const slider = document.getElementById("slider");
  if (!slider) return;
  const range = slider.querySelector("input");
  const images = { left: slider.querySelector(".over"), right: slider.querySelector(".under") };
  const selects = { left: document.getElementById("left"), right: document.getElementById("right") };

  const move = () => {
    slider.style.setProperty("--at", range.value + "%");
    range.setAttribute("aria-valuetext", range.value + " % of the left picture");
  };
  const show = (side) => {
    const picture = document.getElementById(selects[side].value);
    images[side].src = picture.src;
    images[side].alt = picture.alt;
  };
  const choose = (side, id) => {
    if (![...selects[side].options].some((o) => o.value === id)) return;
    selects[side].value = id;
    show(side);
  };
  // #left=reference&right=two-phase&at=25 opens the page on that view.
  const follow = () => {
    const wanted = new URLSearchParams(location.hash.slice(1));
    for (const side of ["left", "right"]) if (wanted.has(side)) choose(side, wanted.get(side));
    const at = Number(wanted.get("at"));
    if (!wanted.has("at") || !(at >= 0 && at <= 100)) return;
    range.value = String(at);
    range.dispatchEvent(new Event("input"));
  };
  range.addEventListener("input", move);
  for (const side of ["left", "right"]) {
    selects[side].addEventListener("change", () => show(side));
    show(side);
  }
  window.addEventListener("hashchange", follow);
  move();
  follow();
})();
