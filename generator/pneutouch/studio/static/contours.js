// Lines of one level on a grid of values, by marching squares, and round levels and ticks. Nothing is drawn here.

/** Multiples of a round step between two ends, at most `most` of them. */
export function rounds(low, high, most) {
  const power = 10 ** Math.floor(Math.log10((high - low) / most));
  const step = [1, 2, 2.5, 5, 10, 20].map((each) => each * power).find((each) => (high - low) / each <= most);
  const all = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) all.push(Number((k * step).toPrecision(9)));
  return all;
}

/** True where values are better told apart by their ratios. */
export const spansRatios = (low, high) => low > 0 && high > 7 * low;

/** A few round levels between the least and the greatest value. */
export function levels(low, high) {
  if (!(high - low > 1e-3 * Math.abs(high))) return [];
  if (!spansRatios(low, high)) return rounds(low, high, 10);
  const all = (ratios) => {
    const found = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
      found.push(...ratios.map((ratio) => Number((ratio * 10 ** power).toPrecision(3))));
    }
    return found.filter((value) => value >= low && value <= high);
  };
  const fine = all([1, 1.5, 2, 3, 5, 7]);
  return fine.length <= 9 ? fine : all([1, 2, 5]);
}

/** Edges of the square at (i, j), in turn around it: their names, and the corners that they join. */
const edges = (i, j) => [
  [`h${i},${j}`, i, j, i + 1, j],
  [`v${i + 1},${j}`, i + 1, j, i + 1, j + 1],
  [`h${i},${j + 1}`, i, j + 1, i + 1, j + 1],
  [`v${i},${j}`, i, j, i, j + 1],
];

/** Where a level crosses the edges of the squares whose corners all have a value, and which crossings a line joins. */
function crossings(values, level) {
  const [places, joined] = [new Map(), new Map()];
  const join = (one, other) => {
    for (const [from, to] of [[one, other], [other, one]]) joined.set(from, [...(joined.get(from) ?? []), to]);
  };
  for (let i = 0; i + 1 < values.length; i += 1) {
    for (let j = 0; j + 1 < values[i].length; j += 1) {
      const corners = [values[i][j], values[i + 1][j], values[i + 1][j + 1], values[i][j + 1]];
      if (corners.includes(null)) continue;
      const crossed = edges(i, j).filter(([, a, b, c, d]) => values[a][b] < level !== values[c][d] < level);
      for (const [name, a, b, c, d] of crossed) {
        const share = (level - values[a][b]) / (values[c][d] - values[a][b]);
        places.set(name, [a + share * (c - a), b + share * (d - b)]);
      }
      const names = crossed.map(([name]) => name);
      // At a saddle the value in the middle tells which corners the lines cut off.
      const middle = corners.reduce((sum, each) => sum + each) / 4;
      if (names.length === 4 && middle < level !== corners[0] < level) names.push(names.shift());
      for (let k = 0; k < names.length; k += 2) join(names[k], names[k + 1]);
    }
  }
  return [places, joined];
}

/** The lines of a level through values (n, m), null where there is none: lists of places in steps of the grid. */
export function contours(values, level) {
  const [places, joined] = crossings(values, level);
  const [lines, seen] = [[], new Set()];
  const follow = (start) => {
    const line = [];
    for (let name = start; name !== undefined; name = joined.get(name).find((each) => !seen.has(each))) {
      seen.add(name);
      line.push(places.get(name));
    }
    // A line that ends where it began is closed.
    if (line.length > 2 && joined.get(start).length === 2) line.push(line[0]);
    lines.push(line);
  };
  const open = [...joined.keys()].filter((name) => joined.get(name).length === 1);
  for (const name of [...open, ...joined.keys()]) if (!seen.has(name)) follow(name);
  return lines;
}
