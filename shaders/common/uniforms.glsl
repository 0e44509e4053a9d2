// What a renderer sets. The names are those of flowtex/render/uniforms.py.

uniform highp sampler2DArray u_slices;
#ifdef FLOWTEX_UNSTEADY
uniform highp sampler2DArray u_slicesNext; // slices of the next destination time
uniform float u_between;                   // how far the time has come from one to the next
#endif
uniform vec2 u_slicesSize;  // texels of a layer
uniform float u_deepest;    // coarsest level of the slices
uniform float u_lags[32];   // lags of the slices, in units of lag
uniform int u_lagCount;
uniform int u_sides;        // 1 backward only, 2 forward too
uniform float u_unit;       // length that the fourth channel of layer 0 is measured in

uniform int u_samples;
uniform float u_spacing;
uniform float u_grain;
uniform int u_kernel;       // 0 Hann, 1 box, 2 ramp
uniform bool u_lod;
uniform float u_contrast;
uniform float u_strength;
uniform int u_seed;
uniform float u_turn;       // clock of the animation, in turns
uniform float u_wave;       // turns by pixel of path

uniform vec3 u_noiseOrigin;      // lattice point near the view, in the surface's frame
uniform vec3 u_noiseOriginCell;  // the same in cells of octave 0, whole numbers
uniform float u_noiseFinest;     // width of a cell of octave 0
uniform float u_texel;           // width of a grain when the level of detail is off
#ifdef FLOWTEX_PAPER
uniform highp sampler2D u_noiseImage;
uniform highp sampler2D u_stepImage;
uniform vec2 u_noiseSize;  // texels of the noise
uniform bool u_noiseCorrected; // noise even on the surface, not in the texture
#endif
