// The numbers of the method, which flowtex/rendering/shaders.py reads.

// Lengths of the arrays that a renderer sets.
const int FLOWTEX_MOST_LAGS = 32;
const int FLOWTEX_HALF_LEVELS = 32;

// The sum along a path.
const int FLOWTEX_KERNEL_HANN = 0;
const int FLOWTEX_KERNEL_BOX = 1;
const int FLOWTEX_KERNEL_RAMP = 2;
const float FLOWTEX_PI = 3.141592653589793;
const float FLOWTEX_LEAST_WEIGHT = 1e-3; // of the sample at the fragment itself
const float FLOWTEX_LEAST_SPEED = 1e-6;  // a particle that is slower stands still
// Correlation of the noise at two points d grains apart: exp(-d^2 (BELL + BELL_BEND d^2)).
const float FLOWTEX_BELL = 1.19;
const float FLOWTEX_BELL_BEND = 0.06;
// The integral over such a bell is less, as if BELL grew by these times BELL_BEND / BELL^2 and its square.
const float FLOWTEX_BENT = 1.5;
const float FLOWTEX_BENT_TWICE = 4.9;   // of the square, which takes from it
const int FLOWTEX_UNCERTAIN_LAYER = 3; // whose fourth channel is the uncertainty of the direction
const float FLOWTEX_FADED = 0.3;         // contrast where it is not known at all
// The local mean that is subtracted from the texture.
const float FLOWTEX_EVEN_SIGMA = 2.0;    // deviation of the bell that it is over, in grains
const float FLOWTEX_LEAST_NEAR = 1e-6;   // correlations of neighbouring weights that count
const float FLOWTEX_MOST_NEAR = 0.999999;

// Paths in a cell give way to the slices from one number to the other: of the length of the nodes'
// mean velocity over the mean of their lengths, and of the cells that a side of the path goes over.
const float FLOWTEX_PARTING = 0.95;
const float FLOWTEX_AGREED = 0.99;
const float FLOWTEX_NEAR_CELLS = 4.0;
const float FLOWTEX_FAR_CELLS = 8.0;
const float FLOWTEX_SLIVER_CELLS = 2.0; // that a path as long as a triangle counts as, at most, where it crosses thin ones
// At a sharp edge slices leave the surface: sines of the angles of nodes' velocities and paths to a
// triangle between which paths in it take their place, over so many times as many cells.
const float FLOWTEX_ALONG_PLANE = 0.3;
const float FLOWTEX_OFF_PLANE = 0.5;
const float FLOWTEX_EDGE_CELLS = 2.0;

// Levels of detail.
const float FLOWTEX_LEAST_SQUARE = 1e-30; // square of the longest side of a footprint; no less, as graphics cards take numbers below 1.2e-38 as zero
const float FLOWTEX_LEAST_TEXELS = 1e-6;  // side of a footprint in texels
const float FLOWTEX_LEAST_ROUND = 0.25;   // shorter side of a footprint, over the longer one, that counts
const float FLOWTEX_MOST_STRETCH = 4.0;    // samples of a streak seen aslant over the usual number, and the reverse
const float FLOWTEX_LEAST_STRETCH = 0.01;  // change of their number below which it stays the usual one
const float FLOWTEX_LEAST_ACROSS = 0.75;   // width of a streak in the picture where the surface is seen aslant, over the usual one
const float FLOWTEX_RIM_HIDDEN = 0.5;      // pixels from an outline at which the texture has no contrast,
const float FLOWTEX_RIM_SHOWN = 1.5;       // and at which it has all,
const float FLOWTEX_RIM_ASLANT = 0.1;      // where the cosine between the normal and the ray is less than this;
const float FLOWTEX_RIM_FACING = 0.25;     // and cosine from which it has all at any distance
const float FLOWTEX_LEAST_FACING = 0.05;  // cosine between the normal and the ray to the eye
const float FLOWTEX_PLACE_FAR = 16.0;     // cells from a place as it is drawn beyond which it is not corrected
const float FLOWTEX_SHARP = 0.86;         // cosine between the normals of triangle and node at a sharp edge
const float FLOWTEX_LEVELS_AROUND = 6.0;  // levels of detail in one round of hues
const float FLOWTEX_HUE_SHIFT = 0.333;    // from one colour channel to the next, in rounds
const float FLOWTEX_LEVEL_DARKEST = 0.35;
const float FLOWTEX_LEVEL_STRENGTH = 0.5; // of an image over the colours of the levels

