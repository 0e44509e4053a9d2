  // Nearer to the eye, or farther, by a share of the distance, and at the same place of the picture.
  gl_Position.z -= flowtexNearer;
