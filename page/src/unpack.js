// Blocks of arrays, as session/view/pack.h makes them.

const decoder = new TextDecoder();

export function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text), bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Bytes plane by plane back to records: the sum of differences, whose lowest bit is the sign. */
function restore(bytes, type, components, records) {
  const n = components * records;
  if (type === 'u8') {
    const out = new Uint8Array(n);
    for (let i = 0; i < n; ++i) {
      const v = bytes[i];
      out[i] = (i < components ? 0 : out[i - components]) + ((v >> 1) ^ -(v & 1));
    }
    return out;
  }
  if (type === 'f64') {
    const out = new BigUint64Array(n);
    for (let i = 0; i < n; ++i) {
      let v = 0n;
      for (let k = 7; k >= 0; --k) v = (v << 8n) | BigInt(bytes[k * n + i]);
      out[i] = (i < components ? 0n : out[i - components]) + ((v >> 1n) ^ -(v & 1n));
    }
    return new Float64Array(out.buffer);
  }
  const out = new Uint32Array(n), b1 = n, b2 = 2 * n, b3 = 3 * n;
  for (let i = 0; i < n; ++i) {
    const v = bytes[i] | (bytes[b1 + i] << 8) | (bytes[b2 + i] << 16) | (bytes[b3 + i] << 24);
    out[i] = (i < components ? 0 : out[i - components]) + ((v >>> 1) ^ -(v & 1));
  }
  return type === 'f32' ? new Float32Array(out.buffer) : out;
}

const sizes = { u8: 1, u32: 4, f32: 4, f64: 8 };

/** The arrays of a block by their names. */
export async function unpack(packed) {
  const raw = await inflate(packed);
  const length = raw[0] | (raw[1] << 8) | (raw[2] << 16) | (raw[3] << 24);
  const header = JSON.parse(decoder.decode(raw.subarray(4, 4 + length)));
  const arrays = {}, sizesOf = {};
  Object.defineProperty(arrays, 'components', { value: sizesOf });
  let at = 4 + length;
  for (const [name, type, components, records] of header) {
    const n = components * records * sizes[type];
    arrays[name] = restore(raw.subarray(at, at + n), type, components, records);
    sizesOf[name] = components;
    at += n;
  }
  return arrays;
}

/** What `now` leaves out (session/view/pack.h, difference()) from the arrays of before. */
export function completed(now, before) {
  const arrays = {};
  for (const key of Object.keys(now)) {
    const [name, how] = splitKey(key);
    if (!how) arrays[name] = now[key];
    else if (how === 'same') arrays[name] = before[name];
    else if (how === 'runs') {
      const runs = now[key], fresh = now[`${name}:new`], old = before[name], size = now.components[`${name}:new`];
      let n = 0;
      for (let i = 0; i < runs.length; i += 2) n += runs[i];
      const out = new old.constructor(n * size);
      let to = 0, at = 0;
      for (let i = 0; i < runs.length; i += 2) {
        const length = runs[i] * size, from = runs[i + 1];
        if (from === 0xffffffff) {
          out.set(fresh.subarray(at, at + length), to);
          at += length;
        } else out.set(old.subarray(from * size, from * size + length), to);
        to += length;
      }
      arrays[name] = out;
    }
  }
  return arrays;
}
const splitKey = (key) => {
  const end = key.lastIndexOf(':'), how = key.slice(end + 1);
  return end > 0 && ['same', 'runs', 'new'].includes(how) ? [key.slice(0, end), how] : [key, ''];
};

export const text = (bytes) => decoder.decode(bytes);