// Noise that is even in space.
const float FLOWTEX_SQRT_HALF = 0.7071067811865476;
const float FLOWTEX_LAST_OCTAVE = 58.99;    // and between two, as the next ones
const float FLOWTEX_LAST_HALF_LEVEL = 30.99;
const float FLOWTEX_LEAST_RATE = 0.25;      // turns in a base period of a grain in motion
const float FLOWTEX_LEAST_TRAVEL = 1e-30;
const float FLOWTEX_MANY_PHASES = 64.0;     // rounds of phases of every other rate
const uvec3 FLOWTEX_AXIS_PRIMES = uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);
const uint FLOWTEX_OCTAVE_PRIME = 0x9e3779b9u;
const uint FLOWTEX_SEED_PRIME = 0x85ebca6bu;
const uint FLOWTEX_HASH_SHIFT = 15u;
const uvec2 FLOWTEX_HASH_FACTORS = uvec2(0x2c1b3c6du, 0x297a2d39u);
const float FLOWTEX_MOST_GRAIN = 2147483648.0; // 2^31, the largest value of a grain
// Streaklets: in every other block of two to the power of so many grains, one is bright.
const uint FLOWTEX_BLOCK_BITS = 6u;
// What bright grains and the others have in units of the largest value of a dense one, so that mean
// and variance are the same.
const float FLOWTEX_SPARSE_HIGH = 6.506407;
const float FLOWTEX_SPARSE_LOW = 0.05123155;
// In motion a bright grain is a dash: its share of a turn, the value of its head, and less what all
// have.
const float FLOWTEX_DASH_SHARE = 0.4;
const float FLOWTEX_DASH_HIGH = 17.909544;
const float FLOWTEX_DASH_LOW = 0.02798366;
// Their sides are as long as this over the tangent of the angle to paths half a side's length beside.
const float FLOWTEX_TOGETHER = 0.5;
const float FLOWTEX_GRAIN_VARIANCE = 1.5372286728091292e18; // a third of its square

// Shading: the lightness that black and white are drawn to, and how far the texture goes from it.
const float FLOWTEX_BASE_DARK = 0.36;
const float FLOWTEX_BASE_LIGHT = 0.80;
const float FLOWTEX_TONE_RANGE = 0.34;
const float FLOWTEX_TONE_SLOPE = 1.1;
const float FLOWTEX_LEAST_LIGHTNESS = 1e-6;
const float FLOWTEX_LEAST_CHROMA = 1e-6; // difference of a linear colour to its grey
// Lights: dark sides stay bright enough to read the texture there.
const float FLOWTEX_AMBIENT_LIGHT = 0.15;
const float FLOWTEX_DIFFUSE_LIGHT = 1.0;

// sRGB.
const float FLOWTEX_SRGB_SLOPE = 12.92;
const float FLOWTEX_SRGB_OFFSET = 0.055;
const float FLOWTEX_SRGB_SCALE = 1.055;
const float FLOWTEX_SRGB_POWER = 2.4;
const float FLOWTEX_SRGB_KNEE = 0.04045;
const float FLOWTEX_SRGB_LINEAR_KNEE = 0.0031308;
// Oklab: linear colours to the responses of cones, and their cube roots to Oklab; and back.
const mat3 FLOWTEX_TO_CONES = mat3(
  0.4122214708, 0.2119034982, 0.0883024619,
  0.5363325363, 0.6806995451, 0.2817188376,
  0.0514459929, 0.1073969566, 0.6299787005);
const mat3 FLOWTEX_TO_LAB = mat3(
  0.2104542553, 1.9779984951, 0.0259040371,
  0.7936177850, -2.4285922050, 0.7827717662,
  -0.0040720468, 0.4505937099, -0.8086757660);
const mat3 FLOWTEX_FROM_LAB = mat3(
  0.9999999984505199, 1.0000000088817607, 1.0000000546724108,
  0.3963377921737679, -0.10556134232365635, -0.08948418209496575,
  0.2158037580607588, -0.06385417477170591, -1.2914855378640917);
const mat3 FLOWTEX_FROM_CONES = mat3(
  4.076741661347995, -1.268438004092176, -0.004196086541836943,
  -3.3077115904081937, 2.6097574006633715, -0.7034186144594496,
  0.23096992872942781, -0.3413193963102195, 1.7076147009309446);

// Tracing.
const float FLOWTEX_ENDLESS = 1e30;        // reach of a path that has not ended
const float FLOWTEX_LEAST_REACH = 1e-30;   // of a path whose reach has a sign
const float FLOWTEX_STEP_CELLS = 0.5;      // longest step
const int FLOWTEX_PIECES = 16;             // of a path that is composed, at most
const float FLOWTEX_MANY_LAGS = 1e4;       // reach of a path that does not end, in lags
const int FLOWTEX_MOST_STEPS = 512;        // after which a path ends
const float FLOWTEX_BISECTED = 4.9e-4;     // of a step within which bisection finds where it does
const float FLOWTEX_BORDER_CELLS = 1e-2;   // that rounding may carry a path beyond a border
const float FLOWTEX_LAG_ROUNDING = 1e-5;
const float FLOWTEX_HALF_MAX = 65504.0;
