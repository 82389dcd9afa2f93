// The socket to the window: opens it with the token of the page's address, requests one update at a time, reconnects
// when it breaks.
import { decode, type Bye, type Hello, type Message, type Reply, type Update } from "./protocol";

export interface ConnectionEvents {
  hello(hello: Hello): void;
  update(update: Update): void;
  bye(bye: Bye): void;
  /**
   * Events: the socket is open; it broke and will be reopened in this number of seconds (0: now); a message was
   * damaged.
   */
  opened(): void;
  broken(seconds: number, attempt: number, reason: string): void;
  damaged(error: string): void;
}

export type Words = { do: string; [more: string]: unknown };

/** The backend of a page: a window behind a socket, or a recording in the page. */
export interface Link {
  readonly connected: boolean;
  /** Sends a request and waits for the reply. An error in it is a refusal, or there is no connection. */
  say(words: Words): Promise<Reply>;
  /** Requests the next update; `rows` of the table `table` are known. No-op if a request is pending. */
  next(rows: number, table: number): void;
  /** Reconnects now instead of after a pause. */
  retry(): void;
}

const longest_pause = 8; // seconds

export class Connection implements Link {
  private socket: WebSocket | null = null;
  private number = 0;
  private waiting = new Map<number, (reply: Reply) => void>();
  private attempt = 0;
  private timer = 0;
  private asked = false;
  private over = false;

  constructor(private readonly events: ConnectionEvents) {
    this.open();
  }

  get connected(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  say(words: Words): Promise<Reply> {
    const id = ++this.number;
    if (!this.connected) return Promise.resolve({ type: "reply", id, error: "there is no connection to the window" });
    return new Promise((resolve) => {
      this.waiting.set(id, resolve);
      this.socket?.send(JSON.stringify({ ...words, id }));
    });
  }

  next(rows: number, table: number): void {
    if (this.asked || !this.connected) return;
    this.asked = true;
    this.socket?.send(JSON.stringify({ do: "next", rows, table }));
  }

  retry(): void {
    if (!this.socket && !this.over) this.open();
  }

  private open(): void {
    clearTimeout(this.timer);
    this.asked = false;
    const { protocol, host, search } = location;
    const token = new URLSearchParams(search).get("token") ?? "";
    const secure = protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${secure}//${host}/socket?token=${encodeURIComponent(token)}`);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.events.opened();
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.heard(event.data);
    socket.onclose = ({ reason }) => this.closed(reason ?? "");
  }

  private heard(data: string | ArrayBuffer): void {
    let message: Message;
    try {
      message = typeof data === "string" ? (JSON.parse(data) as Message) : decode(data);
    } catch (error) {
      this.asked = false;
      this.events.damaged(String(error));
      return;
    }
    this.attempt = 0;
    switch (message.type) {
      case "hello":
        return this.events.hello(message);
      case "update":
        this.asked = false;
        return this.events.update(message);
      case "bye":
        this.over = true;
        return this.events.bye(message);
      case "reply":
        this.waiting.get(message.id)?.(message);
        this.waiting.delete(message.id);
    }
  }

  private closed(reason: string): void {
    this.socket = null;
    for (const [id, resolve] of this.waiting)
      resolve({ type: "reply", id, error: "the connection to the window broke" });
    this.waiting.clear();
    if (this.over) return;
    const seconds = Math.min(longest_pause, 0.5 * 2 ** this.attempt++);
    this.timer = window.setTimeout(() => this.open(), seconds * 1000);
    this.events.broken(seconds, this.attempt, reason);
  }
}
