// Reads CBOR (RFC 8949) as the gateway writes it, with typed arrays (RFC 8746).

const TEXT = new TextDecoder();

const TYPED_ARRAYS = {
  69: Uint16Array, 70: Uint32Array, 71: BigUint64Array,
  72: Int8Array, 77: Int16Array, 78: Int32Array, 79: BigInt64Array,
  85: Float32Array, 86: Float64Array,
};

/** Decode the value in the bytes of an ArrayBuffer. */
export function decode(buffer) {
  const view = new DataView(buffer);
  let at = 0;

  function argument(info) {
    if (info < 24) return info;
    const start = at;
    at += 1 << (info - 24);
    switch (info) {
      case 24: return view.getUint8(start);
      case 25: return view.getUint16(start);
      case 26: return view.getUint32(start);
      case 27: return small(view.getBigUint64(start));
      default: throw new Error(`CBOR: items of indefinite length (${info}) are not supported`);
    }
  }

  function bytes(length) {
    at += length;
    return new Uint8Array(buffer, at - length, length);
  }

  function simple(info) {
    const start = at;
    switch (info) {
      case 20: return false;
      case 21: return true;
      case 22: return null;
      case 23: return undefined;
      case 25: at += 2; return half(view.getUint16(start));
      case 26: at += 4; return view.getFloat32(start);
      case 27: at += 8; return view.getFloat64(start);
      default: throw new Error(`CBOR: unknown simple value ${info}`);
    }
  }

  function item() {
    const initial = view.getUint8(at++);
    const major = initial >> 5, info = initial & 31;
    if (major === 7) return simple(info);
    const value = argument(info);
    switch (major) {
      case 0: return value;
      case 1: return typeof value === "bigint" ? -1n - value : -1 - value;
      case 2: return bytes(value);
      case 3: return TEXT.decode(bytes(value));
      case 4: return Array.from({ length: value }, item);
      case 5: return Object.fromEntries(Array.from({ length: value }, () => [item(), item()]));
      default: return tagged(value, item());
    }
  }

  return item();
}

function small(number) {
  return number <= Number.MAX_SAFE_INTEGER ? Number(number) : number;
}

function half(bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023;
  const sign = bits >> 15 ? -1 : 1;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
}

function tagged(tag, value) {
  const TypedArray = TYPED_ARRAYS[tag];
  // A typed array has to begin at a multiple of its element size, so the bytes are copied.
  return TypedArray ? new TypedArray(value.slice().buffer) : value;
}
