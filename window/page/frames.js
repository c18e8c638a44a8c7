// Decodes the binary messages of the server: poses, LEDs, drawings of layers, what moves on robots. All numbers are little-endian, as are
// all processors that browsers run on, so typed arrays lie directly on the bytes.

const header_bytes = 32;
const types = { 1: 'poses', 2: 'leds', 3: 'drawing', 4: 'values' };
const row_bytes = { poses: 16, leds: 8, drawing: 28, values: 12 };

/** { type, number, tick, count, members, time_s, bytes, words, floats, integers }, or null: not a frame of this protocol. */
export function decodeFrame(buffer) {
  if (buffer.byteLength < header_bytes) return null;
  const head = new DataView(buffer);
  const type = types[head.getUint32(0, true)];
  const count = head.getUint32(16, true);
  if (type === undefined || buffer.byteLength !== header_bytes + count * row_bytes[type]) return null;
  return {
    type,
    count,
    number: head.getUint32(4, true),
    tick: Number(head.getBigInt64(8, true)),
    members: head.getUint32(20, true),
    time_s: head.getFloat64(24, true),
    bytes: new Uint8Array(buffer, header_bytes),
    words: new Uint16Array(buffer, header_bytes),
    floats: new Float32Array(buffer, header_bytes),
    integers: new Uint32Array(buffer, header_bytes),
  };
}

const turn = 2 * Math.PI;
// Of row i of a frame of poses.
export const rowX = (frame, i) => frame.floats[4 * i];
export const rowY = (frame, i) => frame.floats[4 * i + 1];
export const rowZ = (frame, i) => frame.words[8 * i + 4] / 1000;
export const rowHeading = (frame, i) => (frame.words[8 * i + 5] / 65536) * turn;
const tilt = (byte) => (((byte << 24) >> 24) / 128) * (Math.PI / 2);
export const rowRoll = (frame, i) => tilt(frame.bytes[16 * i + 14]);
export const rowPitch = (frame, i) => tilt(frame.bytes[16 * i + 15]);
/** RGB565 of the lit LEDs, mixed; 0: none is lit. */
export const rowColor = (frame, i) => frame.words[8 * i + 6];

/** Writes the colour of `rowColor`, 0 to 255 each. */
export function rgb565(to, at, color) {
  to[at] = ((color >> 11) * 527 + 23) >> 6;
  to[at + 1] = (((color >> 5) & 63) * 259 + 33) >> 6;
  to[at + 2] = ((color & 31) * 527 + 23) >> 6;
}
