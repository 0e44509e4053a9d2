$script
const scene = flowtex.packedModule({ headers: $headers, parts: [
$parts
] }$store);
export const { mount, render } = scene;
export default { render };
