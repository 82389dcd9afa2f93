// The received part of the table of measured quantities: step, time, and one column per quantity.
import type { Update } from "./protocol";

export class Rows {
  /** Number of the table; -1: none yet. */
  number = -1;
  count = 0;
  private columns: Float64Array[] = [];
  private ascending = true;

  /** Replaces the rows from `from` on. Another number starts a new table. Returns false if rows are missing. */
  take(table: NonNullable<Update["table"]>): boolean {
    const width = table.rows > 0 ? table.values.length / table.rows : this.columns.length;
    if (table.number !== this.number || (table.rows > 0 && width !== this.columns.length)) {
      this.number = table.number;
      this.count = 0;
      this.columns = Array.from({ length: width }, () => new Float64Array(64));
      this.ascending = true;
    }
    if (table.from > this.count) return false;
    this.count = table.from;
    for (let row = 0; row < table.rows; ++row) {
      const k = this.count++;
      this.columns.forEach((column, c) => {
        if (k >= column.length) {
          const longer = new Float64Array(2 * column.length);
          longer.set(column);
          this.columns[c] = column = longer;
        }
        column[k] = table.values[row * width + c];
      });
      const time = this.columns[1];
      if (k > 0 && time[k] < time[k - 1]) this.ascending = false;
    }
    return true;
  }

  /** Clears the table, so that it is requested again. */
  forget(): void {
    this.number = -1;
    this.count = 0;
    this.columns = [];
  }

  /** Column c (0 step, 1 time, 2 the first quantity, ...), sorted by time even if the run went back. */
  column(c: number): Float64Array {
    const column = (this.columns[c] ?? new Float64Array(0)).subarray(0, this.count);
    const time = this.columns[1];
    if (this.ascending) return column;
    const order = Array.from({ length: this.count }, (_, k) => k).sort((a, b) => time[a] - time[b] || a - b);
    return Float64Array.from(order, (k) => column[k]);
  }

  /** As comma-separated values, with `names` as the header. */
  csv(names: string[]): string {
    const quoted = names.map((name) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name));
    const lines = [quoted.join(",")];
    for (let row = 0; row < this.count; ++row)
      lines.push(this.columns.map((column) => (Number.isNaN(column[row]) ? "" : String(column[row]))).join(","));
    return `${lines.join("\n")}\n`;
  }
}
