// A plot over time: curves, limits, spans in which a surface is held, jumps; one cursor for all.
const charts = [];
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const FONT = '12px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif';
const AXIS = 66;

function axis(more) {
  return {
    stroke: () => colour("muted"),
    font: FONT,
    labelFont: FONT,
    grid: { stroke: () => colour("line"), width: 1 },
    ticks: { stroke: () => colour("line"), width: 1, size: 4 },
    ...more,
  };
}

const timeAxis = (size = 24) =>
  axis({ label: page.time.label, labelSize: 18, size, gap: 3, values: ticks });

/// Colours the times in which a surface is held.
function shade(chart) {
  if (solutions.length > 1) return;
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = colour("held");
  for (const strip of page.strips[0].filter((strip) => strip.of === "surface")) {
    for (const span of strip.spans.filter((span) => span.mode === "held")) {
      const [from, to] = [span.from, span.to].map((t) => chart.valToPos(t / page.time.si, "x", true));
      ctx.globalAlpha = 0.13;
      ctx.fillRect(from, bbox.top, to - from, bbox.height);
    }
  }
  ctx.restore();
}

function line(chart, [x0, y0, x1, y1], style, width, dash = []) {
  const { ctx } = chart;
  ctx.save();
  ctx.strokeStyle = style;
  ctx.lineWidth = width * uPlot.pxRatio;
  ctx.setLineDash(dash.map((it) => it * uPlot.pxRatio));
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.stroke();
  ctx.restore();
}

/// When a signal of the only solution is at its limits.
const activeIn = (figure) =>
  solutions.length > 1 ? [] : page.strips[0].filter((strip) => strip.name === figure.name);

/// The limits of a plot, thick where the plan is at them, and the jumps.
function annotate(chart, figure) {
  const { bbox } = chart;
  const right = bbox.left + bbox.width;
  const inside = (x) => Math.min(Math.max(x, bbox.left), right);
  const y = (value) => chart.valToPos(value / figure.unit.si, "y", true);
  const place = (time) => inside(chart.valToPos(time / page.time.si, "x", true));
  const x = (time) => (Number.isFinite(time) ? place(time) : time < 0 ? bbox.left : right);
  for (const limit of figure.limits) {
    const height = y(limit.value);
    if (height < bbox.top - 1 || height > bbox.top + bbox.height + 1) continue;
    // That of a phase holds in it only.
    const [first, last] = [limit.from ?? -Infinity, limit.to ?? Infinity];
    line(chart, [x(first), height, x(last), height], colour("limit"), 1, [5, 4]);
    const isOwn = (span) => span.mode === limit.label && span.from < last && span.to > first;
    for (const span of activeIn(figure).flatMap((strip) => strip.spans.filter(isOwn))) {
      const ends = [Math.max(span.from, first), Math.min(span.to, last)].map(x);
      line(chart, [ends[0], height, ends[1], height], colour("limit"), 4);
    }
  }
  for (const mark of page.marks) {
    const place = chart.valToPos(mark.time / page.time.si, "x", true);
    if (place < bbox.left || place > right) continue;
    line(chart, [place, bbox.top, place, bbox.top + bbox.height], colour("muted"), 1, [2, 3]);
  }
}

/// The error bars of measurements, and lines from 0 to what remains of them.
function drawBars(chart, curves) {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  const vertical = (x, from, to, style) => {
    const [a, b] = [from, to].map((it) => chart.valToPos(it, "y", true));
    const place = chart.valToPos(x, "x", true);
    line(chart, [place, a, place, b], style, 1);
  };
  for (const curve of curves.filter(isMeasured)) {
    const style = inkOf(curve);
    const [{ x, y, bars }] = curve.pieces;
    if (curve.kind === "stems") {
      const zero = chart.valToPos(0, "y", true);
      line(chart, [bbox.left, zero, bbox.left + bbox.width, zero], colour("muted"), 1);
      x.forEach((it, k) => vertical(it, 0, y[k], style));
    }
    bars?.forEach(([low, high], k) => vertical(x[k], low, high, style));
  }
  ctx.restore();
}

