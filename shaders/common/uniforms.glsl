// What a renderer sets. The names are those of flowtex/rendering/uniforms.py.

//#include common/constants.glsl

uniform highp sampler2DArray u_slices;
#ifdef FLOWTEX_UNSTEADY
uniform highp sampler2DArray u_slicesNext; // slices of the next destination time
uniform float u_between;                   // how far the time has come from one to the next
#endif
uniform vec2 u_slicesSize;  // texels of a layer
uniform vec2 u_padding;     // texels of the slices before the first node
uniform float u_deepest;    // coarsest level of the slices
uniform float u_lags[FLOWTEX_MOST_LAGS];   // lags of the slices, in units of lag
uniform int u_lagCount;
uniform int u_sides;        // 1 backward only, 2 forward too
uniform float u_unit;       // length that the fourth channel of layer 0 is measured in
#ifdef FLOWTEX_CELLS
uniform int u_rateLayer;    // layer 0 in cells, how paths leave a face, and the speed
uniform float u_cell;       // of this length
#endif

uniform int u_samples;
uniform float u_spacing;
uniform float u_grain;
uniform int u_kernel;       // FLOWTEX_KERNEL_HANN, ..._BOX or ..._RAMP
uniform bool u_lod;
uniform float u_contrast;
uniform float u_strength;
uniform bool u_even;        // whether the local mean will be subtracted
uniform float u_fade;       // speed below which the texture fades, over the typical one
uniform int u_seed;
uniform bool u_showLevel;   // colour by the level of detail
uniform bool u_fixed;       // grains no smaller on the surface than u_texel

uniform vec2 u_clock;          // clock in base periods: a coarse part and the rest
uniform float u_travel;        // what the flow goes in a base period: a length, or pixels,
uniform bool u_travelInPixels;
uniform bool u_travelBySpeed;  // where its speed is the typical one, or everywhere
uniform float u_wave;          // pixels that it goes in one turn, at least

uniform vec4 u_eye;              // the eye, as positions are given, or with w = 0 the way to it
uniform vec3 u_noiseOrigin;      // point near the view, as positions are given
uniform vec3 u_noiseOriginEven;  // the same in cells of octave 0, whole numbers
uniform vec3 u_noiseOriginOdd;   // and in cells of octave 1: whole numbers,
uniform vec3 u_noiseRestOdd;     // and the rest
uniform float u_noiseFinest;     // width of a cell of octave 0
uniform float u_texel;           // width of a grain that is fixed on the surface
#ifdef FLOWTEX_IMAGE
uniform highp sampler2DArray u_image;     // one layer each: colours times opacity, and opacity,
uniform highp sampler2DArray u_stepImage; // and the lag in which the flow crosses a texel
uniform vec2 u_stepSize;   // texels of the step texture
uniform vec2 u_imageSize;  // texels of the image over the surface, with its repeats
uniform vec2 u_imageRound; // 1 along an axis that closes on itself
uniform float u_tiles;     // how often the image is repeated
#ifndef FLOWTEX_PAINTED
uniform float u_noiseDeviations[FLOWTEX_HALF_LEVELS]; // of noise at each mip level and half-way to the next
#endif
#endif
