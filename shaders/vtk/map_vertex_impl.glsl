  // Lower on a globe, by pixels.
  gl_Position = mix(gl_Position, MCDCMatrix[3], flowtexLower * gl_Position.w);
  // Nearer to the eye, or farther, by a share of the distance, and at the same place of the picture.
  // What was seen is not brought before the nearest depth.
  gl_Position.z = max(gl_Position.z - flowtexNearer, min(gl_Position.z, -0.9999 * gl_Position.w));
