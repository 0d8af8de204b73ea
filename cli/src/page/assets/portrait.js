// A phase portrait: one signal over another, chosen by the reader or by the model.
function choices() {
  const all = page.figures.filter((figure) => ["States", "Reported"].includes(figure.group));
  return all.filter((figure) => figure.curves.some((curve) => curve.kind === "line"));
}

/// The ranges of a plot in which one unit is as long on both axes.
function toScale(x, y, width, height) {
  const perPixel = Math.max((x.high - x.low) / width, (y.high - y.low) / height);
  const around = (range, pixels) => {
    const middle = (range.low + range.high) / 2;
    return { low: middle - (perPixel * pixels) / 2, high: middle + (perPixel * pixels) / 2 };
  };
  return [around(x, width), around(y, height)];
}

/// The points of two figures at the same times, a list for each piece of each curve.
function paired(over, of) {
  return over.curves.filter((curve) => !isMeasured(curve)).flatMap((curve) => {
    // Of several phases each has curves of its own.
    const place = (it) => it.values.slice(0, -2).join();
    const isSame = (it) => it.of === curve.of && it.kind === curve.kind && place(it) === place(curve);
    const other = of.curves.find(isSame);
    if (!other) return [];
    const [xs, ys] = [pieces(curve, over.unit), pieces(other, of.unit)];
    const isAligned = xs.length === ys.length && xs.every(({ x }, k) => x.length === ys[k].x.length);
    const at = (time) => valueAt({ ...other, pieces: ys }, time) ?? null;
    return xs.map((piece, k) => ({ x: piece.y, y: isAligned ? ys[k].y : piece.x.map(at), curve }));
  });
}

function drawPath(chart, index) {
  const [xs, ys] = chart.data[index];
  const path = new Path2D();
  xs.forEach((x, k) => {
    const place = [chart.valToPos(x, "x", true), chart.valToPos(ys[k], "y", true)];
    if (k === 0) path.moveTo(...place);
    else path.lineTo(...place);
  });
  return { stroke: path, fill: null, clip: null };
}

/// A dot where a path begins and a ring where it ends.
function drawEnds(chart, paths) {
  const { ctx } = chart;
  paths.forEach(({ x, y, curve }, at) => {
    const dot = (k, isFull) => {
      ctx.save();
      ctx.beginPath();
      ctx.arc(chart.valToPos(x[k], "x", true), chart.valToPos(y[k], "y", true), 4.5 * uPlot.pxRatio, 0, 7);
      ctx.setLineDash([]);
      ctx.lineWidth = 2 * uPlot.pxRatio;
      ctx.strokeStyle = seriesOf({ ...curve, pieces: [0] })[0].stroke();
      ctx.fillStyle = isFull ? ctx.strokeStyle : colour("paper");
      ctx.fill();
      ctx.stroke();
      ctx.restore();
    };
    // Phases are one after the other; a replay begins where the plan does.
    const isSame = (it) => it && ["of", "kind", "hue"].every((key) => it.curve[key] === curve[key]);
    const own = paths.filter(isSame);
    if (curve.kind !== "replay" && own[0] === paths[at]) dot(0, true);
    if (own[own.length - 1] === paths[at]) dot(x.length - 1, false);
  });
}

/// A range with room for borders beside a path.
function widened({ low, high }) {
  const room = 0.1 * (high - low);
  return { low: low - room, high: high + room };
}

/// The pieces of the borders of path conditions, in the units of the axes.
function drawBorders(chart, segments) {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.beginPath();
  for (const [from, to] of segments) {
    ctx.moveTo(chart.valToPos(from[0], "x", true), chart.valToPos(from[1], "y", true));
    ctx.lineTo(chart.valToPos(to[0], "x", true), chart.valToPos(to[1], "y", true));
  }
  ctx.strokeStyle = colour("limit");
  ctx.lineWidth = 1.5 * uPlot.pxRatio;
  ctx.setLineDash([]);
  ctx.stroke();
  ctx.restore();
}

/// Where the motion is at a time, as a dot on each path.
function drawNow(chart, over, of, time) {
  const { ctx } = chart;
  for (const figure of of) {
    for (const curve of figure.curves.filter((it) => it.kind !== "replay" && !isMeasured(it))) {
      const other = over.curves.find((it) => it.of === curve.of && it.kind !== "replay");
      const [x, y] = [[other, over], [curve, figure]].map(([it, { unit }]) =>
        valueAt({ ...it, pieces: pieces(it, unit) }, time),
      );
      if (x === undefined || y === undefined) continue;
      ctx.beginPath();
      ctx.arc(chart.valToPos(x, "x", true), chart.valToPos(y, "y", true), 6 * uPlot.pxRatio, 0, 7);
      ctx.fillStyle = colour("held");
      ctx.fill();
    }
  }
}

