// Modules whose types are found under another name.

// esbuild imports a style sheet as its text.
declare module "*.css" {
  const text: string;
  export default text;
}

// And a shader.
declare module "*.glsl" {
  const text: string;
  export default text;
}

declare module "gl-matrix/esm/mat2d.js" {
  import { mat2d } from "gl-matrix";
  export = mat2d;
}

declare module "gl-matrix/esm/mat3.js" {
  import { mat3 } from "gl-matrix";
  export = mat3;
}

declare module "gl-matrix/esm/mat4.js" {
  import { mat4 } from "gl-matrix";
  export = mat4;
}

declare module "gl-matrix/esm/vec3.js" {
  import { vec3 } from "gl-matrix";
  export = vec3;
}
