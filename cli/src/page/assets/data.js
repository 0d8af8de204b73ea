// The numbers of the page: columns of the embedded documents, in the units in which they are shown.
"use strict";

const read = (id) => JSON.parse(document.getElementById(id).textContent);
const page = read("page");
const solutions = page.names.map((_, at) => read(`solution-${at}`));

/// What stands under some keys of a document.
const at = (of, keys) => keys.reduce((object, key) => object?.[key], solutions[of]);

/// The values of a state or a costate just before jumps and switches, by the grid point that has
/// the values after them.
function valuesBefore(curve, time) {
  const [group, name] = curve.values.slice(-2);
  // That of a phase stands under its name.
  const solution = at(curve.of, curve.values.slice(0, -2)) ?? {};
  const all = {
    states: () => (solution.jumps ?? []).map((it) => ({ time: it.time, value: it.before[name] })),
    costates: () => (solution.costates_before ?? []).map((it) => ({ time: it.time, value: it.values[name] })),
  };
  const before = new Map();
  for (const jump of all[group]?.() ?? []) {
    const distance = (k) => Math.abs(time[k] - jump.time);
    const nearest = time.reduce((best, _, k) => (distance(k) < distance(best) ? k : best), 0);
    before.set(nearest, jump.value);
  }
  return before;
}

/// Whether a polynomial control may jump between two of its times.
function jumpsBetween(curve, a, b) {
  const { phases, certificate } = solutions[curve.of];
  const jumps = [solutions[curve.of], ...Object.values(phases ?? {})].flatMap((it) => it.jumps ?? []);
  const events = [...jumps, ...(certificate?.switches ?? [])];
  return curve.values.includes("control_nodes") && events.some(({ time }) => a < time && time < b);
}

/// Points between those of a grid that a certified solution goes through.
function pointsBetween(curve) {
  const [times, values] = (curve.between ?? []).map((keys) => at(curve.of, keys) ?? []);
  const room = times ? 1e-6 * (times[times.length - 1] - times[0]) : 0;
  let next = 0;
  return (from, to, add) => {
    while (times && times[next] <= from + room) next += 1;
    for (; times && times[next] < to - room; next += 1) add(times[next], values[next]);
  };
}

/// The pieces of a curve between jumps and gaps: lists of times and of values.
function pieces(curve, unit) {
  const time = at(curve.of, curve.time) ?? [];
  const values = at(curve.of, curve.values) ?? [];
  const before = valuesBefore(curve, time);
  const all = [];
  let piece = { x: [], y: [] };
  const end = () => {
    if (piece.x.length) all.push(piece);
    piece = { x: [], y: [] };
  };
  const add = (t, value) => {
    piece.x.push(t / page.time.si);
    piece.y.push(value / unit.si);
  };
  const fill = pointsBetween(curve);
  time.forEach((t, k) => {
    if (k > 0) fill(time[k - 1], t, add);
    const value = curve.kind === "steps" ? values[Math.min(k, values.length - 1)] : values[k];
    if (before.has(k)) {
      add(t, before.get(k));
      end();
    }
    if (curve.ends_in_jump && k > 1 && k === time.length - 1) {
      // It goes on as before up to the jump.
      const slope = (values[k - 1] - values[k - 2]) / (time[k - 1] - time[k - 2]);
      add(t, values[k - 1] + slope * (t - time[k - 1]));
      end();
    }
    if (t === time[k - 1] || jumpsBetween(curve, time[k - 1], t)) end();
    if (value === null || value === undefined) end();
    else add(t, value);
  });
  end();
  return all;
}

const isMeasured = (curve) => curve.kind === "points" || curve.kind === "stems";

/// The measurements of a curve as one piece, with the ends of their error bars; rows in which
/// nothing was measured have none.
function measurements(curve, unit) {
  const [time, values] = [curve.time, curve.values].map((keys) => at(curve.of, keys) ?? []);
  const [keys, size] = curve.bars ?? [];
  const half = keys && at(curve.of, keys);
  const known = values.map((_, k) => k).filter((k) => Number.isFinite(values[k]));
  const ends = (k) => [-1, 1].map((side) => (values[k] + side * half[k] * size) / unit.si);
  return {
    x: known.map((k) => time[k] / page.time.si),
    y: known.map((k) => values[k] / unit.si),
    bars: half ? known.map(ends) : undefined,
  };
}

/// The value that is measured nearest to a time.
function nearest({ pieces: [{ x, y }] }, time) {
  const distance = (k) => Math.abs(x[k] - time);
  return y[x.reduce((best, _, k) => (distance(k) < distance(best) ? k : best), 0)];
}

/// The value of a curve at a time, or nothing outside of it.
function valueAt(curve, time) {
  if (isMeasured(curve)) return nearest(curve, time);
  for (const { x, y } of curve.pieces) {
    const last = x.length - 1;
    if (time < x[0] || time > x[last]) continue;
    let [low, high] = [0, last];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (x[middle] <= time) low = middle;
      else high = middle;
    }
    if (curve.kind === "steps" || high === low) return y[low];
    return y[low] + ((y[high] - y[low]) * (time - x[low])) / (x[high] - x[low]);
  }
  return undefined;
}

/// A number for people.
function short(value, digits = 5) {
  if (value === undefined || !Number.isFinite(value)) return "–";
  const text = Number(value.toPrecision(digits)).toString();
  return text.replace("-", "−");
}

/// Ticks with as many digits as tell them apart.
function ticks(_, values) {
  const [first, last] = [values[0], values[values.length - 1]].map(Math.abs);
  const lost = Math.ceil(Math.log10(Math.max(first, last) / Math.abs(values[values.length - 1] - values[0])));
  return values.map((value) => short(value, Number.isFinite(lost) ? Math.min(Math.max(lost + 3, 5), 12) : 5));
}

/// Where a plot begins and ends: flat where the values differ by nothing but rounding, which
/// `sizes.rs` explains.
function rangeOf(values, limits, rounding) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return { low: -1, high: 1, isFlat: true, middle: NaN };
  const size = Math.max(Math.abs(low), Math.abs(high));
  const isNothing = size <= Math.max(rounding, 1e-50);
  const isFlat = high - low <= Math.max(rounding, 2e-6 * size) || isNothing;
  const middle = isNothing ? 0 : (low + high) / 2;
  if (isFlat) {
    const room = middle === 0 ? 1 : Math.abs(middle) / 2;
    [low, high] = [middle - room, middle + room];
  }
  for (const limit of limits) {
    const width = high - low;
    if (limit >= low - 0.7 * width && limit <= high + 0.7 * width) {
      low = Math.min(low, limit);
      high = Math.max(high, limit);
    }
  }
  const margin = 0.06 * (high - low);
  return { low: low - margin, high: high + margin, isFlat, middle };
}
