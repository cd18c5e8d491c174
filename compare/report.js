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
  // #left=reference&right=hybrid&at=25 opens the page on that view.
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
  // The largest differences: 32 x 32 pixels round each, of the reference and of the method, when they are asked for.
  const kSide = 32;
  for (const details of document.querySelectorAll("details.spots")) {
    details.addEventListener("toggle", () => {
      for (const figure of details.querySelectorAll("figure:not(:has(canvas))")) {
        const pictures = ["reference", details.dataset.method].map((id) => document.getElementById(id));
        const canvases = pictures.map((picture) => {
          const from = (at, size) => Math.max(0, Math.min(Number(at) - kSide / 2, size - kSide));
          const canvas = document.createElement("canvas");
          canvas.width = canvas.height = kSide;
          const x = from(figure.dataset.x, picture.naturalWidth), y = from(figure.dataset.y, picture.naturalHeight);
          canvas.getContext("2d").drawImage(picture, x, y, kSide, kSide, 0, 0, kSide, kSide);
          return canvas;
        });
        figure.prepend(...canvases);
      }
    });
  }
  window.addEventListener("hashchange", follow);
  move();
  follow();
})();
