// The strips: what each surface, control and state does when, in rows over the time.
const ROW = 26;
const MODES = { held: "held", below: "below", above: "above", max: "max", min: "min", free: "free", moving: "above" };
const NAMES = { max: "at max", min: "at min", free: "" };

function readable(mode) {
  return mode === "free" || mode === "below" || mode === "held" ? "on-light" : "paper";
}

function drawRow(chart, strip, row) {
  const { ctx, bbox } = chart;
  const height = (ROW - 6) * uPlot.pxRatio;
  const top = chart.valToPos(row + 0.5, "y", true) - height / 2;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = `${12 * uPlot.pxRatio}px system-ui, sans-serif`;
  ctx.textBaseline = "middle";
  ctx.textAlign = "center";
  for (const span of strip.spans) {
    const [from, to] = [span.from, span.to].map((t) => chart.valToPos(t / page.time.si, "x", true));
    ctx.fillStyle = colour(MODES[span.mode] ?? "free");
    ctx.fillRect(from, top, Math.max(to - from - 1, 1), height);
    const [left, right] = [Math.max(from, bbox.left), Math.min(to, bbox.left + bbox.width)];
    const text = NAMES[span.mode] ?? span.mode;
    if (ctx.measureText(text).width + 8 * uPlot.pxRatio < right - left) {
      ctx.fillStyle = colour(readable(span.mode));
      ctx.fillText(text, (left + right) / 2, top + height / 2);
    }
  }
  ctx.restore();
}

const spansInWords = (strip) =>
  strip.spans
    .filter((span) => span.mode !== "free")
    .map((span) => `${span.mode} ${short(span.from / page.time.si)} to ${short(span.to / page.time.si)}`)
    .join(", ");

function drawStrips(strips, element) {
  const rows = strips.length;
  const height = rows * ROW + 60;
  const output = element.parentElement.querySelector("output");
  element.setAttribute("role", "img");
  const label = strips.map((strip) => `${strip.name}: ${spansInWords(strip)}`).join("; ");
  element.setAttribute("aria-label", `${label} ${page.time.unit}`);
  const longest = Math.max(...strips.map((strip) => strip.name.length));
  const tellModes = (chart) => {
    const left = chart.cursor.left;
    const time = left >= 0 ? chart.posToVal(left, "x") * page.time.si : NaN;
    const here = (strip) => strip.spans.find((span) => span.from <= time && time <= span.to);
    const told = strips.filter(here).map((strip) => `${strip.name} ${here(strip).mode}`);
    output.textContent = told.join(", ");
  };
  const chart = new uPlot(
    {
      width: element.clientWidth,
      height,
      legend: { show: false },
      cursor: { sync, y: false, drag: { x: true, y: false }, points: { show: false } },
      scales: { x: timeScale, y: { range: [0, rows], dir: -1 } },
      axes: [
        timeAxis(),
        axis({
          size: Math.min(Math.max(AXIS, 16 + 7.2 * longest), 180),
          splits: () => strips.map((_, row) => row + 0.5),
          values: () => strips.map((strip) => strip.name),
          filter: (_, splits) => splits,
          grid: { show: false },
          ticks: { show: false },
        }),
      ],
      series: [{}, { show: true, stroke: "transparent", points: { show: false } }],
      hooks: { draw: [(own) => strips.forEach((strip, row) => drawRow(own, strip, row))], setCursor: [tellModes] },
    },
    [page.range, [null, null]],
    element,
  );
  whole(chart);
  charts.push({ chart, element, isOverTime: true, height });
}
