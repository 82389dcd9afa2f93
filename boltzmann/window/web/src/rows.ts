// The table of measured quantities as far as it is here: step, time, and one column for each.
import type { Update } from "./protocol";

export class Rows {
  /** Of the table; -1: none yet. */
  number = -1;
  count = 0;
  private columns: Float64Array[] = [];
  private ascending = true;

  /** Takes new rows over what is known from row `from` on. Another number starts anew. False if rows are missing. */
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

  /** Asks for the whole table again. */
  forget(): void {
    this.number = -1;
    this.count = 0;
    this.columns = [];
  }

  /** Column c (0 step, 1 time, 2 the first quantity, ...), in the order of time also when the run went back. */
  column(c: number): Float64Array {
    const column = (this.columns[c] ?? new Float64Array(0)).subarray(0, this.count);
    const time = this.columns[1];
    if (this.ascending) return column;
    const order = Array.from({ length: this.count }, (_, k) => k).sort((a, b) => time[a] - time[b] || a - b);
    return Float64Array.from(order, (k) => column[k]);
  }

  /** As comma-separated values, `names` over the columns. */
  csv(names: string[]): string {
    const quoted = names.map((name) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name));
    const lines = [quoted.join(",")];
    for (let row = 0; row < this.count; ++row)
      lines.push(this.columns.map((column) => (Number.isNaN(column[row]) ? "" : String(column[row]))).join(","));
    return `${lines.join("\n")}\n`;
  }
}
