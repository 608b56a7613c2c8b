// What the checks of all pages do alike.
const frames = async (count) => {
  for (let i = 0; i < count; i++) await new Promise((done) => requestAnimationFrame(done));
};

/** How many pixels of a WebGL canvas differ from its first one, and a fingerprint of all. */
const pictureOf = (canvas) => {
  const gl = canvas.getContext("webgl2");
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let [different, hash] = [0, 0];
  for (let i = 0; i < pixels.length; i += 4) {
    const same = pixels[i] === pixels[0] && pixels[i + 1] === pixels[1] && pixels[i + 2] === pixels[2];
    if (!same) different++;
    hash = (31 * hash + 7 * pixels[i] + 3 * pixels[i + 1] + pixels[i + 2]) | 0;
  }
  return { different, hash };
};

/** Leaves what was seen in #checks. */
const leave = (seen) => {
  const node = document.createElement("script");
  node.type = "application/json";
  node.id = "checks";
  node.textContent = JSON.stringify(seen).replaceAll("<", "\\u003c");
  document.body.append(node);
};
