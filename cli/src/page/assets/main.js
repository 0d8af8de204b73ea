// Draws everything, and again where the page becomes wider, darker or paper.
document.querySelectorAll("[data-strips]").forEach((element) => {
  drawStrips(page.strips[element.dataset.strips], element);
});
document.querySelectorAll("[data-figure]").forEach((element) => {
  plot(page.figures[element.dataset.figure], element);
});
document.querySelectorAll("[data-map]").forEach(map);
document.querySelectorAll("details.each").forEach((it) => it.addEventListener("toggle", () => unfold(it)));
document.querySelectorAll("[data-asked]").forEach(asked);
document.querySelectorAll("[data-convergence]").forEach(drawConvergence);
document.querySelectorAll("[data-portrait]").forEach(portrait);

function resize() {
  charts.forEach(({ chart, element, height }) => {
    if (chart.width !== element.clientWidth) chart.setSize({ width: element.clientWidth, height });
  });
}

const redraw = () => charts.forEach(({ chart }) => chart.redraw(false, true));

new ResizeObserver(resize).observe(document.body);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
addEventListener("beforeprint", () => {
  document.documentElement.classList.add("printed");
  redraw();
});
addEventListener("afterprint", () => {
  document.documentElement.classList.remove("printed");
  redraw();
});
document.getElementById("whole").addEventListener("click", () => {
  charts.filter(({ isOverTime }) => isOverTime).forEach(({ chart }) => whole(chart));
});
