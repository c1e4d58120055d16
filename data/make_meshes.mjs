// Writes bunny.stl and beam.stl, as README.md describes them.
//
//   npm install bunny@1.0.1 && node make_meshes.mjs node_modules/bunny
import {writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {resolve} from 'node:path';

// Binary STL: an 80-byte title, the number of triangles, then 50 bytes a triangle: unit normal, three corners, zero.
function writeStl(file, title, positions, cells) {
  const bytes = Buffer.alloc(84 + 50 * cells.length);
  bytes.write(title, 0, 79, 'ascii');
  bytes.writeUInt32LE(cells.length, 80);
  cells.forEach((cell, index) => {
    const [a, b, c] = cell.map(i => positions[i].map(Math.fround));
    const u = b.map((v, i) => v - a[i]), w = c.map((v, i) => v - a[i]);
    const normal = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
    const length = Math.hypot(...normal) || 1;
    [...normal.map(v => v / length), ...a, ...b, ...c].forEach(
        (value, i) => bytes.writeFloatLE(value, 84 + 50 * index + 4 * i));
  });
  writeFileSync(new URL(file, import.meta.url), bytes);
}

function box(low, high) {
  const positions = [];
  for (let i = 0; i < 8; ++i) positions.push([0, 1, 2].map(axis => (i >> axis & 1 ? high : low)[axis]));
  const squares = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];  // outward
  return {positions, cells: squares.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]])};
}

const bunny = createRequire(import.meta.url)(resolve(process.argv[2]));
writeStl('bunny.stl', 'Stanford bunny, 3674 triangles, from the npm package bunny 1.0.1, public domain',
         bunny.positions, bunny.cells);
const beam = box([-6, 6.25, 4.25], [6, 7.25, 4.9]);
writeStl('beam.stl', 'beam beside the Stanford bunny, public domain', beam.positions, beam.cells);
