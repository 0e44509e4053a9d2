
export const { FlowtexView, Viewer, decoded, initialize, mountPage, partsOfFile, render } = flowtex;
export default { initialize, render };
