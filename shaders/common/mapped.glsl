// The colours of values, of which flowtexColourOf(n) returns the n-th of flowtexColourCount(): one below the
// range, those in it, one above it, and one where there is no value. Those of a norm begin at the shares of
// the range in their fourth channel, the others each cover an equal share; the first row has 1 with a norm.
const float FLOWTEX_ROUNDED = 1e-6; // part of a share that is rounding

vec3 flowtexColourAt(float share, bool known)
{
  int count = flowtexColourCount() - 3;
  share *= share < 1.0 ? 1.0 + FLOWTEX_ROUNDED : 1.0; // a value at the border of two colours has the second
  int entry = int(clamp(share * float(count), 0.0, float(count - 1))) + 1;
  if (flowtexColourOf(0).a > 0.0)
  {
    int beyond = count + 1;
    entry = 1;
    while (beyond - entry > 1)
    {
      int middle = (entry + beyond) / 2;
      if (flowtexColourOf(middle).a <= share)
        entry = middle;
      else
        beyond = middle;
    }
  }
  if (share < -FLOWTEX_ROUNDED)
    entry = 0;
  if (share > 1.0 + FLOWTEX_ROUNDED)
    entry = count + 1;
  if (!known)
    entry = count + 2;
  return flowtexColourOf(entry).rgb;
}
