// The pixels of a sensor_msgs/Image for a screen, by the same rules as pictures over HTTP.

// Colours: bytes per channel, channels per pixel, and the positions of red, green and blue.
const COLOURS = {
  rgb8: [1, 3, 0, 1, 2], bgr8: [1, 3, 2, 1, 0], rgba8: [1, 4, 0, 1, 2], bgra8: [1, 4, 2, 1, 0],
  rgb16: [2, 3, 0, 1, 2], bgr16: [2, 3, 2, 1, 0], rgba16: [2, 4, 0, 1, 2], bgra16: [2, 4, 2, 1, 0],
  mono8: [1, 1, 0, 0, 0], "8UC1": [1, 1, 0, 0, 0], "8UC3": [1, 3, 2, 1, 0], "8UC4": [1, 4, 2, 1, 0],
};
// Numbers that are scaled by their range: bytes per number, and a function that reads one.
const NUMBERS = {
  mono16: [2, "getUint16"], "16UC1": [2, "getUint16"], "16SC1": [2, "getInt16"], "8SC1": [1, "getInt8"],
  "32SC1": [4, "getInt32"], "32FC1": [4, "getFloat32"], "64FC1": [8, "getFloat64"],
};
const YUV = { yuv422: [1, 0], uyvy: [1, 0], yuv422_yuy2: [0, 1], yuyv: [0, 1] };
const BAYER = /^bayer_([rgb]{4})(8|16)$/;

export function picture(message) {
  const { width, height, step, data } = message;
  // A pixel takes a byte or more, so a picture takes no more memory here than the message allows.
  if (step < width || data.length < height * step) throw new Error(`${data.length} bytes are too few for ${width} × ${height} pixels`);
  const shown = new ImageData(width, height);
  const pixels = shown.data;
  const paint = painter(message, pixels);
  for (let row = 0, to = 0; row < height; row++) {
    for (let column = 0; column < width; column++, to += 4) {
      paint(row, column, to);
      pixels[to + 3] = 255;
    }
  }
  return shown;
}

// Returns a function that writes the red, green and blue of a pixel.
function painter(message, pixels) {
  const { encoding, step, is_bigendian, data } = message;
  if (COLOURS[encoding]) {
    const [bytes, channels, ...places] = COLOURS[encoding];
    const high = bytes === 2 && !is_bigendian ? 1 : 0;
    const [red, green, blue] = places.map((place) => place * bytes + high);
    return (row, column, to) => {
      const at = row * step + column * channels * bytes;
      pixels[to] = data[at + red];
      pixels[to + 1] = data[at + green];
      pixels[to + 2] = data[at + blue];
    };
  }
  if (NUMBERS[encoding]) {
    const valueAt = scaled(message, ...NUMBERS[encoding]);
    return (row, column, to) => { pixels[to] = pixels[to + 1] = pixels[to + 2] = valueAt(row, column); };
  }
  const bayer = BAYER.exec(encoding);
  if (bayer) {
    const valueAt = bayer[2] === "8" ? (row, column) => data[row * step + column] : scaled(message, 2, "getUint16");
    return mosaic(message, bayer[1], valueAt, pixels);
  }
  if (YUV[encoding]) return pairs(message, ...YUV[encoding], pixels);
  throw new Error(`images with the encoding ${encoding} cannot be shown`);
}

// Returns a function that maps a number to 0 to 255 within the range of all; NaN is dark.
function scaled({ width, height, step, is_bigendian, data }, bytes, get) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const numberAt = (row, column) => view[get](row * step + column * bytes, !is_bigendian);
  let low = Infinity, high = -Infinity;
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const number = numberAt(row, column);
      if (!Number.isFinite(number)) continue;
      if (number < low) low = number;
      if (number > high) high = number;
    }
  }
  return (row, column) => {
    const number = numberAt(row, column);
    if (!Number.isFinite(number)) return 0;
    return high > low ? ((number / 2 - low / 2) / (high / 2 - low / 2)) * 255 : 255;
  };
}

// Each square of four pixels has one colour.
function mosaic({ width, height }, pattern, valueAt, pixels) {
  const places = ["r", "g", "b"].map((name) => [0, 1, 2, 3].filter((place) => pattern[place] === name));
  return (row, column, to) => {
    const top = row & ~1, left = column & ~1;
    const at = (place) => valueAt(Math.min(top + (place >> 1), height - 1), Math.min(left + (place & 1), width - 1));
    places.forEach((found, channel) => {
      pixels[to + channel] = found.reduce((sum, place) => sum + at(place), 0) / found.length;
    });
  };
}

// Two pixels share their colour (BT.601).
function pairs({ width, step, data }, bright, shared, pixels) {
  return (row, column, to) => {
    const pair = row * step + (column & ~1) * 2;
    const last = (column | 1) < width ? pair + 2 : pair - 2; // the last pixel may have no partner
    const light = data[row * step + column * 2 + bright];
    const blue = width > 1 ? data[pair + shared] - 128 : 0;
    const red = width > 1 ? data[last + shared] - 128 : 0;
    pixels[to] = light + 1.402 * red;
    pixels[to + 1] = light - 0.344 * blue - 0.714 * red;
    pixels[to + 2] = light + 1.772 * blue;
  };
}
