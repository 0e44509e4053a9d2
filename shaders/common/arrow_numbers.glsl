// How arrows look. Lengths are in pixels where nothing else is said.

const float FLOWTEX_ARROW_LENGTH = 1.05;       // over the least distance of seeds
const float FLOWTEX_ARROW_FORESHORTENED = 0.75; // how far the shorter side of a footprint decides on it
const float FLOWTEX_ARROW_APART = 1.025;       // distance over the least one, below which none is drawn
const float FLOWTEX_ARROW_EDGE = 0.15;         // shorter over longer side of a footprint, likewise
const float FLOWTEX_ARROW_WOUND = 0.375;       // distance of two points of a path over its length, likewise
const float FLOWTEX_ARROW_KNOWN = 0.5;         // how far the direction is known, or shown, likewise
const float FLOWTEX_ARROW_FREE = 3.0;          // reach of a path over its length beyond which it is whole
const float FLOWTEX_ARROW_SLOWEST = 0.4;       // length over the typical one, by speed
const float FLOWTEX_ARROW_FASTEST = 1.5;
const float FLOWTEX_ARROW_SHORTEST = 0.35;     // foreshortened length over the whole one
const float FLOWTEX_ARROW_HEAD = 0.32;         // length of the head over that of the arrow
const float FLOWTEX_ARROW_WIDTH = 0.45;        // half the head's width over its length
const float FLOWTEX_ARROW_SHAFT = 0.32;        // width of the shaft at the head over that of the head
const float FLOWTEX_ARROW_SWEPT = 0.3;         // how far the barbs are swept back, over the head's length
const float FLOWTEX_ARROW_OUTLINE = 1.2;
const float FLOWTEX_ARROW_OUTLINE_OPACITY = 0.85;
const float FLOWTEX_ARROW_LIFT = 4.0;          // how much nearer to the eye, in half widths
const float FLOWTEX_ARROW_NEAREST = 0.999;     // least depth in clip space, with the sign of the far end
const vec3 FLOWTEX_ARROW_DARK = vec3(0.07);
const vec3 FLOWTEX_ARROW_LIGHT = vec3(1.0);
