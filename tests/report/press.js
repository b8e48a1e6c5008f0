// SPDX-License-Identifier: Apache-2.0
// Operates the report's controls as a reader would and stores the results in data-result, which browser.py reads.
(async () => {
  "use strict";
  const at = id => document.getElementById(id);
  const result = { ready: document.documentElement.dataset.ready === "yes" };
  result.fits = document.documentElement.scrollWidth <= window.innerWidth;
  const column = () => [...at("points").tBodies[0].rows].map(row => parseFloat(row.cells[4].textContent));
  const rises = values => values.every((v, i) => i === 0 || values[i - 1] <= v);
  const error = [...at("points").querySelectorAll("th button")].find(b => b.textContent === "error");
  error.click();
  result.sorts = rises(column()) && column().length === data.points.length;
  error.click();
  result.sortsBack = rises(column().reverse());
  const row = at("points").tBodies[0].rows[1];
  row.click();
  result.chooses = at("flags").textContent === data.points[Number(row.dataset.row)].flags && row.classList.contains("chosen");
  at("cut").value = 20;
  at("cut").dispatchEvent(new Event("input"));
  result.slides = at("compare").style.getPropertyValue("--cut") === "20%";
  const images = [at("before"), at("after"), at("heat")];
  await Promise.all(images.map(image => image.decode()));
  result.pictures = images.every(image => image.naturalWidth > 8);
  // The number of measurements depends on the speed of the machine.
  const drawn = data.points.filter(p => p.error > 0 && p.seconds > 0);
  const front = document.querySelector("#pareto polyline.front");
  result.front = front !== null &&
    front.getAttribute("points").split(" ").length === drawn.filter(p => p.on_front).length &&
    drawn.length > 1 && document.querySelectorAll("#pareto circle").length === drawn.length;
  result.slopes = data.slopes.length > 0 &&
    document.querySelectorAll("#convergence polyline").length === data.slopes.length;
  const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g).map(Number);
  result.dark = r + g + b < 3 * 128;
  document.documentElement.dataset.result = JSON.stringify(result);
})();
