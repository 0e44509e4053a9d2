import assert from "node:assert/strict";
import { test } from "node:test";
import { draftUniforms, learnedPrice, motionFactor, movingTime, quality, rowsIn } from "../src/quality.ts";

const ask = (price: number, pixels: number) => quality(price, 2, pixels, 49, 55);

test("a fast machine draws everything", () => {
  assert.deepEqual(ask(1e-7, 2e6), { scale: 1, samples: 49 });
});

test("a slow machine gets fewer and larger pixels", () => {
  const { scale, samples } = ask(3e-5, 1e6);
  assert.equal(samples, 9);
  assert.ok(scale >= 0.2 && scale < 0.5);
  assert.ok(3e-5 * 1e6 * scale ** 2 * (9 + 8) < 60);
  assert.equal(ask(1, 1e6).scale, 0.2);
});

test("a machine between them gets fewer samples of all pixels", () => {
  const { scale, samples } = ask(2e-6, 1e6);
  assert.equal(scale, 1);
  assert.ok(samples > 9 && samples < 49);
});

test("an animation takes the time that its grain needs, and a hand does not wait for it", () => {
  const scale = (price: number, isPlaying: boolean) => {
    const time = movingTime(price, 2, 1e6, 49, isPlaying);
    return [time, quality(price, 2, 1e6, 49, time).scale];
  };
  assert.equal(scale(3e-5, false)[0], 55);
  assert.equal(scale(1e-7, true)[0], 55);
  const [time, share] = scale(2.5e-5, true);
  assert.ok(time > 100 && time < 125 && Math.abs(share - 0.5) < 1e-9);
  const [longest, coarse] = scale(1e-4, true);
  assert.ok(longest === 125 && coarse > scale(1e-4, false)[1]);
});

test("a picture that takes long however few its pixels has its share of time for them", () => {
  const pixels = (fixed: number) => quality(3e-5, fixed, 1e6, 49, 55).scale ** 2;
  assert.ok(Math.abs(pixels(54) * 3e-5 * 1e6 * (9 + 8) - 27) < 1e-9);
  assert.ok(Math.abs(pixels(200) * 3e-5 * 1e6 * (9 + 8) - 55) < 1e-9);
});

test("few samples are never made more", () => {
  assert.equal(quality(3e-5, 2, 1e6, 5, 55).samples, 5);
});

test("strips have as many rows as there is time for, and a few at least", () => {
  const rows = rowsIn(40, 1e-5, 1000, 49);
  assert.ok(rows * 1000 * (49 + 8) * 1e-5 <= 40 && rows > 60);
  assert.equal(rowsIn(40, 1, 1000, 49), 4);
});

test("slower is believed at once, faster by and by", () => {
  const spent = (price: number) => price * 1e6 * (49 + 8);
  const slower = learnedPrice(1e-6, spent(1e-5), 1e6, 49, 1);
  const faster = learnedPrice(1e-5, spent(1e-6), 1e6, 49, 1);
  assert.ok(Math.abs(slower - 7.3e-6) < 1e-9);
  assert.ok(Math.abs(faster - 7.3e-6) < 1e-9);
  assert.ok(Math.abs(learnedPrice(1e-5, spent(1e-5), 1e6, 49, 1) - 1e-5) < 1e-12);
});

test("moving grains take twice the samples", () => {
  assert.equal(motionFactor(49), (98 + 8) / (49 + 8));
});

test("streaks of a draft keep their length, and its grains can be seen", () => {
  const settings = { grain: 1.5, spacing: 0.7, samples: 49 };
  const draft = draftUniforms(settings, 9, 0.2);
  assert.equal(draft.u_grain, 1);
  // In pixels of the draft: five of the page's pixels each.
  const length = 9 * Number(draft.u_spacing) * Number(draft.u_grain);
  assert.ok(Math.abs(length / 0.2 - 49 * 0.7 * 1.5) < 1e-9);
  // Samples that would be too far apart leave gaps.
  assert.equal(draftUniforms(settings, 9, 1).u_spacing, 1.4);
});
