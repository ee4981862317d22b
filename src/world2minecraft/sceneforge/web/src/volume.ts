// Reads the binary arrays that the server sends: "W2MV", version, type, sizes, then the cells.

export interface Volume {
  rev: number;
  shape: [number, number, number];
  cells: Uint8Array | Uint16Array; // C order
}

const HEADER_BYTES = 40;
const MAGIC = 0x564d3257; // "W2MV", little-endian

export async function readVolume(what: string): Promise<Volume> {
  const answer = await fetch(`api/volume?what=${what}`);
  if (!answer.ok) throw new Error(`${what}: ${answer.status} ${answer.statusText}`);
  return { rev: Number(answer.headers.get("X-Rev")), ...parseVolume(await answer.arrayBuffer()) };
}

/** The cells of a volume of bytes that lies elsewhere. */
export async function readVolumeAt(path: string): Promise<Uint8Array> {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status} ${answer.statusText}`);
  return parseVolume(await answer.arrayBuffer()).cells as Uint8Array;
}

/** Take a volume apart; what is no volume is an Error. */
export function parseVolume(buffer: ArrayBuffer): Omit<Volume, "rev"> {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER_BYTES || view.getUint32(0, true) !== MAGIC) {
    throw new Error("not a volume");
  }
  if (view.getUint16(4, true) !== 1) throw new Error("a volume of another version");
  const wide = view.getUint8(6) === 1;
  const shape = [8, 12, 16].map((at) => view.getUint32(at, true)) as [number, number, number];
  const count = shape[0] * shape[1] * shape[2];
  if (buffer.byteLength < HEADER_BYTES + count * (wide ? 2 : 1)) throw new Error("a cut volume");
  const cells = wide
    ? new Uint16Array(buffer, HEADER_BYTES, count)
    : new Uint8Array(buffer, HEADER_BYTES, count);
  return { shape, cells };
}
