// Textures of several layers in half precision.

import { halved } from "./half.ts";

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

/** Send a layer to the texture that is bound, with its mip levels where `levels` are not made there. */
export function sendLayer(
  gl: WebGL2RenderingContext,
  { width, height, channels, levels }: LayersSize,
  layer: number,
  texels: Uint16Array,
): void {
  const format = channels === 1 ? gl.RED : gl.RGBA;
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  for (let [level, w, h] = [0, width, height]; ; level += 1) {
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, level, 0, 0, layer, w, h, 1, format, gl.HALF_FLOAT, texels);
    if (level === levels) return;
    [texels, w, h] = halved(texels, w, h, channels);
  }
}
