// Numbers in half precision, and textures of several layers of them.

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

export interface LayersSize {
  width: number;
  height: number;
  layers: number;
  channels: number;
  /** Mip levels beside the finest. */
  levels: number;
}

/** Raise an error where a graphics card does not support the size of a texture. */
export function checkSize(gl: WebGL2RenderingContext, width: number, height: number, layers = 1): void {
  const most = gl.getParameter(gl.MAX_TEXTURE_SIZE) as number;
  const mostLayers = gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number;
  if (Math.max(width, height) > most || layers > mostLayers) {
    throw new Error(
      `a texture of ${width} x ${height} texels in ${layers} layers is needed, but this graphics ` +
        `card supports at most ${most} x ${most} in ${mostLayers}; show fewer nodes`,
    );
  }
}

/** Give a texture its size, which is bound then. */
export function makeLayers(gl: WebGL2RenderingContext, texture: WebGLTexture, size: LayersSize): void {
  const { width, height, layers, channels, levels } = size;
  checkSize(gl, width, height, layers);
  const target = gl.TEXTURE_2D_ARRAY;
  gl.bindTexture(target, texture);
  gl.texStorage3D(target, levels + 1, channels === 1 ? gl.R16F : gl.RGBA16F, width, height, layers);
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}
