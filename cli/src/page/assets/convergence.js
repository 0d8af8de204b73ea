// How a solve went: errors and widths over the iterations, on a logarithmic axis.
const SMALLEST = 1e-16;

function ofIterations(all) {
  const last = all.objective[all.objective.length - 1];
  return [
    { label: "objective, distance to the last", values: all.objective.map((it) => Math.abs(it - last)) },
    { label: "constraint violation", values: all.constraint_violation },
    { label: "dual infeasibility", values: all.dual_infeasibility },
    { label: "width of smoothing", values: all.sigma, isStepped: true },
  ].filter(({ values }) => values.some((it) => it > SMALLEST));
}

/// Where the grid becomes finer.
function drawGrids(chart, all) {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
  ctx.fillStyle = colour("muted");
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  // Above the curves, from the last grid on, as far as there is room for their names.
  let room = bbox.left + bbox.width + 24 * uPlot.pxRatio;
  const first = all.N.map((_, k) => k).filter((k) => all.N[k] !== all.N[k - 1]);
  for (const k of first.reverse()) {
    const place = chart.valToPos(k, "x", true);
    line(chart, [place, bbox.top, place, bbox.top + bbox.height], colour("muted"), 1, [2, 3]);
    const text = `N ${all.N[k]}`;
    const { width } = ctx.measureText(text);
    const left = Math.min(place, room - width);
    if (place - left > width / 2) continue;
    ctx.fillText(text, left, bbox.top - 5 * uPlot.pxRatio);
    room = left - 8 * uPlot.pxRatio;
  }
  ctx.restore();
}

function decades(curves) {
  const values = curves.flatMap(({ values }) => values.filter((it) => it > SMALLEST));
  const [low, high] = [Math.min(...values), Math.max(...values)].map(Math.log10);
  return [10 ** Math.floor(low), 10 ** Math.max(Math.ceil(high), Math.floor(low) + 1)];
}

/// Some powers of ten, not too many.
function powers([low, high]) {
  const [first, last] = [low, high].map((it) => Math.round(Math.log10(it)));
  const step = Math.ceil((last - first) / 8);
  return Array.from({ length: Math.floor((last - first) / step) + 1 }, (_, k) => 10 ** (first + k * step));
}

function drawConvergence(element) {
  const all = solutions[element.dataset.convergence].convergence;
  const curves = ofIterations(all);
  if (!curves.length) return;
  const figure = element.parentElement;
  figure.querySelector(".legend").replaceChildren(
    ...curves.map(({ label }, at) => {
      const key = document.createElement("span");
      key.className = `key key-${at}`;
      key.textContent = label;
      return key;
    }),
  );
  const output = figure.querySelector("output");
  const tellHere = (chart) => {
    const k = chart.cursor.idx;
    const values = curves.map(({ values }) => short(values[k], 3)).join(" | ");
    output.textContent = k === null || k === undefined ? "" : `${k}: ${values}`;
  };
  const range = decades(curves);
  element.setAttribute("role", "img");
  element.setAttribute("aria-label", `errors over ${all.iteration.length} iterations`);
  const height = 260;
  const chart = new uPlot(
    {
      width: element.clientWidth,
      height,
      padding: [20, 24, 0, 0],
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false }, y: { distr: 3, range: () => range } },
      axes: [
        axis({ label: "iteration", labelSize: 18, size: 24, gap: 3 }),
        axis({
          size: AXIS,
          splits: () => powers(range),
          filter: (_, splits) => splits,
          values: (_, values) => values.map((it) => it.toExponential(0).replace("e+", "e")),
        }),
      ],
      series: [
        {},
        ...curves.map(({ isStepped }, at) => ({
          stroke: () => colour(`curve-${at}`),
          width: 1.5,
          points: { show: false },
          paths: isStepped ? uPlot.paths.stepped({ align: 1 }) : uPlot.paths.linear(),
        })),
      ],
      hooks: { draw: [(own) => drawGrids(own, all)], setCursor: [tellHere] },
    },
    [
      all.iteration.map((_, k) => k),
      ...curves.map(({ values }) => values.map((it) => (it > SMALLEST ? it : null))),
    ],
    element,
  );
  charts.push({ chart, element, isOverTime: false, height });
}
