// Marks of an axis, as lib/catena/drawing/figures/axis_ticks.hpp chooses them.

export interface Axis {
  first: number;
  last: number;
  log: boolean;
}

export interface Ticks {
  at: number[];
  labels: string[];
}

/** Place along the axis, 0 to 1; no number where a value has none. */
export function along(axis: Axis, value: number): number {
  if (!axis.log) return (value - axis.first) / (axis.last - axis.first);
  return value > 0 ? Math.log(value / axis.first) / Math.log(axis.last / axis.first) : NaN;
}

export function valueAt(axis: Axis, place: number): number {
  if (!axis.log) return axis.first + place * (axis.last - axis.first);
  return axis.first * Math.pow(axis.last / axis.first, place);
}

export function rangeOf(lists: ArrayLike<number>[], log: boolean): Axis {
  let low = Infinity;
  let high = -Infinity;
  for (const list of lists) {
    for (let k = 0; k < list.length; ++k) {
      const value = list[k];
      if (!isFinite(value) || (log && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(low <= high)) return { first: log ? 1 : 0, last: log ? 10 : 1, log };
  if (log) return low < high ? { first: low, last: high, log } : { first: low / 2, last: high * 2, log };
  // What differs by rounding is shown as the constant it is.
  const size = Math.max(Math.abs(low), Math.abs(high));
  const room = high - low <= 1e-7 * size ? (size > 0 ? 0.1 * size : 1) : 0.04 * (high - low);
  return { first: low - room, last: high + room, log };
}

function niceStep(least: number): number {
  const power = Math.pow(10, Math.floor(Math.log10(least)));
  for (const factor of [1, 2, 5]) if (factor * power >= least * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

export function ticksOf(axis: Axis, wanted: number): Ticks {
  const ticks: Ticks = { at: [], labels: [] };
  if (axis.log && axis.last / axis.first > 5) {
    const low = Math.ceil(Math.log10(axis.first) - 1e-9);
    const high = Math.floor(Math.log10(axis.last) + 1e-9);
    const every = Math.max(1, Math.ceil((high - low) / wanted));
    for (let power = low; power <= high; power += every) {
      ticks.at.push(Math.pow(10, power));
      ticks.labels.push(`1e${power}`);
    }
    return ticks;
  }
  const step = niceStep((axis.last - axis.first) / Math.max(1, wanted));
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const largest = Math.max(Math.abs(axis.first), Math.abs(axis.last));
  for (let k = Math.ceil(axis.first / step - 1e-9); k * step <= axis.last + 1e-9 * step; ++k) {
    const value = k * step;
    ticks.at.push(value);
    ticks.labels.push(largest >= 1e5 || largest < 1e-3 ? short(value) : value.toFixed(Math.min(decimals, 12)));
  }
  return ticks;
}

/** A number for people: five significant digits. */
export function short(value: number): string {
  if (value === null || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-4) return value.toExponential(3).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(5)));
}