/// Draws signals over another one. `more` may have pieces of borders, and a clock whose time is
/// shown as a dot.
function drawPortrait(element, over, of, isToScale, more = {}) {
  const hued = (path, hue) => ({ ...path, curve: of.length > 1 ? { ...path.curve, hue } : path.curve });
  const paths = of.flatMap((figure, hue) => paired(over, figure).map((path) => hued(path, hue)));
  const height = Math.round(Math.min(Math.max(element.clientWidth * 0.55, 260), 560));
  const rounding = { x: over.rounding / over.unit.si, y: of[0].rounding / of[0].unit.si };
  let [x, y] = ["x", "y"].map((key) => rangeOf(paths.flatMap((path) => path[key]), [], rounding[key]));
  if (more.borders?.length) [x, y] = [x, y].map(widened);
  if (isToScale) [x, y] = toScale(x, y, element.clientWidth - AXIS, height - 40);
  element.replaceChildren();
  element.setAttribute("role", "img");
  element.setAttribute("aria-label", `${of.map((it) => it.name).join(", ")} over ${over.name}`);
  const titled = (figure) => figure.name + (figure.unit.name ? ` [${figure.unit.name}]` : "");
  const chart = new uPlot(
    {
      mode: 2,
      width: element.clientWidth,
      height,
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, auto: false, range: () => [x.low, x.high] },
        y: { auto: false, range: () => [y.low, y.high] },
      },
      axes: [
        axis({ label: titled(over), labelSize: 18, size: 40, gap: 3, values: ticks }),
        axis({ label: of.map(titled).join(", "), labelSize: 18, size: AXIS - 12, values: ticks }),
      ],
      series: [
        {},
        ...paths.map(({ curve }) => ({ ...seriesOf({ ...curve, pieces: [0] })[0], paths: drawPath })),
      ],
      hooks: {
        draw: [
          (own) => drawBorders(own, more.borders ?? []),
          (own) => drawEnds(own, paths),
          (own) => more.clock?.isRunning && drawNow(own, over, of, more.clock.time),
        ],
      },
    },
    [null, ...paths.map((path) => [path.x, path.y])],
    element,
  );
  return { chart, element, height };
}

/// Two lists to choose from, and the portrait of what is chosen.
function portrait(element) {
  const figures = choices();
  const [over, of, isToScale] = ["over", "of", "to-scale"].map((id) => document.getElementById(id));
  const titled = (figure) => {
    const isAlone = figures.filter((it) => it.name === figure.name).length === 1;
    return isAlone ? figure.name : `${figure.name} [${figure.unit.name || "1"}]`;
  };
  const fill = (list, all) =>
    list.replaceChildren(...all.map((figure) => new Option(titled(figure), figures.indexOf(figure))));
  const partners = (figure) => figures.filter((it) => it !== figure && paired(figure, it).length);
  const overs = figures.filter((figure) => partners(figure).length);
  fill(over, overs);
  const first = overs.find((figure) => figure.name.endsWith(".x"));
  over.value = figures.indexOf(first ?? overs[0]);
  isToScale.checked = first !== undefined;
  // Two solutions may have a signal each that the other has not.
  const offer = () => {
    const [all, before] = [partners(figures[over.value]), of.value];
    fill(of, all);
    const next = all.find((figure) => figures.indexOf(figure) > over.value) ?? all[0];
    const isThere = all.includes(figures[before]);
    of.value = isThere ? before : figures.indexOf(next);
  };
  offer();
  over.addEventListener("change", offer);
  let own;
  const draw = () => {
    if (own) {
      own.chart.destroy();
      charts.splice(charts.indexOf(own), 1);
    }
    own = drawPortrait(element, figures[over.value], [figures[of.value]], isToScale.checked);
    charts.push(own);
  };
  [over, of, isToScale].forEach((input) => input.addEventListener("change", draw));
  draw();
}

const SECONDS = 6;

/// Runs a clock through the whole time, and draws at each of its times.
function play(clock, draw) {
  const [first, last] = page.range;
  const begin = performance.now();
  const step = (now) => {
    const passed = Math.min((now - begin) / 1000 / SECONDS, 1);
    clock.isRunning = passed < 1;
    clock.time = first + passed * (last - first);
    document.getElementById("at").textContent = `${page.time.name} = ${short(clock.time)} ${page.time.unit}`;
    draw();
    if (clock.isRunning) requestAnimationFrame(step);
  };
  if (!clock.isRunning) requestAnimationFrame(step);
}

/// A picture that the model asks for.
function asked(element) {
  const { over, of, borders, is_to_scale } = page.portraits[element.dataset.asked];
  const [x, ys] = [page.figures[over], of.map((it) => page.figures[it])];
  const inUnits = (point) => [point[0] / x.unit.si, point[1] / ys[0].unit.si];
  const all = borders.flatMap(([document, keys]) => at(document, keys) ?? []);
  const clock = { isRunning: false };
  const own = drawPortrait(element, x, ys, is_to_scale, {
    clock,
    borders: all.map((segment) => segment.map(inUnits)),
  });
  charts.push(own);
  const caption = element.parentElement.querySelector("figcaption");
  if (ys.length > 1) {
    caption.querySelector(".legend").innerHTML = ys
      .map((_, hue) => `<span class="key key-${hue % 8}"></span>`)
      .join("");
    caption.querySelectorAll(".key").forEach((key, hue) => (key.textContent = ys[hue].name));
  }
  const draw = () => own.chart.redraw(false, false);
  caption.querySelector(".play").addEventListener("click", () => play(clock, draw));
}