/// The values at the cursor, in the caption of each plot and above all of them.
function tell(chart, curves, output, unit) {
  const left = chart.cursor.left;
  if (left === undefined || left === null || left < 0) {
    output.textContent = "";
    return;
  }
  const time = chart.posToVal(left, "x");
  document.getElementById("at").textContent = `${page.time.name} = ${short(time)} ${page.time.unit}`;
  const told = curves.map((curve) => valueAt(curve, time)).filter((it) => it !== undefined);
  output.textContent = told.map((value) => short(value)).join(" | ") + (told.length ? ` ${unit}` : "");
}

/// What a plot shows, for who cannot see it.
function inWords(figure, curves, range) {
  const lines = curves.filter((curve) => curve.kind !== "points");
  const values = lines.flatMap((curve) => curve.pieces.flatMap((piece) => piece.y));
  const name = `${figure.name} over ${page.time.name}`;
  if (!values.length) return `${name}: no values`;
  if (range.isFlat) return `${name}: constant, ${short(range.middle)} ${figure.unit.name}`;
  const low = values.reduce((a, b) => Math.min(a, b));
  const high = values.reduce((a, b) => Math.max(a, b));
  const [first, last] = [values[0], values[values.length - 1]].map((it) => short(it));
  return `${name}: from ${first} to ${last}, between ${short(low)} and ${short(high)} ${figure.unit.name}`;
}

const STYLES = {
  line: () => uPlot.paths.linear(),
  steps: () => uPlot.paths.stepped({ align: 1 }),
  replay: () => uPlot.paths.linear(),
};

/// Measurements are dark, or have the colour of their document where there are several.
const inkOf = (curve) => colour(solutions.length > 1 ? `curve-${curve.of}` : "ink");

function seriesOf(curve) {
  if (isMeasured(curve)) {
    const [stroke, fill] = [0, 1].map(() => () => inkOf(curve));
    return [{ stroke, width: 0, paths: () => null, points: { show: true, size: 5, width: 0, fill, stroke } }];
  }
  const isReplay = curve.kind === "replay";
  const own = { width: isReplay ? 1.5 : 2, points: { show: false }, paths: STYLES[curve.kind]() };
  const hue = curve.hue === undefined ? curve.of : curve.hue % 8;
  own.stroke = () => colour(`curve-${isReplay && solutions.length === 1 ? 1 : hue}`);
  if (isReplay) own.dash = [6, 4];
  return curve.pieces.map(() => own);
}

const timeScale = { time: false, range: (_, min, max) => [min, max] };
/// Shows the whole time.
const whole = (chart) => chart.setScale("x", { min: page.range[0], max: page.range[1] });

const sync = { key: "time", scales: ["x", null] };

/// Draws a figure into its element.
function plot(figure, element) {
  const read = (curve) => (isMeasured(curve) ? [measurements(curve, figure.unit)] : pieces(curve, figure.unit));
  const curves = figure.curves.map((curve) => ({ ...curve, pieces: read(curve) }));
  const tables = curves.flatMap((curve) => curve.pieces.map((piece) => [piece.x, piece.y]));
  if (!tables.length) return;
  const output = element.parentElement.querySelector("output");
  const bars = curves.flatMap((curve) => curve.pieces.flatMap((piece) => (piece.bars ?? []).flat()));
  const zero = curves.some((curve) => curve.kind === "stems") ? [0] : [];
  const values = tables.flatMap((table) => table[1]).concat(bars, zero);
  const limits = figure.limits.map((limit) => limit.value / figure.unit.si);
  const range = rangeOf(values, limits, figure.rounding / figure.unit.si);
  element.setAttribute("role", "img");
  element.setAttribute("aria-label", inWords(figure, curves, range));
  const chart = new uPlot(
    {
      width: element.clientWidth,
      height: 210,
      legend: { show: false },
      cursor: { sync, y: false, drag: { x: true, y: false } },
      scales: { x: timeScale, y: { range: () => [range.low, range.high] } },
      axes: [timeAxis(), axis({ size: AXIS, values: ticks })],
      series: [{}, ...curves.flatMap(seriesOf)],
      hooks: {
        drawClear: [shade],
        draw: [(own) => annotate(own, figure), (own) => drawBars(own, curves)],
        setCursor: [(own) => tell(own, curves, output, figure.unit.name)],
      },
    },
    uPlot.join(tables),
    element,
  );
  whole(chart);
  charts.push({ chart, element, isOverTime: true, height: 210 });
}
