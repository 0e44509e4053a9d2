// Numbers in half precision, and mip levels of them where the graphics card makes none.

export function fromHalf(bits: number): number {
  const exponent = (bits >> 10) & 31;
  const part = bits & 1023;
  let size: number;
  if (exponent === 0) size = part * 2 ** -24;
  else if (exponent === 31) size = part ? NaN : Infinity;
  else size = (1024 + part) * 2 ** (exponent - 25);
  return bits & 32768 ? -size : size;
}

/** Numbers by the bits of their half precision. */
export const HALVES = Float32Array.from({ length: 1 << 16 }, (_, bits) => fromHalf(bits));

const SINGLE = new Float32Array(1);
const BITS = new Uint32Array(SINGLE.buffer);

export function toHalf(x: number): number {
  SINGLE[0] = x;
  const sign = (BITS[0] >>> 16) & 32768;
  const size = BITS[0] & 0x7fffffff;
  if (size >= 0x477ff000) return sign | (size > 0x7f800000 ? 32256 : 31744);
  if (size < 0x38800000) return sign | Math.round(Math.abs(x) * 2 ** 24);
  // A part that rounds up carries into the exponent by itself.
  return sign | ((size - 0x37fff000) >>> 13);
}

/** The next mip level of an image in half precision, filtered linearly, its width and height. */
export function halved(
  texels: Uint16Array,
  width: number,
  height: number,
  channels: number,
): [Uint16Array, number, number] {
  const [w, h] = [Math.max(width >> 1, 1), Math.max(height >> 1, 1)];
  const result = new Uint16Array(w * h * channels);
  const between = (n: number, few: number, many: number): [number, number, number] => {
    const x = (n + 0.5) * (many / few) - 0.5;
    const base = Math.floor(x);
    return [base, Math.min(base + 1, many - 1), x - base];
  };
  for (let j = 0, n = 0; j < h; j += 1) {
    const [low, high, v] = between(j, h, height);
    for (let i = 0; i < w; i += 1) {
      const [left, right, u] = between(i, w, width);
      for (let c = 0; c < channels; c += 1) {
        const at = (y: number, x: number) => fromHalf(texels[(y * width + x) * channels + c]);
        const below = at(low, left) * (1 - u) + at(low, right) * u;
        const above = at(high, left) * (1 - u) + at(high, right) * u;
        result[n++] = toHalf(below * (1 - v) + above * v);
      }
    }
  }
  return [result, w, h];
}
