// The components of an array as colours over time and index.
const FINENESS = 2;

/// The colour of a part between 0 and 1.
function mapped(part) {
  const place = Math.min(Math.max(part, 0), 1) * (page.colours.length - 1);
  const at = Math.min(Math.floor(place), page.colours.length - 2);
  const mixed = page.colours[at].map((it, k) => Math.round(it + (page.colours[at + 1][k] - it) * (place - at)));
  return `rgb(${mixed.join(" ")})`;
}

/// Draws each row in its colours; where there is no value the paper shows.
function drawRows(chart, { first, range: [low, high] }, rows) {
  const { ctx, bbox } = chart;
  const right = bbox.left + bbox.width;
  ctx.save();
  rows.forEach((row, at) => {
    const [top, bottom] = [0.5, -0.5].map((half) => Math.round(chart.valToPos(first + at + half, "y", true)));
    for (let x = bbox.left; x < right; x += FINENESS) {
      const value = valueAt(row, chart.posToVal(x + FINENESS / 2, "x", true));
      if (value === undefined) continue;
      ctx.fillStyle = mapped(high > low ? (value - low) / (high - low) : 0.5);
      ctx.fillRect(x, top, Math.min(FINENESS, right - x), bottom - top);
    }
  });
  ctx.restore();
}

/// The value at the cursor; where it is over another plot, the lowest and the highest then.
function tellRow(chart, array, rows, output) {
  const { left, top } = chart.cursor;
  if (left === undefined || left === null || left < 0) {
    output.textContent = "";
    return;
  }
  const time = chart.posToVal(left, "x");
  document.getElementById("at").textContent = `${page.time.name} = ${short(time)} ${page.time.unit}`;
  const row = Math.round(chart.posToVal(top, "y")) - array.first;
  if (chart.over.matches(":hover") && rows[row]) {
    output.textContent = `${page.figures[array.figures[row]].name} = ${short(valueAt(rows[row], time))} ${array.unit.name}`;
    return;
  }
  const values = rows.map((it) => valueAt(it, time)).filter((it) => it !== undefined);
  const [low, high] = [Math.min(...values), Math.max(...values)].map((it) => short(it));
  output.textContent = values.length ? `${low} to ${high} ${array.unit.name}` : "";
}

function map(element) {
  const array = page.arrays[element.dataset.map];
  const isOwn = (curve) => curve.of === array.of && curve.kind !== "replay" && !isMeasured(curve);
  const rows = array.figures.map((at) => {
    const [own, ...others] = page.figures[at].curves.filter(isOwn);
    const all = [own, ...others].filter((it) => it).flatMap((curve) => pieces(curve, array.unit));
    return { kind: own?.kind, pieces: all };
  });
  const last = array.first + rows.length - 1;
  const height = Math.min(Math.max(6 * rows.length, 200), 420);
  const output = element.parentElement.querySelector("output");
  const [low, high] = array.range.map((it) => short(it));
  element.setAttribute("role", "img");
  element.setAttribute(
    "aria-label",
    `${array.name} over ${page.time.name} and index ${array.first} to ${last}: between ${low} and ${high} ${array.unit.name}`,
  );
  const chart = new uPlot(
    {
      width: element.clientWidth,
      height,
      legend: { show: false },
      cursor: { sync, drag: { x: true, y: false }, points: { show: false } },
      scales: { x: timeScale, y: { range: [array.first - 0.5, last + 0.5] } },
      axes: [timeAxis(), axis({ size: AXIS - 18, label: "index", labelSize: 18, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500] })],
      series: [{}, { show: true, stroke: "transparent", points: { show: false } }],
      hooks: {
        draw: [(own) => drawRows(own, array, rows), (own) => annotate(own, { limits: [], unit: array.unit })],
        setCursor: [(own) => tellRow(own, array, rows, output)],
      },
    },
    [page.range, [null, null]],
    element,
  );
  whole(chart);
  charts.push({ chart, element, isOverTime: true, height });
}

/// The plots of single components, when somebody wants to see them.
function unfold(details) {
  if (!details.open) return;
  details.querySelectorAll("[data-later]").forEach((element) => {
    const { later } = element.dataset;
    element.removeAttribute("data-later");
    element.className = "plot";
    plot(page.figures[later], element);
  });
}
