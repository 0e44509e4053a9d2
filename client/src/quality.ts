// How well there is time to draw: what a pixel costs is learned from what was drawn.

import type { Settings } from "./protocol.ts";
import { clamp } from "./vectors.ts";

/** What a pixel costs beside its samples, in samples. */
const PIXEL_COST = 8;
/** Samples of a draft, and its least share of the width. */
const DRAFT_SAMPLES = 9;
const COARSEST_SCALE = 0.2;
/** Greatest distance of two samples in a draft, in grains. */
const DRAFT_SPACING = 1.4;
/** Milliseconds for a picture while the user moves the view, and at most while an animation plays.
*/
const MOVING_MS = 55;
const PLAYING_MS = 125;
/** Share of the width from which an animation has its grain: below it time is better spent on pixels. */
const CLEAR_SCALE = 0.5;
/** Least rows in a strip. */
const FEWEST_ROWS = 4;
/** Price of a sample of a pixel, in milliseconds: at first, and below which a graphics card draws. */
export const FIRST_PRICE_MS = 4e-5;
export const CARD_PRICE_MS = 2e-6;

/**
 * The best share (`scale`) of the width, and samples, that can be drawn in a time: `price` is for a sample of a
 * pixel, `fixed` what a picture takes at least, all in milliseconds.
 */
export function quality(
  price: number,
  fixed: number,
  pixels: number,
  samples: number,
  budget: number,
): { scale: number; samples: number } {
  // What takes long however few its pixels hardly takes longer with enough of them to be seen well.
  const room = Math.max(budget - fixed, Math.min(fixed / 2, budget), 2) / price;
  if (pixels * (samples + PIXEL_COST) <= room) return { scale: 1, samples };
  const fewer = Math.min(DRAFT_SAMPLES, samples);
  const scale = Math.sqrt(room / (fewer + PIXEL_COST) / pixels);
  if (scale < 1) return { scale: Math.max(scale, COARSEST_SCALE), samples: fewer };
  return { scale: 1, samples: clamp(Math.floor(room / pixels - PIXEL_COST), fewer, samples) };
}

/**
 * Milliseconds for a picture in motion. Users notice a delay, so pixels are left out then; an eye
 * that watches an animation sees grains that are blurred before it minds fewer pictures a second.
 */
export function movingTime(
  price: number,
  fixed: number,
  pixels: number,
  samples: number,
  isPlaying: boolean,
): number {
  if (!isPlaying) return MOVING_MS;
  const fewer = Math.min(DRAFT_SAMPLES, samples);
  const clear = fixed + price * pixels * CLEAR_SCALE ** 2 * (fewer + PIXEL_COST);
  return clamp(clear, MOVING_MS, PLAYING_MS);
}

/** Rows of the full picture that can be summed in a time. */
export function rowsIn(budget: number, price: number, width: number, samples: number): number {
  return Math.max(Math.floor(budget / (price * width * (samples + PIXEL_COST))), FEWEST_ROWS);
}

/** As many times more a sample costs while grains move, as twice the samples are taken. */
export function motionFactor(samples: number): number {
  return (2 * samples + PIXEL_COST) / (samples + PIXEL_COST);
}

/** The price after another picture was drawn. */
export function learnedPrice(price: number, spent: number, pixels: number, samples: number, factor: number): number {
  const latest = Math.max(spent, 0.05) / (pixels * (samples + PIXEL_COST) * factor);
  // A slower measurement counts at once, a faster one gradually: a picture that is late is felt.
  return price + (latest - price) * (latest > price ? 0.7 : 0.3);
}

/**
 * Grain and spacing of a draft, which has fewer samples and coarser pixels than the picture: streaks
 * keep their length on the page, and no grain is so much smaller than a pixel that it would be grey.
 * `density` is that of the draft.
 */
export function draftUniforms(settings: Settings, samples: number, density: number) {
  const [grain, spacing, all] = [settings.grain, settings.spacing, settings.samples].map(Number);
  const drawn = Math.max(grain * density, Math.min(grain, 1));
  const length = all * spacing * grain;
  const stretched = (length * density) / (samples * drawn);
  return { u_grain: drawn, u_spacing: clamp(stretched, 0.1, Math.max(DRAFT_SPACING, spacing)) };
}
