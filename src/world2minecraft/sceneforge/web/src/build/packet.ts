// What rendering/mesh/packets.py packs: a JSON header, then arrays.

export type Values = Uint8Array | Uint16Array | Int32Array | Float32Array;

interface Row {
  dtype: string;
  shape: number[];
  offset: number;
}

const KINDS = { u1: Uint8Array, u2: Uint16Array, i4: Int32Array, f4: Float32Array } as const;

export class Packet {
  private constructor(
    /** All that the header says beside the arrays. */
    readonly told: Readonly<Record<string, unknown>>,
    private readonly rows: Readonly<Record<string, Row>>,
    private readonly data: ArrayBuffer,
    private readonly begin: number,
  ) {}

  static read(data: ArrayBuffer, magic: string): Packet {
    const head = new Uint8Array(data, 0, 4);
    if (String.fromCharCode(...head) !== magic) throw new Error(`not ${magic}`);
    const size = new DataView(data).getUint32(4, true);
    const text = new TextDecoder().decode(new Uint8Array(data, 8, size));
    const { arrays, ...told } = JSON.parse(text) as { arrays: Record<string, Row> };
    return new Packet(told, arrays, data, 8 + size);
  }

  array(name: string): { values: Values; shape: readonly number[] } {
    const row = this.rows[name];
    const kind = row && KINDS[row.dtype as keyof typeof KINDS];
    if (!kind) throw new Error(`no array ${name}`);
    const count = row.shape.reduce((a, b) => a * b, 1);
    return { values: new kind(this.data, this.begin + row.offset, count), shape: row.shape };
  }
}
